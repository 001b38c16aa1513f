// Networks of patterns: parameters that take outputs of co-shaders. The body of a pattern runs once, in line, before the first
// parameter that needs it; its derivatives and the affine form of the shader are those of code that is written out.
#include "rsl/front/connections.h"
#include "rsl/ir/builder.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

/// Handles that a connection of the shader or of a co-shader names.
std::set<std::string> Builder::connectedHandles() const {
    std::set<std::string> handles;
    for (const auto& [to, from] : options_.connections) handles.insert(from.handle);
    for (const CoShader& c : options_.coShaders)
        for (const auto& [to, from] : c.connections) handles.insert(from.handle);
    return handles;
}

/// Runs a pattern whose outputs are read. False if it is running already or cannot run.
bool Builder::runPattern(size_t i) {
    if (pattern_.size() < instances_.size()) pattern_.resize(instances_.size(), Pattern::Waits);
    if (pattern_[i] == Pattern::Runs) return false;
    if (pattern_[i] == Pattern::Done) return true;
    pattern_[i] = Pattern::Runs;
    const Place outside = place_;
    const CoShader& c = *instances_[i].binding;
    beginInstance(i);
    if (!c.shader->object && c.shader->body) {
        // What it writes to Ci and other globals is not used.
        std::map<std::string, Inst*> before;
        for (const auto& [name, n] : globals_) before[name] = value(n);
        enterInstance(i);
        ++handleDepth_;
        Frame frame;
        frame.returned = newSlot(boolean(false));
        frames_.push_back(frame);
        statement(*c.shader->body);
        frames_.pop_back();
        --handleDepth_;
        leaveInstance();
        for (const auto& [name, n] : std::map<std::string, int>(globals_)) {
            const auto was = before.find(name);
            Inst* old = was == before.end() ? nullptr : was->second;
            if (value(n) == old) continue;
            const Symbol* s = symbol(n);
            if (!old && s) old = initialGlobal(name, s->type);
            if (old) set(n, old);
        }
    }
    place_ = outside;
    pattern_[i] = Pattern::Done;
    return true;
}

/// An output converted to the variable's type: a number becomes a grey, a color its mean. Null if it does not convert.
Inst* Builder::connectedOutput(const Connected& c, const Symbol& to) {
    for (size_t i = 0; i < instances_.size(); ++i) {
        const CoShader& pattern = *instances_[i].binding;
        if (pattern.handle != c.handle) continue;
        if (!runPattern(i)) return nullptr;
        const Symbol* s = memberOf(i, c.output);
        const auto keeps = [&](const std::string& why) -> Inst* {
            if (!c.member) report(to.place, msg::kPatternConnection(pattern.shader->name, why, to.name));
            return nullptr;
        };
        if (!s) return keeps("has no output '" + c.output + "'");
        Inst* v = memberValue(i, *s);
        const Kind kind = kindOf(to.type.element());
        if (v->kind == kind) return v;
        if (v->kind == Kind::Float && kind == Kind::Triple) return coerce(v, kind);
        if (v->kind == Kind::Triple && kind == Kind::Float) {
            const auto part = [&](int n) { return emit(Op::Extract, Kind::Float, {v}, n); };
            Inst* sum = emit(Op::Add, Kind::Float, {emit(Op::Add, Kind::Float, {part(0), part(1)}), part(2)});
            return emit(Op::Mul, Kind::Float, {sum, constant(1.0f / 3)});
        }
        return keeps("gives '" + c.output + "' as " + toString(s->type) + ", not " + toString(to.type.element()));
    }
    return nullptr; // there is no such pattern, which was reported when it was bound
}

/// The value that a connection has for a parameter or an element of it; null if there is none. connections: of the instance.
Inst* Builder::connected(const Symbol& s, int element, const Connections& connections) {
    const auto c = connections.find({s.name, element});
    return c == connections.end() ? nullptr : connectedOutput(c->second, s);
}

Inst* Builder::connectedParameter(const Symbol& s) { return s.type.array ? nullptr : connected(s, -1, options_.connections); }

Inst* Builder::connectedParameter(const Symbol& s, const CoShader& of) {
    return s.type.array ? nullptr : connected(s, -1, of.connections);
}

/// Puts what is connected to elements of an array parameter of a co-shader there.
void Builder::connectElements(const Symbol& s, Inst* array, const CoShader& of) {
    for (int n = 0; n < arrayLength(array); ++n)
        if (of.connections.count({s.name, n}))
            if (Inst* v = connected(s, n, of.connections))
                emit(Op::ArrayStore, Kind::None, {array, constant(static_cast<float>(n)), v});
}

} // namespace alpenglow::rsl::ir
