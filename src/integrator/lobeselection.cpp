#include "integrator/lobeselection.h"
#include "integrator/accumulator.h"
#include "integrator/photonflight.h"
#include "integrator/stageset.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

LobeSelection::LobeSelection(const StageSet& s, const VertexStages& v)
    : VertexStage(s, v), accumulator_(s.accumulator), flight_(v.flight), mediumEvents_(s.mediumEvents), surfaces_(s.surfaces) {}

void LobeSelection::prepare() {
    for (size_t k = 0; k < v_.count; ++k) {
        Site& s = v_.sites[k];
        for (size_t b = 0; b < v_.blocks; ++b) {
            LobeBlock& l = s.lobes[b];
            if (!l.asked) {
                std::fill_n(l.chosen, kBlock, 0.f);
                continue;
            }
            s.lanes->prepare(l.lobe[0], l.asked);
            for (int i = 0; s.lights && i < kBlock; ++i)
                l.lights |= Lanes((l.asked & ~v_.vertices[b].guided & ~l.ownOrigin) >> i & (l.lobe[kRowDelta][i] == 0)) << i;
            for (int i = 0; !s.requests.empty() && i < kBlock; ++i)
                if (const LobeVertex* r = s.requests[b * kBlock + size_t(i)]; r && !r->lights) l.lights &= ~(1u << i);
        }
    }
}

void LobeSelection::select(const BatchContext& c) {
    std::vector<SiteRules> of(v_.count);
    for (size_t k = 0; k < v_.count; ++k) of[k] = {v_.sites[k].lighting, v_.sites[k].diffuse, v_.sites[k].walks};
    // Sums of outputs need not conserve energy.
    const SelectRules rules{of.data(), world_.settings().unbiased || c.lightOutput, !rules_.pickOne};
    for (size_t k = 0; k < v_.count; ++k) {
        const bool still = (!world_.settings().indirect && v_.sites[k].diffuse) || (c.subsurface && !rules_.pickOne);
        const bool stays = still && !v_.sites[k].walks && !flight_.on(); // PhotonFlight has limits of its own
        for (size_t b = 0; b < v_.blocks && stays; ++b) v_.sites[k].lobes[b].stays = ~Lanes(0);
    }
    for (size_t b = 0; b < v_.blocks; ++b) {
        const Selected found = stages_.select(v_.vertices[b], v_.lobesOf(b).data(), int(v_.count), rules);
        counters_.depthCap += uint64_t(std::popcount(found.cut & v_.vertices[b].points));
        for (size_t k = 0; k < v_.count; ++k)
            for (Lanes left = v_.sites[k].lobes[b].failed & v_.vertices[b].points; left; left &= left - 1)
                accumulator_.notFinite(c, c.rays[b * kBlock + size_t(std::countr_zero(left))], uint32_t(v_.sites[k].number));
        for (const bool more : {true, false})
            for (Lanes left = more ? found.bright : found.brightWithClear; left; left &= left - 1)
                reportScaled(world_.bindings()[size_t(c.bindings[b * kBlock + size_t(std::countr_zero(left))])], more);
    }
}

void LobeSelection::reportScaled(const SurfaceBinding& b, bool more) {
    if (!(more ? tamed_ : tamedClear_).insert(b.surface.get()).second) return;
    diagnostics_.reportOnce((more ? "energy:" : "energyclear:") + b.surface->name,
                            {more ? Severity::Warning : Severity::Info,
                             Rie::NoError,
                             b.surface->place,
                             "shader \"" + b.surface->name + "\" reflects" + (more ? "" : ", including transmitted light,") +
                                 " more light than it receives; its indirect light is scaled down to conserve energy",
                             "--unbiased disables this",
                             {}});
}

} // namespace alpenglow::integrator
