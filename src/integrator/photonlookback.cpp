// Photons along narrow lobes, for vertices in blocks. Paths reach narrow highlights and rough glass from the other side, and
// their shaders' results may depend on that side: Fresnel reflectance, the direction of refraction, which call is made. So a
// photon that such a lobe sends on carries the value of all narrow lobes of its point, with the shader run from where the photon
// goes; the lobes as the photon found them only sample the direction, with the density of all of them.
#include "integrator/batchpool.h"
#include "integrator/intersector.h"
#include "integrator/kernelinputs.h"
#include "integrator/lobeselection.h"
#include "integrator/photonflight.h"
#include "integrator/photongather.h"
#include "integrator/photonstage.h"
#include "integrator/shadowrays.h"
#include "integrator/singlerequests.h"
#include "integrator/transparency.h"
#include "integrator/vertexlight.h"
#include <algorithm>
#include <bit>
#include <cmath>

namespace alpenglow::integrator {

/// Sets back_ for the photons of turned_, and ends those that no path reaches.
void PhotonFlight::lookBack(const BatchContext& c, Sched& sched) {
    if (turned_.empty()) return;
    if (!seen_) seen_ = std::make_unique<VertexLight>(set_);
    auto seen = batches_.take();
    shadeBack(*seen, c);
    const size_t settled = set_.shadows.settled.size();
    seen_->read(*seen, sched);
    set_.shadows.settled.resize(std::min(settled, set_.shadows.settled.size())); // of rays that no longer exist
    seen_->stages().flight.mark(*seen);
    back_.assign(v_.points, Color(0));
    std::vector<Lanes> turned(v_.blocks);
    for (const Turned& t : turned_) turned[t.point / kBlock] |= 1u << t.point % kBlock;
    for (size_t b = 0; b < v_.blocks; ++b)
        if (turned[b]) valueBack(b, turned[b], *seen, c);
    batches_.giveBack(std::move(seen));
}

/// Runs the shader over the batch as seen by paths from where the photons go.
void PhotonFlight::shadeBack(BatchContext& c, const BatchContext& from) {
    c.extrasOf = nullptr; // the extras of the rays belong to the batch
    c.binding = from.binding;
    c.bound = from.bound;
    c.displaced = from.displaced;
    c.points = from.points;
    c.rays = from.rays;
    c.targets = from.targets;
    c.bindings = from.bindings;
    for (size_t i = 0; i < c.points.size(); ++i) c.points[i].ray = &c.rays[i];
    for (const Turned& t : turned_) { // seen from the photon's next hit: shaders may query its distance
        const Row* const direction = picked_[t.point / kBlock].direction;
        const size_t i = t.point % kBlock;
        const Vec3 w(direction[0][i], direction[1][i], direction[2][i]);
        const PathRay& ray = from.rays[t.point];
        accel::Ray way;
        way.org = v_.originOf(v_.sites[size_t(t.site)], t.point, w);
        way.dir = w;
        way.time = world_.shutterOf(ray);
        way.only = photons_.photonTrace()->job->met;
        way.sides = accel::Sides::Both;
        way.level = ray.sample->level;
        accel::Hit hit;
        ShadePoint& p = c.points[t.point];
        p.I = w * -(intersector_.intersect(way, hit) ? hit.t : length(p.I));
        p.E = p.P - p.I;
        c.rays[t.point].dir = -w;
    }
    inputs_.fill(c);
    if (c.displaced) c.batch->takeDisplacement(*c.displaced->batch);
    c.bound->kernel->run(&c.batch->call());
    c.ran();
}

/// Whether a lobe that samples lights is lit by the light from which a photon has just arrived.
bool PhotonFlight::isLit(const Site& s, size_t point, const BatchContext& c) const {
    const PathRay& ray = c.rays[point];
    if (ray.bounces > 0 || !(s.lobes[point / kBlock].lights >> point % kBlock & 1)) return true;
    return world_.bindings()[size_t(c.bindings[point])].lights.contains(
        photons_.photonTrace()->from[size_t(ray.sample->path)].light);
}

/// Sets back_ for the photons of a block.
void PhotonFlight::valueBack(size_t b, Lanes turned, const BatchContext& seen, const BatchContext& c) {
    Color sum[kBlock];
    float density[kBlock];
    const Lanes reached = sumBack(b, turned, seen, c, sum);
    densityBack(b, reached, c, density);
    for (Lanes left = reached; left; left &= left - 1) {
        const size_t i = size_t(std::countr_zero(left));
        back_[b * kBlock + i] = density[i] > 0 ? sum[i] / density[i] : Color(0);
    }
    picked_[b].goes &= ~(turned & ~reached);
}

/// Value of all narrow lobes of the points, as seen from where the photons go, for light from where they came. Returns the points
/// that have any.
Lanes PhotonFlight::sumBack(size_t b, Lanes turned, const BatchContext& seen, const BatchContext& c, Color* sum) {
    const PhotonTrace& t = *photons_.photonTrace();
    alignas(64) Row w[3] = {}, value[kValueRows];
    Color albedo[kBlock];
    float energy[kBlock], kept[kBlock];
    std::fill_n(albedo, kBlock, Color(0));
    std::fill_n(sum, kBlock, Color(0));
    for (size_t k = 0; k < seen_->stages().blocks.count; ++k) {
        const LobeBlock& l = seen_->stages().blocks.sites[k].lobes[b];
        for (Lanes left = seen_->stages().blocks.sites[k].lighting ? l.asked & turned : 0; left; left &= left - 1) {
            const int i = std::countr_zero(left);
            for (int q = 0; q < 3; ++q) albedo[i][q] += std::fabs(l.weight[q][i]) * l.lobe[kRowAlbedo][i];
        }
    }
    for (Lanes left = turned; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const size_t point = b * kBlock + size_t(i);
        const PathRay& ray = c.rays[point];
        kept[i] = ray.bounces == 0 ? t.from[size_t(ray.sample->path)].kept : 1;
        energy[i] = energyScale(albedo[i], transparency_.clearAt(seen, int(point)), world_.bindings()[size_t(c.bindings[point])]);
        for (int q = 0; q < 3; ++q) w[q][i] = -ray.dir[q];
    }
    Lanes reached = 0;
    for (size_t k = 0; k < seen_->stages().blocks.count; ++k) {
        const Site& s = seen_->stages().blocks.sites[k];
        const LobeBlock& l = s.lobes[b];
        Lanes some = l.asked & l.narrow & turned;
        for (Lanes left = some; left; left &= left - 1) {
            const int i = std::countr_zero(left);
            const size_t point = b * kBlock + size_t(i);
            if (!seen_->stages().gather.mirrors(s, point, seen) || !isLit(s, point, seen)) some &= ~(1u << i);
        }
        if (!some) continue;
        reached |= some;
        s.lanes->evaluate(l.lobe[0], some, w[0], value[0]);
        for (Lanes left = some; left; left &= left - 1) {
            const int i = std::countr_zero(left);
            const Color weight(l.weight[0][i], l.weight[1][i], l.weight[2][i]);
            const Color colour(value[kRowColour][i], value[kRowColour + 1][i], value[kRowColour + 2][i]);
            sum[i] +=
                weight * colour * ((s.lighting ? energy[i] : 1) * (s.raysAt(b * kBlock + size_t(i)).fromTrace ? 1 : kept[i]));
        }
    }
    return reached;
}

/// Density of the directions of photons, over all narrow lobes as they found them.
void PhotonFlight::densityBack(size_t b, Lanes turned, const BatchContext& c, float* density) {
    const ScatterBlock& next = picked_[b];
    alignas(64) Row value[kValueRows];
    std::fill_n(density, kBlock, 0.f);
    for (size_t k = 0; k < v_.count; ++k) {
        const Site& s = v_.sites[k];
        const LobeBlock& l = s.lobes[b];
        Lanes some = l.asked & l.narrow & turned;
        for (Lanes left = some; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left));
            if (!(l.chosen[i] > 0) || !follows(s, b * kBlock + i, c)) some &= ~(1u << i);
        }
        if (!some) continue;
        s.lanes->evaluate(l.lobe[0], some, next.direction[0], value[0]);
        for (Lanes left = some; left; left &= left - 1) {
            const int i = std::countr_zero(left);
            density[i] += l.chosen[i] * (next.site[i] == int(k) ? next.pdf[i] : value[kRowPdf][i]);
        }
    }
}

/// Reflected plus transmitted light must not exceed incident light.
float PhotonFlight::energyScale(const Color& reflected, const Color& clear, const SurfaceBinding& of) const {
    float scale = 1;
    for (int k = 0; k < 3 && !world_.settings().unbiased; ++k)
        if (reflected[k] + clear[k] > 1 && reflected[k] > 0) scale = std::min(scale, (1 - clear[k]) / reflected[k]);
    if (scale < 0.999f) selection_.reportScaled(of, maxComponent(reflected) > 1);
    return scale;
}

} // namespace alpenglow::integrator
