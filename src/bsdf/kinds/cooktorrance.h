// trace()'s "cook-torrance": facets with Beckmann's distribution, in V-shaped grooves. axis = normal.
#pragma once
#include "bsdf/kinds/facets.h"
#include "shadeops/bsdf/cook_torrance.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// Facets of the lobe "cook-torrance" (formula: shadeops/bsdf).
struct BeckmannFacets {
    static constexpr const char* name = "cook-torrance";
    static constexpr bool kFresnel = true;
    static constexpr const char* doc = "Facets with Beckmann's distribution of slopes.";
    static AL_MEMBER void prepare(const Rows& p) {
        const vf m = sane(p.number(kRowRoughness));
        p.own(6, m * m);
    }
    static AL_MEMBER FacetValue evaluate(const Given& p, const Facet<vf>& f, const Pair<Direction>&) {
        const vf d = beckmann(f, p.own(6));
        return {cookTorrance(f, d, p.triple(kRowEta), p.triple(kRowK)), visibleInGroove(f, d * f.nh)};
    }
    static AL_MEMBER Direction draw(const Given& p, const Pair<vf>& u, const Direction& o) {
        return visibleInGroove(fromSlope(-p.own(6) * logOfRest(u.a), {vf(1), vf(0)}), o, u.b);
    }
};
using CookTorrance = FacetLobe<BeckmannFacets>; ///< the lobe

} // namespace alpenglow::bsdf::AL_NAMESPACE
