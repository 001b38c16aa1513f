// Calls that the renderer answers: what goes along with them, and what comes back.
#include "base/limits.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include <algorithm>
#include <cstdio>
#include <set>

namespace alpenglow::rsl::ir {

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
        if (out.size() > limits::kTokenBytes) return nullptr; // cut off and reported when it runs
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

/// The form of trace() that gives an array: a request for each part of the distribution.
std::vector<Inst*> Builder::traceParts(const Expr& written) {
    const Expr& e = withNames(written);
    std::string name = "uniform";
    std::optional<int> numbers; // of "lobeparameters"
    for (const NamedArg& p : e.pairs) {
        if (!p.value) continue;
        if (p.name == "distribution" || p.name == "bsdf") {
            const Inst* v = expr(*p.value, Kind::String);
            name = v->op == Op::ConstString ? v->text : "";
        } else if (p.name == "lobeparameters" && p.value->type.array) {
            numbers = arrayLength(array(*p.value));
        }
    }
    const Distribution* const m = findDistribution(name);
    if (!m || m->parts == 1) {
        report(e.place, name.empty() ? Raised(msg::kTracePartsConstant) : msg::kTraceParts(name));
        return {service(e, Op::Request)};
    }
    int count = m->parts;
    if (!m->lobe.empty()) count = std::clamp(numbers ? *numbers / static_cast<int>(m->lobe.size()) : m->lobes, 1, m->parts);
    std::vector<Inst*> parts;
    for (int i = 0; i < count; ++i) parts.push_back(service(e, Op::Request, i));
    return parts;
}

/// `part`: of a call that gives an array; -1: all in one. `points`: it is answered from point clouds.
Inst* Builder::service(const Expr& e, Op kind, int part, bool points) {
    const Shadeop& op = *e.shadeop;
    const Signature& sig = *e.signature;
    const bool parted = kind == Op::Request && sig.result.array;
    Site s;
    s.op = op.name;
    s.shadeop = &op;
    s.resultType = parted ? e.type.element() : e.type;
    s.pure = op.pure && kind == Op::Service;
    const auto mark = [&](const char* pair) { s.names.push_back(pair), s.pairStrings.push_back("1"); };
    std::vector<Inst*> args;
    struct Out {
        const Expr* lvalue;
        int first;
        int count;
        int at = 0; ///< the first element of an array
    };
    std::vector<Out> outs;
    std::vector<std::pair<Receiver, int>> received; ///< of messages, with their first results
    const Kind whole = parted ? kindOf(sig.result.element()) : sig.result.array ? Kind::None : kindOf(sig.result);
    if (whole != Kind::None) {
        s.resultKinds.push_back(whole);
        s.resultNames.push_back("");
    }
    const auto output = [&](const Expr& l, const std::string& name) {
        if (op.section == "Messages" && !parted) {
            const int first = static_cast<int>(s.resultKinds.size());
            received.push_back({receiver(s, l, name), first});
            return;
        }
        Out o{&l, static_cast<int>(s.resultKinds.size()), 1};
        if (l.type.array && parted) { // the element of this part
            o.at = std::max(part, 0);
            if (o.at >= arrayLength(array(l))) return;
            s.resultKinds.push_back(kindOf(l.type.element()));
            s.resultNames.push_back(name);
        } else if (part > 0) {
            return; // what belongs to all parts comes with the first
        } else if (l.type.array) {
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
            refuseLonger(from, a.place, op.name + "()");
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
        const bool untyped =
            (a.kind == ExprKind::Member || a.kind == ExprKind::Method || a.kind == ExprKind::Index) && a.type.base == Base::Void;
        if (v->op != Op::ConstString || (v->text.empty() && op.section == "Strings"))
            addArgument(s, args, v, untyped ? typeOfMember(a) : a.type);
    }
    if (Inst* c = foldString(op.name, all)) return c;
    if (Inst* heard = nullptr;
        op.name == "displacement" && !all.empty() && all[0]->op == Op::ConstString && heardDisplacement(e, all[0]->text, heard))
        return heard;
    place_ = e.place;
    const Type real{Base::Float, 0}, vector{Base::Vector, 0};
    // Footprints: how far the coordinates go from one sample to the next, along u (x) and along v (y).
    const auto footprint = [&](Inst* v, const char* size, Op d) {
        Inst* step = coerce(global(size, Base::Float), v->kind);
        return isConst(step, 0.0f) ? zero(v->kind) : emit(Op::Mul, v->kind, {emit(d, v->kind, {v}), step});
    };
    const Footprint& over = op.footprint;
    if (over.of == Footprint::Of::Surface && (all.size() == over.first || all.size() == over.first + 2)) {
        const bool given = all.size() > over.first;
        Inst* const st[] = {given ? all[over.first] : global("s", Base::Float),
                            given ? all[over.first + 1] : global("t", Base::Float)};
        for (Inst* c : st)
            if (!given) addArgument(s, args, c, real);
        for (int d = 0; d < 2; ++d)
            for (Inst* c : st) addArgument(s, args, footprint(c, d == 0 ? "du" : "dv", d == 0 ? Op::Du : Op::Dv), real);
        if (over.marks && !given) addArgument(s, args, constant(1), real);
    }
    if (over.of == Footprint::Of::Space && all.size() == over.count) {
        addArgument(s, args, footprint(all[over.first], "du", Op::Du), vector);
        addArgument(s, args, footprint(all[over.first], "dv", Op::Dv), vector);
    }
    if (kind == Op::Request && op.name == "ambient") addArgument(s, args, global("N", Base::Normal), {Base::Normal, 0});
    if (e.channel) {
        s.names.push_back("channel");
        s.pairStrings.push_back("");
        addArgument(s, args, expr(*e.channel, Kind::Float), real);
    }
    for (const NamedArg& p : e.pairs) {
        if (!p.value || ofRaysOnly(e, p.name)) continue;
        if (p.output) {
            output(*p.value, p.name);
            continue;
        }
        const OptionalParameter* known = nullptr;
        for (const OptionalParameter& o : op.optional)
            if (o.name == p.name) known = &o;
        if (p.value->type.array) {
            Inst* from = array(*p.value);
            refuseLonger(from, p.place, "\"" + p.name + "\" of " + op.name + "()");
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
        if (kind == Op::Request && op.name == "subsurface" && p.name == "irradiance") {
            enters(v);
            mark(kPairEntering);
            continue;
        }
        if (v->op == Op::ConstString && v->text.empty()) continue; // every string's default means the same as its absence
        s.names.push_back(p.name);
        s.pairStrings.push_back(v->op == Op::ConstString ? v->text : "");
        if (v->op != Op::ConstString) addArgument(s, args, v, known ? known->type.element() : p.value->type);
    }
    if (kind == Op::Request && op.name == "subsurface" && options_.light == kEntering) return zero(whole);
    // Lights that the rays or the samples of this call meet ask for outputs as they are now.
    static const std::set<std::string> kLit = {"diffuse", "specular", "specularstd", "phong", "trace"};
    if (kind == Op::Request && kLit.count(op.name))
        for (const auto& [name, parameter] : messageSlots_) {
            Inst* v = get(parameter.first);
            s.names.push_back(PairName::surface(name).text());
            s.pairStrings.push_back("");
            addArgument(s, args, v, parameter.second);
        }
    if (quiet_ > 0 && (op.name == "printf" || op.name == "print")) return constant(0);
    if (constructing_ > 0 && (op.name == "printf" || op.name == "print")) mark(kPairOnce); // printlog.h
    if (part >= 0) {
        s.names.push_back(kPairPart);
        s.pairStrings.push_back(std::to_string(part));
    }
    if (points) mark(kPairPoints);
    // A uniform variable takes no varying parameter of another shader (services/dispatch.cpp).
    const auto isUniform = [](const Expr* l) {
        while (l->kind == ExprKind::Index && !l->args.empty()) l = l->args[0].get();
        return l->symbol && l->symbol->storage == Storage::Uniform;
    };
    static const std::set<std::string> kShaders = {"surface",  "displacement", "atmosphere",
                                                   "incident", "opposite",     "lightsource"};
    if (kShaders.count(op.name) && !received.empty() && isUniform(received[0].first.to)) mark(kPairUniform);
    static const std::set<std::string> kOfTheTurn = {"lightsource", "attribute", "shadername"};
    if (lightDepth_ == 0 && kOfTheTurn.count(op.name)) { // there is no light to ask about
        if (op.name == "lightsource" && shader_.kind != ShaderKind::Light)
            report(e.place, msg::kOutsideIlluminance("lightsource"));
        mark(kPairOutside);
    }
    place_ = e.place;
    const bool message = op.section == "Messages" && !s.resultKinds.empty() && s.resultNames[0].empty();
    const std::vector<Inst*> r = call(kind, std::move(s), std::move(args));
    Inst* found = message && !received.empty() ? emit(Op::NotEqual, Kind::Bool, {r[0], constant(0)}) : nullptr;
    // What a file has nothing for stays as it was.
    Inst* read = op.name == "texture3d" && kind == Op::Service ? emit(Op::NotEqual, Kind::Bool, {r[0], constant(0)}) : nullptr;
    const auto either = [&](Inst* v, const auto& old) {
        return read ? emit(Op::Select, v->kind, {read, v, coerce(old(), v->kind)}) : v;
    };
    for (const auto& [receiver, first] : received)
        receive(receiver, std::span(r).subspan(static_cast<size_t>(first), static_cast<size_t>(receiver.rows)), found);
    for (const Out& o : outs) {
        if (o.lvalue->type.array) {
            Inst* a = array(*o.lvalue);
            for (int n = 0; n < o.count && a->op == Op::ArrayNew; ++n) {
                Inst* at = constant(static_cast<float>(o.at + n));
                Inst* v = either(r[static_cast<size_t>(o.first + n)], [&] { return emit(Op::ArrayLoad, a->element, {a, at}); });
                emit(Op::ArrayStore, Kind::None, {a, at, v});
            }
            continue;
        }
        const Held held(*this, *o.lvalue);
        Inst* v = r[static_cast<size_t>(o.first)];
        assign(*o.lvalue, either(v, [&] { return expr(*o.lvalue); }));
    }
    return whole != Kind::None && !r.empty() ? r[0] : constant(0);
}

} // namespace alpenglow::rsl::ir
