// illuminance in surfaces and volumes; illuminate and solar in lights.
#include "rsl/ir/builder.h"
#include <functional>

namespace alpenglow::rsl::ir {

void Builder::illuminance(const Stmt& s) {
    if (lightDepth_ > 0) {
        error(s.place, "illuminance inside illuminance");
        return;
    }
    const Type vector{Base::Vector, 0}, color{Base::Color, 0};
    Site site;
    site.op = "illuminance";
    site.place = s.place;
    if (s.category) {
        Inst* c = expr(*s.category);
        if (c->op != Op::ConstString)
            warn(s.place, "the category of this illuminance is not known at compile time; all lights are taken");
        site.strings.push_back(c->op == Op::ConstString ? c->text : "");
    } else {
        site.strings.push_back("");
    }
    std::vector<const NamedArg*> lightParameters;
    for (const NamedArg& p : s.pairs) {
        if (p.name.rfind("light:", 0) == 0) {
            lightParameters.push_back(&p);
            continue;
        }
        Inst* v = p.value ? expr(*p.value) : nullptr;
        if (!v || v->op != Op::ConstString) {
            warn(p.place, "the pair \"" + p.name + "\" of illuminance is not yet available and has no effect");
            continue;
        }
        site.names.push_back(p.name);
        site.pairStrings.push_back(v->text);
    }
    Inst* inst = k_.make(Op::LightLoop, Kind::None);
    inst->place = s.place;
    inst->regions.resize(1);
    inst->args.push_back(s.exprs.empty() ? global("P", Base::Point) : expr(*s.exprs[0], Kind::Triple));
    inst->args.push_back(s.exprs.size() > 1 ? expr(*s.exprs[1], Kind::Triple) : zero(Kind::Triple));
    inst->args.push_back(s.exprs.size() > 2 ? expr(*s.exprs[2], Kind::Float) : constant(3.14159274f));

    std::set<int> assigned;
    std::set<const Function*> seen;
    for (const StmtPtr& b : s.body)
        if (b) scanAssigned(*b, assigned, seen);
    for (const NamedArg* p : lightParameters)
        if (p->value && p->value->kind == ExprKind::Variable && p->value->symbol) assigned.insert(slot(p->value->symbol));
    Frame& f = frames_.back();
    for (const LoopFrame& l : f.loops) {
        assigned.insert(l.broken);
        assigned.insert(l.continued);
    }
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
            for (const NamedArg* p : lightParameters) {
                Site get;
                get.op = "lightsource";
                get.strings = {p->name.substr(6)};
                get.resultKinds = {Kind::Float, kindOf(p->value->type)};
                get.resultNames = {"", "value"};
                get.resultType = {Base::Float, 0};
                get.shadeop = findShadeop("lightsource");
                if (p->value->type.array) continue;
                const std::vector<Inst*> v = call(Op::Service, std::move(get), {});
                Inst* found = emit(Op::NotEqual, Kind::Bool, {v[0], constant(0)});
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

/// Blocks of the shader's body, in order of the text, so that loops and conditions around them carry their slots.
void Builder::findBlocks(const Stmt& s) {
    if (s.kind == StmtKind::Illuminate || s.kind == StmtKind::Solar) addBlock(s);
    for (const StmtPtr& b : s.body)
        if (b) findBlocks(*b);
    if (s.elseBody) findBlocks(*s.elseBody);
}

void Builder::lightBlock(const Stmt& s) {
    int index = -1;
    for (size_t n = 0; n < lightBlocks_.size(); ++n)
        if (lightBlocks_[n].stmt == &s) index = static_cast<int>(n);
    if (index < 0) index = addBlock(s); // inside a function
    const LightBlock b = lightBlocks_[static_cast<size_t>(index)];
    Inst *L, *lit = boolean(true);
    if (s.kind == StmtKind::Solar) {
        L = s.exprs.empty() ? input("L", {Base::Vector, 0}, false) : expr(*s.exprs[0], Kind::Triple);
    } else {
        L = emit(Op::Sub, Kind::Triple,
                 {global("Ps", Base::Point), s.exprs.empty() ? global("P", Base::Point) : expr(*s.exprs[0], Kind::Triple)});
        if (s.exprs.size() > 2) {
            Inst* axis = expr(*s.exprs[1], Kind::Triple);
            Inst* angle = expr(*s.exprs[2], Kind::Float);
            place_ = s.place;
            Inst* lengths =
                emit(Op::Mul, Kind::Float, {runtime1("al_length", {L}, Kind::Float), runtime1("al_length", {axis}, Kind::Float)});
            Inst* limit = emit(Op::Mul, Kind::Float, {runtime1("al_cos", {angle}, Kind::Float), lengths});
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
    branch(
        lit,
        [&] {
            set(slots[0], L);
            set(slots[1], zero(Kind::Triple));
            set(slots[2], leaves_.constant(Kind::Triple, 1.0f));
            statements(s.body, 0);
            set(litSlot, constant(1));
            set(b.Cl, get(slots[1]));
            set(b.Ol, get(slots[2]));
            return std::vector<Inst*>{};
        },
        [] { return std::vector<Inst*>{}; });
    set(b.L, L);
    set(b.lit, get(litSlot));
    for (int n = 0; n < 3; ++n) set(slots[n], before[n]);
}

} // namespace alpenglow::rsl::ir
