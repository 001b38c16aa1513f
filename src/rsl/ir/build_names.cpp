// Names of optional parameters that are no literals ("string n = "samples"; occlusion(P, N, 0, n, 16)"). Most are known when the
// kernel is built, as the strings that a scene gives are; the call is then built as if they were written. Where a name is known
// only when the kernel runs, the call is built once for each parameter that takes the value, and once without; the one that runs
// is found by comparison.
#include "base/diagnostics.h"
#include "rsl/front/clone.h"
#include "rsl/ir/builder.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

namespace {

/// Calls that one may become.
constexpr size_t kCallsByName = 64;

/// Whether something can be put there.
bool isPlace(const Expr& e) {
    const Expr* root = &e;
    while (root->kind == ExprKind::Index && !root->args.empty()) root = root->args[0].get();
    return root->kind == ExprKind::Variable && root->symbol;
}

/// "uniform float blur" declares in place: the name is the last word.
std::string lastWord(const std::string& text) {
    const size_t space = text.find_last_of(" \t");
    return space == std::string::npos ? text : text.substr(space + 1);
}

bool takes(const OptionalParameter& o, const Expr& v) {
    const Type t = v.type;
    const auto width = [](Base b) { return componentCount(b); };
    if (isStringLike(o.type.base) != isStringLike(t.base))
        return !o.output && o.type == Type{Base::String, 0} && o.name.ends_with("space") && t.base == Base::Matrix && !t.array;
    if (o.output) return isPlace(v) && width(o.type.base) == width(t.base);
    if (t.array && !o.type.array) return false;
    return width(o.type.base) == width(t.base) || width(t.base) == 1;
}

const OptionalParameter* parameterOf(const Shadeop& op, const std::string& name) {
    const auto o =
        std::find_if(op.optional.begin(), op.optional.end(), [&](const OptionalParameter& p) { return p.name == name; });
    return o == op.optional.end() ? nullptr : &*o;
}

bool hasMadeNames(const std::vector<NamedArg>& pairs) {
    return std::any_of(pairs.begin(), pairs.end(), [](const NamedArg& p) { return p.named == NamedArg::Name::Made; });
}

} // namespace

/// Gives a pair its name; false, with a message, where the call has no use for it.
bool Builder::nameArgument(const Shadeop& op, NamedArg& p, const std::string& text) {
    p.name = lastWord(text);
    p.named = NamedArg::Name::Written;
    const OptionalParameter* o = parameterOf(op, p.name);
    if (!o) { // messages have a colon, channels any name
        p.output = op.name == "texture3d" && isPlace(*p.value);
        if (op.name == "texture3d" || op.name == "bake3d" || p.name.find(':') != std::string::npos) return true;
        std::vector<std::string> names;
        for (const OptionalParameter& known : op.optional) names.push_back(known.name);
        const std::string near = nearestName(p.name, names);
        report(p.place, msg::kNoSuchParameter(op.name, p.name), near.empty() ? "" : "did you mean \"" + near + "\"?");
        return false;
    }
    p.output = o->output;
    if (takes(*o, *p.value)) return true;
    report(p.place, o->output ? msg::kOutputPair(p.name, toString(o->type))
                              : msg::kPairType(p.name, op.name, toString(o->type), toString(p.value->type)));
    return false;
}

/// The call with the names that are known now. `open`: pairs, by their place in the call, whose names are known when it runs.
ExprPtr Builder::namedNow(const Expr& e, std::vector<std::pair<size_t, Inst*>>& open) {
    ExprPtr call = front::clone(e);
    std::vector<NamedArg> pairs;
    Inst* name = nullptr;
    for (NamedArg& p : call->pairs) {
        if (p.named == NamedArg::Name::Made) {
            name = expr(*p.value, Kind::String);
            continue;
        }
        if (p.named == NamedArg::Name::ByMade) {
            if (name->op == Op::ConstString) {
                if (name->text.empty() || !nameArgument(*e.shadeop, p, name->text)) continue;
            } else {
                open.emplace_back(pairs.size(), name);
            }
        }
        pairs.push_back(std::move(p));
    }
    call->pairs = std::move(pairs);
    return call;
}

/// The call without names that are made; itself where it has none. Names that only the run knows are refused.
const Expr& Builder::withNames(const Expr& e) {
    // NOLINTNEXTLINE(bugprone-return-const-ref-from-parameter): an expression of the syntax tree, which outlives the builder
    if (!hasMadeNames(e.pairs)) return e;
    std::vector<std::pair<size_t, Inst*>> open;
    named_.push_back(namedNow(e, open));
    Expr& call = *named_.back();
    for (size_t n = open.size(); n-- > 0;) {
        NamedArg& p = call.pairs[open[n].first];
        report(p.place, msg::kMadeNameArray(e.shadeop->name));
        call.pairs.erase(call.pairs.begin() + static_cast<std::ptrdiff_t>(open[n].first));
    }
    return call;
}

/// A call with names that are no literals; null where all are.
Inst* Builder::callByNames(const Expr& e) {
    if (!hasMadeNames(e.pairs)) return nullptr;
    if (e.type.array) return shadeopCall(withNames(e));
    std::vector<std::pair<size_t, Inst*>> open;
    ExprPtr call = namedNow(e, open);
    size_t calls = 1;
    for (const auto& [at, name] : open)
        calls *= 1 + static_cast<size_t>(std::count_if(e.shadeop->optional.begin(), e.shadeop->optional.end(),
                                                       [&, n = at](const auto& o) { return takes(o, *call->pairs[n].value); }));
    if (calls > kCallsByName) {
        report(e.place, msg::kMadeNames(open.size(), e.shadeop->name, calls, kCallsByName));
        return zero(kindOf(e.type) == Kind::None ? Kind::Float : kindOf(e.type));
    }
    return chooseNames(std::move(call), open);
}

/// The last of the open names decides between calls, in which the others do.
Inst* Builder::chooseNames(ExprPtr call, std::span<const std::pair<size_t, Inst*>> open) {
    if (open.empty()) {
        named_.push_back(std::move(call));
        return shadeopCall(*named_.back());
    }
    const auto [at, name] = open.back();
    const std::span rest = open.first(open.size() - 1);
    const Shadeop& op = *call->shadeop;
    std::vector<const OptionalParameter*> all;
    for (const OptionalParameter& o : op.optional)
        if (takes(o, *call->pairs[at].value)) all.push_back(&o);
    const std::function<std::vector<Inst*>(size_t)> from = [&](size_t n) -> std::vector<Inst*> {
        ExprPtr one = front::clone(*call);
        NamedArg& p = one->pairs[at];
        if (n == all.size()) {
            Site s = complaint(msg::kNoSuchParameterOfType(op.name, kWhenRun));
            place_ = s.place = keptPlace(p.place);
            std::vector<Inst*> args;
            addArgument(s, args, name, {Base::String, 0});
            branch(
                emit(Op::NotEqual, Kind::Bool, {name, leaves_.string("")}),
                [&] {
                    this->call(Op::Service, std::move(s), std::move(args));
                    return std::vector<Inst*>{};
                },
                [] { return std::vector<Inst*>{}; });
            one->pairs.erase(one->pairs.begin() + static_cast<std::ptrdiff_t>(at));
            return {chooseNames(std::move(one), rest)};
        }
        p.name = all[n]->name;
        p.output = all[n]->output;
        p.named = NamedArg::Name::Written;
        return branch(
            emit(Op::Equal, Kind::Bool, {name, leaves_.string(p.name)}),
            [&] { return std::vector<Inst*>{chooseNames(std::move(one), rest)}; }, [&] { return from(n + 1); });
    };
    return from(0)[0];
}

/// The pairs of a statement, with the names that are known now; others are refused.
std::vector<Builder::Pair> Builder::pairsOf(const Stmt& s) {
    std::vector<Pair> all;
    Inst* name = nullptr;
    for (const NamedArg& p : s.pairs) {
        if (p.named == NamedArg::Name::Made) name = p.value ? expr(*p.value, Kind::String) : nullptr;
        else if (p.named == NamedArg::Name::Written) all.push_back({p.name, p.value.get(), p.output, p.place});
        else if (name && name->op == Op::ConstString) {
            const bool output = name->text.find(':') != std::string::npos && !name->text.starts_with("send:");
            if (output && p.value && !isPlace(*p.value)) report(p.place, msg::kOutputPairValue(name->text));
            else if (!name->text.empty()) all.push_back({name->text, p.value.get(), output, p.place});
        } else {
            report(p.place, msg::kMadeNameStatement(s.kind == StmtKind::Gather ? "gather" : "illuminance"));
        }
    }
    return all;
}

} // namespace alpenglow::rsl::ir
