// trace()'s "uniform" and "cosine": averages of radiance over a cone. axis = R, a = half angle (samplecone); 0 = one ray.
#include "transport/lobe.h"
#include "transport/sampling.h"

namespace alpenglow::transport {
namespace {
float oneMinusCos(float a) {
    float s = std::sin(0.5f * std::min(a, float(kPi)));
    return 2 * s * s;
}
bool inside(const LobeParams& p, Vec3 w) {
    if (p.hasHorizon && !(dot(p.horizon, w) > 0)) return false;
    // By the chord: 1 - cos of a narrow cone is lost in rounding. The last term is that of the components of both vectors.
    const Vec3d chord = Vec3d(w) - Vec3d(p.axis);
    return length(chord) <= std::sqrt(2 * double(oneMinusCos(p.a))) * (1 + 1e-6) + 3e-7;
}
bool delta(const LobeParams& p) { return !(p.a > 1e-6f); }
float uniformValue(const LobeParams& p, Vec3 w) { return !delta(p) && inside(p, w) ? 1 / (2 * float(kPi) * oneMinusCos(p.a)) : 0; }
bool uniformDraw(const LobeParams& p, Vec2 u, Vec3& w) {
    w = delta(p) ? p.axis : Basis(p.axis).toWorld(sampleCone(oneMinusCos(p.a), u));
    return !p.hasHorizon || dot(p.horizon, w) > 0;
}
// The cosine form counts light above the plane of the axis only.
float sineSquared(const LobeParams& p) {
    float s = std::sin(std::min(p.a, float(kPi) / 2));
    return s * s;
}
float cosineValue(const LobeParams& p, Vec3 w) {
    float c = dot(p.axis, w);
    return !delta(p) && c > 0 && inside(p, w) ? c / (float(kPi) * sineSquared(p)) : 0;
}
bool cosineDraw(const LobeParams& p, Vec2 u, Vec3& w) {
    if (delta(p)) {
        w = p.axis;
    } else {
        float r2 = u.x * sineSquared(p), r = std::sqrt(r2), phi = 2 * float(kPi) * u.y;
        w = Basis(p.axis).toWorld({r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.f, 1 - r2))});
        if (!(dot(p.axis, w) > 0)) return false;
    }
    return !p.hasHorizon || dot(p.horizon, w) > 0;
}
float one(const LobeParams&) { return 1; }
float spread(const LobeParams& p) { return std::min(p.a * 0.5f, 0.7f); }
} // namespace
extern const LobeKind kUniformLobe, kCosineLobe;
const LobeKind kUniformLobe = {"uniform", "Plain average over the cone of half angle a about axis.", delta, uniformValue, uniformValue,
                               uniformDraw, one, spread};
const LobeKind kCosineLobe = {"cosine", "Cosine-weighted average over the cone of half angle a about axis; pi/2 is irradiance / pi.", delta,
                              cosineValue, cosineValue, cosineDraw, one, spread};
} // namespace alpenglow::transport
