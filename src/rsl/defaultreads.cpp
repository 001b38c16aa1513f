#include "rsl/defaultreads.h"
#include "rsl/front/visit.h"
#include "shadeops/descriptor.h"
#include <functional>

namespace alpenglow::rsl {

namespace {
/// Calls that read the point without having it as an argument.
bool ofSample(const Shadeop& s) {
    return !s.pure || s.lowering == Lowering::Request || s.section == "Texture" || s.name == "area" || s.name == "depth";
}
/// Names the space of which every primitive has its own, or may: it is computed.
bool isObject(const Expr& e) { return e.type.base == Base::String && (e.kind != ExprKind::String || e.text == "object"); }
} // namespace

DefaultReads readsOfDefault(const Expr* e) {
    DefaultReads found;
    std::set<const Function*> seen;
    const std::function<void(const Expr&)> look = [&](const Expr& x) {
        if (x.symbol && x.symbol->origin == Symbol::Origin::Global) found.sample = true;
        if (x.symbol && x.symbol->origin == Symbol::Origin::ShaderParameter) found.parameters.insert(x.symbol->name);
        if (x.shadeop) found.sample |= ofSample(*x.shadeop);
        found.object |= x.space && isObject(*x.space);
        if (x.shadeop && x.shadeop->name.ends_with("transform"))
            for (const ExprPtr& a : x.args) found.object |= a && isObject(*a);
        if (x.function && x.function->body && seen.insert(x.function).second) front::everyExpr(*x.function->body, look);
    };
    if (e) front::everyExpr(*e, look);
    return found;
}

} // namespace alpenglow::rsl
