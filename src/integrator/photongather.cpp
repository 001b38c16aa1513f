#include "integrator/photongather.h"
#include "integrator/accumulator.h"
#include "integrator/guiderays.h"
#include "integrator/lightpathstates.h"
#include "integrator/photonjob.h"
#include "integrator/photonstage.h"
#include "integrator/stageset.h"
#include "integrator/surfacepoints.h"
#include <algorithm>
#include <bit>
#include <cmath>

namespace alpenglow::integrator {

PhotonGather::PhotonGather(const StageSet& s, const VertexStages& v)
    : VertexStage(s, v), accumulator_(s.accumulator), guide_(s.guide), paths_(s.paths), stage_(s.photons), surfaces_(s.surfaces) {
}

void PhotonGather::mark(BatchContext& c) {
    gathers_.clear();
    if (!world_.photons() || !world_.photons()->hasPasses()) return;
    for (size_t i = 0; i < v_.points; ++i) {
        if (!stage_.passOf(c.rays[i])) continue;
        gathers_.resize(v_.blocks);
        gathers_[i / kBlock] |= 1u << i % kBlock;
    }
    const float below = world_.photons()->widthOfPasses;
    for (size_t k = 0; k < v_.count && !gathers_.empty(); ++k)
        for (size_t b = 0; b < v_.blocks; ++b) {
            const Site& s = v_.sites[k];
            LobeBlock& l = v_.sites[k].lobes[b];
            for (Lanes left = l.asked & gathers_[b]; left; left &= left - 1) {
                const int i = std::countr_zero(left);
                const size_t point = b * kBlock + size_t(i);
                if (!isNarrow(s, point, below, c)) continue;
                l.narrow |= 1u << i;
                l.left |= Lanes((c.rays[point].trail & shading::kTrailSpread) && mirrors(s, point, c)) << i;
            }
        }
}

/// Decided by what both a photon and a path know: the roughness, and that the lobe is the same from either of its directions.
/// This holds for microfacets and for highlights around the mirror direction. A highlight around another direction, as by
/// refraction, has paths that only one of both finds. Shaders that move P are excluded, as they cannot run twice.
bool PhotonGather::isNarrow(const Site& s, size_t point, float below, BatchContext& c) const {
    const size_t i = point % kBlock;
    const LobeBlock& l = s.lobes[point / kBlock];
    if (l.lobe[kRowDelta][i] != 0 || s.walks || c.between || !(l.lobe[kRowSpread][i] < below)) return false;
    if (c.binding->moveS || c.bound->kernel->facts().suspends) return false;
    constexpr float kSame = 1e-3f; // between unit directions
    const VertexBlock& v = v_.vertices[point / kBlock];
    const Vec3 in = normalize(Vec3(v.I[0][i], v.I[1][i], v.I[2][i]));
    const auto triple = [&](int row) { return Vec3(l.lobe[row][i], l.lobe[row + 1][i], l.lobe[row + 2][i]); };
    if (s.kind->has(kAxisIsMirror)) {
        const bool has = l.lobe[kRowHasHorizon][i] != 0;
        if (!has) surfaces_.pointsOfRows(c);
        const Vec3 n = has ? triple(kRowHorizon) : normalize(c.points[point].N);
        return length(triple(kRowAxis) - (in - n * (2 * dot(in, n)))) < kSame;
    }
    return s.kind->has(kSameFromBoth) && length(triple(kRowWo) + in) < kSame;
}

bool PhotonGather::seesAll(const Site& s, size_t point, const BatchContext& c) const {
    const shading::RaySet& set = s.raysAt(point).set;
    const float reach = s.options.empty() ? 1e38f : s.options[point].maxDistance;
    return !(s.lobes[point / kBlock].ownOrigin >> point % kBlock & 1) && !set.only && !(reach < 1e37f) &&
           set.mode == shading::HitMode::Default && set.sides == accel::Sides::Front &&
           world_.bindings()[size_t(c.bindings[point])].photons.intersectsBoth;
}

/// Whether a lobe receives light from all directions of its point, so that photons can be gathered for it. Surfaces only.
bool PhotonGather::spreads(const Site& s, size_t point, const BatchContext& c) const {
    const LobeBlock& l = s.lobes[point / kBlock];
    const bool single = l.lobe[kRowDelta][point % kBlock] != 0 || (l.narrow >> point % kBlock & 1);
    return !single && !c.between && seesAll(s, point, c);
}

bool PhotonGather::mirrors(const Site& s, size_t point, const BatchContext& c) const {
    const LobeBlock& l = s.lobes[point / kBlock];
    const bool single = l.lobe[kRowDelta][point % kBlock] != 0 || (l.narrow >> point % kBlock & 1);
    return single && !s.walks && !v_.waits && seesAll(s, point, c);
}

Lanes PhotonGather::bring(const LobeBlock& l, const BoundLight& light) const {
    return l.left && world_.photons()->lightsOfPasses[size_t(&light - world_.lights().data())] ? l.left : 0;
}

uint8_t PhotonGather::trailBehind(const Site& s, size_t point, const BatchContext& c) const {
    if (spreads(s, point, c)) return shading::kTrailSpread;
    const bool spread = c.rays[point].trail & shading::kTrailSpread;
    return spread && mirrors(s, point, c) ? shading::kTrailSpread | shading::kTrailMirrored : 0;
}

void PhotonGather::keep(size_t block, const BatchContext& c) {
    if (gathers_.empty() || guide_.on()) return; // with the guide no photons are gathered
    RayBlock& r = v_.rays[block];
    for (Lanes left = v_.next.goes & gathers_[block]; left; left &= left - 1) {
        const size_t i = size_t(std::countr_zero(left));
        r.flags[i] |= uint32_t(trailBehind(v_.sites[size_t(v_.next.site[i])], block * kBlock + i, c)) << 24;
    }
}

/// Finds the photons near a point: near_.
void PhotonGather::findNear(const photonmap::PhotonGrid& grid, size_t point, const BatchContext& c) {
    const geometry::SurfacePoint& p = c.points.empty() ? c.surfaces[point] : c.points[point].surface;
    const Vec3& n = p.displaced ? p.displacedN : p.n;
    const float time = c.rays[point].shutter();
    const float perArea = 1 / (float(kPi) * grid.radius() * grid.radius() * grid.lasts(time));
    near_.clear();
    grid.within(p.displaced ? p.displacedP : p.P, time, [&](const photonmap::Photon& photon) {
        if (!(std::fabs(dot(photonmap::unpackUnit(photon.normal), n)) > 0.7f)) return;
        const Vec3 w = photon.direction();
        near_.push_back({w, photon.power * (perArea / safeCosine(dot(w, n)))});
    });
}

void PhotonGather::take(BatchContext& c, Sched& sched) {
    if (gathers_.empty() || !rules_.pickOne || c.between) return;
    for (size_t point = 0; point < v_.points; ++point) {
        const size_t block = point / kBlock, i = point % kBlock;
        if (!(gathers_[block] & v_.vertices[block].points & (1u << i))) continue;
        const PathRay& ray = c.rays[point];
        const photonmap::PhotonGrid& grid = *stage_.passOf(ray);
        if (grid.size() == 0) continue;
        near_.clear();
        bool searched = false;
        for (size_t k = 0; k < v_.count; ++k) {
            const Site& s = v_.sites[k];
            const LobeBlock& l = s.lobes[block];
            if (!(l.asked >> i & 1) || !(l.chosen[i] > 0) || !spreads(s, point, c)) continue;
            if (!std::exchange(searched, true)) findNear(grid, point, c);
            if (near_.empty()) break;
            Color weight(l.weight[0][i], l.weight[1][i], l.weight[2][i]);
            if (s.lighting) weight = weight * v_.vertices[block].energyScale[i];
            const Color light = (v_.waits ? weight : weight * ray.weight) * givenBack(s, point);
            const uint16_t path = paths_.atPhotons(v_.pathOf(s, false, point, near_[0].from, c));
            accumulator_.contribute(
                sched, {c.targets[point], light, LightEvent::Photons, &ray, v_.shareOf(s, point, ray), nullptr, path});
        }
    }
}

/// Light of near_ that a lobe reflects.
Color PhotonGather::givenBack(const Site& s, size_t point) const {
    const size_t i = point % kBlock;
    const LobeBlock& l = s.lobes[point / kBlock];
    Color sum(0);
    if (s.kind->has(kLambert)) { // the most frequent case
        const Vec3 axis(l.lobe[kRowAxis][i], l.lobe[kRowAxis + 1][i], l.lobe[kRowAxis + 2][i]);
        for (const Near& photon : near_) sum += photon.light * std::max(dot(axis, photon.from), 0.f);
        return sum * float(1 / kPi);
    }
    alignas(64) Row w[3] = {}, value[kValueRows];
    for (const Near& photon : near_) {
        for (int q = 0; q < 3; ++q) w[q][i] = photon.from[q];
        s.lanes->evaluate(l.lobe[0], 1u << i, w[0], value[0]);
        sum += photon.light * Color(value[kRowColour][i], value[kRowColour + 1][i], value[kRowColour + 2][i]);
    }
    return sum;
}

} // namespace alpenglow::integrator
