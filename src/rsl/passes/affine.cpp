#include "rsl/passes/affine.h"
#include "rsl/ir/edit.h"
#include "rsl/passes/affine_analysis.h"
#include "rsl/passes/affine_constant.h"
#include "rsl/passes/affine_weights.h"
#include "rsl/passes/split_sums.h"

namespace alpenglow::rsl::passes {

std::vector<std::pair<int, std::string>> nonAffineSites(const Kernel& k) {
    std::map<int, std::string> all = analyseDependence(k).bad;
    for (const auto& s : k.facts.stuck) all.insert(s);
    return {all.begin(), all.end()};
}

namespace {

Region copyOf(Kernel& k, const Region& r) {
    CopyMap map;
    Region copy;
    copyBody(k, r, map, copy.body);
    return copy;
}

bool prove(Kernel& k, bool split) {
    k.facts.affine = true;
    k.facts.suspends = false;
    k.facts.whyNot.clear();
    k.facts.stuck.clear();
    bool any = false;
    Inst* ci = nullptr;
    forEach(k.body, [&](Inst* i) {
        any = any || i->op == Op::Request;
        if (i->op == Op::Output && k.outputs[static_cast<size_t>(i->index)].name == k.light) ci = i;
    });
    if (!any) return true;
    const auto refuse = [&](int site, const std::string& why) {
        const Site& s = k.sites[static_cast<size_t>(site)];
        k.facts.affine = false;
        k.facts.suspends = true;
        for (const auto& [number, reason] : nonAffineSites(k)) {
            const Site& other = k.sites[static_cast<size_t>(number)];
            k.facts.nonLinear.push_back({other.op, reason, other.place});
        }
        k.facts.whyNot = s.op + "()" + (s.place.line ? ", line " + std::to_string(s.place.line) : "") + ": " + why;
        return false;
    };
    Dependence d = analyseDependence(k);
    if (!d.bad.empty()) return refuse(d.bad.begin()->first, d.bad.begin()->second);
    // Work on a copy, so that a failure leaves the kernel as it was.
    Region original = k.body;
    k.body = copyOf(k, original);
    if (split && splitSums(k) == 0) {
        k.body = std::move(original);
        return false;
    }
    ci = nullptr;
    d = analyseDependence(k);
    forEach(k.body, [&](Inst* i) {
        if (i->op == Op::Output && k.outputs[static_cast<size_t>(i->index)].name == k.light) ci = i;
    });
    bool good = false;
    std::string why;
    int site = -1;
    {
        Weights weights(k, d);
        good = weights.run(ci);
        why = weights.why();
        site = weights.stuckSite();
    }
    if (!good) {
        k.body = original;
        if (site < 0) forEach(k.body, [&](Inst* i) { site = site < 0 && i->op == Op::Request ? i->site : site; });
        k.facts.stuck.emplace_back(site, why);
        return refuse(site, why);
    }
    dropResults(k, d);
    // Nothing uses the results of these Requests any more: they are removed.
    const auto sweep = [&](auto&& self, Region& r) -> void {
        std::erase_if(
            r.body, [](const Inst* i) { return i->op == Op::Request || (i->op == Op::Result && i->args[0]->op == Op::Request); });
        for (Inst* i : r.body)
            for (Region& sub : i->regions) self(self, sub);
    };
    sweep(sweep, k.body);
    return true;
}

} // namespace

void makeAffine(Kernel& k) {
    const std::vector<KernelFacts::NonLinear> lobes = k.facts.nonLinear; // that stay direct
    if (prove(k, false)) return;
    const KernelFacts facts = k.facts;
    k.facts.nonLinear = lobes;
    if (facts.stuck.empty() || !prove(k, true)) k.facts = facts;
}

} // namespace alpenglow::rsl::passes
