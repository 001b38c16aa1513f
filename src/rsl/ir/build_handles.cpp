// Co-shaders: calls of their methods are inlined. A handle is the name under which the scene bound the shader; where it is not
// known here, one branch a bound shader decides. Members of a co-shader are variables that begin where the shader begins.
#include "base/category.h"
#include "base/limits.h"
#include "rsl/front/protocol.h"
#include "rsl/front/visit.h"
#include "rsl/ir/builder.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

namespace {

/// Is `this`, `surface` or `caller` used as a value, and not only to name what belongs to it?
bool handsItselfOver(const Shader& s, const Program& p) {
    bool found = false;
    const auto body = [&](const Stmt* b) {
        if (b)
            front::everyStmt(
                *b, [](const Stmt&) {},
                [&](const Expr& e) {
                    found |= e.kind == ExprKind::String && e.handle &&
                             (e.text == "(this)" || e.text == "(surface)" || e.text == "(caller)");
                });
    };
    body(s.body.get());
    for (const auto& n : s.nested) front::everyFunction(*n, [&](const Function& f) { body(f.body.get()); });
    for (const auto& n : p.functions) front::everyFunction(*n, [&](const Function& f) { body(f.body.get()); });
    return found;
}

} // namespace

/// An error that shows when the shader runs, where it comes to this.
void Builder::complain(const Place& place, const Raised& message) {
    place_ = place;
    call(Op::Service, complaint(message), {});
}

/// What `this` is called: a co-shader by its handle, others by what they are (seed, format "%h").
std::string Builder::thisHandle() const {
    if (!current_.empty() && !isSelf(current_.back())) return instances_[current_.back()].binding->handle;
    return "<" + std::string(toString(shader_.kind)) + ">";
}

/// `this`, and the handles that have names of their own: `surface`, the shader of the surface that is shaded or lit; `caller`,
/// the shader that called the method; `light`, the light of the turn of illuminance.
Inst* Builder::handleText(const Expr& e) {
    const std::string self = "<" + std::string(toString(shader_.kind)) + ">",
                      surface = "<" + std::string(toString(ShaderKind::Surface)) + ">";
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
    report(e.place, msg::kNullCaller(e.text.substr(1, e.text.size() - 2)));
    return leaves_.string("");
}

/// Asks the renderer for one value. `to`: the variable that takes it, and what comes back is whether there is one; else the value
/// does.
Inst* Builder::answered(Site s, std::vector<Inst*> args, Kind kind, const Expr* to) {
    s.resultKinds = {Kind::Float};
    s.resultNames = {""};
    s.resultType = {Base::Float, 0};
    Receiver r;
    if (to) r = receiver(s, *to, "value");
    else s.resultKinds.push_back(kind), s.resultNames.push_back("value");
    const std::vector<Inst*> v = call(Op::Service, std::move(s), std::move(args));
    if (!to) return v[1];
    receive(r, std::span(v).subspan(1), emit(Op::NotEqual, Kind::Bool, {v[0], constant(0)}));
    return v[0];
}

/// A parameter of the surface that a light, a displacement or an atmosphere asks for by the handle `surface`; null where the
/// handle is another. `to`: the variable that getvar() fills, which then gives whether there is one; else the value is given.
Inst* Builder::ofSurface(const Expr& handle, const std::string& name, Kind kind, const Expr* to) {
    if (shader_.kind == ShaderKind::Surface || shader_.kind == ShaderKind::Imager) return nullptr;
    Inst* h = expr(handle, Kind::String);
    if (h->op != Op::ConstString || h->text != "<surface>") return nullptr;
    Site s;
    s.op = "surface";
    s.shadeop = findShadeop("surface");
    s.strings = {name};
    return answered(std::move(s), {}, kind, to);
}

void Builder::switchInstance(bool fromSelf, size_t from, bool toSelf, size_t to) {
    if (fromSelf == toSelf && (fromSelf || from == to)) return;
    std::swap(slots_, fromSelf ? ownSlots_ : instances_[from].slots);
    std::swap(slots_, toSelf ? ownSlots_ : instances_[to].slots);
    files_ = toSelf ? &program_.files : instances_[to].files;
    fileBase_ = toSelf ? 0 : instances_[to].fileBase;
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

/// Binds the parameters of a co-shader and runs what comes before the methods: members, construct() and begin().
void Builder::beginInstance(size_t i) {
    const CoShader& c = *instances_[i].binding;
    enterInstance(i);
    ++handleDepth_;
    for (const ShaderParameter& p : c.shader->parameters) {
        const Symbol& s = *p.symbol;
        const auto& numbers = c.numbers.count(s.name) ? c.numbers.at(s.name) : std::vector<float>{};
        Inst* v = connectedParameter(s, c);
        if (v) {
            // it takes an output of another
        } else if (std::find(c.computed.begin(), c.computed.end(), s.name) != c.computed.end()) {
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
            connectElements(s, v, c);
            if (s.type.array < 0 || s.open)
                given_[v] =
                    parameterLength(p, std::vector<std::pair<std::string, std::string>>(c.strings.begin(), c.strings.end()));
        } else {
            std::vector<float> all = numbers;
            all.resize(static_cast<size_t>(components(kindOf(s.type))));
            v = leaves_.constant(kindOf(s.type), all);
        }
        set(slot(&s), v);
    }
    if (c.shader->object && c.shader->body)
        for (const StmtPtr& s : c.shader->body->body) {
            const bool starts = s->kind == StmtKind::Expression && (s->value->text == "construct" || s->value->text == "begin");
            if ((s->kind == StmtKind::Declare && !s->definition) || starts) statement(*s);
        }
    --handleDepth_;
    leaveInstance();
}

/// Begins all co-shaders but patterns, which begin when a parameter wants their outputs.
void Builder::beginCoShaders() {
    if (options_.coShaders.empty() && !program_.handles) return;
    for (const CoShader& c : options_.coShaders) {
        instances_.push_back({&c, &c.program->files, int(k_.files.size()), {}});
        k_.files.insert(k_.files.end(), c.program->files.begin(), c.program->files.end());
    }
    const std::set<std::string> patterns = connectedHandles();
    for (size_t i = 0; i < instances_.size(); ++i)
        if (!patterns.count(instances_[i].binding->handle)) beginInstance(i);
    bool handed = handsItselfOver(shader_, program_);
    for (const CoShader& c : options_.coShaders) handed |= handsItselfOver(*c.shader, *c.program);
    if (!handed) return;
    // Others may be handed `this`: then the shader itself is one of those that a handle can mean, the last.
    selfBinding_.handle = thisHandle();
    selfBinding_.program = &program_;
    selfBinding_.shader = &shader_;
    instances_.push_back({&selfBinding_, &program_.files, 0, {}});
}

/// Runs `code` for the co-shader of the handle and gives its value; zero of null.
Inst* Builder::forHandle(const Expr& handle, Kind kind, const std::function<Inst*(size_t)>& code,
                         const std::function<Inst*(Inst*)>& light) {
    Inst* h = expr(handle, Kind::String);
    place_ = handle.place;
    if (failed_) return zero(kind);
    if (handleDepth_ > limits::kCoShaderDepth) {
        report(handle.place, msg::kCoShaderDepth(limits::kCoShaderDepth));
        return zero(kind);
    }
    if (h->op == Op::ConstString) {
        for (size_t i = 0; i < instances_.size(); ++i)
            if (instances_[i].binding->handle == h->text) {
                certain_ = true;
                return coerce(code(i), kind);
            }
        report(handle.place, msg::kNullHandle);
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

/// What a call gives for each parameter, null where it leaves the default: so many in order, at least those without a default,
/// and then names and values, as h->light(L, Cl, "samples", 16). Whether the call fits.
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
    return forHandle(
        *e.args[0], kind,
        [&](size_t i) -> Inst* {
            const CoShader& c = *instances_[i].binding;
            if (c.light && e.text == "light" &&
                (e.args.size() == 3 || (e.args.size() == 4 && e.args[3]->type == Type{Base::Color, 0})))
                return lightMethod(e, leaves_.string(c.handle)); // with its samples and shadows
            const Function* f = methodOf(i, e);
            const bool publicly = f && c.shader->publics.count(e.text);
            if (!certain_ && isSelf(i) && !publicly) return zero(kind); // another shader of the handle has it
            if (!certain_ && !publicly) { // who is meant shows when the shader runs, and whether the call is reached at all
                complain(e.place, msg::kNoPublicMethodHere(shownHandle(c.handle), c.shader->name, e.text, e.args.size() - 1));
                return zero(kind);
            }
            if (!publicly) {
                report(e.place, msg::kNoPublicMethod(shownHandle(c.handle), c.shader->name, e.text, e.args.size() - 1));
                return zero(kind);
            }
            if (openMethods_.count({i, f}) &&
                !certain_) { // it may be another each time: whether it is a circle shows when the shader runs
                complain(e.place, msg::kInnerCall(e.text, shownHandle(c.handle), wayTo(i, *f)));
                return zero(kind);
            }
            if (openMethods_.count({i, f})) {
                report(e.place, msg::kCoShaderRecursion(e.text, shownHandle(c.handle), wayTo(i, *f)));
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
                    const std::string type = (p.output ? "a variable of type " : "") + toString(p.type);
                    report(given.place, msg::kMethodArgument(n + 1, e.text, shownHandle(c.handle), type, toString(given.type)));
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
            way_.push_back({i, f});
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
            way_.pop_back();
            place_ = e.place;
            for (size_t n = 0; n < outputs.size(); ++n)
                if (f->parameters[n]->output && !f->parameters[n]->type.array && arguments[n]) assign(*arguments[n], outputs[n]);
            Inst* result = frame.result >= 0 ? get(frame.result) : zero(kind);
            if (result->kind != kind && !(result->kind == Kind::Float && kind != Kind::String)) {
                report(e.place, msg::kMethodType(e.text, shownHandle(c.handle), toString(f->result), toString(e.type)));
                return zero(kind);
            }
            return result;
        },
        [&](Inst* handle) { return lightMethod(e, handle); });
}

/// The method of a shader with handles that the function is when it is called by its bare name; none where it is no method, or
/// open already.
std::optional<std::pair<size_t, const Function*>> Builder::methodByName(const Function& f) const {
    size_t i = instances_.size();
    if (!current_.empty()) i = current_.back();
    else
        for (size_t n = 0; n < instances_.size(); ++n)
            if (isSelf(n)) i = n;
    if (i == instances_.size()) return std::nullopt;
    const auto& methods = instances_[i].binding->shader->nested;
    const bool method = std::any_of(methods.begin(), methods.end(), [&](const auto& m) { return m.get() == &f; });
    if (!method || openMethods_.count({i, &f})) return std::nullopt;
    return std::pair{i, &f};
}

/// The calls from an open method to the one that would open it again: "surface() > coat->go() > surface()".
std::string Builder::wayTo(size_t i, const Function& f) const {
    const std::pair<size_t, const Function*> again{i, &f};
    std::string text;
    const auto add = [&](const auto& m) {
        text += (text.empty() ? "" : " > ") + (isSelf(m.first) ? "" : instances_[m.first].binding->handle + "->") +
                m.second->name + "()";
    };
    for (auto m = std::find(way_.begin(), way_.end(), again); m != way_.end(); ++m) add(*m);
    add(again);
    return text;
}

/// Whether a method that the call can mean has this argument (1 is the first) as an output.
bool Builder::mayFill(const Expr& call, size_t argument) const {
    if (call.text == "light" && argument <= 3) return true; // L, Cl and Ol, of lights that the renderer answers for
    for (const Instance& i : instances_)
        for (const auto& f : i.binding->shader->nested) {
            std::vector<const Expr*> given;
            if (f->name != call.text || !argumentsOf(*f, call, given)) continue;
            for (size_t n = 0; n < given.size(); ++n)
                if (given[n] == call.args[argument].get() && f->parameters[n]->output) return true;
        }
    return false;
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
