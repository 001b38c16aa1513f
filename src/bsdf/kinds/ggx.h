// trace()'s "ggx": reflection by Smith microfacets with the distribution of Trowbridge and Reitz. axis = normal. Visible normals
// are sampled, so values do not exceed densities.
#pragma once
#include "bsdf/kinds/smith.h"
#include "shadeops/bsdf/ggx.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// Samples visible facets that reflect light from above, approximately (Eto and Tokuyoshi, "Bounded VNDF Sampling for the
/// Smith-GGX BRDF", 2023).
struct GgxFacets {
    static constexpr const char* name = "ggx";
    static constexpr bool kFresnel = true;
    static constexpr const char* doc =
        "Facets of Trowbridge and Reitz; roughness along udir, roughnessv across. Metals: \"eta\" of two.";
    /// Own rows of prepare(): roughness along and across udir, factor of the density, Smith's lambda of wo, lower bound of the
    /// sampled cap.
    enum : int { kA = 6, kB, kPerDensity, kLambda, kLow };
    static AL_MEMBER void prepare(const Rows& p) {
        const vf a = sane(p.number(kRowRoughness)), b = sane(p.number(kRowRoughnessV));
        const Pair<Direction> t{p.ownTriple(0), p.ownTriple(3)};
        const vf no = dot(p.axis(), p.wo()), no2 = no * no, s2 = stretched2(p.wo(), t, a, b), far = rootLanes(s2 + no2);
        const vf least = minLanes(minLanes(a, b), vf(1)), a2 = least * least, s = rootOf(vf(1) - no2) + vf(1);
        const vf k = divide((vf(1) - a2) * s * s, mad(a2, no2, s * s));
        p.own(kA, a), p.own(kB, b), p.own(kPerDensity, divide(vf(2), mad(k, no, far)));
        p.own(kLambda, ggxLambda(s2, no)), p.own(kLow, divide(k * no, far));
    }
    static AL_MEMBER FacetValue evaluate(const Given& p, const Facet<vf>& f, const Pair<Direction>& t) {
        const vf a = p.own(kA), b = p.own(kB), d = ggxFacets(f, t, a, b);
        const vf lambdas = p.own(kLambda) + ggxLambda(stretched2(f.l, t, a, b), f.nl);
        return {smithReflection(f, d, lambdas, p.triple(kRowEta), p.triple(kRowK)), d * f.oh * p.own(kPerDensity)};
    }
    static AL_MEMBER Direction draw(const Given& p, const Pair<vf>& u, const Direction& o) {
        const vf a = p.own(kA), b = p.own(kB);
        return visibleGgx(stretched(o, a, b), p.own(kLow), a, b, u);
    }
};
using GgxReflection = FacetLobe<GgxFacets>;

} // namespace alpenglow::bsdf::AL_NAMESPACE
