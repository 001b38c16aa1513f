// Calls that the renderer answers: their operands and results.
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include <algorithm>
#include <set>
#include <string_view>

namespace alpenglow::rsl::ir {

/// One call while it is built: arguments, pairs and results go into the same site, in this order.
struct Builder::ServiceCall {
    Builder& b;
    const Expr& e;
    const Op kind;     ///< Service or Request
    const int part;    ///< of a call whose result is an array; -1: all elements in one call
    const bool points; ///< it is answered from point clouds
    const Shadeop& op = *e.shadeop;
    const Signature& sig = *e.signature;
    const bool byElement = kind == Op::Request && sig.result.array;
    /// Kind of the result; None where there is none, or several.
    const Kind whole = byElement ? kindOf(sig.result.element()) : sig.result.array ? Kind::None : kindOf(sig.result);
    Site site{};
    std::vector<Inst*> args{}; ///< of the instruction
    /// A variable, and which results it takes.
    struct Out {
        const Expr* lvalue;
        int first;
        int count;
        int at = 0; ///< the first element of an array
    };
    std::vector<Out> outs{};
    std::vector<std::pair<Receiver, int>> received{}; ///< of messages, with their first results
    std::vector<Inst*> positional{};                  ///< arguments that are no arrays, constant strings among them

    void mark(const char* pair) { addPair(site, pair, "1"); }
    void begin();
    void output(const Expr& variable, const std::string& name);
    void result(Kind, const std::string& name);
    void arguments();
    void argument(const Expr&, const Parameter&);
    Inst* footprint(Inst* v, const char* size, Op derivative);
    void footprints();
    void pairs();
    void pair(const NamedArg&);
    void arrayPair(const NamedArg&);
    void hiddenPairs();
    Inst* finish();
    void store(const Out&, std::span<Inst* const> results, Inst* read);
};

namespace {

bool isOneOf(std::span<const std::string_view> names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool isUniform(const Expr* l) {
    while (l->kind == ExprKind::Index && !l->args.empty()) l = l->args[0].get();
    return l->symbol && l->symbol->storage == Storage::Uniform;
}

} // namespace

void Builder::ServiceCall::result(Kind k, const std::string& name) {
    site.resultKinds.push_back(k);
    site.resultNames.push_back(name);
}

void Builder::ServiceCall::begin() {
    site.op = op.name;
    site.shadeop = &op;
    site.resultType = storedType(byElement ? e.type.element() : e.type);
    site.pure = op.pure && kind == Op::Service;
    if (whole != Kind::None) result(whole, "");
}

void Builder::ServiceCall::output(const Expr& l, const std::string& name) {
    const int first = static_cast<int>(site.resultKinds.size());
    if (op.section == "Messages" && !byElement) {
        received.push_back({b.receiver(site, l, name), first});
        return;
    }
    Out o{&l, first, 1};
    if (l.type.array && byElement) { // the element of this part
        o.at = std::max(part, 0);
        if (o.at >= b.arrayLength(b.array(l))) return;
        result(kindOf(l.type.element()), name);
    } else if (part > 0) {
        return; // the first part has what belongs to all parts
    } else if (l.type.array) {
        Inst* a = b.array(l);
        o.count = b.arrayLength(a);
        for (int n = 0; n < o.count; ++n) result(a->element, name + "[" + std::to_string(n) + "]");
    } else {
        result(kindOf(l.type), name);
    }
    outs.push_back(o);
}

void Builder::ServiceCall::argument(const Expr& a, const Parameter& p) {
    if (a.type.array) {
        Inst* from = b.array(a);
        b.refuseLonger(from, a.place, op.name + "()");
        for (int n = 0; n < b.arrayLength(from); ++n) addArgument(site, args, b.load(from, n), a.type.element());
        return;
    }
    Inst* v = b.expr(a);
    if (p.type.base != Base::Void) v = b.coerce(v, p.type);
    else if (v->kind == Kind::Bool) v = b.coerce(v, Kind::Float);
    positional.push_back(v);
    if (v->kind == Kind::String) site.strings.push_back(v->op == Op::ConstString ? v->text : "");
    // Where any strings come in rows, "" in the site stands for the next row: an empty one among them needs its own.
    const bool untyped =
        (a.kind == ExprKind::Member || a.kind == ExprKind::Method || a.kind == ExprKind::Index) && a.type.base == Base::Void;
    if (v->op != Op::ConstString || (v->text.empty() && op.section == "Strings"))
        addArgument(site, args, v, untyped ? b.typeOfMember(a) : a.type);
}

void Builder::ServiceCall::arguments() {
    const size_t fixed = sig.parameters.size();
    for (size_t i = 0; i < e.args.size(); ++i) {
        const Parameter any{};
        const Parameter& p = fixed == 0 ? any : sig.parameters[std::min(i, fixed - 1)];
        if (p.output && i < fixed) output(*e.args[i], p.name);
        else argument(*e.args[i], p);
    }
}

/// The change of a coordinate from one sample to the next, along u or v.
Inst* Builder::ServiceCall::footprint(Inst* v, const char* size, Op derivative) {
    Inst* step = b.coerce(b.global(size, Base::Float), v->kind);
    return isConst(step, 0.0f) ? b.zero(v->kind) : b.emit(Op::Mul, v->kind, {b.emit(derivative, v->kind, {v}), step});
}

void Builder::ServiceCall::footprints() {
    const Type real{Base::Float, 0}, vector{Base::Vector, 0};
    const Footprint& over = op.footprint;
    const auto& all = positional;
    if (over.of == Footprint::Of::Surface && (all.size() == over.first || all.size() == over.first + 2)) {
        const bool given = all.size() > over.first;
        Inst* const st[] = {given ? all[over.first] : b.global("s", Base::Float),
                            given ? all[over.first + 1] : b.global("t", Base::Float)};
        for (Inst* c : st)
            if (!given) addArgument(site, args, c, real);
        for (int d = 0; d < 2; ++d)
            for (Inst* c : st) addArgument(site, args, footprint(c, d == 0 ? "du" : "dv", d == 0 ? Op::Du : Op::Dv), real);
        if (over.marks && !given) addArgument(site, args, b.constant(1), real);
    }
    if (over.of == Footprint::Of::Space && all.size() == over.count) {
        addArgument(site, args, footprint(all[over.first], "du", Op::Du), vector);
        addArgument(site, args, footprint(all[over.first], "dv", Op::Dv), vector);
    }
}

void Builder::ServiceCall::arrayPair(const NamedArg& p) {
    Inst* from = b.array(*p.value);
    b.refuseLonger(from, p.place, "\"" + p.name + "\" of " + op.name + "()");
    for (int n = 0; n < b.arrayLength(from); ++n) {
        addPair(site, p.name + "[" + std::to_string(n) + "]", "");
        addArgument(site, args, b.load(from, n), p.value->type.element());
    }
}

void Builder::ServiceCall::pair(const NamedArg& p) {
    if (p.output) return output(*p.value, p.name);
    if (p.value->type.array) return arrayPair(p);
    const auto known = std::find_if(op.optional.rbegin(), op.optional.rend(), [&](const auto& o) { return o.name == p.name; });
    const Type* wanted = known == op.optional.rend() ? nullptr : &known->type;
    Inst* v = b.expr(*p.value);
    if (wanted && (wanted->base == Base::String) == (v->kind == Kind::String)) v = b.coerce(v, wanted->element());
    else if (v->kind == Kind::Bool) v = b.coerce(v, Kind::Float);
    if (kind == Op::Request && op.name == "subsurface" && p.name == "irradiance") {
        b.enters(v);
        return mark(kPairEntering);
    }
    if (v->op == Op::ConstString && v->text.empty()) return; // every string's default means the same as its absence
    addPair(site, args, p.name, v, wanted ? wanted->element() : p.value->type);
}

void Builder::ServiceCall::pairs() {
    if (kind == Op::Request && op.name == "ambient") addArgument(site, args, b.global("N", Base::Normal), {Base::Normal, 0});
    if (e.channel) {
        addPair(site, "channel", "");
        addArgument(site, args, b.expr(*e.channel, Kind::Float), {Base::Float, 0});
    }
    for (const NamedArg& p : e.pairs)
        if (p.value && !b.ofRaysOnly(e, p.name)) pair(p);
}

/// Pairs that the shader does not write, for the renderer.
void Builder::ServiceCall::hiddenPairs() {
    // Lights that rays or samples of this call reach query the current values of outputs.
    static constexpr std::string_view kLit[] = {"diffuse", "specular", "specularstd", "phong", "trace"};
    if (kind == Op::Request && isOneOf(kLit, op.name))
        for (const auto& [name, parameter] : b.messageSlots_) {
            addPair(site, PairName::surface(name).text(), "");
            addArgument(site, args, b.get(parameter.first), parameter.second);
        }
    if (b.constructing_ > 0 && (op.name == "printf" || op.name == "print")) mark(kPairOnce); // printlog.h
    if (part >= 0) addPair(site, kPairPart, std::to_string(part));
    if (points) mark(kPairPoints);
    // A uniform variable takes no varying parameter of another shader (services/dispatch.cpp).
    static constexpr std::string_view kShaders[] = {"surface",  "displacement", "atmosphere",
                                                    "incident", "opposite",     "lightsource"};
    if (isOneOf(kShaders, op.name) && !received.empty() && isUniform(received[0].first.to)) mark(kPairUniform);
    static constexpr std::string_view kOfTheTurn[] = {"lightsource", "attribute", "shadername"};
    if (b.lightDepth_ == 0 && isOneOf(kOfTheTurn, op.name)) { // outside of light loops
        if (op.name == "lightsource" && b.shader_.kind != ShaderKind::Light)
            b.report(e.place, msg::kOutsideIlluminance("lightsource"));
        mark(kPairOutside);
    }
}

/// `read`: what was read is there; else the variable stays as it was. Null: always.
void Builder::ServiceCall::store(const Out& o, std::span<Inst* const> results, Inst* read) {
    const auto either = [&](Inst* v, const auto& old) {
        return read ? b.emit(Op::Select, v->kind, {read, v, b.coerce(old(), v->kind)}) : v;
    };
    if (!o.lvalue->type.array) {
        const Held held(b, *o.lvalue);
        return b.assign(*o.lvalue, either(results[0], [&] { return b.expr(*o.lvalue); }));
    }
    Inst* a = b.array(*o.lvalue);
    for (int n = 0; n < o.count && a->op == Op::ArrayNew; ++n) {
        Inst* at = b.constant(o.at + n);
        Inst* v = either(results[static_cast<size_t>(n)], [&] { return b.emit(Op::ArrayLoad, a->element, {a, at}); });
        b.emit(Op::ArrayStore, Kind::None, {a, at, v});
    }
}

/// The instruction, and its results in the variables.
Inst* Builder::ServiceCall::finish() {
    b.place_ = e.place;
    const bool message = op.section == "Messages" && !site.resultKinds.empty() && site.resultNames[0].empty();
    const std::vector<Inst*> r = b.call(kind, std::move(site), std::move(args));
    const auto from = [&](int first, int count) {
        return std::span(r).subspan(static_cast<size_t>(first), static_cast<size_t>(count));
    };
    Inst* found = message && !received.empty() ? b.isNot0(r[0]) : nullptr;
    Inst* read = op.name == "texture3d" && kind == Op::Service ? b.isNot0(r[0]) : nullptr;
    for (const auto& [receiver, first] : received) b.receive(receiver, from(first, receiver.rows), found);
    for (const Out& o : outs) store(o, from(o.first, o.count), read);
    return whole != Kind::None && !r.empty() ? r[0] : b.constant(0);
}

Inst* Builder::service(const Expr& e, Op kind, int part, bool points) {
    ServiceCall c{*this, e, kind, part, points};
    c.begin();
    c.arguments();
    if (Inst* folded = foldString(c.op.name, c.positional)) return folded;
    if (c.op.name == "displacement" && !c.positional.empty() && c.positional[0]->op == Op::ConstString)
        if (Inst* queried = nullptr; queriedDisplacement(e, c.positional[0]->text, queried)) return queried;
    place_ = e.place;
    c.footprints();
    c.pairs();
    if (kind == Op::Request && c.op.name == "subsurface" && options_.light == kEntering) return zero(c.whole);
    if (quiet_ > 0 && (c.op.name == "printf" || c.op.name == "print")) return constant(0);
    c.hiddenPairs();
    return c.finish();
}

} // namespace alpenglow::rsl::ir
