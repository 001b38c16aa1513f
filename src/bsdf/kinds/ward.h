// trace()'s "ward": anisotropic Gaussian slopes. axis = normal.
#pragma once
#include "bsdf/kinds/facets.h"
#include "shadeops/bsdf/ward.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// Facets of the lobe "ward" (formula: shadeops/bsdf).
struct WardFacets {
    static constexpr const char* name = "ward";
    static constexpr bool kFresnel = false;
    static constexpr const char* doc = "Anisotropic Gaussian slopes; roughness along udir, roughnessv across.";
    static AL_MEMBER void prepare(const Rows& p) {
        p.own(6, sane(p.number(kRowRoughness))), p.own(7, sane(p.number(kRowRoughnessV)));
    }
    static AL_MEMBER FacetValue evaluate(const Given& p, const Facet<vf>& f, const Pair<Direction>& t) {
        const vf a = p.own(6), b = p.own(7), lobe = wardLobe(f, t, a, b), v = ward(f, lobe, a, b);
        return {{v, v, v}, divide(lobe * vf(1 / kPi), a * b * f.nh * f.nh * f.nh)};
    }
    static AL_MEMBER Direction draw(const Given& p, const Pair<vf>& u, const Direction&) {
        const vf a = p.own(6), b = p.own(7);
        const Pair<vf> d = elliptic(u.b, a, b);
        const vf x = d.a / a, y = d.b / b;
        return fromSlope(-logOfRest(u.a) / mad(x, x, y * y), d);
    }
};
using Ward = FacetLobe<WardFacets>; ///< the lobe

} // namespace alpenglow::bsdf::AL_NAMESPACE
