#include "rsl/passes/split_sums.h"
#include "rsl/ir/edit.h"
#include "rsl/passes/affine_analysis.h"
#include "rsl/passes/dce.h"

namespace alpenglow::rsl::passes {
namespace {

struct Splitter {
    Kernel& k;
    Dependence d;
    int changes = 0;

    /// Nothing in the turns can be seen but rays.
    bool quiet(const Region& r) const {
        bool good = true;
        forEach(r, [&](const Inst* i) {
            good = good && i->op != Op::ArrayStore && i->op != Op::Output &&
                   (i->op != Op::Service || k.sites[static_cast<size_t>(i->site)].pure);
        });
        return good;
    }

    /// Carried values that depend on rays, each with the rays of this loop that it depends on; empty when they cannot be parted.
    std::vector<size_t> parts(const Inst* i) const {
        const size_t fixed = i->op == Op::LightLoop ? 4 : 0;
        const Region& body = i->regions.back();
        SiteSet inside;
        bool alike = false; // two of the same site
        for (const Region& r : i->regions)
            forEach(r, [&](const Inst* x) {
                if (x->op != Op::Request) return;
                alike = alike || inside.has(d.ordinal(x));
                inside.add(d.ordinal(x));
            });
        if (alike) return {};
        std::vector<size_t> vars;
        SiteSet seen;
        for (size_t n = 0; n < body.yields.size(); ++n) {
            if (!d.of(body.params[fixed + n])) continue;
            const SiteSet mine = d.of(body.yields[n]) & inside;
            if (mine & seen) return {};
            seen.join(mine);
            vars.push_back(n);
        }
        return vars;
    }

    void region(Region& r) {
        std::vector<Inst*> body;
        for (Inst* i : r.body) {
            for (Region& sub : i->regions) region(sub);
            body.push_back(i);
            if (i->op == Op::Result && moved.count({i->args[0], i->index})) i->args[0] = moved[{i->args[0], i->index}];
            if ((i->op != Op::Loop && i->op != Op::LightLoop) || !quiet(i->regions.back()) || !quiet(i->regions.front()))
                continue;
            const std::vector<size_t> vars = parts(i);
            if (vars.size() < 2) continue;
            for (size_t v = 1; v < vars.size(); ++v) {
                CopyMap map;
                Inst* copy = copyInst(k, i, map);
                body.push_back(copy);
                moved[{i, static_cast<int>(vars[v])}] = copy;
            }
            ++changes;
        }
        r.body = std::move(body);
    }
    std::map<std::pair<const Inst*, int>, Inst*> moved;
};

} // namespace

int splitSums(Kernel& k) {
    Splitter s{k, analyseDependence(k), 0, {}};
    s.region(k.body);
    if (s.changes) removeDeadCode(k);
    return s.changes;
}

} // namespace alpenglow::rsl::passes
