// trace()'s "phong": SLProject's glossy lobe about a perfect direction (pathtracer.md 5.3). axis = perfect reflected or refracted
// direction, a = exponent (1000 and above: perfect), horizon = surface normal. f cos = (n+2)/(2 pi) cos^n |w . horizon|,
// only on the perfect direction's side of the surface; without a horizon the plain normalised lobe (n+1)/(2 pi) cos^n.
// What this does not do: conserve energy at grazing angles (the part below the surface is lost, as in the seed).
#include "transport/lobe.h"
#include "transport/sampling.h"

namespace alpenglow::transport {
namespace {
constexpr float kPerfect = 1000; // SLMaterial::PERFECT
bool delta(const LobeParams& p) { return p.a >= kPerfect; }
bool sameSide(const LobeParams& p, Vec3 w) { return !p.hasHorizon || dot(p.horizon, p.axis) * dot(p.horizon, w) > 0; }
float value(const LobeParams& p, Vec3 w) {
    float c = dot(p.axis, w);
    if (delta(p) || !(c > 0) || !sameSide(p, w)) return 0;
    float lobe = std::pow(c, p.a) / (2 * float(kPi));
    return p.hasHorizon ? (p.a + 2) * lobe * std::fabs(dot(p.horizon, w)) : (p.a + 1) * lobe;
}
float density(const LobeParams& p, Vec3 w) { return delta(p) || !sameSide(p, w) ? 0 : phongPdf(p.a, dot(p.axis, w)); }
bool draw(const LobeParams& p, Vec2 u, Vec3& w) {
    if (delta(p)) { w = p.axis; return true; }
    w = Basis(p.axis).toWorld(samplePhong(p.a, u));
    return sameSide(p, w);
}
float spread(const LobeParams& p) { return delta(p) ? 0 : std::min(0.7f, std::sqrt(2 / (p.a + 1))); }
} // namespace
extern const LobeKind kPhongTraceLobe;
const LobeKind kPhongTraceLobe = {"slphong", "SLProject's normalised Phong lobe of exponent a about axis; 1000 and above: one direction.", delta, value,
                                  density, draw, [](const LobeParams&) { return 1.f; }, spread};
} // namespace alpenglow::transport
