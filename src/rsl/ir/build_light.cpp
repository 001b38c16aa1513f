// illuminance in surfaces and volumes; illuminate and solar in lights.
#include "base/category.h"
#include "base/limits.h"
#include "rsl/front/protocol.h"
#include "rsl/front/visit.h"
#include "rsl/ir/builder.h"
#include <functional>
#include <set>
#include <utility>

namespace alpenglow::rsl::ir {

void Builder::illuminance(const Stmt& s) {
    const Type vector{Base::Vector, 0}, color{Base::Color, 0};
    Site site;
    site.op = "illuminance";
    site.place = keptPlace(s.place);
    // What the renderer must know before the loop begins, beyond P, axis and angle: a call of its own.
    Site setup;
    setup.op = "lightsetup";
    setup.place = keptPlace(s.place);
    std::vector<Inst*> given;
    const auto give = [&](const std::string& name, Inst* v, Type t) {
        setup.names.push_back(name);
        setup.pairStrings.push_back(v->op == Op::ConstString ? v->text : "");
        if (v->op != Op::ConstString) addArgument(setup, given, v, t);
    };
    site.strings.push_back("");
    if (s.category) {
        Inst* c = expr(*s.category);
        if (c->op == Op::ConstString) site.strings[0] = c->text;
        else give("category", c, {Base::String, 0});
        if (const std::string wrong = categoryError(site.strings[0]); !wrong.empty()) {
            report(s.place, msg::kLightCategory(site.strings[0], wrong));
            site.strings[0].clear();
        }
    }
    std::vector<const Pair*> lightParameters;
    const std::vector<Pair> all = pairsOf(s);
    for (const Pair& p : all) {
        if (p.name.rfind("light:", 0) == 0) {
            lightParameters.push_back(&p);
            continue;
        }
        if (!p.value) continue;
        if (const PairName pair = PairName::parse(p.name); pair.kind == PairName::Kind::Send && pair.to == PairName::To::Light) {
            if (p.value->type.array) {
                if (p.value->type.base == Base::String) {
                    report(p.place, msg::kLightPairStrings(p.name));
                    continue;
                }
                Inst* a = array(*p.value);
                for (int n = 0; n < arrayLength(a); ++n)
                    give(PairName::send(pair.name, n).text(),
                         emit(Op::ArrayLoad, a->element, {a, constant(static_cast<float>(n))}), p.value->type.element());
                continue;
            }
            Inst* v = expr(*p.value);
            if (v->kind == Kind::Bool) v = coerce(v, Kind::Float);
            if (v->kind == Kind::String && v->op != Op::ConstString) report(p.place, msg::kSentString(p.name));
            else give(p.name, v, p.value->type);
            continue;
        }
        Inst* v = expr(*p.value);
        const bool cache = p.name == "lightcache";
        if (!cache || v->op != Op::ConstString || (v->text != "reuse" && v->text != "refresh")) {
            report(p.place, cache ? Raised(msg::kLightCache) : msg::kLightPair(p.name));
            continue;
        }
        site.names.push_back(p.name);
        site.pairStrings.push_back(v->text);
    }
    // Outputs of the shader that lights of the scene ask for, as they are now.
    for (const auto& [name, parameter] : messageSlots_)
        give(PairName::surface(name).text(), get(parameter.first), parameter.second);
    if (const auto n = globals_.find("N"); n != globals_.end() && writes_.count("N"))
        give("N", get(n->second), {Base::Normal, 0});
    Inst* inst = k_.make(Op::LightLoop, Kind::None);
    inst->place = keptPlace(s.place);
    inst->regions.resize(1);
    inst->args.push_back(s.exprs.empty() ? global("P", Base::Point) : expr(*s.exprs[0], Kind::Triple));
    inst->args.push_back(s.exprs.size() > 1 ? expr(*s.exprs[1], Kind::Triple) : zero(Kind::Triple));
    inst->args.push_back(s.exprs.size() > 2 ? expr(*s.exprs[2], Kind::Float) : constant(3.14159274f));

    if (!setup.names.empty()) {
        site.names.push_back(kPairSetUp);
        site.pairStrings.push_back("1");
        place_ = s.place;
        call(Op::Service, std::move(setup), std::move(given));
    }
    std::set<int> assigned;
    std::set<const Function*> seen;
    for (const StmtPtr& b : s.body)
        if (b) scanAssigned(*b, assigned, seen);
    for (const Pair* p : lightParameters)
        if (p->value && p->value->kind == ExprKind::Variable && p->value->symbol) assigned.insert(slot(p->value->symbol));
    Frame& f = frames_.back();
    for (const LoopFrame& l : f.loops) assigned.insert({l.broken, l.continued});
    if (f.returned >= 0) assigned.insert(f.returned);
    if (f.result >= 0) assigned.insert(f.result);
    const LoopFrame flags{newSlot(boolean(false)), newSlot(boolean(false))};
    assigned.insert(flags.broken);

    addLengths(assigned);
    // L, Cl, Ol exist inside the block only.
    int lightSlots[3];
    const char* const names[] = {"L", "Cl", "Ol"};
    for (int n = 0; n < 3; ++n) {
        const auto it = globals_.find(names[n]);
        if (it != globals_.end()) {
            lightSlots[n] = it->second;
        } else {
            lightSlots[n] = globals_[names[n]] = newSlot(zero(Kind::Triple));
        }
        if (!env_[static_cast<size_t>(lightSlots[n])]) env_[static_cast<size_t>(lightSlots[n])] = zero(Kind::Triple);
        assigned.erase(lightSlots[n]);
    }
    std::vector<int> carried;
    for (int n : assigned) {
        const Symbol* sym = symbols_[static_cast<size_t>(n)];
        if (sym && sym->origin == Symbol::Origin::Global) get(n);
        Inst* v = env_[static_cast<size_t>(n)];
        if (!v || v->kind == Kind::Array) continue;
        carried.push_back(n);
        inst->args.push_back(v);
        inst->results.push_back(v->kind);
    }
    const size_t mark = log_.size();
    Region* saved = region_;
    Region& r = inst->regions[0];
    region_ = &r;
    const auto param = [&](Kind k) {
        Inst* p = k_.make(Op::RegionParam, k);
        p->index = static_cast<int>(r.params.size());
        r.params.push_back(p);
        return p;
    };
    Inst* L = param(Kind::Triple);
    Inst* Cl = param(Kind::Triple);
    Inst* Ol = param(Kind::Triple);
    Inst* light = param(Kind::Float);
    for (size_t c = 0; c < carried.size(); ++c) set(carried[c], param(inst->results[c]));
    const std::set<std::string> writes = writes_;
    frames_.back().loops.push_back(flags);
    ++lightDepth_;
    branch(
        emit(Op::Not, Kind::Bool, {get(flags.broken)}),
        [&] {
            Inst* visible = Cl;
            if (options_.path) { // the shadow between the light and P: a request of its own
                Site shadow;
                shadow.op = "lightvisibility";
                shadow.argKinds = {Kind::Float, Kind::Triple};
                shadow.argTypes = {{Base::Float, 0}, vector};
                shadow.resultKinds = {Kind::Triple};
                shadow.resultNames = {""};
                shadow.resultType = color;
                place_ = s.place;
                visible = emit(Op::Mul, Kind::Triple, {Cl, call(Op::Request, std::move(shadow), {light, L})[0]});
            }
            set(lightSlots[0], L);
            set(lightSlots[1], visible);
            set(lightSlots[2], Ol);
            set(flags.continued, boolean(false));
            for (const Pair* p : lightParameters) {
                Site get;
                get.op = "lightsource";
                get.strings = {p->name.substr(6)};
                get.resultType = {Base::Float, 0};
                get.shadeop = findShadeop("lightsource");
                Inst* whole = p->value->type.array ? array(*p->value) : nullptr;
                const int count = whole ? arrayLength(whole) : 1;
                get.resultKinds = {Kind::Float};
                get.resultNames = {""};
                for (int n = 0; n < count; ++n) {
                    get.resultKinds.push_back(kindOf(p->value->type.element()));
                    get.resultNames.push_back(whole ? "value[" + std::to_string(n) + "]" : "value");
                }
                const std::vector<Inst*> v = call(Op::Service, std::move(get), {});
                Inst* found = emit(Op::NotEqual, Kind::Bool, {v[0], constant(0)});
                for (int n = 0; whole && whole->op == Op::ArrayNew && n < count; ++n) {
                    Inst* at = constant(static_cast<float>(n));
                    Inst* element = v[static_cast<size_t>(n) + 1];
                    emit(Op::ArrayStore, Kind::None,
                         {whole, at,
                          emit(Op::Select, element->kind, {found, element, emit(Op::ArrayLoad, whole->element, {whole, at})})});
                }
                if (whole) continue;
                const Held held(*this, *p->value);
                assign(*p->value, emit(Op::Select, v[1]->kind, {found, v[1], coerce(expr(*p->value), v[1]->kind)}));
            }
            statements(s.body, 0);
            return std::vector<Inst*>{};
        },
        [] { return std::vector<Inst*>{}; });
    --lightDepth_;
    frames_.back().loops.pop_back();
    for (int n : carried) r.yields.push_back(get(n));
    region_ = saved;
    while (log_.size() > mark) {
        env_[static_cast<size_t>(log_.back().first)] = log_.back().second;
        log_.pop_back();
    }
    writes_ = writes;
    for (int n : carried)
        if (const Symbol* sym = symbols_[static_cast<size_t>(n)]; sym && sym->origin == Symbol::Origin::Global)
            writes_.insert(sym->name);
    inst->site = static_cast<int>(k_.sites.size());
    k_.sites.push_back(std::move(site));
    region_->body.push_back(inst);
    place_ = s.place;
    for (size_t c = 0; c < carried.size(); ++c) set(carried[c], emit(Op::Result, inst->results[c], {inst}, static_cast<int>(c)));
}

int Builder::addBlock(const Stmt& s) {
    LightBlock b{&s, s.kind == StmtKind::Solar, 0, 0, 0, 0};
    b.L = newSlot(zero(Kind::Triple));
    b.Cl = newSlot(zero(Kind::Triple));
    b.Ol = newSlot(leaves_.constant(Kind::Triple, 1.0f));
    b.lit = newSlot(constant(0));
    lightBlocks_.push_back(b);
    return static_cast<int>(lightBlocks_.size()) - 1;
}

/// Blocks of a body and of the functions that it calls, once for each call, in order of the text, up to one more than there may
/// be. `without`: functions that have none, which are not looked into again.
static void blocksOf(const Stmt& s, std::vector<const Stmt*>& found, std::set<const Function*>& without) {
    const auto statement = [&](const Stmt& x) {
        if ((x.kind == StmtKind::Illuminate || x.kind == StmtKind::Solar) && found.size() <= limits::kLightBlocks)
            found.push_back(&x);
    };
    front::everyStmt(s, statement, [&](const Expr& e) {
        if (!e.function || !e.function->body || found.size() > limits::kLightBlocks || without.count(e.function)) return;
        const size_t before = found.size();
        blocksOf(*e.function->body, found, without);
        if (found.size() == before) without.insert(e.function);
    });
}

/// The blocks of the shader, before any is built, so that loops and conditions around them carry their slots.
void Builder::findBlocks(const Stmt& s) {
    std::vector<const Stmt*> found;
    std::set<const Function*> without;
    blocksOf(s, found, without);
    for (const Stmt* b : found) addBlock(*b);
}

/// The angle of a cone: beyond pi it has all directions.
Inst* Builder::within(Inst* angle) {
    Inst* most = constant(3.14159265f);
    return emit(Op::Select, Kind::Float, {emit(Op::Less, Kind::Bool, {most, angle}), most, angle});
}

/// A direction of the cone about `axis`, as long as it. The renderer's numbers (transport: coneNumbers) are three: how far from
/// the axis, evenly over the solid angle, and a unit vector that says which way; zero far is the axis itself.
Inst* Builder::inCone(Inst* axis, Inst* angle) {
    Inst* numbers = input("Ci", {Base::Color, 0}, false);
    const auto part = [&](Inst* v, int n) { return emit(Op::Extract, Kind::Float, {v}, n); };
    const auto times = [&](Inst* v, Inst* k) { return emit(Op::Mul, Kind::Triple, {v, coerce(k, Kind::Triple)}); };
    const auto minus = [&](Inst* a, Inst* b) { return emit(Op::Sub, Kind::Float, {a, b}); };
    const auto product = [&](Inst* a, Inst* b) { return emit(Op::Mul, Kind::Float, {a, b}); };
    Inst* n = runtime1("al_normalize_t", {axis}, Kind::Triple);
    Inst* steep = emit(Op::Less, Kind::Bool, {product(part(n, 0), part(n, 0)), constant(0.5f)});
    Inst* beside = emit(Op::Select, Kind::Triple,
                        {steep, leaves_.constant(Kind::Triple, std::vector<float>{1, 0, 0}),
                         leaves_.constant(Kind::Triple, std::vector<float>{0, 1, 0})});
    Inst* t = runtime1("al_normalize_t", {cross(n, beside)}, Kind::Triple);
    Inst* u = cross(n, t);
    Inst* half = runtime1("al_sin", {product(within(angle), constant(0.5f))}, Kind::Float);
    Inst* height = product(part(numbers, 0), product(constant(2), product(half, half))); // 1 - cos
    Inst* away = runtime1("al_sqrt", {product(height, minus(constant(2), height))}, Kind::Float);
    Inst* sideways = emit(Op::Add, Kind::Triple, {times(t, part(numbers, 1)), times(u, part(numbers, 2))});
    Inst* unit = emit(Op::Add, Kind::Triple, {times(n, minus(constant(1), height)), times(sideways, away)});
    return times(unit, runtime1("al_length", {axis}, Kind::Float));
}

void Builder::lightBlock(const Stmt& s) {
    int index = -1;
    for (size_t n = 0; n < lightBlocks_.size() && index < 0; ++n)
        if (lightBlocks_[n].stmt == &s && !lightBlocks_[n].built) index = static_cast<int>(n);
    if (lightBlocks_.size() > limits::kLightBlocks || (index < 0 && lightBlocks_.size() == limits::kLightBlocks)) {
        report(s.place, msg::kLightBlocks(limits::kLightBlocks));
        return;
    }
    if (index < 0) index = addBlock(s); // in a method of a co-shader
    lightBlocks_[static_cast<size_t>(index)].built = true;
    const LightBlock b = lightBlocks_[static_cast<size_t>(index)];
    Inst *L, *lit = boolean(true);
    if (s.kind == StmtKind::Solar) {
        // All directions: the renderer's, from where P stands.
        L = s.exprs.empty() ? emit(Op::Sub, Kind::Triple, {global("Ps", Base::Point), global("P", Base::Point)})
                            : expr(*s.exprs[0], Kind::Triple);
        if (s.exprs.size() > 1)
            if (Inst* angle = expr(*s.exprs[1], Kind::Float); !isConst(angle) || angle->numbers[0] != 0) {
                place_ = s.place;
                L = inCone(L, angle);
                lightBlocks_[static_cast<size_t>(index)].cone = true;
            }
    } else {
        L = emit(Op::Sub, Kind::Triple,
                 {global("Ps", Base::Point), s.exprs.empty() ? global("P", Base::Point) : expr(*s.exprs[0], Kind::Triple)});
        if (s.exprs.size() > 2) {
            Inst* axis = expr(*s.exprs[1], Kind::Triple);
            Inst* angle = expr(*s.exprs[2], Kind::Float);
            place_ = s.place;
            Inst* lengths =
                emit(Op::Mul, Kind::Float, {runtime1("al_length", {L}, Kind::Float), runtime1("al_length", {axis}, Kind::Float)});
            // -2 for all directions: the product of lengths may round to less than -dot(L, axis).
            Inst* all = emit(Op::LessEqual, Kind::Bool, {constant(3.14159265f), angle});
            Inst* cosine = emit(Op::Select, Kind::Float, {all, constant(-2), runtime1("al_cos", {within(angle)}, Kind::Float)});
            Inst* limit = emit(Op::Mul, Kind::Float, {cosine, lengths});
            lit = emit(Op::LessEqual, Kind::Bool, {limit, dot(L, axis)});
        }
    }
    int slots[3];
    const char* const names[] = {"L", "Cl", "Ol"};
    for (int n = 0; n < 3; ++n) {
        const auto it = globals_.find(names[n]);
        slots[n] = it != globals_.end() ? it->second : (globals_[names[n]] = newSlot(nullptr));
        if (!env_[static_cast<size_t>(slots[n])])
            env_[static_cast<size_t>(slots[n])] = leaves_.constant(Kind::Triple, n == 2 ? 1.0f : 0.0f);
    }
    Inst* before[3];
    for (int n = 0; n < 3; ++n) before[n] = get(slots[n]);
    const int litSlot = newSlot(constant(0));
    set(b.L, L);
    const bool outer = std::exchange(inSolar_, s.kind == StmtKind::Solar);
    ++blockDepth_;
    branch(
        lit,
        [&] {
            set(slots[0], L); // Cl and Ol are as the shader has left them: 0 and 1 at first
            statements(s.body, 0);
            set(litSlot, constant(1));
            set(b.Cl, get(slots[1]));
            set(b.Ol, get(slots[2]));
            set(b.L, get(slots[0])); // the block may have turned it: parallel rays of a projector
            return std::vector<Inst*>{};
        },
        [] { return std::vector<Inst*>{}; });
    --blockDepth_;
    inSolar_ = outer;
    set(b.lit, get(litSlot));
    for (int n = 0; n < 3; ++n) set(slots[n], before[n]);
    set(blockRan_, boolean(true));
    if (lightBlocks_.size() == 1 && region_ == &k_.body && frames_.size() == 1) { // black outside of the cone
        lightBlocks_[0].only = true;
        set(slots[1], get(b.Cl));
        set(slots[2], get(b.Ol));
    }
}

} // namespace alpenglow::rsl::ir
