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
    const auto look = [&](const Expr& e) {
        found |= e.kind == ExprKind::String && e.handle && (e.text == "(this)" || e.text == "(surface)" || e.text == "(caller)");
    };
    const auto body = [&](const Stmt& b) { front::everyExpr(b, look); };
    front::everyBody(s, body);
    for (const auto& f : p.functions) front::everyFunctionBody(*f, body);
    return found;
}

} // namespace

/// An error that is reported at run time, by the points that reach it.
void Builder::complain(const Place& place, const Raised& message) {
    place_ = place;
    call(Op::Service, complaint(message), {});
}

/// What `this` is called: a co-shader by its handle, others by what they are, as format "%h" prints it.
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
        if (n == 0) return leaves_.string(surface); // lights are queried by surfaces
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

/// Binds the parameters of a co-shader and runs its members, construct() and begin(), before any method.
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
        } else if (isStringLike(s.type.base) && !s.type.array) {
            v = leaves_.string(c.strings.count(s.name) ? c.strings.at(s.name) : "");
        } else if (isStringLike(s.type.base)) {
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

/// Runs the beginning of all co-shaders but patterns, which run when a parameter reads their outputs.
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

/// Runs `code` for the co-shader of the handle and returns its value; zero for the null handle.
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
                anyHandle_ = false;
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
            anyHandle_ = !some;
            return std::vector<Inst*>{coerce(code(i), kind)};
        };
        return branch(same, call, [&] { return from(n + 1); });
    };
    return from(0)[0];
}

} // namespace alpenglow::rsl::ir
