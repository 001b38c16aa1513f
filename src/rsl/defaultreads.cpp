#include "rsl/defaultreads.h"
#include "shadeops/descriptor.h"

namespace alpenglow::rsl {

namespace {

class Reader {
public:
    DefaultReads found;

    void read(const Expr* e) {
        if (!e) return;
        if (e->symbol && e->symbol->origin == Symbol::Origin::Global) found.sample = true;
        if (e->symbol && e->symbol->origin == Symbol::Origin::ShaderParameter) found.parameters.insert(e->symbol->name);
        if (e->shadeop) found.sample |= ofSample(*e->shadeop);
        const auto object = [](const Expr& x) { return x.kind == ExprKind::String && x.text == "object"; };
        found.object |= e->space && object(*e->space);
        if (e->shadeop && e->shadeop->name.ends_with("transform"))
            for (const ExprPtr& a : e->args) found.object |= object(*a);
        for (const ExprPtr& a : e->args) read(a.get());
        for (const NamedArg& p : e->pairs) read(p.value.get());
        read(e->space.get());
        read(e->channel.get());
        if (e->function && seen_.insert(e->function).second) read(e->function->body.get());
    }

private:
    /// Calls that look at the point without being given it.
    static bool ofSample(const Shadeop& s) {
        return !s.pure || s.lowering == Lowering::Request || s.section == "Texture" || s.name == "area" || s.name == "depth";
    }

    void read(const Stmt* s) {
        if (!s) return;
        for (const StmtPtr& b : s->body) read(b.get());
        read(s->elseBody.get());
        for (const ExprPtr* e : {&s->condition, &s->init, &s->step, &s->value}) read(e->get());
        for (const auto& d : s->declarators) read(d.init.get());
        for (const ExprPtr& e : s->exprs) read(e.get());
        for (const NamedArg& p : s->pairs) read(p.value.get());
    }

    std::set<const Function*> seen_;
};

} // namespace

DefaultReads readsOfDefault(const Expr* e) {
    Reader r;
    r.read(e);
    return std::move(r.found);
}

} // namespace alpenglow::rsl
