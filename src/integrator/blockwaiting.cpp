// Requests of waiting kernels in blocks: each call has a target of its own for the light of its rays.
#include "bsdf/sampling.h"
#include "integrator/blockvertices.h"
#include "integrator/lightpathstates.h"
#include "integrator/photonstage.h"
#include "integrator/strips.h"
#include "services/random.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

/// Whether the strips of a batch all make the same first request, for one ray each, at nearly all points of the batch.
bool BlockVertices::takes(const BatchContext& c, std::span<KernelStrip* const> strips) const {
    if (world_.traceSubsets_ || c.aside || c.between || c.below || !c.clear.empty() || c.points.empty() ||
        photons_.photonTrace() || !takesRays(c))
        return false;
    size_t asked = 0;
    for (const KernelStrip* s : strips) {
        const StripRequest r = s->request();
        const SiteInfo& site = c.bound->sites[size_t(r.site)];
        if (r.site != strips[0]->request().site || !site.block || site.kind != SiteKind::Trace || r.gather) return false;
        for (const int lane : r.memory->laneOf) {
            const int samples = site.rays->samples;
            const bool several =
                site.trace->hemisphere || (samples >= 0 && r.memory->in[size_t(samples) * size_t(r.lanes) + size_t(lane)] > 1);
            if (several || r.memory->occurrences[size_t(r.site) * 64 + size_t(lane)] != 0) return false;
        }
        asked += r.memory->laneOf.size();
    }
    return 2 * asked >= c.points.size();
}

bool BlockVertices::run(BatchContext& c, std::span<KernelStrip* const> strips, Sched& sched) {
    if (!takes(c, strips)) return false;
    std::vector<EmitRecord> emits;
    std::vector<float> arena;
    std::vector<AccumulatorId> targets = c.targets;
    before_.assign(c.points.size(), 0);
    for (const KernelStrip* s : strips) { // as a kernel that does not wait emits it: weight 1, then the arguments
        const StripRequest r = s->request();
        EmitRecord& e = emits.emplace_back();
        e.site = r.site, e.first = r.first, e.lanes = r.lanes, e.offset = arena.size();
        arena.insert(arena.end(), 3 * size_t(r.lanes), 1.f);
        arena.insert(arena.end(), r.memory->in.begin(), r.memory->in.end());
        arena.resize(e.offset + size_t(rowsOfArguments(c.bound->sites[size_t(r.site)]) + 3) * size_t(r.lanes));
        for (size_t k = 0; k < r.memory->laneOf.size(); ++k) {
            const size_t lane = size_t(r.memory->laneOf[k]), point = size_t(r.first) + lane;
            e.mask |= uint64_t(1) << lane;
            targets[point] = r.memory->ids[k];
            before_[point] = r.asked[lane];
        }
    }
    c.emits.swap(emits), c.arena.swap(arena), c.targets.swap(targets);
    const bool done = follow(c, sched, true);
    c.emits.swap(emits), c.arena.swap(arena), c.targets.swap(targets);
    if (!done) return false;
    for (KernelStrip* s : strips) {
        uint64_t lobes = 0;
        counters_.inRows += s->request().memory->laneOf.size();
        for (int lane = 0; lane < s->request().lanes; ++lane) {
            const size_t point = size_t(s->request().first + lane);
            if (point < points_ && count_ > 0)
                lobes |= uint64_t(sites_[0].lobes[point / kBlock].asked >> point % kBlock & 1) << lane;
        }
        s->noteAsked(lobes);
    }
    return true;
}

/// Roulette for rays of a waiting kernel, by the number of rays that it requests.
void BlockVertices::endByChance(size_t b) {
    RayBlock& r = rays_[b];
    for (Lanes left = next_.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const uint32_t known = r.flags[i] & kAskedBits, before = before_[b * kBlock + size_t(i)];
        const auto count = uint32_t(sites_[size_t(next_.site[i])].samplesAt(b * kBlock + size_t(i)));
        r.flags[i] = (r.flags[i] & ~kAskedBits) | std::min<uint32_t>(std::max(known, before + count), kAskedBits);
        const float q = survived_[i] = rouletteWaiting(vertices_[b].bounces[i], known, before, count);
        if (q < 1 && !(next_.dice[i] < q)) next_.goes &= ~(1u << i);
        for (int k = 0; k < 3; ++k) next_.weight[k][i] = next_.weight[k][i] / q;
    }
}

} // namespace alpenglow::integrator
