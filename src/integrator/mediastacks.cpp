// Interior and Exterior (RISpec 3.2): which volume a ray is in. A ray that continues on the side that N points away from is in
// the Interior of the primitive; on the other side it is in the Exterior. A surface with neither bounds no volume.
#include "integrator/mediastacks.h"
#include "integrator/atmosphere.h"
#include "integrator/context.h"
#include "integrator/stageset.h"
#include <algorithm>
#include <tuple>

namespace alpenglow::integrator {

MediaStacks::MediaStacks(const StageSet& s) : Stage(s.context), atmosphere_(s.atmosphere) {}

using shading::Media;

void MediaStacks::reportLost(const Media* m, const ShadePoint& p) const {
    if (m && m->lost)
        diagnostics_.reportOnce(
            "media", {Severity::Warning,
                      Rie::Limit,
                      p.shape ? p.shape->place() : SourcePlace{},
                      "a ray is inside of more than " + std::to_string(limits::kMedia) + " volumes; the outermost are ignored",
                      {},
                      {}});
}

const Media* MediaStacks::kept(const Media& m) {
    if (m.count == 0 && !m.lost) return nullptr;
    for (const Media& known : known_)
        if (known == m) return &known;
    return &known_.emplace_back(m);
}

const Media* MediaStacks::beyond(const SurfaceBinding& b, const Media* from, const Vec3& n, const Vec3& in, const Vec3& to) {
    if (b.inside < 0 && b.outside < 0) return from;
    return kept(b.beyond(from ? *from : Media(), n, in, to));
}

const Media* MediaStacks::towards(const KernelRun& c, int point, const Vec3& w) {
    if (world_.media().empty() || size_t(point) >= c.bindings.size()) return nullptr;
    const PathRay& ray = c.rays[size_t(point)];
    if (c.between) return ray.media;
    const ShadePoint& p = c.points[size_t(point)];
    const Media* m = beyond(world_.bindings()[size_t(c.bindings[size_t(point)])], ray.media, p.surface.n, ray.dir, w);
    reportLost(m, p);
    return m;
}

void MediaStacks::shadowsInMedia(std::span<ShadowRay> rays, const Vec3& a, const Vec3& b, const Vec3& at,
                                 const geometry::SurfacePoint* s, const SurfaceBinding* binding) {
    if (world_.media().empty() || !s) return;
    const auto isHere = [&](const Vec3& x) { return length(x - at) <= geometry::roundingError(x) + 4 * s->pError; };
    for (ShadowRay& r : rays) {
        if (!isHere(a) && isHere(b) && r.distance < 1e30f) { // media are known here, not at the other end
            r.origin += r.dir * r.distance;
            r.dir = -r.dir;
        } else if (!isHere(a)) {
            continue;
        }
        if (r.ray && binding) r.media = beyond(*binding, r.ray->media, s->n, r.ray->dir, r.dir);
        else if (r.ray && (dot(r.ray->dir, s->n) < 0) == (dot(r.dir, s->n) > 0))
            r.media = r.ray->media; // of a light: back along the ray that arrived
    }
}

void MediaStacks::dim(std::span<const MediumPart> parts, std::span<const ShadowRay> rays, std::span<Color> out) {
    std::vector<const MediumPart*> order;
    for (const MediumPart& p : parts)
        if (maxComponent(out[p.ray]) > 0) order.push_back(&p);
    std::stable_sort(order.begin(), order.end(), [](const MediumPart* a, const MediumPart* b) {
        return std::tie(a->medium, a->ray) < std::tie(b->medium, b->ray);
    });
    std::vector<ShadePoint> points;
    std::vector<AtmosphereEffect> hazes;
    for (size_t first = 0, end; first < order.size(); first = end) {
        const Medium& m = world_.media()[size_t(order[first]->medium)];
        points.clear();
        for (end = first; end < order.size() && order[end]->medium == order[first]->medium; ++end) {
            const MediumPart& part = *order[end];
            if (m.homogeneous) {
                out[part.ray] *= m.homogeneous->transmittance(length(part.to - part.from));
                continue;
            }
            ShadePoint& p = points.emplace_back();
            p.shape = m.shape;
            p.P = p.surface.P = part.to;
            p.I = part.to - part.from;
            p.E = part.from;
            p.N = p.surface.n = p.surface.N = p.surface.Ng = length(p.I) > 0 ? -normalize(p.I) : Vec3(0, 0, 1);
            p.Ci = p.Oi = Color(1);
            p.ray = rays[part.ray].ray;
            p.shutter = rays[part.ray].time;
            world_.setTime(p);
        }
        if (points.empty()) continue;
        hazes.assign(points.size(), {});
        atmosphere_.atmosphereEffects(m, world_.bindings()[size_t(m.binding)], points, hazes, true);
        for (size_t k = first; k < end; ++k) {
            const Color& left = hazes[k - first].slope;
            for (int i = 0; i < 3; ++i) out[order[k]->ray][i] *= std::isfinite(left[i]) ? std::max(left[i], 0.f) : 0;
        }
    }
}

} // namespace alpenglow::integrator
