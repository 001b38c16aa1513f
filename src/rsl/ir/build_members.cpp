// Members of co-shaders and variables of the primitive: a->x, a->list[i], getvar(), readprimvar(), hasmethod().
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

/// The member or parameter of that name; null when it is not to be seen.
const Symbol* Builder::memberOf(size_t i, const std::string& name) const {
    const Shader& s = *instances_[i].binding->shader;
    for (const ShaderParameter& p : s.parameters)
        if (p.symbol->name == name) return p.symbol;
    if (!s.object || !s.publics.count(name)) return nullptr;
    for (const StmtPtr& x : s.body->body)
        for (const Stmt::Declarator& d : x->declarators)
            if (d.symbol->name == name) return d.symbol;
    return nullptr;
}

/// All that memberOf() knows.
std::vector<const Symbol*> Builder::membersOf(size_t i) const {
    const Shader& s = *instances_[i].binding->shader;
    std::vector<const Symbol*> all;
    for (const ShaderParameter& p : s.parameters) all.push_back(p.symbol);
    if (s.object)
        for (const StmtPtr& x : s.body->body)
            for (const Stmt::Declarator& d : x->declarators)
                if (s.publics.count(d.symbol->name)) all.push_back(d.symbol);
    return all;
}

Inst* Builder::memberValue(size_t i, const Symbol& s) {
    enterInstance(i);
    Inst* v = get(slot(&s));
    leaveInstance();
    return v;
}

/// The type of what `handle->name` or `handle->name()` gives, for who takes any: that of the shader that the handle names, or of
/// the first that has one; a number where that is not to be seen.
Type Builder::typeOfMember(const Expr& e) {
    const bool element = e.kind == ExprKind::Index; // of an array, or a component
    const Expr& member = element ? *e.args[0] : e;
    const Expr& of = *member.args[0];
    Inst* h = of.kind == ExprKind::Variable || of.kind == ExprKind::String ? expr(of) : nullptr;
    const bool known = h && h->op == Op::ConstString;
    for (size_t i = 0; i < instances_.size(); ++i) {
        if (known && instances_[i].binding->handle != h->text) continue;
        if (e.kind == ExprKind::Method) {
            if (const Function* f = methodOf(i, e)) return f->result.base == Base::Void ? Type{Base::Float, 0} : f->result;
        } else if (const Symbol* s = memberOf(i, member.text)) {
            if (!element) return s->type;
            if (s->type.array) return s->type.element();
        }
    }
    return {Base::Float, 0};
}

/// Reports that the shader of this turn of forHandle() lacks what is asked. This is an error when the kernel is built if the
/// handle can mean no other shader. Otherwise (another one has it, or only the run decides, as with getlights() of a scene
/// without lights) it is reported when the shader reaches this place with such a handle.
void Builder::reportMissing(const Place& place, size_t i, const Missing& lack, const std::function<bool(size_t)>& has) {
    if (!certain_ && isSelf(i)) return; // another shader of the handle has it
    const CoShader& c = *instances_[i].binding;
    bool another = anyHandle_ || (c.light && !certain_); // lights of other kinds may have it; these are queried at run time
    for (size_t n = 0; n < instances_.size() && !certain_; ++n) another |= n != i && has(n);
    if (another) complain(place, lack.whenRun);
    else report(place, lack.error);
}

Builder::Missing Builder::noMember(size_t i, const std::string& name) const {
    const CoShader& c = *instances_[i].binding;
    const std::string handle = shownHandle(c.handle);
    return {msg::kNoPublicMember(handle, c.shader->name, name), msg::kNoPublicMemberHere(handle, c.shader->name, name)};
}

Builder::Missing Builder::otherType(size_t i, const Symbol& has, const std::string& name, const std::string& wanted) const {
    const CoShader& c = *instances_[i].binding;
    const std::string handle = shownHandle(c.handle), type = toString(has.type);
    return {msg::kMemberType(handle, c.shader->name, name, type, wanted),
            msg::kMemberTypeHere(handle, c.shader->name, name, type, wanted)};
}

Inst* Builder::memberAccess(const Expr& e) {
    const Type type = e.type.base == Base::Void ? typeOfMember(e) : e.type;
    const Kind kind = kindOf(type);
    if (Inst* v = ofSurface(*e.args[0], e.text, kind, nullptr)) return v;
    const auto fits = [&](size_t i) {
        const Symbol* s = memberOf(i, e.text);
        return s && !s->type.array && (kindOf(s->type) == kind || (kindOf(s->type) == Kind::Float && kind != Kind::String));
    };
    return forHandle(
        *e.args[0], kind,
        [&](size_t i) -> Inst* {
            const CoShader& c = *instances_[i].binding;
            const Symbol* s = memberOf(i, e.text);
            if (c.light && !(isSelf(i) && !certain_) && (!fits(i) || s->output))
                return lightMember(leaves_.string(c.handle), leaves_.string(e.text), kind, nullptr);
            if (!fits(i)) {
                reportMissing(e.place, i, s ? otherType(i, *s, e.text, toString(type)) : noMember(i, e.text), fits);
                return zero(kind);
            }
            return memberValue(i, *s);
        },
        [&](Inst* handle) { return lightMember(handle, leaves_.string(e.text), kind, nullptr); });
}

namespace {
bool among(const std::string& name, std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}
} // namespace

/// getvar(null, name [, variable]): of the primitive. `to` may be null.
Inst* Builder::primitiveVariable(const std::string& name, const Expr* to) {
    if (shader_.kind == ShaderKind::Light || shader_.kind == ShaderKind::Imager ||
        (to && (to->type.array || isStringLike(to->type.base))))
        return askPrimitive(leaves_.string(name), to);
    const auto& there = options_.varyingParameters;
    if (std::find(there.begin(), there.end(), name) == there.end()) {
        // Predefined variables of every primitive, as inputs with derivatives.
        const bool triple = among(name, {"P", "N", "Cs", "Os"});
        if (!triple && !among(name, {"s", "t"})) return askPrimitive(leaves_.string(name), to);
        if (!to) return constant(1);
        if (kindOf(to->type) != (triple ? Kind::Triple : Kind::Float)) return constant(0);
        assign(*to, input(name, to->type, false));
        return constant(1);
    }
    if (!to) return constant(1);
    const Type wanted = to->type;
    for (const ShaderParameter& p : shader_.parameters)
        if (p.symbol->name == name && p.symbol->type != wanted) return constant(0);
    // A primitive variable has one type: that of its first use, in the shader before its co-shaders.
    const auto asked = [&](const Program& p) {
        const auto found = p.primitiveVariables.find(name);
        return found == p.primitiveVariables.end() ? nullptr : &found->second;
    };
    const Type* first = asked(program_);
    for (size_t i = 0; i < instances_.size() && !first; ++i) first = asked(*instances_[i].binding->program);
    if (first && *first != wanted) return constant(0);
    assign(*to, input(InputName::parameter(name).text(), wanted, false));
    return constant(1);
}

Inst* Builder::readPrimitiveVariable(const Expr& e) {
    Inst* name = expr(*e.args[0]);
    place_ = e.place;
    if (name->op == Op::ConstString) return primitiveVariable(name->text, e.args[1].get());
    return askPrimitive(name, e.args[1].get());
}

/// Whether the shader of a handle has a public method of that name, with any parameters.
Inst* Builder::hasMethod(const Expr& e) {
    Inst* name = expr(*e.args[1]);
    Inst* handle = expr(*e.args[0]);
    place_ = e.place;
    if (name->op != Op::ConstString) {
        report(e.place, msg::kHasmethodConstant);
        return constant(0);
    }
    const auto has = [&](const Shader& s) {
        return s.publics.count(name->text) > 0 &&
               std::any_of(s.nested.begin(), s.nested.end(), [&](const auto& f) { return f->name == name->text; });
    };
    if (handle->op == Op::ConstString) {
        if (handle->text == selfBinding_.handle) return constant(has(shader_) ? 1.0f : 0.0f);
        for (const Instance& i : instances_)
            if (i.binding->handle == handle->text) return constant(has(*i.binding->shader) ? 1.0f : 0.0f);
        return constant(0);
    }
    return forHandle(
        *e.args[0], Kind::Float, [&](size_t i) { return constant(has(*instances_[i].binding->shader) ? 1.0f : 0.0f); },
        [&](Inst* other) -> Inst* { // no co-shader: a light, or null
            if (name->text != "light") return constant(0);
            Inst* null = emit(Op::Equal, Kind::Bool, {other, leaves_.string("")});
            return emit(Op::Select, Kind::Float, {null, constant(0), constant(1)});
        });
}

/// Copies an array of another shader. False, and nothing is done, where it is of another type or does not fill the variable.
bool Builder::takeArray(const Expr& to, Inst* from) {
    Inst* a = array(to);
    if (a->op != Op::ArrayNew || from->kind != Kind::Array || from->element != a->element) return false;
    if (const Lengths* l = lengths(a)) {
        const Lengths slots = *l;
        Inst* n = limitLength(a, lengthOf(from));
        set(slots.length, n);
        set(slots.reserved, runtime1("al_max_f", {get(slots.reserved), n}, Kind::Float));
    } else if (arrayLength(from) < arrayLength(a)) {
        return false;
    }
    const int storage = lengths(from) ? from->index : arrayLength(from);
    for (int n = 0; n < std::min(lengths(a) ? a->index : arrayLength(a), storage); ++n) {
        Inst* at = constant(static_cast<float>(n));
        emit(Op::ArrayStore, Kind::None, {a, at, emit(Op::ArrayLoad, a->element, {from, at})});
    }
    return true;
}

/// handle->tab as a whole: a copy, empty of null.
Inst* Builder::memberArray(const Expr& e) {
    int room = 1;
    for (size_t i = 0; i < instances_.size(); ++i)
        if (const Symbol* s = memberOf(i, e.text); s && s->type.array)
            if (Inst* v = memberValue(i, *s); v->kind == Kind::Array)
                room = std::max(room, lengths(v) ? v->index : arrayLength(v));
    Inst* a = newResizable(e.type.base, room);
    const Lengths l = *lengths(a);
    set(l.length, constant(0));
    set(l.reserved, constant(0));
    const auto given = [&](size_t i) -> Inst* {
        const Symbol* s = memberOf(i, e.text);
        Inst* from = s && s->type.array ? memberValue(i, *s) : nullptr;
        return from && from->kind == Kind::Array && from->element == a->element ? from : nullptr;
    };
    forHandle(
        *e.args[0], Kind::Float,
        [&](size_t i) -> Inst* {
            Inst* from = given(i);
            if (!from) {
                const Symbol* s = memberOf(i, e.text);
                const std::string wanted = "an array of " + toString(e.type.element());
                reportMissing(e.place, i, s ? otherType(i, *s, e.text, wanted) : noMember(i, e.text), given);
                return constant(0);
            }
            set(l.length, lengthOf(from));
            set(l.reserved, lengthOf(from));
            for (int n = 0; n < std::min(a->index, lengths(from) ? from->index : arrayLength(from)); ++n) {
                Inst* at = constant(static_cast<float>(n));
                emit(Op::ArrayStore, Kind::None, {a, at, emit(Op::ArrayLoad, a->element, {from, at})});
            }
            return constant(1);
        },
        [&](Inst* handle) -> Inst* { // a light
            Site s;
            s.op = "lightparameter";
            s.place = keptPlace(place_);
            s.strings = {e.text};
            s.resultKinds = {Kind::Float, Kind::Float};
            s.resultNames = {"", lengthResult("value")};
            s.resultType = {Base::Float, 0};
            for (int n = 0; n < a->index; ++n) {
                s.resultKinds.push_back(a->element);
                s.resultNames.push_back("value[" + std::to_string(n) + "]");
            }
            std::vector<Inst*> args;
            addArgument(s, args, handle, {Base::String, 0});
            const std::vector<Inst*> v = call(Op::Service, std::move(s), std::move(args));
            Inst* n = limitLength(a, v[1]);
            set(l.length, n);
            set(l.reserved, n);
            for (int k = 0; k < a->index; ++k)
                emit(Op::ArrayStore, Kind::None, {a, constant(static_cast<float>(k)), v[static_cast<size_t>(k) + 2]});
            return v[0];
        });
    return a;
}

/// The length of handle->tab, of any type; 0 of null.
Inst* Builder::memberLength(const Expr& e) {
    const auto found = [&](size_t i) -> Inst* {
        const Symbol* s = memberOf(i, e.text);
        Inst* v = s && s->type.array ? memberValue(i, *s) : nullptr;
        return v && v->kind == Kind::Array ? v : nullptr;
    };
    return forHandle(
        *e.args[0], Kind::Float,
        [&](size_t i) -> Inst* {
            if (Inst* v = found(i)) return lengthOf(v);
            const CoShader& c = *instances_[i].binding;
            const std::string handle = shownHandle(c.handle);
            reportMissing(
                e.place, i,
                {msg::kNoPublicArray(handle, c.shader->name, e.text), msg::kNoPublicArrayHere(handle, c.shader->name, e.text)},
                found);
            return constant(0);
        },
        [&](Inst* handle) -> Inst* { // a light
            Site s;
            s.op = "lightparameter";
            s.place = keptPlace(place_);
            s.strings = {e.text};
            s.resultKinds = {Kind::Float, Kind::Float};
            s.resultNames = {"", lengthResult("value")};
            s.resultType = {Base::Float, 0};
            std::vector<Inst*> args;
            addArgument(s, args, handle, {Base::String, 0});
            return call(Op::Service, std::move(s), std::move(args))[1];
        });
}

/// handle->tab[i]: an element of an array, or a component of a tuple.
Inst* Builder::memberElement(const Expr& e) {
    const Expr& member = *e.args[0];
    const Type type = e.type.base == Base::Void ? typeOfMember(e) : e.type;
    const Kind kind = kindOf(type);
    Inst* at = expr(*e.args[1], Kind::Float);
    place_ = e.place;
    const auto inArray = [&](const Inst* v) {
        return v->kind == Kind::Array && (v->element == kind || (v->element == Kind::Float && kind == Kind::Triple));
    };
    const auto inTuple = [&](const Inst* v) { return v->kind == Kind::Triple && kind != Kind::String && kind != Kind::Matrix; };
    const auto has = [&](size_t i) {
        const Symbol* s = memberOf(i, member.text);
        const Inst* v = s ? memberValue(i, *s) : nullptr;
        return v && (inArray(v) || inTuple(v));
    };
    return forHandle(
        *member.args[0], kind,
        [&](size_t i) -> Inst* {
            const Symbol* s = memberOf(i, member.text);
            Inst* v = s ? memberValue(i, *s) : nullptr;
            if (v && inArray(v)) return loadElement(v, elementOf(v, at));
            if (v && inTuple(v)) {
                const auto part = [&](int n) { return emit(Op::Extract, Kind::Float, {v}, n); };
                Inst* low = emit(Op::Select, Kind::Float, {emit(Op::LessEqual, Kind::Bool, {constant(1), at}), part(1), part(0)});
                return emit(Op::Select, Kind::Float, {emit(Op::LessEqual, Kind::Bool, {constant(2), at}), part(2), low});
            }
            const std::string wanted = "an array of " + toString(type);
            reportMissing(e.place, i, s ? otherType(i, *s, member.text, wanted) : noMember(i, member.text), has);
            return zero(kind);
        },
        [&](Inst* handle) { return lightMember(handle, leaves_.string(member.text), kind, nullptr, at); });
}

/// getvar(handle, name [, variable]): 1 when there is such a member.
Inst* Builder::getVariable(const Expr& e) {
    Inst* name = expr(*e.args[1]);
    place_ = e.place;
    Inst* handle = expr(*e.args[0]);
    const Expr* to = e.args.size() > 2 ? e.args[2].get() : nullptr;
    const bool null = handle->op == Op::ConstString && handle->text.empty();
    if (null) return name->op == Op::ConstString ? primitiveVariable(name->text, to) : askPrimitive(name, to);
    if (name->op == Op::ConstString)
        if (Inst* v = ofSurface(*e.args[0], name->text, Kind::Float, to)) return v;
    const auto take = [&](size_t i, const Symbol* s) -> Inst* {
        if (!s) return constant(0);
        if (!to) return constant(1);
        if ((s->type.array != 0) != (to->type.array != 0) || kindOf(s->type.element()) != kindOf(to->type.element()))
            return constant(0);
        const bool varying = s->origin == Symbol::Origin::ShaderParameter && s->storage == Storage::Varying;
        if (varying && to->symbol &&
            to->symbol->storage == Storage::Uniform) { // a varying parameter does not become a uniform variable, as in messages
            report(e.place, msg::kUniformGetvar(name->text, instances_[i].binding->shader->name));
            return constant(0);
        }
        if (s->type.array) return constant(takeArray(*to, memberValue(i, *s)) ? 1.0f : 0.0f);
        assign(*to, memberValue(i, *s));
        return constant(1);
    };
    return forHandle(
        *e.args[0], Kind::Float,
        [&](size_t i) -> Inst* {
            if (name->op == Op::ConstString) return take(i, memberOf(i, name->text));
            Inst* found = constant(0); // a name that is made when the shader runs is compared with all
            for (const Symbol* s : membersOf(i)) {
                if (to &&
                    ((s->type.array != 0) != (to->type.array != 0) || kindOf(s->type.element()) != kindOf(to->type.element())))
                    continue;
                found = branch(
                    emit(Op::Equal, Kind::Bool, {name, leaves_.string(s->name)}), [&] { return std::vector<Inst*>{take(i, s)}; },
                    [&] { return std::vector<Inst*>{found}; })[0];
            }
            return found;
        },
        [&](Inst* light) -> Inst* { return lightMember(light, name, to ? kindOf(to->type.element()) : Kind::Float, to); });
}

} // namespace alpenglow::rsl::ir
