// outputchannel(), writeaov() and readaov(): outputs that no parameter declares. Each is a variable of the kernel, zero until a call gives it a value.
#include "rsl/ir/builder.h"

namespace alpenglow::rsl::ir {

namespace {

/// The name without "light:" or "local:"; `kept` tells of such a prefix.
std::string bareName(const std::string& name, bool& kept) {
    kept = name.rfind("light:", 0) == 0 || name.rfind("local:", 0) == 0;
    return kept ? name.substr(6) : name;
}

} // namespace

void Builder::beginChannels() {
    const auto add = [&](const Program& p) {
        for (const auto& [name, type] : p.channels)
            if (!channels_.count(name)) channels_[name] = {newSlot(zero(kindOf(type))), type};
    };
    add(program_);
    for (const CoShader& c : options_.coShaders) add(*c.program);
}

/// The slot that a call assigns: of a parameter of the main shader, or of a channel. -1: nothing is assigned.
int Builder::channelSlot(const std::string& text, Kind kind) {
    bool kept = false;
    const std::string name = bareName(text, kept);
    if (kept && (handleDepth_ > 0 || shader_.kind == ShaderKind::Light)) return -1; // it stays with the co-shader or the light
    for (const ShaderParameter& p : shader_.parameters) {
        if (p.symbol->name != name) continue;
        return p.symbol->output && kindOf(p.symbol->type) == kind && !p.symbol->type.array ? slot(p.symbol) : -1;
    }
    const auto c = channels_.find(name);
    return c != channels_.end() && kindOf(c->second.second) == kind && !hasGlobal(name.c_str()) ? c->second.first : -1;
}

Inst* Builder::outputChannel(const Expr& e) {
    Inst* name = expr(*e.args[0]);
    Inst* value = expr(*e.args[1]);
    if (value->kind == Kind::Bool) value = coerce(value, Kind::Float);
    place_ = e.place;
    if (name->op != Op::ConstString) {
        warn(e.place, "outputchannel() needs a name that is known when the shader is compiled; it does nothing");
        return constant(0);
    }
    const int n = channelSlot(name->text, value->kind);
    if (n >= 0) set(n, value);
    else if (bool kept = false; e.args[0]->kind != ExprKind::String && !channels_.count(bareName(name->text, kept)))
        warn(e.place, "outputchannel() needs a name that is known when the shader is compiled; it does nothing");
    return constant(0);
}

/// writeaov(name, value): an output of that name and type is given the value; where there is none nobody asks for it.
Inst* Builder::writeAov(const Expr& e) {
    Inst* name = expr(*e.args[0]);
    Inst* value = expr(*e.args[1]);
    if (value->kind == Kind::Bool) value = coerce(value, Kind::Float);
    place_ = e.place;
    if (name->op != Op::ConstString) {
        warn(e.place, "writeaov() needs a name that is known when the shader is compiled; it does nothing");
        return constant(0);
    }
    if (const int n = channelSlot(name->text, value->kind); n >= 0) set(n, value);
    return constant(0);
}

Inst* Builder::readAov(const Expr& e) {
    Inst* name = expr(*e.args[0]);
    place_ = e.place;
    if (name->op != Op::ConstString) {
        warn(e.place, "readaov() needs a name that is known when the shader is compiled; it finds nothing");
        return constant(0);
    }
    const int n = channelSlot(name->text, kindOf(e.args[1]->type));
    if (n < 0 || e.args[1]->type.array) return constant(0);
    assign(*e.args[1], get(n));
    return constant(1);
}

} // namespace alpenglow::rsl::ir
