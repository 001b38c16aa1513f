// Traced shadows of light loops. A point light may have a radius (__shadowradius): shadows are then cast by the disk around its
// position that faces the lit point, while attenuation, cone and cosine stay those of the point.
#include "base/direction.h"
#include "bsdf/sampling.h"
#include "integrator/lightkernels.h"
#include "integrator/mediastacks.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/shadowrays.h"
#include <bit>

namespace alpenglow::integrator {

Vec3 onShadowDisk(const Vec3& centre, const Vec3& w, float radius, Vec2 u) {
    const float r = radius * std::sqrt(u.x);
    const Vec2 d = unitCircle(u.y);
    const Basis b(w);
    return centre + b.t * (r * d.x) + b.u * (r * d.y);
}

int rowsOfArguments(const SiteInfo& s) {
    int rows = 0;
    for (rsl::ir::Kind k : s.site->argKinds) rows += rsl::ir::components(k);
    return rows;
}

void Requests::lightVisibility(BatchContext& c, const SiteInfo& s, int point, const float* in, int lanes, int lane, Color weight,
                               AccumulatorId target) {
    const auto f = [&](int row) { return in[size_t(row) * size_t(lanes) + size_t(lane)]; };
    const Vec3 l(f(s.rows[1]), f(s.rows[1] + 1), f(s.rows[1] + 2));
    const Vec3 w = directionOr(l, {});
    if (!(dot(w, w) > 0)) return;
    const ShadePoint& p = c.points[size_t(point)];
    const Vec3 o = geometry::offsetOrigin(p.surface, w, length(p.P - p.surface.P));
    const float distance = f(s.rows[0]), radius = f(rowsOfArguments(s));
    ShadowRay ray{o, w, distance < 1e30f ? distance * (1 - 1e-4f) : 1e38f, weight, target, p.shutter, p.ray};
    if (radius > 0 && distance > 0 && distance < 1e30f) {
        const uint32_t vertex = std::bit_cast<uint32_t>(f(rowsOfArguments(s) + 1));
        const Vec2 u = store_.random(c.rays[size_t(point)]).pair(vertex, kLightPoint, 0);
        const Vec3 to = onShadowDisk(p.P + w * distance, w, radius, u) - o;
        ray.dir = normalizeOr(to, w);
        ray.distance = length(to) * (1 - 1e-4f);
    }
    ray.media = media_.towards(c, point, w);
    shadows_.queue.push_back(ray);
}

void LightKernels::shadowLight(const KernelRun& c, const BoundLight& light, int first, uint32_t draw,
                               std::span<const ShadePoint> q, std::span<const int> laneOf, std::span<LightValue> v) {
    std::vector<ShadowRay> rays;
    std::vector<size_t> of;
    std::vector<Color> sum(q.size(), Color(0)), left;
    std::vector<int> count(q.size(), 0);
    const auto follow = [&] {
        left.resize(rays.size());
        shadows_.transmittances(rays, left);
        for (size_t k = 0; k < of.size(); ++k) sum[of[k]] += left[k];
        rays.clear();
        of.clear();
    };
    const uint32_t use = kLightPoint + uint32_t(&light - world_.lights().data());
    for (size_t i = 0; i < q.size(); ++i) {
        if (!v[i].lit || v[i].Cl == Color(0)) continue;
        const ShadePoint& lit = c.points[size_t(first + laneOf[i])];
        const Vec3 to = -v[i].L;
        const float far = length(to);
        if (!(far > 0)) continue;
        const Vec3 w = to / far;
        const Vec3 o = geometry::offsetOrigin(lit.surface, w, length(q[i].Ps - lit.surface.P));
        const bool anywhere = light.kind == LightKind::Distant;
        const float distance = anywhere ? 1e38f : light.kind == LightKind::Area ? far * (1 - 1e-4f) : far * (1 - 1e-5f);
        const bool soft = v[i].shadowRadius > 0 && lit.ray;
        count[i] = soft ? v[i].shadowSamples : 1;
        for (int k = 0; k < count[i]; ++k) {
            ShadowRay ray{o, w, distance, Color(1), shading::kNoAccumulator, lit.shutter, lit.ray};
            if (soft) {
                const Random numbers = store_.random(*lit.ray).draw(uint32_t(k), uint32_t(count[i]));
                const Vec2 u = numbers.pair(lit.ray->vertex, use, draw);
                const Vec3 way = onShadowDisk(q[i].Ps + to, w, v[i].shadowRadius, u) - o;
                ray.dir = normalizeOr(way, w);
                ray.distance = length(way) * (1 - 1e-5f);
            }
            ray.media = media_.towards(c, first + laneOf[i], w);
            rays.push_back(ray);
            of.push_back(i);
            if (rays.size() >= kShadowsAtOnce) follow();
        }
    }
    follow();
    for (size_t i = 0; i < q.size(); ++i)
        if (count[i] > 0) v[i].Cl *= sum[i] / float(count[i]);
}

void LightKernels::takeShadowSays(LightValue& v, const BoundLight& light, float radius, float samples) {
    constexpr float kMost = 4096;
    const auto say = [&](const char* what) {
        diagnostics_.reportOnce(
            what + light.instance->name,
            {Severity::Warning, Rie::Range, light.instance->place, "light \"" + light.instance->name + "\": " + what, {}, {}});
    };
    if (!std::isfinite(radius) || radius < 0) say("__shadowradius must be >= 0; the light casts the shadows of a point");
    else v.shadowRadius = radius;
    if (!(samples >= 1)) say("__shadowsamples must be >= 1; 1 is used");
    else if (samples > kMost) say("__shadowsamples exceeds the limit of 4096");
    v.shadowSamples = samples >= 1 ? int(std::min(samples, kMost)) : 1;
}

} // namespace alpenglow::integrator
