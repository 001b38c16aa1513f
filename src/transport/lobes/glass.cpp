// trace()'s "glass-ggx": reflection and refraction at rough facets. axis = normal; wo may lie on either side. part 0: reflection alone, 1:
// refraction alone. A facet is drawn by its slope; reflection or refraction by Fresnel's share at the normal, kept away from 0 and 1.
#include "transport/lobes/distribution.h"

namespace alpenglow::transport {
namespace {
struct Sides {
    Vec3 n;            ///< on the side of wo
    float here, there; ///< indices of refraction
    float reflect;     ///< probability of reflection
};
Sides sidesOf(const LobeParams& p) {
    const bool inside = dot(p.axis, p.wo) < 0;
    const float index = std::max(p.more->eta.x, 0.01f);
    Sides s{inside ? -p.axis : p.axis, inside ? index : 1, inside ? 1 : index, 0};
    const float c = std::min(std::fabs(dot(p.axis, p.wo)), 1.f), r = s.here / s.there, s2 = r * r * (1 - c * c);
    float f = 1;
    if (s2 < 1) {
        const float t = std::sqrt(1 - s2), rs = (r * c - t) / (r * c + t), rp = (c - r * t) / (c + r * t);
        f = 0.5f * (rs * rs + rp * rp);
    }
    s.reflect = p.more->part == 0 ? 1 : p.more->part == 1 ? 0 : std::clamp(f, 0.1f, 0.9f);
    return s;
}
float value(const LobeParams& p, Vec3 w) {
    if (!aboveHorizon(p, w) && dot(p.axis, w) * dot(p.axis, p.wo) > 0) return 0;
    const DistributionParams& m = *p.more;
    const Color parts = (BsdfArguments() << w << p.axis << p.wo << m.udir << m.roughness << m.roughnessv << m.eta.x << 0.f << 0.f).value("al_bsdf_glassggx", 2);
    const float first = m.lobes.size() > 0 ? m.lobes[0] : 1, second = m.lobes.size() > 1 ? m.lobes[1] : 1;
    return (m.part == 1 ? 0 : parts.x * first) + (m.part == 0 ? 0 : parts.y * second);
}
float facetDensity(const DistributionParams& m, const TangentFrame& f, const Vec3& h) {
    const float a = sane(m.roughness), b = sane(m.roughnessv);
    const Vec3 l = f.toLocal(h);
    const float hu = l.x / a, hv = l.y / b, q = hu * hu + hv * hv + l.z * l.z;
    return l.z / (float(kPi) * a * b * q * q);
}
float density(const LobeParams& p, Vec3 w) {
    const Sides s = sidesOf(p);
    const TangentFrame f(s.n, p.more->udir);
    const bool reflects = dot(s.n, w) > 0;
    Vec3 h = reflects ? p.wo + w : p.wo * s.here + w * s.there;
    const float l = length(h);
    if (!(l > 1e-6f)) return 0;
    h = h / l;
    if (dot(s.n, h) < 0) h = -h;
    const float oh = dot(p.wo, h), lh = dot(w, h);
    if (!(oh > 1e-6f) || !(reflects ? lh > 0 : lh < 0)) return 0;
    if (reflects) return s.reflect * facetDensity(*p.more, f, h) / (4 * oh);
    const float both = s.here * oh + s.there * lh;
    return (1 - s.reflect) * facetDensity(*p.more, f, h) * -lh * s.there * s.there / (both * both);
}
bool draw(const LobeParams& p, Vec2 u, Vec3& w) {
    const Sides s = sidesOf(p);
    const bool reflects = u.x < s.reflect;
    u.x = reflects ? u.x / s.reflect : (u.x - s.reflect) / (1 - s.reflect);
    const float a = sane(p.more->roughness), b = sane(p.more->roughnessv);
    const float r = std::sqrt(u.x / std::max(1 - u.x, 1e-7f));
    const Vec2 d = unitCircle(u.y);
    Vec3 h(a * r * d.x, b * r * d.y, 1);
    h = TangentFrame(s.n, p.more->udir).toWorld(h / length(h));
    const float oh = dot(p.wo, h);
    if (!(oh > 1e-6f)) return false;
    if (reflects) {
        w = h * (2 * oh) - p.wo;
    } else {
        const float e = s.here / s.there, k = 1 - e * e * (1 - oh * oh);
        if (!(k > 0)) return false;
        w = h * (e * oh - std::sqrt(k)) - p.wo * e;
    }
    w = w / length(w);
    if ((dot(s.n, w) > 0) != reflects) return false;
    return !reflects || aboveHorizon(p, w);
}
} // namespace
extern const LobeKind kGlassLobe;
const LobeKind kGlassLobe = {"glass-ggx", "Reflection and refraction at facets with the distribution of Trowbridge and Reitz.", notDelta, value, density, draw,
                             about1, spreadOf, nullptr, true};
} // namespace alpenglow::transport
