// Diffusion in place of walks: samples surface points near the shaded one.
#include "bsdf/dipole.h"
#include "bsdf/sampling.h"
#include "integrator/intersector.h"
#include "integrator/raystore.h"
#include "integrator/subsurface.h"
#include "integrator/subsurfacewalks.h"

namespace alpenglow::integrator {

/// Finds surface points by lines along one of three axes, chosen at random; all intersections of a line count (King et al.,
/// BSSRDF Importance Sampling, 2013).
void Walks::probe(int asked) {
    const WorldImpl& world = world_;
    const WalkAsked& a = asked_[size_t(asked)];
    const SubsurfaceMedium& b = media_[size_t(a.subsurface)];
    const ShadePoint& p = c_.points[size_t(a.point)];
    const PathRay& ray = c_.rays[size_t(a.point)];
    const bool turned = dot(p.surface.n, ray.dir) > 0;
    const std::optional<Entry> entered = entry(asked);
    if (!entered) return;
    const Basis about(entered->out);
    const Vec3 from = entered->at;
    Color part(std::fabs(a.weight.x), std::fabs(a.weight.y), std::fabs(a.weight.z));
    for (int k = 0; k < 3; ++k)
        if (!(b.scattering[k] > 0)) part[k] = 0; // no contribution, so it is not chosen
    const double sum = double(part.x) + part.y + part.z;
    if (!(sum > 0)) return;
    std::vector<Dipole> dipoles;
    double share[3];
    for (int k = 0; k < 3; ++k) {
        dipoles.emplace_back(subsurface_.albedoInversions.of(b.index), b.model == SubsurfaceSite::Model::BetterDipole,
                             double(b.absorption[k]), std::max(double(b.scattering[k]), 1e-12));
        share[k] = part[k] / sum;
    }
    const Random random = store_.random(ray);
    const Vec2 where = random.pair(a.vertex, kSegmentEvent, 0), how = random.pair(a.vertex, kSegmentEvent, 1);
    const float which = random.one(a.vertex, kSegmentEvent, 0);
    int channel = 2;
    double at = how.x;
    for (int k = 0; k < 2 && channel == 2; ++k)
        if (at < share[k]) channel = k;
        else at -= share[k];
    while (channel > 0 && !(share[channel] > 0)) --channel; // rounding
    const double r = dipoles[size_t(channel)].choose(random.one(a.vertex, kSegmentEvent, 1), where.x);
    const Vec2 turn = unitCircle(where.y);
    const Vec3 axes[3] = {about.n, about.t, about.u};
    const double chances[3] = {.5, .25, .25};
    const int k = which < .5f ? 0 : which < .75f ? 1 : 2;
    const Vec3 axis = axes[k], x = axes[(k + 1) % 3], y = axes[(k + 2) % 3];
    const geometry::Bounds box = world.bounds();
    const float far = length(box.hi - box.lo) + length(from - (box.lo + box.hi) * 0.5f) + 1;
    if (!(r < far)) return; // outside of the range
    Walker line{asked, from + x * float(r * turn.x) + y * float(r * turn.y) + axis * far, -axis, a.weight, a.weight, a.vertex};
    accel::Ray probe = rayOf(line, 2 * double(far));
    accel::Hit hit;
    for (int layer = 0; layer < limits::kShadowLayers && intersector_.intersect(probe, hit); ++layer) {
        world.goOn(probe, hit);
        if (!belongs(hit.shape, b.group)) continue;
        const geometry::SurfacePoint s = world.accel().point(hit);
        const Vec3 n = s.displaced ? s.displacedN : s.n, to = (s.displaced ? s.displacedP : s.P) - from;
        double density = 0; // of all axes and channels that could have sampled this point
        for (int j = 0; j < 3; ++j) {
            const Vec3 across = to - axes[j] * dot(to, axes[j]);
            double d = 0;
            for (int i = 0; i < 3; ++i)
                if (share[i] > 0) d += share[i] * dipoles[size_t(i)].density(length(across));
            density += chances[j] * d * std::fabs(dot(n, axes[j]));
        }
        if (!(density > 0)) continue;
        Exit exit{asked, {}, childVertex(a.vertex, kSegmentEvent, uint32_t(16 + layer)), hit.shape, s, turned ? -n : n};
        for (int i = 0; i < 3; ++i)
            exit.weight[i] = b.scattering[i] > 0 ? float(a.weight[i] * dipoles[size_t(i)].at(length(to)) / density) : 0;
        if (isFinite(exit.weight)) exits_.push_back(exit);
    }
}

} // namespace alpenglow::integrator
