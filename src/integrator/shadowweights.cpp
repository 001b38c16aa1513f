// Which shadow rays are traced, and with which weight their light counts.
#include "base/hash.h"
#include "integrator/context.h"
#include "integrator/raystore.h"
#include "integrator/shadowrays.h"
#include "services/random.h"
#include <bit>

namespace alpenglow::integrator {

/// Below PhotonStore::leastLight the probability that a ray is traced is its light's share of that. Neither
/// the light of a ray nor its random number depends on its batch.
void ShadowRays::roulette(const Sched& s) {
    constexpr float kLeastChance = .1f; // bounds the brightest that a survivor becomes
    const float least = world_.photons() ? world_.photons()->leastLight : 0;
    if (!(least > 0) || context_.seen || world_.shadowVisibility().differs()) return;
    const auto bits = [](float f) { return uint64_t(std::bit_cast<uint32_t>(f)); };
    size_t kept = 0;
    for (ShadowRay& r : queue) {
        float light = luminance(r.contribution);
        for (int32_t k = r.more; k >= 0; k = more[size_t(k)].more) light += luminance(more[size_t(k)].contribution);
        if (light >= 0 && light < least && r.distance > 0 && r.hemisphere < 0 && r.ray && s.isRoot(r.target)) {
            const float chance = std::max(light / least, kLeastChance);
            // Of each light sample its own number: its direction is part of the key.
            const uint64_t way = mix64(bits(r.dir.x) << 32 ^ bits(r.dir.y));
            if (store_.random(*r.ray).one(r.ray->vertex, kShadowRoulette, uint32_t(way >> 32)) >= chance) continue;
            r.contribution = r.contribution / chance;
            for (int32_t k = r.more; k >= 0; k = more[size_t(k)].more)
                more[size_t(k)].contribution = more[size_t(k)].contribution / chance;
        }
        if (&queue[kept] != &r) queue[kept] = r;
        ++kept;
    }
    queue.resize(kept);
}

void ShadowRays::takeAlone() {
    const accel::Accel* const lobesOnly = world_.shadowVisibility().lobesOnly.get();
    for (const AloneLight& a : alone) {
        ShadowRay& r = queue[a.ray];
        if (!(maxComponent(transmitted_[a.ray]) > 0)) continue;
        bool takes = !differs_.empty() && differs_[a.ray];
        if (!takes && lobesOnly && r.distance > 0) {
            accel::Ray way = rayOf(r);
            way.mask = a.lobes;
            way.tfar *= 1 - 1e-4f; // the light itself may be one of them
            way.only = nullptr;    // by shapes of another tree
            takes = lobesOnly->occluded(way);
        }
        if (takes) (a.more < 0 ? r.contribution : more[size_t(a.more)].contribution) = a.light;
    }
    alone.clear();
}

} // namespace alpenglow::integrator
