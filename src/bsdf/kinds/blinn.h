// trace()'s "blinn": facets whose slopes follow a power of the cosine. axis = normal.
#pragma once
#include "bsdf/kinds/facets.h"
#include "shadeops/bsdf/blinn.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// Facets of the lobe "blinn" (formula: shadeops/bsdf).
struct BlinnFacets {
    static constexpr const char* name = "blinn";
    static constexpr bool kFresnel = true;
    static constexpr const char* doc = "Facets whose slopes follow a power of the cosine.";
    static AL_MEMBER void prepare(const Rows& p) {
        const vf e = exponentOf(p.number(kRowRoughness));
        p.own(6, e), p.own(7, vf(1) / (e + vf(2)));
    }
    static AL_MEMBER FacetValue evaluate(const Given& p, const Facet<vf>& f, const Pair<Direction>&) {
        const vf e = p.own(6), lobe = blinnLobe(f, e);
        return {blinn(f, e, lobe, p.triple(kRowEta), p.triple(kRowK)),
                visibleInGroove(f, (e + vf(2)) * vf(0.5f / kPi) * lobe * f.nh)};
    }
    static AL_MEMBER Direction draw(const Given& p, const Pair<vf>& u, const Direction& o) {
        return visibleInGroove(samplePhong(p.own(7), {u.a, vf(0)}), o, u.b);
    }
};
using Blinn = FacetLobe<BlinnFacets>; ///< the lobe

} // namespace alpenglow::bsdf::AL_NAMESPACE
