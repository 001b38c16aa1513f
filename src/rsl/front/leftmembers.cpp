#include "rsl/front/leftmembers.h"
#include "rsl/front/visit.h"
#include "rsl/front/writes.h"
#include <functional>
#include <set>

namespace alpenglow::rsl {

namespace {

using Symbols = std::set<const Symbol*>;

/// The effects of those calls in a shader's body that `wanted` names, callees included.
struct Deeds {
    Symbols used, written;
    bool looks = false; ///< at the place of the sample, which a displacement moves
};

Deeds deedsOf(const Shader& s, const std::function<bool(const std::string&)>& wanted) {
    static const std::set<std::string> kMoved = {"P", "N", "Ng", "I", "dPdu", "dPdv", "dNdu", "dNdv"};
    Deeds d;
    std::set<const Function*> seen;
    const auto write = [&](const Expr& e) {
        if (const Symbol* root = front::rootOf(e)) d.written.insert(root);
    };
    std::function<void(const Function&)> enter;
    const auto expression = [&](const Expr& e) {
        if (e.symbol) {
            d.used.insert(e.symbol);
            d.looks |= e.symbol->origin == Symbol::Origin::Global && kMoved.count(e.symbol->name) > 0;
        }
        front::eachWritten(e, write);
        if (e.function) enter(*e.function);
    };
    const auto statement = [&](const Stmt& x) { front::eachWritten(x, write); };
    enter = [&](const Function& f) {
        if (f.body && seen.insert(&f).second) front::everyStmt(*f.body, statement, expression);
    };
    for (const StmtPtr& x : s.body->body)
        if (x && x->kind == StmtKind::Expression && x->value && wanted(x->value->text))
            front::everyStmt(*x, statement, expression);
    return d;
}

bool begins(const std::string& method) { return method == "construct" || method == "begin"; }

} // namespace

const Symbol* ownMember(const Shader& s, const std::string& name) {
    for (const ShaderParameter& p : s.parameters)
        if (p.symbol->name == name) return p.symbol;
    if (s.object && s.body)
        for (const StmtPtr& x : s.body->body)
            for (const Stmt::Declarator& d : x->declarators)
                if (d.symbol->name == name) return d.symbol;
    return nullptr;
}

std::vector<std::string> membersLeft(const Shader& displacement, const Shader& surface) {
    std::vector<std::string> names;
    if (!displacement.object || !surface.object || !displacement.body || !surface.body) return names;
    Symbols written = deedsOf(displacement, [](const std::string& m) { return m == "displacement"; }).written;
    if (const Deeds first = deedsOf(displacement, begins); first.looks)
        written.insert(first.written.begin(), first.written.end());
    const Deeds reader = deedsOf(surface, [](const std::string& m) { return !begins(m); });
    const auto add = [&](const Symbol* s) {
        const Symbol* there = ownMember(surface, s->name);
        if (written.count(s) && there && (reader.used.count(there) || surface.publics.count(s->name))) names.push_back(s->name);
    };
    for (const ShaderParameter& p : displacement.parameters) add(p.symbol);
    for (const StmtPtr& x : displacement.body->body)
        for (const Stmt::Declarator& d : x->declarators) add(d.symbol);
    return names;
}

} // namespace alpenglow::rsl
