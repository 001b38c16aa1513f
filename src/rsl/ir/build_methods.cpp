// Methods of other shaders: which one a call means, and its body in line.
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

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

/// A call of a method of one co-shader while it is built.
struct Builder::MethodCall {
    Builder& b;
    const Expr& e;
    const size_t instance;
    const CoShader& c;
    const Function* f = nullptr;      ///< the method
    std::vector<const Expr*> given{}; ///< by parameter; null where the default counts
    std::vector<Inst*> values{};      ///< by parameter; null until they are known
    std::deque<Held> held{};          ///< places that outputs are written to
    Frame frame{};

    bool allowed();
    bool fits(size_t parameter, const Expr& argument) const;
    bool argument(size_t parameter);
    bool arguments();
    void bindParameters();
    void run();
    Inst* result(Kind);
};

/// Whether the method can be called; what keeps it from that is reported. Where which shader is meant shows only when the shader
/// runs, the message waits until then: perhaps the call is never reached.
bool Builder::MethodCall::allowed() {
    const bool publicly = f && c.shader->publics.count(e.text);
    const std::string handle = shownHandle(c.handle);
    if (!publicly) {
        if (b.certain_) b.report(e.place, msg::kNoPublicMethod(handle, c.shader->name, e.text, e.args.size() - 1));
        else if (!b.isSelf(instance)) // else another shader of the handle has it
            b.complain(e.place, msg::kNoPublicMethodHere(handle, c.shader->name, e.text, e.args.size() - 1));
        return false;
    }
    if (!b.openMethods_.count({instance, f})) return true;
    if (b.certain_) b.report(e.place, msg::kCoShaderRecursion(e.text, handle, b.wayTo(instance, *f)));
    else b.complain(e.place, msg::kInnerCall(e.text, handle, b.wayTo(instance, *f)));
    return false;
}

bool Builder::MethodCall::fits(size_t n, const Expr& argument) const {
    const Symbol& p = *f->parameters[n];
    const Type type = argument.type;
    const bool variable = argument.kind == ExprKind::Variable || argument.kind == ExprKind::Index;
    const bool fits = (type.array != 0) == (p.type.array != 0) &&
                      (kindOf(type.element()) == kindOf(p.type.element()) ||
                       (type == Type{Base::Float, 0} && !p.output && kindOf(p.type) != Kind::String));
    return fits && (!p.output || variable);
}

bool Builder::MethodCall::argument(size_t n) {
    if (!given[n]) {
        values.push_back(nullptr);
        return true;
    }
    const Expr& a = *given[n];
    const Symbol& p = *f->parameters[n];
    if (!fits(n, a)) {
        const std::string type = (p.output ? "a variable of type " : "") + toString(p.type);
        b.report(a.place, msg::kMethodArgument(n + 1, e.text, shownHandle(c.handle), type, toString(a.type)));
        return false;
    }
    if (p.output) held.emplace_back(b, a);
    if (!p.type.array) {
        values.push_back(p.output ? nullptr : b.coerce(b.expr(a), p.type));
        return true;
    }
    Inst* array = b.array(a);
    if (!p.output) { // by value
        Inst* copy = b.newArray(p.type.base, b.arrayLength(array));
        b.copyArray(copy, a);
        array = copy;
    }
    values.push_back(array);
    return true;
}

bool Builder::MethodCall::arguments() {
    argumentsOf(*f, e, given);
    for (size_t n = 0; n < f->parameters.size() && !b.failed_; ++n)
        if (!argument(n)) return false;
    for (size_t n = 0; n < values.size() && !b.failed_; ++n) // outputs are what they are when all arguments are known
        if (given[n] && !values[n]) values[n] = b.coerce(b.expr(*given[n]), f->parameters[n]->type);
    return !b.failed_;
}

void Builder::MethodCall::bindParameters() {
    for (size_t n = 0; n < values.size(); ++n) {
        const Symbol& p = *f->parameters[n];
        if (!values[n] && p.type.array) {
            values[n] = b.newResizable(p.type.base, 0);
            b.copyResizable(values[n], *f->defaults[n]);
        } else if (!values[n]) {
            values[n] = b.coerce(b.expr(*f->defaults[n], kindOf(p.type)), p.type);
        }
        b.set(b.slot(&p), values[n]);
    }
}

/// The body, then what it leaves in outputs.
void Builder::MethodCall::run() {
    b.openMethods_.insert({instance, f});
    b.way_.push_back({instance, f});
    b.enterInstance(instance);
    ++b.handleDepth_;
    bindParameters();
    frame.function = f;
    frame.type = f->result;
    frame.returned = b.newSlot(b.boolean(false));
    if (f->result.base != Base::Void) frame.result = b.newSlot(b.zero(kindOf(f->result)));
    b.frames_.push_back(frame);
    if (f->body) b.statement(*f->body);
    b.frames_.pop_back();
    std::vector<Inst*> outputs;
    for (const Symbol* p : f->parameters) outputs.push_back(b.get(b.slot(p)));
    --b.handleDepth_;
    b.leaveInstance();
    b.openMethods_.erase({instance, f});
    b.way_.pop_back();
    b.place_ = e.place;
    for (size_t n = 0; n < outputs.size(); ++n)
        if (f->parameters[n]->output && !f->parameters[n]->type.array && given[n]) b.assign(*given[n], outputs[n]);
}

Inst* Builder::MethodCall::result(Kind kind) {
    Inst* v = frame.result >= 0 ? b.get(frame.result) : b.zero(kind);
    if (v->kind == kind || (v->kind == Kind::Float && kind != Kind::String)) return v;
    b.report(e.place, msg::kMethodType(e.text, shownHandle(c.handle), toString(f->result), toString(e.type)));
    return b.zero(kind);
}

Inst* Builder::methodCall(const Expr& e) {
    const Type type = e.type.base == Base::Void ? typeOfMember(e) : e.type;
    const Kind kind = kindOf(type) == Kind::None ? Kind::Float : kindOf(type);
    const auto ofCoShader = [&](size_t i) -> Inst* {
        const CoShader& c = *instances_[i].binding;
        if (c.light && e.text == "light" &&
            (e.args.size() == 3 || (e.args.size() == 4 && e.args[3]->type == Type{Base::Color, 0})))
            return lightMethod(e, leaves_.string(c.handle)); // with its samples and shadows
        MethodCall call{*this, e, i, c, methodOf(i, e)};
        if (!call.allowed() || !call.arguments()) return zero(kind);
        call.run();
        return call.result(kind);
    };
    return forHandle(*e.args[0], kind, ofCoShader, [&](Inst* handle) { return lightMethod(e, handle); });
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
