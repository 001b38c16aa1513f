// evalparam(): parameters by their names.
#include "rsl/ir/builder.h"

namespace alpenglow::rsl::ir {

/// evalparam(name, variable): 1 where the shader, or the co-shader whose method runs, has a parameter of that name that the
/// variable can take. A name that is made when the shader runs is compared with those of all that fit.
Inst* Builder::evalParameter(const Expr& e) {
    const Expr& to = *e.args[1];
    Inst* name = expr(*e.args[0], Kind::String);
    place_ = e.place;
    const Expr* root = &to;
    while (root->kind == ExprKind::Index && !root->args.empty()) root = root->args[0].get();
    const bool uniform = root->symbol && root->symbol->storage == Storage::Uniform;
    const bool own = current_.empty() || isSelf(current_.back());
    const Shader& shader = own ? shader_ : *instances_[current_.back()].binding->shader;
    const auto fits = [&](const Symbol& s) {
        return (s.type.array != 0) == (to.type.array != 0) && kindOf(s.type.element()) == kindOf(to.type.element()) &&
               !(uniform && s.storage == Storage::Varying);
    };
    const auto give = [&](const Symbol& s) {
        Inst* value = get(slot(&s));
        if (to.type.array) return takeArray(to, value);
        const Held held(*this, to);
        assign(to, value);
        return true;
    };
    Inst* found = constant(0);
    for (const ShaderParameter& p : shader.parameters) {
        const Symbol& s = *p.symbol;
        if (!fits(s)) continue;
        if (name->op == Op::ConstString) {
            if (s.name == name->text) return constant(give(s) ? 1.0f : 0.0f);
            continue;
        }
        found = branch(
            emit(Op::Equal, Kind::Bool, {name, leaves_.string(s.name)}),
            [&] { return std::vector<Inst*>{constant(give(s) ? 1.0f : 0.0f)}; }, [&] { return std::vector<Inst*>{found}; })[0];
    }
    return found;
}

} // namespace alpenglow::rsl::ir
