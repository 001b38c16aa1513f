// Light-directed sampling for surfaces in media (lightdirected.h): selects the light and its share of a lobe's samples.
#include "integrator/lightdirected.h"
#include "bsdf/sampling.h"
#include "integrator/mediastacks.h"
#include "integrator/medium.h"

namespace alpenglow::integrator {

namespace {
constexpr float kMostLightDirected = 0.3f; ///< largest share of a lobe's samples
constexpr float kHalfwayThick = 0.2f;      ///< optical distance to the light at which the share is half of that
} // namespace

float LightDirected::density(const Vec3& w, float ofLobe) const {
    if (!(share > 0)) return ofLobe;
    const float sine = std::max(length(cross(w, light)), 1e-6f);
    return (1 - share) * ofLobe + share * float(0.5 / (kPi * kPi)) / sine;
}

std::optional<Vec3> LightDirected::draw(Vec2& u) const {
    if (!(share > 0)) return {};
    if (u.x >= share) {
        u.x = std::min((u.x - share) / (1 - share), 1 - 0x1p-24f);
        return {};
    }
    const Vec2 off = unitCircle(0.5f * u.x / share), about = unitCircle(u.y);
    return Basis(light).toWorld({off.y * about.x, off.y * about.y, off.x});
}

bool MediumEvents::surfacesAim() const {
    return world_.scatters() && rules_.pickOne && rules_.lightsAtRequests &&
           world_.settings().mediumSampling != MediumSampling::Distance;
}

/// Tries the side of the surface that the ray arrives from first, then the other one.
LightDirected MediumEvents::atSurfaceInMedium(const KernelRun& c, size_t point) const {
    const PathRay& ray = c.rays[point];
    const ShadePoint& p = c.points[point];
    const Vec3 n = dot(p.surface.n, ray.dir) > 0 ? -p.surface.n : p.surface.n;
    for (const Vec3& side : {n, -n}) {
        const int medium = MediaStacks::mediumOf(media_.towards(c, int(point), side));
        if (medium < 0) continue;
        const Medium& m = world_.media()[size_t(medium)];
        if (!m.homogeneous || !(maxComponent(m.homogeneous->scattering) > 0)) continue;
        float away = 0;
        const Vec3 to = lightDirection(m, ray, p.P, &away);
        if (!(dot(to, side) > 0)) continue;
        const float thick = away * mean(m.homogeneous->scattering); // small where little is scattered on the way
        return {to, kMostLightDirected * thick / (thick + kHalfwayThick)};
    }
    return {};
}

} // namespace alpenglow::integrator
