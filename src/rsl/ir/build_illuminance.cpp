// illuminance in surfaces and volumes: a loop over the lights that reach a point.
#include "base/category.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"

namespace alpenglow::rsl::ir {

/// One illuminance statement while it is built.
struct Builder::Illuminance {
    Builder& b;
    const Stmt& s;
    Site site;                ///< of the loop
    Site setup;               ///< what the renderer must know before the loop begins, beyond P, axis and angle: a call of its own
    std::vector<Inst*> given; ///< arguments of that call
    std::vector<Pair> pairs;
    std::vector<const Pair*> lightParameters; ///< "light:NAME": variables that take parameters of each light
    LoopFrame flags;
    int light[3]; ///< slots of L, Cl, Ol

    void category();
    void readPairs();
    void send(const Pair&, const PairName&);
    void give(const std::string& name, Inst*, Type);
    void giveSurface();
    Inst* begin();
    std::set<int> assigned();
    void findLightSlots();
    void body(Inst* L, Inst* Cl, Inst* Ol, Inst* index);
    Inst* shadowed(Inst* L, Inst* Cl, Inst* index);
    void readLight(const Pair&);
};

/// Passes a value to the renderer before the loop begins.
void Builder::Illuminance::give(const std::string& name, Inst* v, Type t) { addPair(setup, given, name, v, t); }

void Builder::Illuminance::category() {
    site.strings.push_back("");
    if (!s.category) return;
    Inst* c = b.expr(*s.category);
    if (c->op == Op::ConstString) site.strings[0] = c->text;
    else give("category", c, {Base::String, 0});
    if (const std::string wrong = categoryError(site.strings[0]); !wrong.empty()) {
        b.report(s.place, msg::kLightCategory(site.strings[0], wrong));
        site.strings[0].clear();
    }
}

/// "send:light:NAME": a value for a parameter of the lights.
void Builder::Illuminance::send(const Pair& p, const PairName& pair) {
    const Type type = p.value->type;
    if (!type.array) {
        Inst* v = b.expr(*p.value);
        if (v->kind == Kind::Bool) v = b.coerce(v, Kind::Float);
        if (v->kind == Kind::String && v->op != Op::ConstString) b.report(p.place, msg::kSentString(p.name));
        else give(p.name, v, type);
        return;
    }
    if (isStringLike(type.base)) {
        b.report(p.place, msg::kLightPairStrings(p.name));
        return;
    }
    Inst* a = b.array(*p.value);
    for (int n = 0; n < b.arrayLength(a); ++n) give(PairName::send(pair.name, n).text(), b.load(a, n), type.element());
}

void Builder::Illuminance::readPairs() {
    pairs = b.pairsOf(s);
    for (const Pair& p : pairs) {
        if (p.name.rfind("light:", 0) == 0) {
            lightParameters.push_back(&p);
            continue;
        }
        if (!p.value) continue;
        if (const PairName pair = PairName::parse(p.name); pair.kind == PairName::Kind::Send && pair.to == PairName::To::Light) {
            send(p, pair);
            continue;
        }
        Inst* v = b.expr(*p.value);
        const bool cache = p.name == "lightcache";
        if (!cache || v->op != Op::ConstString || (v->text != "reuse" && v->text != "refresh")) {
            b.report(p.place, cache ? Raised(msg::kLightCache) : msg::kLightPair(p.name));
            continue;
        }
        addPair(site, p.name, v->text);
    }
}

/// The current values of outputs that lights of the scene query, and of N if the shader has changed it.
void Builder::Illuminance::giveSurface() {
    for (const auto& [name, parameter] : b.messageSlots_)
        give(PairName::surface(name).text(), b.get(parameter.first), parameter.second);
    if (const auto n = b.globals_.find("N"); n != b.globals_.end() && b.writes_.count("N"))
        give("N", b.get(n->second), {Base::Normal, 0});
}

/// The loop with its fixed operands. The service call before it passes the rest to the renderer.
Inst* Builder::Illuminance::begin() {
    Inst* inst = b.k_.make(Op::LightLoop, Kind::None);
    inst->place = b.keptPlace(s.place);
    inst->regions.resize(1);
    inst->args.push_back(s.exprs.empty() ? b.global("P", Base::Point) : b.expr(*s.exprs[0], Kind::Triple));
    inst->args.push_back(s.exprs.size() > 1 ? b.expr(*s.exprs[1], Kind::Triple) : b.zero(Kind::Triple));
    inst->args.push_back(s.exprs.size() > 2 ? b.expr(*s.exprs[2], Kind::Float) : b.constant(3.14159274f));
    if (!setup.names.empty()) {
        addPair(site, kPairSetUp, "1");
        b.place_ = s.place;
        b.call(Op::Service, std::move(setup), std::move(given));
    }
    return inst;
}

/// Slots that a turn may change.
std::set<int> Builder::Illuminance::assigned() {
    std::set<int> slots;
    std::set<const Function*> seen;
    for (const StmtPtr& statement : s.body)
        if (statement) b.scanAssigned(*statement, slots, seen);
    for (const Pair* p : lightParameters)
        if (p->value && p->value->kind == ExprKind::Variable && p->value->symbol) slots.insert(b.slot(p->value->symbol));
    const Frame& f = b.frames_.back();
    for (const LoopFrame& l : f.loops) slots.insert({l.broken, l.continued});
    if (f.returned >= 0) slots.insert(f.returned);
    if (f.result >= 0) slots.insert(f.result);
    flags = {b.newSlot(b.boolean(false)), b.newSlot(b.boolean(false))};
    slots.insert(flags.broken);
    b.addLengths(slots);
    return slots;
}

/// L, Cl, Ol exist inside the block only.
void Builder::Illuminance::findLightSlots() {
    const char* const names[] = {"L", "Cl", "Ol"};
    for (int n = 0; n < 3; ++n) {
        const auto it = b.globals_.find(names[n]);
        light[n] = it != b.globals_.end() ? it->second : (b.globals_[names[n]] = b.newSlot(b.zero(Kind::Triple)));
        if (!b.value(light[n])) b.value(light[n]) = b.zero(Kind::Triple);
    }
}

/// Under path the shadow between the light and P is a request of its own.
Inst* Builder::Illuminance::shadowed(Inst* L, Inst* Cl, Inst* index) {
    if (!b.options_.path) return Cl;
    Site shadow;
    shadow.op = "lightvisibility";
    shadow.argKinds = {Kind::Float, Kind::Triple};
    shadow.argTypes = {{Base::Float, 0}, {Base::Vector, 0}};
    shadow.resultKinds = {Kind::Triple};
    shadow.resultNames = {""};
    shadow.resultType = {Base::Color, 0};
    b.place_ = s.place;
    return b.emit(Op::Mul, Kind::Triple, {Cl, b.call(Op::Request, std::move(shadow), {index, L})[0]});
}

/// A variable takes a parameter of the light of this turn, where the light has it.
void Builder::Illuminance::readLight(const Pair& p) {
    Site get;
    get.op = "lightsource";
    get.strings = {p.name.substr(6)};
    get.resultType = {Base::Float, 0};
    get.shadeop = findShadeop("lightsource");
    Inst* whole = p.value->type.array ? b.array(*p.value) : nullptr;
    const int count = whole ? b.arrayLength(whole) : 1;
    get.resultKinds = {Kind::Float};
    get.resultNames = {""};
    for (int n = 0; n < count; ++n) {
        get.resultKinds.push_back(kindOf(p.value->type.element()));
        get.resultNames.push_back(whole ? "value[" + std::to_string(n) + "]" : "value");
    }
    const std::vector<Inst*> v = b.call(Op::Service, std::move(get), {});
    Inst* found = b.isNot0(v[0]);
    for (int n = 0; whole && whole->op == Op::ArrayNew && n < count; ++n) {
        Inst* at = b.constant(n);
        Inst* element = v[static_cast<size_t>(n) + 1];
        Inst* old = b.emit(Op::ArrayLoad, whole->element, {whole, at});
        b.emit(Op::ArrayStore, Kind::None, {whole, at, b.emit(Op::Select, element->kind, {found, element, old})});
    }
    if (whole) return;
    const Held held(b, *p.value);
    b.assign(*p.value, b.emit(Op::Select, v[1]->kind, {found, v[1], b.coerce(b.expr(*p.value), v[1]->kind)}));
}

void Builder::Illuminance::body(Inst* L, Inst* Cl, Inst* Ol, Inst* index) {
    Inst* visible = shadowed(L, Cl, index);
    b.set(light[0], L);
    b.set(light[1], visible);
    b.set(light[2], Ol);
    b.set(flags.continued, b.boolean(false));
    for (const Pair* p : lightParameters) readLight(*p);
    b.statements(s.body, 0);
}

void Builder::illuminance(const Stmt& s) {
    Illuminance i{*this, s, {}, {}, {}, {}, {}, {}, {}};
    i.site.op = "illuminance";
    i.setup.op = "lightsetup";
    i.site.place = i.setup.place = keptPlace(s.place);
    i.category();
    i.readPairs();
    i.giveSurface();
    Inst* inst = i.begin();
    std::set<int> assigned = i.assigned();
    i.findLightSlots();
    for (const int n : i.light) assigned.erase(n);
    const std::vector<int> carried = carry(inst, assigned);
    const std::set<std::string> writes = writes_;
    {
        Region& r = inst->regions[0];
        const Scope scope(*this, r);
        Inst* L = parameter(r, Kind::Triple);
        Inst* Cl = parameter(r, Kind::Triple);
        Inst* Ol = parameter(r, Kind::Triple);
        Inst* index = parameter(r, Kind::Float);
        enterTurn(inst, r, carried);
        frames_.back().loops.push_back(i.flags);
        ++lightDepth_;
        when(emit(Op::Not, Kind::Bool, {get(i.flags.broken)}), [&] { i.body(L, Cl, Ol, index); });
        --lightDepth_;
        frames_.back().loops.pop_back();
        for (int n : carried) r.yields.push_back(get(n));
    }
    writes_ = writes; // what the turns set is what the loop carries
    for (int n : carried)
        if (isGlobal(n)) writes_.insert(symbol(n)->name);
    inst->site = static_cast<int>(k_.sites.size());
    k_.sites.push_back(std::move(i.site));
    place_ = s.place;
    leaveLoop(inst, carried);
}

} // namespace alpenglow::rsl::ir
