#include "rsl/front/writes.h"
#include <algorithm>

namespace alpenglow::rsl::front {

Writes writesArgument(const Expr& call, size_t i) {
    const auto known = [](bool output) { return output ? Writes::Yes : Writes::No; };
    if (call.kind == ExprKind::Method) return i > 0 ? Writes::Perhaps : Writes::No;
    if (call.signature) { // also where the shadeop is a function in RSL: what is behind its parameters are tokens
        const auto& p = call.signature->parameters;
        if (p.empty() || (i >= p.size() && !call.signature->repeats)) return Writes::No;
        return known(p[std::min(i, p.size() - 1)].output);
    }
    if (!call.function || i >= call.function->parameters.size()) return Writes::No;
    const Symbol* p = call.function->parameters[i];
    return known(p && p->output);
}

bool writesAny(const Shadeop& op) {
    return std::ranges::any_of(op.signatures,
                               [](const Signature& s) { return std::ranges::any_of(s.parameters, &Parameter::output); });
}

const Symbol* rootOf(const Expr& place) {
    const Expr* e = &place;
    while ((e->kind == ExprKind::Index || e->kind == ExprKind::Cast) && !e->args.empty() && e->args[0]) e = e->args[0].get();
    return e->kind == ExprKind::Variable ? e->symbol : nullptr;
}

} // namespace alpenglow::rsl::front
