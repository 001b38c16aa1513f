// phong(N, V, size): the mirror direction of V about N, to the power of size. axis = N, wo = V, a = size.
// Per light term Cl max(0, R.L)^size, so f cos = (R.w)^size / pi on the side of N.
#include "transport/lobe.h"
#include "transport/sampling.h"

namespace alpenglow::transport {
namespace {
Vec3 mirror(const LobeParams& p) { return p.axis * (2 * dot(p.axis, p.wo)) - p.wo; }
float value(const LobeParams& p, Vec3 w) {
    float c = dot(mirror(p), w);
    return c > 0 && dot(p.axis, w) > 0 ? std::pow(c, p.a) / float(kPi) : 0;
}
float density(const LobeParams& p, Vec3 w) { return dot(p.axis, w) > 0 ? phongPdf(p.a, dot(mirror(p), w)) : 0; }
bool draw(const LobeParams& p, Vec2 u, Vec3& w) {
    w = Basis(normalize(mirror(p))).toWorld(samplePhong(p.a, u));
    return dot(p.axis, w) > 0;
}
float albedo(const LobeParams& p) { return std::min(1.f, 2 / (p.a + 1)); }
float spread(const LobeParams& p) { return std::min(0.7f, std::sqrt(2 / (p.a + 1))); }
} // namespace
extern const LobeKind kPhongLobe;
const LobeKind kPhongLobe = {"phong", "Phong highlight: f cos = max(0, R.w)^a / pi above the surface.",
                             [](const LobeParams&) { return false; }, value, density, draw, albedo, spread};
} // namespace alpenglow::transport
