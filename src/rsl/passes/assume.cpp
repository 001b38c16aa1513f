#include "rsl/passes/assume.h"
#include "rsl/ir/edit.h"
#include <unordered_map>

namespace alpenglow::rsl::passes {
namespace {

struct Assumer {
    Leaves leaves;
    std::unordered_map<const Inst*, bool> known;
    int changes = 0;

    explicit Assumer(Kernel& k) : leaves(k) {}

    void use(Inst*& a) {
        const auto it = known.find(a);
        if (it == known.end()) return;
        a = leaves.constant(Kind::Bool, it->second ? 1.0f : 0.0f);
        ++changes;
    }

    /// Notes that a condition holds (or does not), and what follows for its parts. `added` takes what has to be forgotten again.
    void learn(const Inst* c, bool holds, std::vector<const Inst*>& added) {
        if (c->op == Op::Const) return;
        if (known.emplace(c, holds).second) added.push_back(c);
        if (c->op == Op::Not) learn(c->args[0], !holds, added);
        if ((c->op == Op::And && holds) || (c->op == Op::Or && !holds))
            for (const Inst* a : c->args) learn(a, holds, added);
    }
    void forget(std::vector<const Inst*>& added) {
        for (const Inst* c : added) known.erase(c);
        added.clear();
    }

    void region(Region& r) {
        for (Inst* i : r.body) {
            for (Inst*& a : i->args) use(a);
            std::vector<const Inst*> added;
            if (i->op == Op::If) {
                for (size_t n = 0; n < i->regions.size(); ++n) {
                    learn(i->args[0], n == 0, added);
                    region(i->regions[n]);
                    forget(added);
                }
            } else if (i->op == Op::Loop) {
                Region &test = i->regions[0], &body = i->regions[1];
                region(test);
                std::vector<const Inst*> carried;
                learn(test.yields[0], true, carried);
                for (size_t n = 0; n < test.params.size() && n < body.params.size(); ++n)
                    if (const auto it = known.find(test.params[n]); it != known.end()) {
                        known.emplace(body.params[n], it->second);
                        added.push_back(body.params[n]);
                    }
                forget(carried);
                region(body);
                forget(added);
            } else {
                for (Region& sub : i->regions) region(sub);
            }
        }
        for (Inst*& y : r.yields) use(y);
    }
};

} // namespace

int assumeConditions(Kernel& k) {
    Assumer a(k);
    a.region(k.body);
    return a.changes;
}

} // namespace alpenglow::rsl::passes
