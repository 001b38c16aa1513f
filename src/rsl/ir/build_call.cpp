// Calls: user functions inlined, shadeops by their Lowering.
#include "rsl/ir/builder.h"
#include <algorithm>
#include <cmath>
#include <cstdio>

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

Inst* Builder::inlineFunction(const Function& f, const std::vector<const Expr*>& args) {
    std::set<int> assigned;
    std::set<const Function*> seen;
    if (f.body) scanAssigned(*f.body, assigned, seen);
    const size_t n = std::min(args.size(), f.parameters.size());
    std::vector<Inst*> values(n);
    for (size_t i = 0; i < n && !failed_; ++i) {
        const Symbol& p = *f.parameters[i];
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
    if (failed_) return zero(Kind::Float);
    std::vector<Inst*> outputs;
    if (Inst* result = nullptr; n == f.parameters.size() && outlined(f, values, result, outputs)) {
        for (size_t i = 0, o = 0; i < n; ++i)
            if (f.parameters[i]->output) assign(*args[i], outputs[o++]);
        return result;
    }
    if (failed_) return zero(Kind::Float);
    for (size_t i = 0; i < n; ++i) set(slot(f.parameters[i]), values[i]);
    Frame frame;
    frame.function = &f;
    frame.type = f.result;
    frame.returned = newSlot(boolean(false));
    if (f.result.base != Base::Void) frame.result = newSlot(zero(kindOf(f.result)));
    frames_.push_back(frame);
    if (f.body) statement(*f.body);
    frames_.pop_back();
    for (size_t i = 0; i < n; ++i)
        if (f.parameters[i]->output && !f.parameters[i]->type.array) assign(*args[i], get(slot(f.parameters[i])));
    return frame.result >= 0 ? get(frame.result) : constant(0);
}

bool Builder::isLobe(const Expr& e) const {
    const std::string& n = e.shadeop->name;
    return n == "diffuse" || n == "specular" || n == "specularstd" || n == "phong";
}

Inst* Builder::shadeopCall(const Expr& e) {
    const Shadeop& op = *e.shadeop;
    if (options_.path && isLobe(e) && !direct_.count({e.place.file, e.place.line, e.place.column}))
        return service(e, Op::Request);
    if (options_.path && op.name == "ambient") return service(e, Op::Request);
    if (op.name == "filterstep" && !e.pairs.empty()) return filterstep(e);
    if (e.function) return functionCall(e);
    if (op.name == "shadername" && e.args.empty()) return leaves_.string(shader_.name);
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
    if (e.shadeop->lowering != Lowering::Unavailable)
        warn(e.place, e.shadeop->name + "() in this form is not yet available; its result is 0");
    if (e.type.array) return newArray(e.type.base, std::max(1, e.type.array));
    return zero(kindOf(e.type) == Kind::None ? Kind::Float : kindOf(e.type));
}

Inst* Builder::runtimeCall(const Expr& e) {
    const Signature& s = *e.signature;
    std::vector<Inst*> args;
    std::vector<size_t> outputs;
    for (size_t i = 0; i < e.args.size(); ++i) {
        const Parameter& p = s.parameters[std::min(i, s.parameters.size() - 1)];
        if (e.args[i]->type.array) {
            Inst* a = array(*e.args[i]);
            for (int n = 0; n < arrayLength(a); ++n)
                args.push_back(emit(Op::ArrayLoad, a->element, {a, constant(static_cast<float>(n))}));
            continue;
        }
        args.push_back(coerce(expr(*e.args[i]), p.type));
        if (p.output) outputs.push_back(i);
    }
    place_ = e.place;
    if (s.symbol.empty()) {
        error(e.place, e.shadeop->name + "() has no code");
        return zero(Kind::Float);
    }
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

void Builder::addArgument(Site& s, std::vector<Inst*>& args, Inst* v, Type t) {
    args.push_back(v);
    s.argKinds.push_back(v->kind);
    s.argTypes.push_back(t);
}

/// concat and format of constants; null when something is not constant.
Inst* Builder::foldString(const std::string& op, const std::vector<Inst*>& args) {
    for (const Inst* a : args)
        if (a->op != Op::ConstString && !(a->op == Op::Const && a->kind == Kind::Float)) return nullptr;
    std::string out;
    if (op == "concat") {
        for (const Inst* a : args) out += a->text;
        return leaves_.string(out);
    }
    if (op != "format" || args.empty() || args[0]->op != Op::ConstString) return nullptr;
    const std::string& p = args[0]->text;
    size_t next = 1;
    for (size_t i = 0; i < p.size(); ++i) {
        if (p[i] != '%') {
            out += p[i];
            continue;
        }
        if (i + 1 < p.size() && p[i + 1] == '%') {
            out += '%';
            ++i;
            continue;
        }
        // Only the plain conversions; widths and precisions are the service's business.
        if (i + 1 >= p.size() || next >= args.size()) return nullptr;
        const Inst* a = args[next++];
        const char c = p[++i];
        if (c == 's' && a->op == Op::ConstString) out += a->text;
        else if (c == 'd' && a->op == Op::Const) {
            char text[64];
            std::snprintf(text, sizeof text, "%.0f", static_cast<double>(a->numbers[0]));
            out += text;
        } else return nullptr;
    }
    return leaves_.string(out);
}

Inst* Builder::service(const Expr& e, Op kind) {
    const Shadeop& op = *e.shadeop;
    const Signature& sig = *e.signature;
    Site s;
    s.op = op.name;
    s.shadeop = &op;
    s.resultType = e.type;
    s.pure = op.pure && kind == Op::Service;
    std::vector<Inst*> args;
    struct Out {
        const Expr* lvalue;
        int first;
        int count;
    };
    std::vector<Out> outs;
    if (kindOf(sig.result) != Kind::None && !sig.result.array) {
        s.resultKinds.push_back(kindOf(sig.result));
        s.resultNames.push_back("");
    }
    const auto output = [&](const Expr& l, const std::string& name) {
        Out o{&l, static_cast<int>(s.resultKinds.size()), 1};
        if (l.type.array) {
            Inst* a = array(l);
            o.count = arrayLength(a);
            for (int n = 0; n < o.count; ++n) {
                s.resultKinds.push_back(a->element);
                s.resultNames.push_back(name + "[" + std::to_string(n) + "]");
            }
        } else {
            s.resultKinds.push_back(kindOf(l.type));
            s.resultNames.push_back(name);
        }
        outs.push_back(o);
    };
    std::vector<Inst*> all;
    const size_t fixed = sig.parameters.size();
    for (size_t i = 0; i < e.args.size(); ++i) {
        const Parameter any{};
        const Parameter& p = fixed == 0 ? any : sig.parameters[std::min(i, fixed - 1)];
        const Expr& a = *e.args[i];
        if (p.output && i < fixed) {
            output(a, p.name);
            continue;
        }
        if (a.type.array) {
            Inst* from = array(a);
            for (int n = 0; n < arrayLength(from); ++n)
                addArgument(s, args, emit(Op::ArrayLoad, from->element, {from, constant(static_cast<float>(n))}),
                            a.type.element());
            continue;
        }
        Inst* v = expr(a);
        if (p.type.base != Base::Void) v = coerce(v, p.type);
        else if (v->kind == Kind::Bool) v = coerce(v, Kind::Float);
        all.push_back(v);
        if (v->kind == Kind::String) s.strings.push_back(v->op == Op::ConstString ? v->text : "");
        // Where any strings come in rows, "" in the site stands for the next row: an empty one among them needs its own.
        if (v->op != Op::ConstString || (v->text.empty() && op.section == "Strings")) addArgument(s, args, v, a.type);
    }
    if (Inst* c = foldString(op.name, all)) return c;
    place_ = e.place;
    const Type real{Base::Float, 0}, vector{Base::Vector, 0};
    // Footprints: how far the coordinates go from one sample to the next, along u (x) and along v (y).
    const auto footprint = [&](Inst* v, const char* size, Op d) {
        Inst* step = coerce(global(size, Base::Float), v->kind);
        return isConst(step, 0.0f) ? zero(v->kind) : emit(Op::Mul, v->kind, {emit(d, v->kind, {v}), step});
    };
    if (op.name == "texture" && all.size() <= 3) {
        Inst* st[2];
        if (all.size() == 3) {
            st[0] = all[1];
            st[1] = all[2];
        } else {
            st[0] = global("s", Base::Float);
            st[1] = global("t", Base::Float);
            addArgument(s, args, st[0], real);
            addArgument(s, args, st[1], real);
        }
        for (int d = 0; d < 2; ++d)
            for (Inst* c : st) addArgument(s, args, footprint(c, d == 0 ? "du" : "dv", d == 0 ? Op::Du : Op::Dv), real);
    }
    if (op.name == "environment" && all.size() == 2) {
        addArgument(s, args, footprint(all[1], "du", Op::Du), vector);
        addArgument(s, args, footprint(all[1], "dv", Op::Dv), vector);
    }
    if (kind == Op::Request && op.name == "ambient") addArgument(s, args, global("N", Base::Normal), {Base::Normal, 0});
    if (e.channel) {
        s.names.push_back("channel");
        s.pairStrings.push_back("");
        addArgument(s, args, expr(*e.channel, Kind::Float), real);
    }
    for (const NamedArg& p : e.pairs) {
        if (!p.value) continue;
        if (p.output) {
            output(*p.value, p.name);
            continue;
        }
        const OptionalParameter* known = nullptr;
        for (const OptionalParameter& o : op.optional)
            if (o.name == p.name) known = &o;
        if (p.value->type.array) {
            Inst* from = array(*p.value);
            for (int n = 0; n < arrayLength(from); ++n) {
                s.names.push_back(p.name + "[" + std::to_string(n) + "]");
                s.pairStrings.push_back("");
                addArgument(s, args, emit(Op::ArrayLoad, from->element, {from, constant(static_cast<float>(n))}),
                            p.value->type.element());
            }
            continue;
        }
        Inst* v = expr(*p.value);
        if (known && (known->type.base == Base::String) == (v->kind == Kind::String)) v = coerce(v, known->type.element());
        else if (v->kind == Kind::Bool) v = coerce(v, Kind::Float);
        if (v->op == Op::ConstString && v->text.empty()) continue; // every string's default means the same as its absence
        s.names.push_back(p.name);
        s.pairStrings.push_back(v->op == Op::ConstString ? v->text : "");
        if (v->op != Op::ConstString) addArgument(s, args, v, known ? known->type.element() : p.value->type);
    }
    place_ = e.place;
    const bool message = op.section == "Messages" && !s.resultKinds.empty() && s.resultNames[0].empty();
    const std::vector<Inst*> r = call(kind, std::move(s), std::move(args));
    Inst* found = message && !outs.empty() ? emit(Op::NotEqual, Kind::Bool, {r[0], constant(0)}) : nullptr;
    for (const Out& o : outs) {
        if (o.lvalue->type.array) {
            Inst* a = array(*o.lvalue);
            for (int n = 0; n < o.count && a->op == Op::ArrayNew; ++n) {
                Inst* at = constant(static_cast<float>(n));
                Inst* v = r[static_cast<size_t>(o.first + n)];
                if (found) v = emit(Op::Select, v->kind, {found, v, emit(Op::ArrayLoad, a->element, {a, at})});
                emit(Op::ArrayStore, Kind::None, {a, at, v});
            }
            continue;
        }
        Inst* v = r[static_cast<size_t>(o.first)];
        if (found) // a message that does not arrive leaves the variable as it was
            v = emit(Op::Select, v->kind, {found, v, coerce(expr(*o.lvalue), v->kind)});
        assign(*o.lvalue, v);
    }
    return kindOf(sig.result) != Kind::None && !r.empty() && !sig.result.array ? r[0] : constant(0);
}

Inst* Builder::random(const Expr& e) {
    Site s;
    s.op = "random";
    s.strings = {uniformContext_ ? "uniform" : "varying"};
    const Kind k = kindOf(e.signature ? e.signature->result : e.type);
    s.resultKinds = {k};
    s.resultNames = {""};
    s.resultType = e.type;
    s.shadeop = e.shadeop;
    return call(Op::Service, std::move(s), {})[0];
}

Inst* Builder::transformCall(const Expr& e) {
    const std::string& name = e.shadeop->name;
    Base base = e.args.back()->type.base;
    if (name == "vtransform") base = Base::Vector;
    else if (name == "ntransform") base = Base::Normal;
    std::vector<Inst*> a;
    for (const ExprPtr& x : e.args) a.push_back(expr(*x));
    place_ = e.place;
    Inst* v = coerce(a.back(), base == Base::Matrix ? Kind::Matrix : Kind::Triple);
    Inst* from = a.size() == 3 ? a[0] : leaves_.string("current");
    Inst* to = a[a.size() - 2];
    const auto between = [&](Inst* f, Inst* t) {
        if (f->op == Op::ConstString && t->op == Op::ConstString) return toSpace(f->text, t->text, v, base, e.place);
        return dynamicSpace(name.c_str(), f, t, v, base);
    };
    if (to->kind == Kind::Matrix) {
        v = between(from, leaves_.string("current"));
        return transformBy(to, v, base);
    }
    return between(from, to);
}

Inst* Builder::special(const Expr& e) {
    const std::string& n = e.shadeop->name;
    if (n == "Du" || n == "Dv") {
        Inst* v = expr(*e.args[0]);
        return emit(n == "Du" ? Op::Du : Op::Dv, v->kind, {v});
    }
    if (n == "transform" || n == "vtransform" || n == "ntransform") return transformCall(e);
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
    if (n == "getshaders" || n == "getlights") return array(e);
    if (n == "getlight") return getLight(e);
    if (n == "islightcategory") return isLightCategory(e);
    if (n == "isoutput") return isOutput(e);
    if (n == "bsdf") return e.type.array ? array(e) : bsdf(e)[0];
    if (n == "mtransform") return transformCall(e);
    if (n == "outputchannel") return outputChannel(e);
    if (n == "gridmin" || n == "gridmax") return gridBound(e, n == "gridmin" ? -0.5f : 0.5f);
    if (n == "arraylength") return lengthOf(array(*e.args[0]));
    if (n == "resize" || n == "reserve" || n == "push" || n == "pop" || n == "capacity") return resizing(e);
    return unavailable(e);
}

/// Whether a display asks for an output: of a variable, or by its name; of an array also by element.
Inst* Builder::isOutput(const Expr& e) {
    const Expr& a = *e.args[0];
    std::string name;
    if (a.kind == ExprKind::Variable && a.symbol && a.symbol->origin == Symbol::Origin::ShaderParameter && a.symbol->output)
        name = a.symbol->name;
    else if (Inst* v = a.type == Type{Base::String, 0} ? expr(a) : nullptr; v && v->op == Op::ConstString)
        name = v->text.substr(0, v->text.find('['));
    const auto& wanted = options_.outputs;
    const bool declared = std::any_of(shader_.parameters.begin(), shader_.parameters.end(),
                                      [&](const ShaderParameter& p) { return p.symbol->output && p.symbol->name == name; });
    const bool known = declared || hasGlobal(name.c_str()) || channels_.count(name);
    return constant(known && std::find(wanted.begin(), wanted.end(), name) != wanted.end() ? 1.0f : 0.0f);
}

/// A hit is a grid of one point (design decision 6): the value, and half of what it changes over the footprint below or above it.
/// As a statement it is the variable that becomes that.
Inst* Builder::gridBound(const Expr& e, float half) {
    Inst* v = expr(*e.args[0], Kind::Float);
    place_ = e.place;
    const auto change = [&](Op d, const char* step) {
        return runtime1("al_abs", {emit(Op::Mul, Kind::Float, {emit(d, Kind::Float, {v}), global(step, Base::Float)})}, Kind::Float);
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
    Inst* width = constant(1);
    for (const NamedArg& p : e.pairs) {
        Inst* v = expr(*p.value);
        if (p.name == "width") width = coerce(v, Kind::Float);
        else if (p.name == "filter" && v->op == Op::ConstString &&
                 (v->text == "box" || v->text == "triangle" || v->text == "gaussian"))
            filter = v->text;
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
    return runtime1("al_filterstep_" + filter,
                    {a[0], emit(Op::Sub, Kind::Float, {middle, half}), emit(Op::Add, Kind::Float, {middle, half})}, Kind::Float);
}

Inst* Builder::spline(const Expr& e) {
    size_t at = 0;
    std::string basis = "catmull-rom";
    if (!e.args.empty() && e.args[0]->type.base == Base::String) {
        Inst* b = expr(*e.args[0]);
        if (b->op == Op::ConstString) basis = b->text;
        else warn(e.place, "the basis of this spline is not known at compile time; catmull-rom is taken");
        at = 1;
    }
    const bool solve = basis.rfind("solve", 0) == 0;
    if (solve) basis = basis.substr(5);
    if (basis == "catmull-rom" || basis == "catmullrom" || basis.empty()) basis = "catmullrom";
    else if (basis == "b-spline") basis = "bspline";
    else if (basis != "bezier" && basis != "bspline" && basis != "hermite") basis = "linear";
    const int step = basis == "bezier" ? 3 : basis == "hermite" ? 2 : 1;
    Inst* v = expr(*e.args[at], Kind::Float);
    const Kind k = kindOf(e.signature ? e.signature->result : e.type);
    std::vector<Inst*> points;
    Inst* storage = nullptr;
    if (e.args.size() == at + 2 && e.args[at + 1]->type.array) {
        storage = array(*e.args[at + 1]);
        for (int i = 0; i < arrayLength(storage); ++i)
            points.push_back(emit(Op::ArrayLoad, storage->element, {storage, constant(static_cast<float>(i))}));
    } else {
        for (size_t i = at + 1; i < e.args.size(); ++i) points.push_back(expr(*e.args[i], k));
    }
    place_ = e.place;
    const int n = static_cast<int>(points.size());
    const int segments = (n - 4) / step + 1;
    if (n < 4 || segments < 1) {
        warn(e.place, "a spline needs at least four control points; this one is 0");
        return zero(k);
    }
    const auto point = [&](int s, int j) { return points[static_cast<size_t>(s * step + j)]; };
    const auto less = [&](Inst* a, Inst* b) { return emit(Op::LessEqual, Kind::Bool, {a, b}); };
    if (solve) {
        if (k != Kind::Float) return unavailable(e);
        const auto value = [&](int s, float t) {
            return runtime1("al_spline_" + basis + "_f", {constant(t), point(s, 0), point(s, 1), point(s, 2), point(s, 3)},
                            Kind::Float);
        };
        const auto away = [&](Inst* end) { return runtime1("al_abs", {emit(Op::Sub, Kind::Float, {v, end})}, Kind::Float); };
        Inst* r =
            emit(Op::Select, Kind::Float, {less(away(value(0, 0)), away(value(segments - 1, 1))), constant(0), constant(1)});
        for (int s = segments - 1; s >= 0; --s) {
            Inst *a = value(s, 0), *b = value(s, 1);
            Inst* up = emit(Op::And, Kind::Bool, {less(a, v), less(v, b)});
            Inst* down = emit(Op::And, Kind::Bool, {less(b, v), less(v, a)});
            Inst* t = runtime1("al_splinesolve_" + basis, {v, point(s, 0), point(s, 1), point(s, 2), point(s, 3)}, Kind::Float);
            Inst* x =
                emit(Op::Div, Kind::Float,
                     {emit(Op::Add, Kind::Float, {constant(static_cast<float>(s)), t}), constant(static_cast<float>(segments))});
            r = emit(Op::Select, Kind::Float, {emit(Op::Or, Kind::Bool, {up, down}), x, r});
        }
        return r;
    }
    const std::vector<Inst*> st =
        runtime("al_splinesegment", {v, constant(static_cast<float>(segments))}, {Kind::Float, Kind::Float});
    std::vector<Inst*> args = {st[1]};
    if (!storage && segments > 8) { // long lists by storage, short ones by selects
        storage = newArray(e.signature ? e.signature->result.base : e.type.base, n);
        for (int i = 0; i < n; ++i)
            emit(Op::ArrayStore, Kind::None, {storage, constant(static_cast<float>(i)), points[static_cast<size_t>(i)]});
    }
    for (int j = 0; j < 4; ++j) {
        if (storage && segments > 8) {
            Inst* index = emit(Op::Mul, Kind::Float, {st[0], constant(static_cast<float>(step))});
            args.push_back(emit(Op::ArrayLoad, storage->element,
                                {storage, emit(Op::Add, Kind::Float, {index, constant(static_cast<float>(j))})}));
            continue;
        }
        Inst* p = point(segments - 1, j);
        for (int s = segments - 2; s >= 0; --s)
            p = emit(Op::Select, k,
                     {emit(Op::Less, Kind::Bool, {st[0], constant(static_cast<float>(s) + 0.5f)}), point(s, j), p});
        args.push_back(p);
    }
    return runtime1("al_spline_" + basis + (k == Kind::Float ? "_f" : "_t"), args, k);
}

} // namespace alpenglow::rsl::ir
