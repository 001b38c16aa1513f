// trace()'s "ashikhmin-shirley": anisotropic facets. axis = normal.
#pragma once
#include "bsdf/kinds/facets.h"
#include "shadeops/bsdf/ashikhmin_shirley.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// The facet rotated by half a turn about the normal, z.
AL_INLINE Direction turnedAbout(const Direction& h) { return {-h.x, -h.y, h.z}; }

/// Facets of the lobe "ashikhmin-shirley" (formula: shadeops/bsdf).
struct AshikhminFacets {
    static constexpr const char* name = "ashikhmin-shirley";
    static constexpr bool kFresnel = true;
    static constexpr const char* doc = "Anisotropic facets; roughness along udir, roughnessv across.";
    static AL_MEMBER void prepare(const Rows& p) {
        const vf eu = exponentOf(p.number(kRowRoughness)), ev = exponentOf(p.number(kRowRoughnessV));
        p.own(6, eu), p.own(7, ev), p.own(8, (eu + vf(1)) * (ev + vf(1)));
    }
    static AL_MEMBER FacetValue evaluate(const Given& p, const Facet<vf>& f, const Pair<Direction>& t) {
        const vf lobe = ashikhminLobe(f, t, p.own(6), p.own(7)), density = rootLanes(p.own(8)) * vf(0.5f / kPi) * lobe;
        return {ashikhminShirley(f, p.own(8), lobe, p.triple(kRowEta), p.triple(kRowK)),
                select(useful(f.nh * f.no * vf(2) - f.oh, f.nh, f.no), density, density * vf(2))};
    }
    /// Whether a facet reflects light from above to the viewer. If the sampled one does not, the opposite one is used.
    static AL_MEMBER vm useful(vf oh, vf nh, vf no) { return (oh > 1e-6f) & (oh * nh * vf(2) > no); }
    static AL_MEMBER Direction draw(const Given& p, const Pair<vf>& u, const Direction& o) {
        const vf eu = p.own(6), ev = p.own(7);
        const Pair<vf> d = elliptic(u.b, rootLanes(ev + vf(1)), rootLanes(eu + vf(1)));
        const vf e = mad(eu * d.a, d.a, mad(ev * d.b, d.b, vf(1)));
        const Direction h = withCosine(powLanes(vf(1) - u.a, vf(1) / e), d);
        return select3(useful(dot(h, o), h.z, o.z), h, turnedAbout(h));
    }
};
using AshikhminShirley = FacetLobe<AshikhminFacets>; ///< the lobe

} // namespace alpenglow::bsdf::AL_NAMESPACE
