// trace()'s "beckmann": reflection by Smith microfacets with Gaussian slopes. axis = normal. Visible normals are sampled, so
// values do not exceed densities.
#pragma once
#include "bsdf/kinds/smith.h"
#include "shadeops/bsdf/beckmann.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// erf of x >= 0, accurate to 1.5e-7.
AL_INLINE vf errorFunction(vf x) { return vf(1) - scaledErfc(x) * expLanes(-x * x); }
/// Inverse of erf within +-0.99999, accurate to 1e-6 (Giles, "Approximating the erfinv function", 2011).
AL_INLINE vf inverseErf(vf y) {
    constexpr float kNear[] = {1.50140941f,     0.246640727f,   -0.00417768164f, -0.00125372503f, 0.00021858087f,
                               -4.39150654e-6f, -3.5233877e-6f, 3.43273939e-7f,  2.81022636e-8f};
    constexpr float kFar[] = {2.83297682f,     1.00167406f,    0.00943887047f,  -0.0076224613f,  0.00573950773f,
                              -0.00367342844f, 0.00134934322f, 0.000100950558f, -0.000200214257f};
    const vf x = maxLanes(minLanes(y, vf(0.99999f)), vf(-0.99999f)), w = -logLanes((vf(1) - x) * (vf(1) + x));
    return x * select(w < 5, polynomial(kNear, w - vf(2.5f)), polynomial(kFar, rootLanes(maxLanes(w, vf(5))) - vf(3)));
}
/// Slope, in the plane of the viewer, of a visible facet of roughness 1 for a viewer at this cosine > 0: inverts the distribution
/// by bracketed Newton steps (Heitz and d'Eon 2014; Jakob, "An Improved Visible Normal Sampling Routine for the Beckmann
/// Distribution", 2014).
AL_INLINE vf visibleBeckmannSlope(vf cosine, vf u) {
    const vf c = minLanes(cosine, vf(0.99999f)), tangent = rootLanes(mad(-c, c, vf(1))) / c, perRoot = tangent * vf(0.564189584f);
    const vf cot = vf(1) / tangent, x = maxLanes(u, vf(1e-6f));
    vf low = vf(-1), high = errorFunction(cot);
    const vf angle = acosLanes(c), fit = mad(angle, mad(angle, mad(angle, vf(-0.0594f), vf(0.4265f)), vf(-0.876f)), vf(1));
    const vf whole = vf(1) / mad(perRoot, expLanes(-cot * cot), high + vf(1));
    vf at = high - (high + vf(1)) * powLanes(vf(1) - x, fit);
    for (int step = 0; step < 8; ++step) {
        at = select((at >= low) & (at <= high), at, (low + high) * vf(0.5f));
        const vf slope = inverseErf(at), over = mad(whole, mad(perRoot, expLanes(-slope * slope), at + vf(1)), -x);
        low = select(over > 0, low, at), high = select(over > 0, at, high);
        at = at - divide(over, whole * mad(-slope, tangent, vf(1)));
    }
    return inverseErf(maxLanes(minLanes(at, high), low));
}
struct SmithBeckmannFacets {
    static constexpr const char* name = "beckmann";
    static constexpr bool kFresnel = true;
    static constexpr const char* doc =
        "Facets with Gaussian slopes; roughness along udir, roughnessv across. Metals: \"eta\" of two.";
    /// Own rows of prepare(): roughness along and across udir, factor of the density, Smith's lambda of wo.
    enum : int { kA = 6, kB, kPerDensity, kLambda };
    static AL_MEMBER void prepare(const Rows& p) {
        const vf a = sane(p.number(kRowRoughness)), b = sane(p.number(kRowRoughnessV));
        const Pair<Direction> t{p.ownTriple(0), p.ownTriple(3)};
        const vf no = dot(p.axis(), p.wo()), lambda = beckmannLambda(stretched2(p.wo(), t, a, b), no);
        p.own(kA, a), p.own(kB, b), p.own(kLambda, lambda), p.own(kPerDensity, divide(vf(1), no * (lambda + vf(1))));
    }
    static AL_MEMBER FacetValue evaluate(const Given& p, const Facet<vf>& f, const Pair<Direction>& t) {
        const vf a = p.own(kA), b = p.own(kB), d = beckmannFacets(f, t, a, b);
        const vf lambdas = p.own(kLambda) + beckmannLambda(stretched2(f.l, t, a, b), f.nl);
        return {smithReflection(f, d, lambdas, p.triple(kRowEta), p.triple(kRowK)), d * f.oh * p.own(kPerDensity)};
    }
    static AL_MEMBER Direction draw(const Given& p, const Pair<vf>& u, const Direction& o) {
        const vf a = p.own(kA), b = p.own(kB);
        const Direction view = stretched(o, a, b);
        const vf along = visibleBeckmannSlope(view.z, u.a), across = inverseErf(mad(u.b, vf(2), vf(-1)));
        const vf side = rootLanes(mad(view.x, view.x, view.y * view.y));
        const vm tilted = side > 1e-6f;
        const vf x = select(tilted, view.x / side, vf(1)), y = where(tilted, view.y / side);
        return normalize(Direction{-a * mad(x, along, -y * across), -b * mad(y, along, x * across), vf(1)});
    }
};
using BeckmannReflection = FacetLobe<SmithBeckmannFacets>;

} // namespace alpenglow::bsdf::AL_NAMESPACE
