// Which signatures of the shadeops a text calls, after the checker has chosen: what the tests of completeness count.
#pragma once
#include "rsl/front/ast.h"
#include "rsl/front/visit.h"
#include <map>
#include <set>
#include <string>
#include <utility>

namespace alpenglow::rsl {

struct Calls {
    std::set<const Signature*> signatures;
    std::set<std::pair<const Shadeop*, std::string>> pairs; ///< optional parameters that were given
};

/// The calls that the program writes itself; those in the RSL text of shadeops are not its own.
inline void collectCalls(const Program& p, Calls& calls) {
    std::set<const Function*> texts;
    const auto expression = [&](const Expr& e) {
        if (!e.shadeop) return;
        calls.signatures.insert(e.signature);
        for (const NamedArg& a : e.pairs) calls.pairs.emplace(e.shadeop, a.name);
        // Of those written in RSL they are arguments now; what was left out stands at the place of the call.
        const size_t count = e.signature->parameters.size();
        for (size_t i = count; e.function && i < e.args.size() && i - count < e.shadeop->optional.size(); ++i)
            if (e.args[i]->place.line != e.place.line || e.args[i]->place.column != e.place.column)
                calls.pairs.emplace(e.shadeop, e.shadeop->optional[i - count].name);
        if (e.function) texts.insert(e.function);
    };
    const auto statement = [&](const Stmt& s) { // written like a call, and described like one
        if (s.kind != StmtKind::Gather) return;
        const Shadeop* op = findShadeop("gather");
        calls.signatures.insert(&op->signatures[0]);
        for (const NamedArg& a : s.pairs) calls.pairs.emplace(op, a.name);
    };
    const auto nothing = [](const Stmt&) {};
    const auto all = [&](auto&& self, const Function& f) -> void {
        if (f.body) front::everyStmt(*f.body, statement, expression);
        for (const auto& n : f.nested)
            if (n) self(self, *n);
    };
    for (const auto& s : p.shaders) {
        for (const ShaderParameter& x : s->parameters)
            if (x.defaultValue) front::everyExpr(*x.defaultValue, expression);
        if (s->body) front::everyStmt(*s->body, statement, expression);
        for (const auto& n : s->nested)
            if (n) all(all, *n);
    }
    // Functions stand in no order: first those that are known to be the program's own, again until no text of a shadeop is new.
    std::set<const Function*> done;
    for (bool found = true; found;) {
        found = false;
        std::set<const Function*> called;
        const auto note = [&](const Expr& e) {
            if (e.function && !e.shadeop) called.insert(e.function);
        };
        for (const auto& s : p.shaders) {
            if (s->body) front::everyStmt(*s->body, nothing, note);
            for (const auto& n : s->nested)
                if (n)
                    front::everyFunction(*n, [&](const Function& f) {
                        if (f.body) front::everyStmt(*f.body, nothing, note);
                    });
        }
        for (const Function* f : done)
            front::everyFunction(*f, [&](const Function& g) {
                if (g.body) front::everyStmt(*g.body, nothing, note);
            });
        for (const Function* f : called)
            if (done.insert(f).second) {
                found = true;
                all(all, *f);
            }
    }
}

} // namespace alpenglow::rsl
