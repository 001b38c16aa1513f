#include "rsl/passes/outline.h"
#include "base/limits.h"
#include "rsl/ir/edit.h"
#include "rsl/passes/affine_analysis.h"
#include "rsl/passes/derivatives.h"
#include <algorithm>
#include <map>
#include <unordered_set>

namespace alpenglow::rsl::passes {
namespace {

struct Inliner {
    Kernel& k;
    std::unordered_set<const Inst*> functions; ///< every call of these
    std::unordered_set<const Inst*> calls;     ///< these calls
    Replacements rep;
    int changes = 0;

    void region(Region& r) {
        std::vector<Inst*> body;
        body.reserve(r.body.size());
        std::unordered_map<const Inst*, std::vector<Inst*>> gone;
        for (Inst* i : r.body) {
            rep.apply(i);
            for (Region& sub : i->regions) region(sub);
            if (i->op == Op::Result) {
                const auto it = gone.find(i->args[0]);
                if (it != gone.end()) {
                    rep.set(i, it->second[static_cast<size_t>(i->index)]);
                    continue;
                }
            }
            if (i->op != Op::Call || (!functions.count(i->args[0]) && !calls.count(i))) {
                body.push_back(i);
                continue;
            }
            const Region& f = i->args[0]->regions[0];
            CopyMap map;
            for (size_t p = 0; p < f.params.size(); ++p) map[f.params[p]] = i->args[p + 1];
            copyBody(k, f, map, body);
            for (Inst* y : f.yields) gone[i].push_back(mapped(map, y));
            ++changes;
        }
        for (Inst*& y : r.yields) y = rep(y);
        r.body = std::move(body);
    }
};

std::vector<Inst*> functionsOf(const Kernel& k) {
    std::vector<Inst*> list;
    for (Inst* i : k.body.body)
        if (i->op == Op::Function) list.push_back(i);
    return list;
}

void removeUnused(Kernel& k) {
    for (bool again = true; again;) {
        again = false;
        std::unordered_set<const Inst*> called;
        forEach(k.body, [&](Inst* i) {
            if (i->op == Op::Call) called.insert(i->args[0]);
        });
        auto& body = k.body.body;
        const auto unused = [&](const Inst* i) { return i->op == Op::Function && !called.count(i); };
        const auto end = std::remove_if(body.begin(), body.end(), unused);
        again = end != body.end();
        body.erase(end, body.end());
    }
}

int run(Kernel& k, Inliner&& inliner) {
    inliner.region(k.body);
    removeUnused(k);
    return inliner.changes;
}

} // namespace

int inlineCalls(Kernel& k, int budget) {
    if (functionsOf(k).empty()) return 0;
    removeUnused(k);
    int changes = 0;
    // Callees precede callers: the sizes of callees are known.
    std::unordered_map<const Inst*, int> calls;
    forEach(k.body, [&](Inst* i) {
        if (i->op == Op::Call) ++calls[i->args[0]];
    });
    Inliner small{k, {}, {}, {}, 0};
    std::unordered_map<const Inst*, size_t> size;
    for (Inst* f : functionsOf(k)) {
        size_t& n = size[f];
        forEach(f->regions[0],
                [&](Inst* i) { n += i->op == Op::Call && small.functions.count(i->args[0]) ? size[i->args[0]] : 1; });
        if (budget > 0 && (n <= static_cast<size_t>(budget) || calls[f] == 1)) small.functions.insert(f);
    }
    if (!small.functions.empty()) changes += run(k, std::move(small));
    // What a ray's result goes through must be seen through. Inlining shows the calls inside, so again.
    for (;;) {
        if (functionsOf(k).empty() || instructionCount(k.body) > limits::kAffineInlining) return changes;
        const Dependence d = analyseDependence(k);
        Inliner traced{k, {}, {}, {}, 0};
        forEach(k.body, [&](Inst* i) {
            if (i->op == Op::Call && std::any_of(i->args.begin() + 1, i->args.end(), [&](Inst* a) { return bool(d.of(a)); }))
                traced.calls.insert(i);
        });
        if (traced.calls.empty()) return changes;
        changes += run(k, std::move(traced));
    }
}

namespace {

struct Specialiser {
    Kernel& k;
    std::map<std::pair<const Inst*, std::vector<uint8_t>>, Inst*> known;
    std::vector<Inst*> made;

    Inst* variant(Inst* f, const std::vector<uint8_t>& orders) {
        if (const auto it = known.find({f, orders}); it != known.end()) return it->second;
        CopyMap map;
        Inst* copy = copyInst(k, f, map);
        redirect(callOrders(k, copy, orders));
        made.push_back(copy);
        known[{f, orders}] = copy;
        return copy;
    }

    void redirect(const CallOrders& calls) {
        for (const auto& [call, orders] : calls) call->args[0] = variant(call->args[0], orders);
    }
};

} // namespace

void specialiseFunctions(Kernel& k) {
    if (functionsOf(k).empty()) return;
    Specialiser s{k, {}, {}};
    s.redirect(callOrders(k, nullptr, {}));
    auto& body = k.body.body;
    body.erase(std::remove_if(body.begin(), body.end(), [](const Inst* i) { return i->op == Op::Function; }), body.end());
    const auto behindLeaves = std::find_if(body.begin(), body.end(), [](const Inst* i) { return !isLeaf(i); });
    body.insert(behindLeaves, s.made.begin(), s.made.end());
}

} // namespace alpenglow::rsl::passes
