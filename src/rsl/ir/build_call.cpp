// Calls: user functions inlined, shadeops by their Lowering.
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include "shadeops/specular.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <utility>

namespace alpenglow::rsl::ir {

bool Builder::hasGlobal(const char* name) const {
    for (const GlobalVariable& g : globalVariables(shader_.kind))
        if (std::string(name) == g.name) return true;
    return false;
}

/// The current value of a predefined variable, or zero where this kind of shader has none.
Inst* Builder::global(const char* name, Base base) {
    const auto it = globals_.find(name);
    if (it != globals_.end()) return get(it->second);
    return hasGlobal(name) ? initialGlobal(name, {base, 0}) : zero(kindOf({base, 0}));
}

Inst* Builder::functionCall(const Expr& e) {
    std::vector<const Expr*> args;
    for (const ExprPtr& a : e.args) args.push_back(a.get());
    if (!e.function) return zero(kindOf(e.type));
    return coerce(inlineFunction(*e.function, args), kindOf(e.type) == Kind::None ? Kind::Float : kindOf(e.type));
}

/// Output parameters are the variables that they are given. Where that shows, because one variable is given to two of them or the
/// function uses it by its own name too, they share its slot: the slots by parameter, -1 for those with one of their own. Empty
/// where it does not show, and a copy that is handed back does as well.
std::vector<int> Builder::sharedOutputs(const Function& f, const std::vector<const Expr*>& args) {
    std::vector<int> slots(args.size(), -1);
    std::set<int> given;
    bool shows = false;
    for (size_t i = 0; i < args.size() && i < f.parameters.size(); ++i) {
        const Symbol& p = *f.parameters[i];
        const Expr& a = *args[i];
        if (!p.output || p.type.array || a.kind != ExprKind::Variable || !a.symbol || a.symbol->type.array) continue;
        slots[i] = slot(a.symbol);
        shows |= !given.insert(slots[i]).second;
    }
    if (given.empty()) return {};
    for (const Symbol* x : scan(f).used)
        if (!shows && !scan(f).own.count(x) && !x->type.array) shows = given.count(slot(x)) > 0;
    return shows ? slots : std::vector<int>{};
}

Inst* Builder::inlineFunction(const Function& f, const std::vector<const Expr*>& args, Inst** whole) {
    std::set<int> assigned;
    std::set<const Function*> seen;
    if (f.body) scanAssigned(*f.body, assigned, seen);
    const size_t n = std::min(args.size(), f.parameters.size());
    std::vector<Inst*> values(n);
    std::deque<Held> held;
    for (size_t i = 0; i < n && !failed_; ++i) {
        const Symbol& p = *f.parameters[i];
        if (p.output) held.emplace_back(*this, *args[i]);
        if (p.output && !p.type.array) continue; // what it is when all arguments are known
        if (!p.type.array) {
            values[i] = coerce(expr(*args[i]), p.type);
            continue;
        }
        Inst* a = array(*args[i]);
        if (!p.output && assigned.count(slot(&p))) { // by value
            largestResize();
            const bool grows = lengths(a) || (p.type.array < 0 && grown_.count(&p));
            Inst* copy = grows ? newResizable(p.type.base, 0) : newArray(p.type.base, arrayLength(a));
            if (grows) copyResizable(copy, *args[i]);
            else copyArray(copy, *args[i]);
            a = copy;
        }
        values[i] = a;
    }
    for (size_t i = 0; i < n && !failed_; ++i)
        if (!values[i]) values[i] = coerce(expr(*args[i]), f.parameters[i]->type);
    if (failed_) return zero(Kind::Float);
    std::vector<Inst*> outputs;
    const std::vector<int> shared = sharedOutputs(f, args);
    const auto isShared = [&](size_t i) { return i < shared.size() && shared[i] >= 0; };
    if (Inst* result = nullptr;
        shared.empty() && sharing_ == 0 && n == f.parameters.size() && outlined(f, values, result, outputs)) {
        for (size_t i = 0, o = 0; i < n; ++i)
            if (f.parameters[i]->output) assign(*args[i], outputs[o++]);
        return result;
    }
    if (failed_) return zero(Kind::Float);
    std::vector<int> own(n, -1); // the slots of parameters that share another for this call
    for (size_t i = 0; i < n; ++i) {
        const int usual = slot(f.parameters[i]); // there is one from now on, to come back to
        if (isShared(i)) own[i] = usual, slots_[f.parameters[i]] = shared[i];
        else set(slot(f.parameters[i]), values[i]);
    }
    sharing_ += !shared.empty();
    Frame frame;
    frame.function = &f;
    frame.type = f.result;
    frame.returned = newSlot(boolean(false));
    if (f.result.array) {
        largestResize();
        frame.array = f.result.array < 0 ? newResizable(f.result.base, 0) : newArray(f.result.base, f.result.array);
        if (whole) *whole = frame.array;
    } else if (f.result.base != Base::Void) {
        frame.result = newSlot(zero(kindOf(f.result)));
    }
    frames_.push_back(frame);
    const bool constructs = f.name == "construct" && (shader_.object || handleDepth_ > 0);
    constructing_ += constructs;
    const auto method = methodByName(f); // a handle may come back to it
    if (method) openMethods_.insert(*method), way_.push_back(*method);
    if (f.body) statement(*f.body);
    if (method) openMethods_.erase(*method), way_.pop_back();
    constructing_ -= constructs;
    frames_.pop_back();
    sharing_ -= !shared.empty();
    for (size_t i = 0; i < n; ++i) {
        if (isShared(i)) slots_[f.parameters[i]] = own[i];
        else if (f.parameters[i]->output && !f.parameters[i]->type.array) assign(*args[i], get(slot(f.parameters[i])));
    }
    return frame.result >= 0 ? get(frame.result) : constant(0);
}

bool Builder::isLobe(const Expr& e) const {
    const std::string& n = e.shadeop->name;
    return n == "diffuse" || n == "specular" || n == "specularstd" || n == "phong";
}

Inst* Builder::shadeopCall(const Expr& e) {
    if (Inst* chosen = callByNames(e)) return chosen;
    const Shadeop& op = *e.shadeop;
    if (options_.path && isLobe(e) && !direct_.count({e.place.file, e.place.line, e.place.column}))
        return service(e, Op::Request);
    if (options_.path && op.name == "ambient") return service(e, Op::Request);
    if (op.name == "filterstep" && !e.pairs.empty()) return filterstep(e);
    if (e.function) { // messages about its text get the place of the call
        const std::optional<Place> before = ownText_;
        if (!ownText_) ownText_ = e.place;
        const size_t sites = k_.sites.size();
        Inst* value = functionCall(e);
        ownText_ = before;
        for (size_t n = sites; n < k_.sites.size() && isLobe(e) && op.name != "diffuse"; ++n)
            if (Site& s = k_.sites[n]; s.op == "illuminance") s.names.push_back(kPairHighlight), s.pairStrings.push_back("1");
        return value;
    }
    if (op.name == "shadername" && e.args.empty()) return leaves_.string(shader_.name);
    if (op.name == "trace" || op.name == "occlusion" || op.name == "indirectdiffuse" || op.name == "environment")
        checkDistribution(e);
    if (Inst* traced = tracedMap(e)) return traced;
    if (Inst* light = hemisphere(e)) return light;
    switch (op.lowering) {
    case Lowering::Runtime:
        return runtimeCall(e);
    case Lowering::Service:
        return op.section == kPluginSection ? pluginCall(e) : service(e, Op::Service);
    case Lowering::Request:
        return e.type.array ? unavailable(e) : service(e, Op::Request);
    case Lowering::Special:
        return special(e);
    default:
        return unavailable(e);
    }
}

Inst* Builder::unavailable(const Expr& e) {
    // The checker reports shadeops of Lowering::Unavailable; here only what depends on the form of the call.
    if (e.shadeop->lowering != Lowering::Unavailable) report(e.place, msg::kFormNotAvailable(e.shadeop->name));
    if (e.type.array) return newArray(e.type.base, std::max(1, e.type.array));
    return zero(kindOf(e.type) == Kind::None ? Kind::Float : kindOf(e.type));
}

Inst* Builder::runtimeCall(const Expr& e) {
    const Signature& s = *e.signature;
    std::vector<Inst*> args;
    std::vector<size_t> outputs;
    std::deque<Held> held;
    for (size_t i = 0; i < e.args.size(); ++i) {
        const Parameter& p = s.parameters[std::min(i, s.parameters.size() - 1)];
        if (e.args[i]->type.array) {
            Inst* a = array(*e.args[i]);
            refuseLonger(a, e.place, e.shadeop->name + "()");
            for (int n = 0; n < arrayLength(a); ++n)
                args.push_back(emit(Op::ArrayLoad, a->element, {a, constant(static_cast<float>(n))}));
            continue;
        }
        if (p.output) {
            held.emplace_back(*this, *e.args[i]);
            outputs.push_back(i);
        }
        args.push_back(coerce(expr(*e.args[i]), p.type));
    }
    place_ = e.place;
    if (s.symbol.empty()) {
        report(e.place, msg::kNoCode(e.shadeop->name));
        return zero(Kind::Float);
    }
    if (program_.rispecSpecular && e.shadeop->name == "specularbrdf") // its exponent is kSpecularExponent / roughness
        args.back() = emit(Op::Mul, args.back()->kind, {args.back(), constant(kSpecularExponent / kRispecExponent)});
    const Kind result = kindOf(s.result);
    if (s.repeats && args.size() > 2) {
        Inst* v = args[0];
        for (size_t i = 1; i < args.size(); ++i) v = runtime1(s.symbol, {v, args[i]}, result);
        return v;
    }
    std::vector<Kind> kinds;
    if (result != Kind::None) kinds.push_back(result);
    for (size_t i : outputs) kinds.push_back(kindOf(s.parameters[i].type));
    const std::vector<Inst*> r = runtime(s.symbol, args, kinds);
    for (size_t i = 0; i < outputs.size(); ++i) assign(*e.args[outputs[i]], r[i + (result != Kind::None ? 1 : 0)]);
    return result != Kind::None ? r[0] : constant(0);
}

Inst* Builder::random(const Expr& e) {
    Site s;
    s.op = "random";
    s.strings = {uniformContext_ ? "uniform" : "varying"};
    const Kind k = kindOf(e.signature ? e.signature->result : e.type);
    s.resultKinds = {k};
    s.resultNames = {""};
    s.resultType = storedType(e.type);
    s.shadeop = e.shadeop;
    return call(Op::Service, std::move(s), {})[0];
}

Inst* Builder::special(const Expr& e) {
    const std::string& n = e.shadeop->name;
    if (n == "Du" || n == "Dv") {
        Inst* v = expr(*e.args[0]);
        return emit(n == "Du" ? Op::Du : Op::Dv, v->kind, {v});
    }
    if (n == "transform" || n == "ptransform" || n == "vtransform" || n == "ntransform") return transformCall(e);
    if (n == "ctransform") {
        Inst* from = e.args.size() == 3 ? expr(*e.args[0]) : leaves_.string("rgb");
        Inst* to = expr(*e.args[e.args.size() - 2]);
        Inst* c = expr(*e.args.back(), Kind::Triple);
        if (from->op == Op::ConstString && to->op == Op::ConstString) return colourSpace(from->text, to->text, c);
        return dynamicSpace("ctransform", from, to, c, Base::Color);
    }
    if (n == "spline") return spline(e);
    if (n == "random") return random(e);
    if (n == "getshader") return getShader(e);
    if (n == "getvar") return getVariable(e);
    if (n == "readprimvar") return readPrimitiveVariable(e);
    if (n == "evalparam") return evalParameter(e);
    if (n == "hasmethod") return hasMethod(e);
    if (n == "writeaov") return writeAov(e);
    if (n == "readaov") return readAov(e);
    if (n == "getshaders" || n == "getlights") return array(e);
    if (n == "getlight") return getLight(e);
    if (n == "islightcategory") return isLightCategory(e);
    if (n == "isoutput") return isOutput(e);
    if (n == "bsdf") return e.type.array ? array(e) : bsdf(e)[0];
    if (n == "mtransform") return transformCall(e);
    if (n == "outputchannel") return outputChannel(e);
    if (n == "gridmin" || n == "gridmax") return gridBound(e, n == "gridmin" ? -0.5f : 0.5f);
    if (n == "arraylength") return e.args[0]->kind == ExprKind::Member ? memberLength(*e.args[0]) : lengthOf(array(*e.args[0]));
    if (n == "resize" || n == "reserve" || n == "push" || n == "pop" || n == "capacity") return resizing(e);
    return unavailable(e);
}

/// Whether a display asks for an output: of a variable, or by its name; for an array also where it asks for one of the elements.
Inst* Builder::isOutput(const Expr& e) {
    const Expr& a = *e.args[0];
    const auto parameter = [](const Expr& x) {
        return x.kind == ExprKind::Variable && x.symbol && x.symbol->origin == Symbol::Origin::ShaderParameter &&
               x.symbol->output;
    };
    std::string name;
    if (parameter(a)) name = a.symbol->name;
    else if (a.kind == ExprKind::Index && parameter(*a.args[0]) && a.args[0]->type.array) { // an element: which, if that is known
        Inst* at = expr(*a.args[1], Kind::Float);
        name = a.args[0]->symbol->name + (isConst(at) ? "[" + indexText(at->numbers[0]) + "]" : "");
    }
    Inst* const text = name.empty() && storedType(a.type) == Type{Base::String, 0} ? expr(a) : nullptr;
    if (text && text->op != Op::ConstString) { // one of those that are asked for
        std::set<std::string> all;
        for (const std::string& o : options_.outputs) all.insert({o, o.substr(0, o.find('['))});
        Inst* found = constant(0);
        for (const std::string& o : all)
            if (isWanted(o))
                found =
                    emit(Op::Select, Kind::Float, {emit(Op::Equal, Kind::Bool, {text, leaves_.string(o)}), constant(1), found});
        return found;
    }
    return constant(isWanted(text ? text->text : name) ? 1.0f : 0.0f);
}

bool Builder::isWanted(const std::string& name) const {
    const std::string base = name.substr(0, name.find('['));
    const bool declared = std::any_of(shader_.parameters.begin(), shader_.parameters.end(),
                                      [&](const ShaderParameter& p) { return p.symbol->output && p.symbol->name == base; });
    const bool known = declared || hasGlobal(base.c_str()) || channels_.count(base);
    const bool wanted = std::any_of(options_.outputs.begin(), options_.outputs.end(), [&](const std::string& o) {
        return o == name || o == base || (name == base && o.rfind(base + "[", 0) == 0);
    });
    return known && wanted;
}

/// A hit is a grid of one point (docs/design/decisions.md): the value, and half of its change over the footprint less or more.
/// As a statement it is the variable that becomes that.
Inst* Builder::gridBound(const Expr& e, float half) {
    Inst* v = expr(*e.args[0], Kind::Float);
    place_ = e.place;
    const auto change = [&](Op d, const char* step) {
        return runtime1("al_abs", {emit(Op::Mul, Kind::Float, {emit(d, Kind::Float, {v}), global(step, Base::Float)})},
                        Kind::Float);
    };
    Inst* size = emit(Op::Add, Kind::Float, {change(Op::Du, "du"), change(Op::Dv, "dv")});
    Inst* bound = emit(Op::Add, Kind::Float, {v, emit(Op::Mul, Kind::Float, {constant(half), size})});
    if (e.signature && e.signature->result.base == Base::Void && e.args[0]->kind == ExprKind::Variable) assign(*e.args[0], bound);
    return bound;
}

Inst* Builder::filterstep(const Expr& e) {
    std::vector<Inst*> a;
    for (const ExprPtr& x : e.args) a.push_back(expr(*x, Kind::Float));
    std::string filter = "catmullrom";
    Inst* asked = nullptr; // a filter that is known only when the shader runs
    Inst* width = constant(1);
    for (const NamedArg& p : e.pairs) {
        Inst* v = expr(*p.value);
        if (p.name == "width") width = coerce(v, Kind::Float);
        else if (p.name == "filter" && v->op == Op::ConstString &&
                 (v->text == "box" || v->text == "triangle" || v->text == "gaussian"))
            filter = v->text;
        else if (p.name == "filter" && v->kind == Kind::String && v->op != Op::ConstString) asked = v;
    }
    place_ = e.place;
    const auto mul = [&](Inst* x, Inst* y) { return emit(Op::Mul, Kind::Float, {x, y}); };
    Inst *middle, *w;
    if (a.size() == 2) {
        const auto size = [&](Op d, const char* step) {
            return runtime1("al_abs", {mul(emit(d, Kind::Float, {a[1]}), global(step, Base::Float))}, Kind::Float);
        };
        middle = a[1];
        w = emit(Op::Add, Kind::Float, {size(Op::Du, "du"), size(Op::Dv, "dv")});
    } else {
        middle = mul(constant(0.5f), emit(Op::Add, Kind::Float, {a[1], a[2]}));
        w = emit(Op::Sub, Kind::Float, {a[2], a[1]});
    }
    Inst* half = mul(mul(constant(0.5f), w), width);
    Inst *from = emit(Op::Sub, Kind::Float, {middle, half}), *to = emit(Op::Add, Kind::Float, {middle, half});
    Inst* step = runtime1("al_filterstep_" + filter, {a[0], from, to}, Kind::Float);
    for (const char* other : {"box", "triangle", "gaussian"})
        if (asked)
            step = emit(Op::Select, Kind::Float,
                        {emit(Op::Equal, Kind::Bool, {asked, leaves_.string(other)}),
                         runtime1(std::string("al_filterstep_") + other, {a[0], from, to}, Kind::Float), step});
    return step;
}

} // namespace alpenglow::rsl::ir
