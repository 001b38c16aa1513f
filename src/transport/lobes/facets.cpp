// trace()'s reflections by small facets: "blinn", "ashikhmin-shirley", "cook-torrance", "ward". axis = normal. A facet is drawn by its
// slope, and the light it mirrors to wo is asked for; what lies below the surface is lost.
#include "transport/lobes/distribution.h"

namespace alpenglow::transport {
namespace {

/// Draws half vectors h about +z, x along udir; density(h) per solid angle of h.
struct BlinnFacets {
    static constexpr std::string_view symbol = "al_bsdf_blinn";
    static constexpr int width = 3;
    static void arguments(BsdfArguments& a, const DistributionParams& m) { a << m.roughness << m.eta << m.k; }
    static Vec3 draw(const DistributionParams& m, Vec2 u) { return samplePhong(exponentOf(m.roughness), u); }
    static float density(const DistributionParams& m, const Vec3& h) { return phongPdf(exponentOf(m.roughness), h.z); }
};
/// About the axis by an angle whose tangent is `ratio` times that of 2 pi u.
Vec2 elliptic(float u, float first, float second) {
    Vec2 c = unitCircle(u);
    c = {c.x * first, c.y * second};
    const float l = std::sqrt(c.x * c.x + c.y * c.y);
    return {c.x / l, c.y / l};
}
struct AshikhminFacets {
    static constexpr std::string_view symbol = "al_bsdf_ashikhminshirley";
    static constexpr int width = 3;
    static void arguments(BsdfArguments& a, const DistributionParams& m) { a << m.udir << m.roughness << m.roughnessv << m.eta << m.k; }
    static Vec3 draw(const DistributionParams& m, Vec2 u) {
        const float eu = exponentOf(m.roughness), ev = exponentOf(m.roughnessv);
        const Vec2 d = elliptic(u.y, std::sqrt(ev + 1), std::sqrt(eu + 1));
        const float c = std::pow(1 - u.x, 1 / (eu * d.x * d.x + ev * d.y * d.y + 1)), s = std::sqrt(std::max(0.f, 1 - c * c));
        return {s * d.x, s * d.y, c};
    }
    static float density(const DistributionParams& m, const Vec3& h) {
        const float eu = exponentOf(m.roughness), ev = exponentOf(m.roughnessv), s2 = h.x * h.x + h.y * h.y;
        const float e = s2 > 0 ? (eu * h.x * h.x + ev * h.y * h.y) / s2 : 0;
        return std::sqrt((eu + 1) * (ev + 1)) / (2 * float(kPi)) * std::pow(h.z, e);
    }
};
Vec3 fromSlope(float tangent2, Vec2 d) {
    const float c = 1 / std::sqrt(1 + tangent2), s = std::sqrt(tangent2) * c;
    return {s * d.x, s * d.y, c};
}
struct BeckmannFacets {
    static constexpr std::string_view symbol = "al_bsdf_cooktorrance";
    static constexpr int width = 3;
    static void arguments(BsdfArguments& a, const DistributionParams& m) { a << m.roughness << m.eta << m.k; }
    static Vec3 draw(const DistributionParams& m, Vec2 u) {
        const float r = sane(m.roughness);
        return fromSlope(-r * r * std::log(std::max(1 - u.x, 1e-30f)), unitCircle(u.y));
    }
    static float density(const DistributionParams& m, const Vec3& h) {
        const float r = sane(m.roughness), c2 = h.z * h.z;
        return std::exp(-(1 - c2) / (c2 * r * r)) / (float(kPi) * r * r * c2 * h.z);
    }
};
struct WardFacets {
    static constexpr std::string_view symbol = "al_bsdf_ward";
    static constexpr int width = 1;
    static void arguments(BsdfArguments& a, const DistributionParams& m) { a << m.udir << m.roughness << m.roughnessv; }
    static Vec3 draw(const DistributionParams& m, Vec2 u) {
        const float a = sane(m.roughness), b = sane(m.roughnessv);
        const Vec2 d = elliptic(u.y, a, b);
        return fromSlope(-std::log(std::max(1 - u.x, 1e-30f)) / (d.x * d.x / (a * a) + d.y * d.y / (b * b)), d);
    }
    static float density(const DistributionParams& m, const Vec3& h) {
        const float a = sane(m.roughness), b = sane(m.roughnessv), c2 = h.z * h.z;
        return std::exp(-(h.x * h.x / (a * a) + h.y * h.y / (b * b)) / c2) / (float(kPi) * a * b * c2 * h.z);
    }
};

template <class F> Color colour(const LobeParams& p, Vec3 w) {
    if (!aboveHorizon(p, w)) return Color(0);
    BsdfArguments a;
    a << w << p.axis << p.wo;
    F::arguments(a, *p.more);
    return a.value(F::symbol, F::width);
}
template <class F> float value(const LobeParams& p, Vec3 w) { return maxComponent(colour<F>(p, w)); }
template <class F> float density(const LobeParams& p, Vec3 w) {
    if (!(dot(p.axis, w) > 0)) return 0;
    Vec3 h = p.wo + w;
    const float l = length(h);
    if (!(l > 1e-6f)) return 0;
    h = h / l;
    const float oh = dot(p.wo, h), c = dot(p.axis, h);
    if (!(oh > 1e-6f) || !(c > 1e-6f)) return 0;
    return F::density(*p.more, TangentFrame(p.axis, p.more->udir).toLocal(h)) / (4 * oh);
}
template <class F> bool draw(const LobeParams& p, Vec2 u, Vec3& w) {
    const Vec3 h = TangentFrame(p.axis, p.more->udir).toWorld(F::draw(*p.more, u));
    const float oh = dot(p.wo, h);
    if (!(oh > 1e-6f)) return false;
    w = h * (2 * oh) - p.wo;
    w = w / length(w);
    return dot(p.axis, w) > 0 && aboveHorizon(p, w);
}
template <class F> constexpr LobeKind kind(std::string_view name, std::string_view doc) {
    return {name, doc, notDelta, value<F>, density<F>, draw<F>, about1, spreadOf, colour<F>, true};
}
} // namespace
extern const LobeKind kBlinnLobe, kAshikhminShirleyLobe, kCookTorranceLobe, kWardLobe;
const LobeKind kBlinnLobe = kind<BlinnFacets>("blinn", "Facets whose slopes follow a power of the cosine.");
const LobeKind kAshikhminShirleyLobe = kind<AshikhminFacets>("ashikhmin-shirley", "Anisotropic facets; roughness along udir, roughnessv across.");
const LobeKind kCookTorranceLobe = kind<BeckmannFacets>("cook-torrance", "Facets with Beckmann's distribution of slopes.");
const LobeKind kWardLobe = kind<WardFacets>("ward", "Anisotropic Gaussian slopes; roughness along udir, roughnessv across.");
} // namespace alpenglow::transport
