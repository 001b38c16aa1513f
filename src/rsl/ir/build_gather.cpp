// gather: rays by the handful, then a loop over what they found. A turn that has no rays left asks for the next handful (Request
// "gather"), so that what they bring takes bounded memory; each turn then reads its own ray (Service "gatherturn").
#include "rsl/front/protocol.h"
#include "rsl/gatherrays.h"
#include "rsl/ir/builder.h"
#include <algorithm>
#include <string_view>

namespace alpenglow::rsl::ir {

namespace {

/// Pairs that a gather takes. Outputs have a colon.
bool isInput(const std::string& name) {
    static const std::set<std::string_view> kNames = {"label",         "subset",     "bias",         "hitmode",   "hitsides",
                                                      "maxdist",       "samplebase", "type",         "raytype",   "raylabel",
                                                      "excludesubset", "maxhitdist", "distribution", "othreshold"};
    return kNames.count(name) > 0;
}

} // namespace

/// The request of a gather for each batch of rays, and the variables that its iterations fill.
struct Builder::GatherCall {
    Site site, turn;
    std::vector<Inst*> args;
    std::vector<std::pair<Receiver, size_t>> outputs; ///< with the index of the flag that is set if there is a value
};

Builder::GatherCall Builder::gatherCall(const Stmt& s) {
    GatherCall g;
    g.site.op = "gather";
    g.turn.op = "gatherturn";
    const Type real{Base::Float, 0}, point{Base::Point, 0}, vector{Base::Vector, 0};
    g.site.place = g.turn.place = keptPlace(s.place);
    g.site.resultType = g.turn.resultType = real;
    g.site.shadeop = g.turn.shadeop = findShadeop("gather");
    const std::string number = std::to_string(gathers_++);
    g.site.strings.push_back("");
    if (s.category) {
        const Inst* c = expr(*s.category);
        if (c->op == Op::ConstString) g.site.strings[0] = c->text;
        else report(s.place, msg::kGatherCategoryConstant);
    }
    const Kind kinds[] = {Kind::Triple, Kind::Triple, Kind::Float, Kind::Float};
    const Type types[] = {point, vector, real, real};
    for (size_t i = 0; i < 4; ++i)
        addArgument(g.site, g.args, i < s.exprs.size() ? expr(*s.exprs[i], kinds[i]) : zero(kinds[i]), types[i]);
    addPair(g.site, kPairGather, number);
    addPair(g.turn, kPairGather, number);
    g.turn.resultKinds = {Kind::Float};
    g.turn.resultNames = {""};
    for (const Pair& p : pairsOf(s)) {
        if (!p.value) continue;
        if (p.output) {
            const size_t flag = g.turn.resultKinds.size();
            g.turn.resultKinds.push_back(Kind::Float);
            g.turn.resultNames.push_back("?" + p.name);
            g.outputs.push_back({receiver(g.turn, *p.value, p.name), flag});
            continue;
        }
        if (p.name.starts_with("send:")) {
            send(g.site, g.args, p);
            continue;
        }
        if (!isInput(p.name) || p.value->type.array) continue; // reported by front/lint_calls.cpp
        Inst* v = expr(*p.value);
        const bool text = v->kind == Kind::String,
                   wantsText = !(p.name == "bias" || p.name == "maxdist" || p.name == "samplebase" || p.name == "maxhitdist" ||
                                 p.name == "othreshold");
        if (text != wantsText) {
            report(p.place, msg::kGatherPairType(p.name, wantsText ? "string" : "number"));
            continue;
        }
        if (!text) v = coerce(v, p.name == "othreshold" ? Kind::Triple : Kind::Float);
        if (v->op == Op::ConstString && v->text.empty()) continue;
        addPair(g.site, g.args, p.name, v, {wantsText ? Base::String : v->kind == Kind::Triple ? Base::Color : Base::Float, 0});
    }
    g.site.resultKinds = {Kind::Float};
    g.site.resultNames = {""};
    return g;
}

/// A value for a parameter of the shaders that the rays meet. Of an array each element is an argument, and before them how many
/// there are.
void Builder::send(Site& site, std::vector<Inst*>& args, const Pair& p) {
    const PairName pair = PairName::parse(p.name);
    const Type type = p.value->type;
    if (pair.kind != PairName::Kind::Send) {
        report(p.place, msg::kGatherSend(p.name));
        return;
    }
    const bool handle = type.base == Base::Shader;
    if (handle || (pair.to == PairName::To::Light && type.base == Base::String)) {
        report(p.place, handle ? msg::kGatherSendShader(p.name) : msg::kGatherSendString(p.name));
        return;
    }
    const auto give = [&](const PairName& name, Inst* v, Type t) {
        site.names.push_back(name.text());
        site.pairStrings.emplace_back();
        addArgument(site, args, v, t);
    };
    if (!type.array) {
        Inst* v = expr(*p.value);
        return give(pair, v->kind == Kind::Bool ? coerce(v, Kind::Float) : v, type);
    }
    Inst* a = array(*p.value);
    refuseLonger(a, p.place, "\"" + p.name + "\"");
    give(PairName::send(pair.name, -1, pair.to, true), lengthOf(a), {Base::Float, 0});
    for (int n = 0; n < arrayLength(a); ++n)
        give(PairName::send(pair.name, n, pair.to), emit(Op::ArrayLoad, a->element, {a, constant(static_cast<float>(n))}),
             type.element());
}

std::set<int> Builder::assignedByGather(const Stmt& s) {
    std::set<int> assigned;
    std::set<const Function*> seen;
    scanAssigned(s, assigned, seen);
    return assigned;
}

/// One turn: the variables get what the ray found, and the statement for a hit or a miss runs.
void Builder::gatherTurn(const Stmt& s, GatherCall& g, Inst* ray) {
    std::vector<Inst*> args;
    addArgument(g.turn, args, ray, {Base::Float, 0});
    place_ = s.place;
    const std::vector<Inst*> r = call(Op::Service, std::move(g.turn), std::move(args));
    for (const auto& [receiver, flag] : g.outputs)
        receive(receiver, std::span(r).subspan(flag + 1, static_cast<size_t>(receiver.rows)), isNot0(r[flag]));
    when(
        isNot0(r[0]), [&] { statements(s.body, 0); },
        [&] {
            if (s.elseBody) statement(*s.elseBody);
        });
}

void Builder::gather(const Stmt& s) {
    GatherCall g = gatherCall(s);
    std::set<int> assigned = assignedByGather(s);
    const int turn = newSlot(constant(0)), end = newSlot(constant(1)), left = newSlot(constant(0));
    assigned.insert({turn, end, left});
    const auto less = [&](Inst* a, Inst* b) { return emit(Op::Less, Kind::Bool, {a, b}); };
    // The arguments of the request: P, dir, angle, samples, then the number of the turn, then pairs.
    g.site.argKinds.insert(g.site.argKinds.begin() + 4, Kind::Float);
    g.site.argTypes.insert(g.site.argTypes.begin() + 4, Type{Base::Float, 0});
    Turns t;
    t.goesOn = [&] { return less(get(turn), get(end)); };
    t.turn = [&] {
        when(less(get(left), constant(0.5f)), [&] {
            std::vector<Inst*> args = g.args;
            args.insert(args.begin() + 4, get(turn));
            place_ = s.place;
            set(end, call(Op::Request, std::move(g.site), std::move(args))[0]);
            set(left, constant(static_cast<float>(kGatherRays)));
        });
        Inst* now = get(turn);
        set(turn, emit(Op::Add, Kind::Float, {now, constant(1)}));
        set(left, emit(Op::Sub, Kind::Float, {get(left), constant(1)}));
        when(less(now, get(end)), [&] { gatherTurn(s, g, now); });
    };
    const bool jump = std::any_of(s.body.begin(), s.body.end(), [](const StmtPtr& b) { return b && jumps(*b); }) ||
                      (s.elseBody && jumps(*s.elseBody));
    turns(assigned, jump, t, s.place);
}

} // namespace alpenglow::rsl::ir
