// Co-shaders: calls of their methods are inlined. A handle is the name under which the scene bound the shader; where it is not known
// here, one branch a bound shader decides. Members of a co-shader are variables that begin where the shader begins.
#include "base/category.h"
#include "base/limits.h"
#include "rsl/front/visit.h"
#include "rsl/ir/builder.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

namespace {

/// Is `this`, `surface` or `caller` used as a value, and not only to name what belongs to it?
bool handsItselfOver(const Shader& s, const Program& p) {
    bool found = false;
    const auto body = [&](const Stmt* b) {
        if (b) front::everyStmt(*b, [](const Stmt&) {}, [&](const Expr& e) {
            found |= e.kind == ExprKind::String && e.handle && (e.text == "(this)" || e.text == "(surface)" || e.text == "(caller)");
        });
    };
    body(s.body.get());
    for (const auto& n : s.nested) front::everyFunction(*n, [&](const Function& f) { body(f.body.get()); });
    for (const auto& n : p.functions) front::everyFunction(*n, [&](const Function& f) { body(f.body.get()); });
    return found;
}

} // namespace

/// Does anything of these programs write to the variable, or to an element of it?
bool Builder::everWritten(const Symbol& s) {
    if (!written_) {
        written_.emplace();
        const auto add = [&](const Expr* e) {
            while (e->kind == ExprKind::Index && !e->args.empty()) e = e->args[0].get();
            if (e->symbol) written_->insert(e->symbol);
        };
        const auto expression = [&](const Expr& e) {
            if (e.kind == ExprKind::Assign) add(e.args[0].get());
            const bool other = e.kind == ExprKind::Method; // its parameters are not known yet
            for (size_t n = 0; n < e.args.size(); ++n) {
                const bool output = e.signature ? n < e.signature->parameters.size() && e.signature->parameters[n].output
                                                : e.function && n < e.function->parameters.size() && e.function->parameters[n]->output;
                if ((output || other) && e.args[n]) add(e.args[n].get());
            }
            for (const NamedArg& p : e.pairs)
                if (p.output && p.value) add(p.value.get());
        };
        const auto body = [&](const StmtPtr& b) {
            if (b)
                front::everyStmt(*b, [&](const Stmt& x) {
                    for (const NamedArg& p : x.pairs)
                        if (p.value) add(p.value.get());
                }, expression);
        };
        const auto program = [&](const Program& p) {
            for (const auto& x : p.shaders) body(x->body);
            front::everyFunction(p, [&](const Function& f) { body(f.body); });
        };
        program(program_);
        for (const CoShader& c : options_.coShaders) program(*c.program);
    }
    return written_->count(&s) > 0;
}

/// Elements of parameters that only read are known, also where the index is not.
void Builder::noteTexts(const Inst* array, const Symbol& s, int length, std::span<const std::pair<std::string, std::string>> given) {
    if (array->op != Op::ArrayNew || array->element != Kind::String || everWritten(s)) return;
    std::vector<std::string> all(static_cast<size_t>(std::max(0, length)));
    for (int n = 0; n < length; ++n)
        for (const auto& [name, text] : given)
            if (name == s.name + "[" + std::to_string(n) + "]") all[static_cast<size_t>(n)] = text;
    texts_[array] = std::move(all);
}

/// Whether all that the string can be is known, and what that is.
bool Builder::possibleTexts(const Inst* v, std::set<std::string>& out, int depth) const {
    if (depth > 16) return false;
    if (v->op == Op::ConstString) {
        out.insert(v->text);
        return true;
    }
    if (v->op == Op::Select && v->args.size() == 3) return possibleTexts(v->args[1], out, depth + 1) && possibleTexts(v->args[2], out, depth + 1);
    if (v->op == Op::Result && v->args[0]->op == Op::If)
        return std::all_of(v->args[0]->regions.begin(), v->args[0]->regions.end(),
                           [&](const Region& r) { return possibleTexts(r.yields[static_cast<size_t>(v->index)], out, depth + 1); });
    const auto known = v->op == Op::ArrayLoad ? texts_.find(v->args[0]) : texts_.end();
    if (known == texts_.end()) return false;
    out.insert(known->second.begin(), known->second.end());
    return true;
}

/// An error that shows when the shader runs, where it comes to this.
void Builder::complain(const Place& place, const std::string& text) {
    Site s;
    s.op = "complaint";
    s.strings = {text};
    place_ = place;
    call(Op::Service, std::move(s), {});
}

/// What `this` is called: a co-shader by its handle, others by what they are (seed, format "%h").
std::string Builder::thisHandle() const {
    if (!current_.empty() && !isSelf(current_.back())) return instances_[current_.back()].binding->handle;
    return "<" + std::string(toString(shader_.kind)) + ">";
}

/// `this`, and the handles that have names of their own: `surface`, the shader of the surface that is shaded or lit; `caller`, the
/// shader that called the method; `light`, the light of the turn of illuminance.
Inst* Builder::handleText(const Expr& e) {
    const std::string self = "<" + std::string(toString(shader_.kind)) + ">", surface = "<" + std::string(toString(ShaderKind::Surface)) + ">";
    const bool lightShader = shader_.kind == ShaderKind::Light;
    if (e.text == "(this)" || (e.text == "(light)" && lightShader)) return leaves_.string(thisHandle());
    if (e.text == "(surface)" && shader_.kind != ShaderKind::Imager) return leaves_.string(surface);
    if (e.text == "(caller)" && (!current_.empty() || lightShader)) {
        const size_t n = current_.size();
        if (n == 0) return leaves_.string(surface); // a light is asked by the surface
        return leaves_.string(n > 1 && !isSelf(current_[n - 2]) ? instances_[current_[n - 2]].binding->handle : self);
    }
    if (e.text == "(light)" && lightDepth_ > 0) {
        Site s;
        s.op = "currentlight";
        s.resultKinds = {Kind::String};
        s.resultNames = {""};
        s.resultType = {Base::String, 0};
        place_ = e.place;
        return call(Op::Service, std::move(s), {})[0];
    }
    warn(e.place, "'" + e.text.substr(1, e.text.size() - 2) + "' is null here: there is no such shader");
    return leaves_.string("");
}

/// A parameter of the surface that a light, a displacement or an atmosphere asks for by the handle `surface`; null where the handle is
/// another. `to`: the variable that getvar() fills, which then gives whether there is one; else the value is given.
Inst* Builder::ofSurface(const Expr& handle, const std::string& name, Kind kind, const Expr* to) {
    if (shader_.kind == ShaderKind::Surface || shader_.kind == ShaderKind::Imager) return nullptr;
    Inst* h = expr(handle, Kind::String);
    if (h->op != Op::ConstString || h->text != "<surface>") return nullptr;
    Site s;
    s.op = "surface";
    s.shadeop = findShadeop("surface");
    s.strings = {name};
    s.resultKinds = {Kind::Float};
    s.resultNames = {""};
    s.resultType = {Base::Float, 0};
    Receiver r;
    if (to) r = receiver(s, *to, "value");
    else s.resultKinds.push_back(kind), s.resultNames.push_back("value");
    const std::vector<Inst*> v = call(Op::Service, std::move(s), {});
    if (!to) return v[1];
    receive(r, std::span(v).subspan(1), emit(Op::NotEqual, Kind::Bool, {v[0], constant(0)}));
    return v[0];
}

void Builder::switchInstance(bool fromSelf, size_t from, bool toSelf, size_t to) {
    if (fromSelf == toSelf && (fromSelf || from == to)) return;
    std::swap(slots_, fromSelf ? ownSlots_ : instances_[from].slots);
    std::swap(slots_, toSelf ? ownSlots_ : instances_[to].slots);
    files_ = toSelf ? &program_.files : instances_[to].files;
}

/// From here to leaveInstance() variables are those of the co-shader, or of the shader itself again.
void Builder::enterInstance(size_t i) {
    const bool own = current_.empty() || isSelf(current_.back());
    switchInstance(own, own ? 0 : current_.back(), isSelf(i), i);
    current_.push_back(i);
}

void Builder::leaveInstance() {
    const size_t i = current_.back();
    current_.pop_back();
    const bool own = current_.empty() || isSelf(current_.back());
    switchInstance(isSelf(i), i, own, own ? 0 : current_.back());
}

/// Binds the parameters and runs what comes before the methods: members, construct() and begin().
void Builder::beginCoShaders() {
    if (!program_.handles) return;
    for (const CoShader& c : options_.coShaders) instances_.push_back({&c, &c.program->files, {}});
    for (size_t i = 0; i < instances_.size(); ++i) {
        const CoShader& c = *instances_[i].binding;
        enterInstance(i);
        ++handleDepth_;
        for (const ShaderParameter& p : c.shader->parameters) {
            const Symbol& s = *p.symbol;
            const auto& numbers = c.numbers.count(s.name) ? c.numbers.at(s.name) : std::vector<float>{};
            Inst* v = nullptr;
            if (std::find(c.computed.begin(), c.computed.end(), s.name) != c.computed.end()) {
                v = defaultValue(p, std::max(1, s.type.array));
            } else if (s.type.base == Base::String && !s.type.array) {
                v = leaves_.string(c.strings.count(s.name) ? c.strings.at(s.name) : "");
            } else if (s.type.base == Base::String) {
                const std::vector<std::pair<std::string, std::string>> given(c.strings.begin(), c.strings.end());
                int n = 0;
                while (c.strings.count(s.name + "[" + std::to_string(n) + "]")) ++n;
                v = constantTexts(s.name, n, given);
                if (!v) v = newArray(Base::String, std::max(1, s.type.array));
                if (s.type.array < 0 || s.open) given_[v] = parameterLength(p, given);
                noteTexts(v, s, n, given);
            } else if (s.type.array) {
                const size_t each = static_cast<size_t>(components(kindOf(s.type.element())));
                const int n = std::max<int>(1, static_cast<int>(numbers.size() / each));
                v = newArray(s.type.base, n);
                for (size_t k = 0; k < numbers.size() / each; ++k) {
                    const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(k * each);
                    Inst* x = leaves_.constant(v->element, std::vector<float>(first, first + static_cast<std::ptrdiff_t>(each)));
                    emit(Op::ArrayStore, Kind::None, {v, constant(static_cast<float>(k)), x});
                }
                if (s.type.array < 0 || s.open) given_[v] = parameterLength(p, std::vector<std::pair<std::string, std::string>>(c.strings.begin(), c.strings.end()));
            } else {
                std::vector<float> all = numbers;
                all.resize(static_cast<size_t>(components(kindOf(s.type))));
                v = leaves_.constant(kindOf(s.type), all);
            }
            set(slot(&s), v);
        }
        if (c.shader->object && c.shader->body)
            for (const StmtPtr& s : c.shader->body->body) {
                const bool starts = s->kind == StmtKind::Expression &&
                                    (s->value->text == "construct" || s->value->text == "begin");
                if ((s->kind == StmtKind::Declare && !s->definition) || starts) statement(*s);
            }
        --handleDepth_;
        leaveInstance();
    }
    bool handed = handsItselfOver(shader_, program_);
    for (const CoShader& c : options_.coShaders) handed |= handsItselfOver(*c.shader, *c.program);
    if (!handed) return;
    // Others may be handed `this`: then the shader itself is one of those that a handle can mean, the last.
    selfBinding_.handle = thisHandle();
    selfBinding_.program = &program_;
    selfBinding_.shader = &shader_;
    instances_.push_back({&selfBinding_, &program_.files, {}});
}

/// Runs `code` for the co-shader of the handle and gives its value; zero of null.
Inst* Builder::forHandle(const Expr& handle, Kind kind, const std::function<Inst*(size_t)>& code, const std::function<Inst*(Inst*)>& light) {
    Inst* h = expr(handle, Kind::String);
    place_ = handle.place;
    if (failed_) return zero(kind);
    if (handleDepth_ > limits::kCoShaderDepth) {
        error(handle.place, "co-shaders call each other more than " + std::to_string(limits::kCoShaderDepth) + " deep");
        return zero(kind);
    }
    if (h->op == Op::ConstString) {
        for (size_t i = 0; i < instances_.size(); ++i)
            if (instances_[i].binding->handle == h->text) {
                certain_ = true;
                return coerce(code(i), kind);
            }
        warn(handle.place, "this handle is null here: no co-shader is bound to it");
        return zero(kind);
    }
    std::set<std::string> possible;
    const bool some = possibleTexts(h, possible);
    std::vector<size_t> candidates;
    for (size_t i = 0; i < instances_.size(); ++i)
        if (!some || possible.count(instances_[i].binding->handle)) candidates.push_back(i);
    const std::function<std::vector<Inst*>(size_t)> from = [&](size_t n) -> std::vector<Inst*> {
        if (n == candidates.size()) return {light ? coerce(light(h), kind) : zero(kind)}; // no co-shader: perhaps a light
        const size_t i = candidates[n];
        Inst* same = emit(Op::Equal, Kind::Bool, {h, leaves_.string(instances_[i].binding->handle)});
        const auto call = [&] {
            certain_ = false;
            return std::vector<Inst*>{coerce(code(i), kind)};
        };
        return branch(same, call, [&] { return from(n + 1); });
    };
    return from(0)[0];
}

/// What a call gives for each parameter, null where it leaves the default: so many in order, at least those without a default, and
/// then names and values, as h->light(L, Cl, "samples", 16). Whether the call fits.
bool Builder::argumentsOf(const Function& f, const Expr& call, std::vector<const Expr*>& given) {
    const size_t count = call.args.size() - 1, most = f.parameters.size();
    const auto optional = [&](size_t n) { return n < f.defaults.size() && f.defaults[n]; };
    size_t least = most;
    while (least > 0 && optional(least - 1)) --least;
    for (size_t inOrder = least; inOrder <= std::min(count, most); ++inOrder) {
        given.assign(most, nullptr);
        for (size_t n = 0; n < inOrder; ++n) given[n] = call.args[n + 1].get();
        bool fits = (count - inOrder) % 2 == 0;
        for (size_t n = inOrder; fits && n < count; n += 2) {
            const Expr& name = *call.args[n + 1];
            size_t to = inOrder;
            while (to < most && !(name.kind == ExprKind::String && f.parameters[to]->name == name.text)) ++to;
            fits = to < most;
            if (fits) given[to] = call.args[n + 2].get();
        }
        if (fits) return true;
    }
    return false;
}

const Function* Builder::methodOf(size_t i, const Expr& call) const {
    std::vector<const Expr*> given;
    for (const auto& f : instances_[i].binding->shader->nested)
        if (f->name == call.text && argumentsOf(*f, call, given)) return f.get();
    return nullptr;
}

Inst* Builder::methodCall(const Expr& e) {
    const Type type = e.type.base == Base::Void ? typeOfMember(e) : e.type;
    const Kind kind = kindOf(type) == Kind::None ? Kind::Float : kindOf(type);
    return forHandle(*e.args[0], kind, [&](size_t i) -> Inst* {
        const CoShader& c = *instances_[i].binding;
        const Function* f = methodOf(i, e);
        if (!certain_ && isSelf(i) && (!f || !c.shader->publics.count(e.text))) return zero(kind); // one of the others is meant
        const auto has = [&](size_t other) { return methodOf(other, e) && instances_[other].binding->shader->publics.count(e.text); };
        if (!certain_ && !has(i)) { // as long as another can be meant
            bool another = false;
            for (size_t n = 0; n < instances_.size(); ++n) another |= n != i && has(n);
            if (another) {
                complain(e.place, "co-shader '" + c.handle + "' (" + c.shader->name + ") has no public method '" + e.text + "' with " +
                                      std::to_string(e.args.size() - 1) + " arguments; the call does nothing");
                return zero(kind);
            }
        }
        if (!f || !c.shader->publics.count(e.text)) {
            error(e.place, "co-shader '" + c.handle + "' (" + c.shader->name + ") has no public method '" + e.text + "' with " +
                               std::to_string(e.args.size() - 1) + " arguments");
            return zero(kind);
        }
        if (openMethods_.count({i, f}) && !certain_) { // it may be another each time: whether it is a circle shows when the shader runs
            complain(e.place, "method '" + e.text + "' of co-shader '" + c.handle + "' calls itself; the inner call does nothing");
            return zero(kind);
        }
        if (openMethods_.count({i, f})) {
            error(e.place, "method '" + e.text + "' of co-shader '" + c.handle + "' calls itself; recursion is not allowed");
            return zero(kind);
        }
        std::vector<const Expr*> arguments;
        argumentsOf(*f, e, arguments);
        std::vector<Inst*> values;
        std::deque<Held> held;
        for (size_t n = 0; n < f->parameters.size() && !failed_; ++n) {
            if (!arguments[n]) {
                values.push_back(nullptr);
                continue;
            }
            const Expr& given = *arguments[n];
            const Symbol& p = *f->parameters[n];
            const bool variable = given.kind == ExprKind::Variable || given.kind == ExprKind::Index;
            const bool fits = (given.type.array != 0) == (p.type.array != 0) &&
                              (kindOf(given.type.element()) == kindOf(p.type.element()) ||
                               (given.type == Type{Base::Float, 0} && !p.output && kindOf(p.type) != Kind::String));
            if (!fits || (p.output && !variable)) {
                error(given.place, "argument " + std::to_string(n + 1) + " of method '" + e.text + "' of co-shader '" + c.handle +
                                       "' is " + (p.output ? "a variable of type " : "") + toString(p.type) + ", not " +
                                       toString(given.type));
                return zero(kind);
            }
            if (p.output) held.emplace_back(*this, given);
            if (!p.type.array) {
                values.push_back(p.output ? nullptr : coerce(expr(given), p.type));
                continue;
            }
            Inst* a = array(given);
            if (!p.output) { // by value
                Inst* copy = newArray(p.type.base, arrayLength(a));
                copyArray(copy, given);
                a = copy;
            }
            values.push_back(a);
        }
        for (size_t n = 0; n < values.size() && !failed_; ++n) // outputs are what they are when all arguments are known
            if (arguments[n] && !values[n]) values[n] = coerce(expr(*arguments[n]), f->parameters[n]->type);
        if (failed_) return zero(kind);
        openMethods_.insert({i, f});
        enterInstance(i);
        ++handleDepth_;
        for (size_t n = 0; n < values.size(); ++n) {
            const Symbol& p = *f->parameters[n];
            if (!values[n] && p.type.array) {
                values[n] = newResizable(p.type.base, 0);
                copyResizable(values[n], *f->defaults[n]);
            } else if (!values[n]) {
                values[n] = coerce(expr(*f->defaults[n], kindOf(p.type)), p.type);
            }
            set(slot(&p), values[n]);
        }
        Frame frame;
        frame.function = f;
        frame.type = f->result;
        frame.returned = newSlot(boolean(false));
        if (f->result.base != Base::Void) frame.result = newSlot(zero(kindOf(f->result)));
        frames_.push_back(frame);
        if (f->body) statement(*f->body);
        frames_.pop_back();
        std::vector<Inst*> outputs;
        for (const Symbol* p : f->parameters) outputs.push_back(get(slot(p)));
        --handleDepth_;
        leaveInstance();
        openMethods_.erase({i, f});
        place_ = e.place;
        for (size_t n = 0; n < outputs.size(); ++n)
            if (f->parameters[n]->output && !f->parameters[n]->type.array && arguments[n])
                assign(*arguments[n], outputs[n]);
        Inst* result = frame.result >= 0 ? get(frame.result) : zero(kind);
        if (result->kind != kind && !(result->kind == Kind::Float && kind != Kind::String)) {
            error(e.place, "method '" + e.text + "' of co-shader '" + c.handle + "' gives " + toString(f->result) + ", not " +
                               toString(e.type));
            return zero(kind);
        }
        return result;
    }, [&](Inst* handle) { return lightMethod(e, handle); });
}

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

/// The type of what `handle->name` or `handle->name()` gives, for who takes any: that of the shader that the handle names, or of the first
/// that has one; a number where that is not to be seen.
Type Builder::typeOfMember(const Expr& e) {
    Inst* h = e.args[0]->kind == ExprKind::Variable || e.args[0]->kind == ExprKind::String ? expr(*e.args[0]) : nullptr;
    const bool known = h && h->op == Op::ConstString;
    for (size_t i = 0; i < instances_.size(); ++i) {
        if (known && instances_[i].binding->handle != h->text) continue;
        if (e.kind == ExprKind::Method) {
            if (const Function* f = methodOf(i, e)) return f->result.base == Base::Void ? Type{Base::Float, 0} : f->result;
        } else if (const Symbol* s = memberOf(i, e.text)) {
            return s->type;
        }
    }
    return {Base::Float, 0};
}

Inst* Builder::memberAccess(const Expr& e) {
    const Kind kind = kindOf(e.type.base == Base::Void ? typeOfMember(e) : e.type);
    if (Inst* v = ofSurface(*e.args[0], e.text, kind, nullptr)) return v;
    return forHandle(*e.args[0], kind, [&](size_t i) -> Inst* {
        const CoShader& c = *instances_[i].binding;
        const Symbol* s = memberOf(i, e.text);
        const bool fits = s && !s->type.array &&
                          (kindOf(s->type) == kind || (kindOf(s->type) == Kind::Float && kind != Kind::String));
        if (!fits && !certain_ && isSelf(i)) return zero(kind);
        if (!fits) {
            error(e.place, "co-shader '" + c.handle + "' (" + c.shader->name + ") " +
                               (s ? "has '" + e.text + "' as " + toString(s->type) + ", not " + toString(e.type)
                                  : "has no public member '" + e.text + "'"));
            return zero(kind);
        }
        return memberValue(i, *s);
    }, [&](Inst* handle) { return lightMember(handle, leaves_.string(e.text), kind, nullptr); });
}

namespace {
bool among(const std::string& name, std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}
} // namespace

/// getvar(null, name [, variable]): of the primitive. `to` may be null.
Inst* Builder::primitiveVariable(const std::string& name, const Expr* to) {
    if (shader_.kind == ShaderKind::Light || shader_.kind == ShaderKind::Imager || (to && (to->type.array || to->type.base == Base::String)))
        return askPrimitive(leaves_.string(name), to);
    const auto& there = options_.varyingParameters;
    if (std::find(there.begin(), there.end(), name) == there.end()) {
        // What every primitive has, as it comes to the shader, with its derivatives.
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
    // The scene knows one type for it: that of the first who asks, the shader before its co-shaders.
    const auto asked = [&](const Program& p) {
        const auto found = p.primitiveVariables.find(name);
        return found == p.primitiveVariables.end() ? nullptr : &found->second;
    };
    const Type* first = asked(program_);
    for (size_t i = 0; i < instances_.size() && !first; ++i) first = asked(*instances_[i].binding->program);
    if (first && *first != wanted) return constant(0);
    assign(*to, input("param:" + name, wanted, false));
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
        warn(e.place, "hasmethod() needs a name that is known when the shader is compiled; it gives 0");
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
    return forHandle(*e.args[0], Kind::Float, [&](size_t i) { return constant(has(*instances_[i].binding->shader) ? 1.0f : 0.0f); },
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
            if (Inst* v = memberValue(i, *s); v->kind == Kind::Array) room = std::max(room, lengths(v) ? v->index : arrayLength(v));
    Inst* a = newResizable(e.type.base, room);
    const Lengths l = *lengths(a);
    set(l.length, constant(0));
    set(l.reserved, constant(0));
    forHandle(*e.args[0], Kind::Float, [&](size_t i) -> Inst* {
        const Symbol* s = memberOf(i, e.text);
        Inst* from = s && s->type.array ? memberValue(i, *s) : nullptr;
        if (!from || from->kind != Kind::Array || from->element != a->element) {
            const CoShader& c = *instances_[i].binding;
            error(e.place, "co-shader '" + c.handle + "' (" + c.shader->name + ") " +
                               (s ? "has '" + e.text + "' as " + toString(s->type) + ", not an array of " + toString(e.type.element()) : "has no public member '" + e.text + "'"));
            return constant(0);
        }
        set(l.length, lengthOf(from));
        set(l.reserved, lengthOf(from));
        for (int n = 0; n < std::min(a->index, lengths(from) ? from->index : arrayLength(from)); ++n) {
            Inst* at = constant(static_cast<float>(n));
            emit(Op::ArrayStore, Kind::None, {a, at, emit(Op::ArrayLoad, a->element, {from, at})});
        }
        return constant(1);
    }, [&](Inst* handle) -> Inst* { // a light
        Site s;
        s.op = "lightparameter";
        s.place = place_;
        s.strings = {e.text};
        s.resultKinds = {Kind::Float, Kind::Float};
        s.resultNames = {"", "length value"};
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
        for (int k = 0; k < a->index; ++k) emit(Op::ArrayStore, Kind::None, {a, constant(static_cast<float>(k)), v[static_cast<size_t>(k) + 2]});
        return v[0];
    });
    return a;
}

/// The length of handle->tab, of any type; 0 of null.
Inst* Builder::memberLength(const Expr& e) {
    return forHandle(*e.args[0], Kind::Float, [&](size_t i) -> Inst* {
        const Symbol* s = memberOf(i, e.text);
        if (s && s->type.array)
            if (Inst* v = memberValue(i, *s); v->kind == Kind::Array) return lengthOf(v);
        const CoShader& c = *instances_[i].binding;
        error(e.place, "co-shader '" + c.handle + "' (" + c.shader->name + ") has no public array '" + e.text + "'");
        return constant(0);
    });
}

/// handle->tab[i]: an element of an array, or a component of a tuple.
Inst* Builder::memberElement(const Expr& e) {
    const Expr& member = *e.args[0];
    const Kind kind = kindOf(e.type);
    Inst* at = expr(*e.args[1], Kind::Float);
    place_ = e.place;
    return forHandle(*member.args[0], kind, [&](size_t i) -> Inst* {
        const CoShader& c = *instances_[i].binding;
        const Symbol* s = memberOf(i, member.text);
        Inst* v = s ? memberValue(i, *s) : nullptr;
        if (v && v->kind == Kind::Array && (v->element == kind || (v->element == Kind::Float && kind == Kind::Triple)))
            return emit(Op::ArrayLoad, v->element, {v, elementOf(v, at)});
        if (v && v->kind == Kind::Triple && kind != Kind::String && kind != Kind::Matrix) {
            const auto part = [&](int n) { return emit(Op::Extract, Kind::Float, {v}, n); };
            Inst* low = emit(Op::Select, Kind::Float, {emit(Op::LessEqual, Kind::Bool, {constant(1), at}), part(1), part(0)});
            return emit(Op::Select, Kind::Float, {emit(Op::LessEqual, Kind::Bool, {constant(2), at}), part(2), low});
        }
        error(e.place, "co-shader '" + c.handle + "' (" + c.shader->name + ") " +
                           (s ? "has '" + member.text + "' as " + toString(s->type) + ", which has no element of type " + toString(e.type)
                              : "has no public member '" + member.text + "'"));
        return zero(kind);
    }, [&](Inst* handle) { return isConst(at) ? lightMember(handle, leaves_.string(member.text + "[" + std::to_string(static_cast<int>(at->numbers[0])) + "]"), kind, nullptr) : zero(kind); });
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
        if ((s->type.array != 0) != (to->type.array != 0) || kindOf(s->type.element()) != kindOf(to->type.element())) return constant(0);
        const bool varying = s->origin == Symbol::Origin::ShaderParameter && s->storage == Storage::Varying;
        if (varying && to->symbol && to->symbol->storage == Storage::Uniform) { // a varying parameter does not become a uniform variable, as in messages
            warn(e.place, "getvar(): parameter '" + name->text + "' of '" + instances_[i].binding->shader->name +
                              "' is varying and the variable is uniform: nothing is assigned, and the result is 0");
            return constant(0);
        }
        if (s->type.array) return constant(takeArray(*to, memberValue(i, *s)) ? 1.0f : 0.0f);
        assign(*to, memberValue(i, *s));
        return constant(1);
    };
    return forHandle(*e.args[0], Kind::Float, [&](size_t i) -> Inst* {
        if (name->op == Op::ConstString) return take(i, memberOf(i, name->text));
        Inst* found = constant(0); // a name that is made when the shader runs is compared with all
        for (const Symbol* s : membersOf(i)) {
            if (to && ((s->type.array != 0) != (to->type.array != 0) || kindOf(s->type.element()) != kindOf(to->type.element()))) continue;
            found = branch(
                emit(Op::Equal, Kind::Bool, {name, leaves_.string(s->name)}), [&] { return std::vector<Inst*>{take(i, s)}; },
                [&] { return std::vector<Inst*>{found}; })[0];
        }
        return found;
    }, [&](Inst* light) -> Inst* { return lightMember(light, name, to ? kindOf(to->type.element()) : Kind::Float, to); });
}

Inst* Builder::getShader(const Expr& e) {
    Inst* h = expr(*e.args[0], Kind::String);
    if (h->op == Op::ConstString) {
        for (const Instance& i : instances_)
            if (i.binding->handle == h->text) return h;
        return leaves_.string("");
    }
    Inst* found = leaves_.string("");
    for (const Instance& i : instances_) {
        Inst* name = leaves_.string(i.binding->handle);
        found = emit(Op::Select, Kind::String, {emit(Op::Equal, Kind::Bool, {h, name}), name, found});
    }
    return found;
}

/// The handles that getshaders() gives, in the order of their names. `when`: where the category is known only when the shader runs,
/// whether each is among them; else empty.
std::vector<Inst*> Builder::handlesOf(const Expr& e, std::vector<Inst*>* when) {
    std::string wanted;
    Inst* asked = nullptr;
    for (const NamedArg& p : e.pairs) {
        if (p.name != "category") continue;
        Inst* v = expr(*p.value);
        if (v->op == Op::ConstString) wanted = v->text;
        else asked = v;
    }
    std::vector<Inst*> all;
    for (const Instance& i : instances_) {
        if (i.binding == &selfBinding_) continue;
        const auto& strings = i.binding->strings;
        const auto own = strings.find("__category");
        const std::string category = own == strings.end() ? std::string() : own->second;
        if (!inCategory(wanted, category)) continue;
        all.push_back(leaves_.string(i.binding->handle));
        if (!asked || !when) continue;
        Site s;
        s.op = "incategory";
        s.strings = {"", category};
        s.resultKinds = {Kind::Float};
        s.resultNames = {""};
        s.resultType = {Base::Float, 0};
        place_ = e.place;
        std::vector<Inst*> args;
        addArgument(s, args, asked, {Base::String, 0});
        when->push_back(emit(Op::NotEqual, Kind::Bool, {call(Op::Service, std::move(s), std::move(args))[0], constant(0)}));
    }
    return all;
}

/// Stores in the array the handles that getshaders() gives, and returns how many that are.
Inst* Builder::storeHandles(Inst* to, const Expr& e) {
    std::vector<Inst*> when;
    const std::vector<Inst*> all = handlesOf(e, &when);
    const size_t room = static_cast<size_t>(lengths(to) ? to->index : arrayLength(to));
    if (when.empty()) {
        for (size_t n = 0; n < std::min(all.size(), room); ++n) emit(Op::ArrayStore, Kind::None, {to, constant(static_cast<float>(n)), all[n]});
        return constant(static_cast<float>(std::min(all.size(), room)));
    }
    Inst* next = constant(0);
    for (size_t n = 0; n < std::min(all.size(), room); ++n)
        next = branch(
            when[n],
            [&] {
                emit(Op::ArrayStore, Kind::None, {to, next, all[n]});
                return std::vector<Inst*>{emit(Op::Add, Kind::Float, {next, constant(1)})};
            },
            [&] { return std::vector<Inst*>{next}; })[0];
    return next;
}

/// What the methods that a call can mean assign.
void Builder::scanMethod(const Expr& e, std::set<int>& out) {
    const bool outermost = scannedMethods_.empty();
    for (size_t i = 0; i < instances_.size(); ++i) {
        const Function* f = methodOf(i, e);
        if (!f || !f->body || !scannedMethods_.insert({i, f}).second) continue;
        std::set<const Function*> seen{f};
        enterInstance(i);
        scanAssigned(*f->body, out, seen);
        leaveInstance();
    }
    if (outermost) scannedMethods_.clear();
}

} // namespace alpenglow::rsl::ir
