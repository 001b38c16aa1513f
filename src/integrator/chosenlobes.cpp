// Lobes for samples of chosen lights: gathered from their points to blocks of samples, and connected.
#include "integrator/chosenlights.h"
#include "integrator/connection.h"
#include "integrator/medium.h"
#include "integrator/photongather.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

/// Copies the evaluated lobes of a call site at the points of the samples. Returns the lanes that sample the light.
Lanes LightSampling::ChosenLights::gatherLobes(const Questions& q, const Site& s) {
    Lanes asked = 0;
    const float* from[kBlock]; // by lane: first row of the lobe's block, at its column
    for (int i = 0; i < kBlock; ++i) {
        const Asked& a = *q.asked[i];
        const size_t at = size_t(a.point % kBlock);
        const LobeBlock& l = s.lobes[size_t(a.point / kBlock)];
        from[i] = l.lobe[0] + at;
        for (int r = 0; r < 3; ++r) lobe_.weight[r][i] = l.weight[r][at];
        lobe_.chosen[i] = l.chosen[at];
        const BoundLight& light = world_.lights()[size_t(a.light)];
        const bool samples = ((l.lights & ~lightSampling_.gathered_.bring(l, light)) >> at & 1) &&
                             lightSampling_.samples(s, light) &&
                             (v_.draw == 0 || v_.draw < uint32_t(lightSampling_.drawsOf(s, size_t(a.point))));
        asked |= Lanes(samples) << i;
    }
    lobe_.asked = lobe_.lights = asked & q.lights.asked;
    if (!lobe_.lights) return 0;
    const auto rows = [&](int first, int end) {
        for (int r = first; r < end; ++r)
            for (int i = 0; i < kBlock; ++i) lobe_.lobe[r][i] = from[i][r * kBlock];
    };
    const int needs = s.lanes->needs;
    rows(kRowAxis, kRowWo);
    if (needs & kNeedsWo) rows(kRowWo, kRowHorizon);
    if (needs & kNeedsHorizon) rows(kRowHorizon, kRowA);
    if (needs & kNeedsA) rows(kRowA, kRowRoughness);
    if (needs & kNeedsSurface) rows(kRowRoughness, kRowCount);
    if (needs & kNeedsNumbers) rows(kRowCount, kRowAlbedo);
    rows(kRowAlbedo, kLobeRows);
    return lobe_.lights;
}

/// Makes the shadow rays of a block of samples: one each, for all lobes of its point.
void LightSampling::ChosenLights::connect(Questions& q, BatchContext& c) {
    stages_.aim(q.points, q.lights, v_.shadow);
    std::fill_n(v_.sent, kBlock, -1);
    size_t points[kBlock] = {};
    const BoundLight* lights[kBlock];
    for (int i = 0; i < kBlock; ++i) {
        if (q.there >> i & 1) points[i] = size_t(q.asked[i]->point);
        lights[i] = &world_.lights()[size_t(q.asked[i]->light)];
    }
    q.lights.hasPart = c.between;
    for (Lanes left = c.between ? q.there & q.lights.asked : 0; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        q.lights.part[i] =
            lightSampling_.mediumEvents_.shareOfDistance(c.flown[points[i]], world_.lights()[size_t(q.asked[i]->light)]);
    }
    const Lanes placed = q.lights.asked;
    for (size_t k = 0; k < v_.count; ++k) {
        const Site& s = v_.sites[k];
        if (v_.onlySite >= 0 && v_.onlySite != int(k)) continue;
        q.lights.asked = placed;
        q.lights.asked = s.lights ? gatherLobes(q, s) : 0;
        if (!q.lights.asked) continue;
        Connection::OwnShadows own(lightSampling_.connection_, s);
        own.limit(s, points, lights, q.says, q.lights);
        const Lanes asked = lobe_.lights = q.lights.asked;
        s.lanes->evaluate(lobe_.lobe[0], asked, q.lights.w[0], v_.value[0]);
        for (Lanes some = lightSampling_.connection_.contribute(s, q.points, lobe_, q.lights, c, points); some;
             some &= some - 1) {
            const int i = std::countr_zero(some);
            const LightValue* says = q.says[i] < 0 ? nullptr : &v_.values[size_t(q.says[i])];
            const Vec3 w(q.lights.w[0][i], q.lights.w[1][i], q.lights.w[2][i]);
            lightSampling_.connection_.sendShadow(s, points[i], size_t(i), w, *lights[i], says, c);
        }
    }
}

} // namespace alpenglow::integrator
