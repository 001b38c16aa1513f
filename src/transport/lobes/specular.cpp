// specular(N, V, roughness) and specularstd: Blinn highlight. axis = N, wo = V, a = exponent of N.H.
// Per light term Cl max(0, N.H)^e, so f cos = (N.H)^e / pi on the side of N.
#include "transport/lobe.h"
#include "transport/sampling.h"

namespace alpenglow::transport {
namespace {
float value(const LobeParams& p, Vec3 w) {
    if (!(dot(p.axis, w) > 0)) return 0;
    float c = dot(p.axis, normalize(w + p.wo));
    return c > 0 ? std::pow(c, p.a) / float(kPi) : 0;
}
float density(const LobeParams& p, Vec3 w) {
    Vec3 h = normalize(w + p.wo);
    float d = dot(p.wo, h);
    return d > 0 && dot(p.axis, w) > 0 ? phongPdf(p.a, dot(p.axis, h)) / (4 * d) : 0;
}
bool draw(const LobeParams& p, Vec2 u, Vec3& w) {
    Vec3 h = Basis(p.axis).toWorld(samplePhong(p.a, u));
    float d = dot(p.wo, h);
    if (!(d > 0)) return false; // the mirror image would lie below the facet
    w = normalize(h * (2 * d) - p.wo);
    return dot(p.axis, w) > 0;
}
float albedo(const LobeParams& p) { return std::min(1.f, 8 * std::max(0.1f, dot(p.axis, p.wo)) / (p.a + 1)); }
float spread(const LobeParams& p) { return std::min(0.7f, std::sqrt(2 / (p.a + 1))); }
} // namespace
extern const LobeKind kSpecularLobe;
const LobeKind kSpecularLobe = {"specular", "Blinn highlight: f cos = max(0, N.H)^a / pi above the surface.",
                                [](const LobeParams&) { return false; }, value, density, draw, albedo, spread};
} // namespace alpenglow::transport
