// trace()'s reflections by small facets: "blinn", "ashikhmin-shirley", "cook-torrance", "ward". axis = normal. A facet is drawn
// by its slope, and the light it mirrors to wo is asked for; what lies below the surface is lost.
#pragma once
#include "lobes/kinds/lobe.h"
#include "shadeops/bsdf/ashikhmin_shirley.h"
#include "shadeops/bsdf/blinn.h"
#include "shadeops/bsdf/cook_torrance.h"
#include "shadeops/bsdf/ward.h"

namespace alpenglow::transport::AL_NAMESPACE {

/// Footprint of rays behind rough facets.
AL_INLINE vf spreadOfRoughness(const Given& p) {
    return minLanes(vf(0.7f), sane(minLanes(p.number(kRowRoughness), p.number(kRowRoughnessV))));
}
/// About the axis by an angle whose tangent is second / first times that of 2 pi u.
AL_INLINE Pair<vf> elliptic(vf u, vf first, vf second) {
    const Pair<vf> c = unitCircle(u);
    const vf x = c.a * first, y = c.b * second, l = vf(1) / rootLanes(mad(x, x, y * y));
    return {x * l, y * l};
}
AL_INLINE vf logOfRest(vf u) { return logLanes(maxLanes(vf(1) - u, vf(1e-30f))); }

/// Values of facets: colour, and the density of the half vector h per solid angle of h.
struct FacetValue {
    Direction colour;
    vf density;
};

/// Facets draws half vectors about +z, x along udir, in rows of its own from 6 on; 0 to 5 are the tangents.
template <class Facets> struct FacetLobe {
    static constexpr const char* name = Facets::name;
    static constexpr const char* doc = Facets::doc;
    static constexpr bool distribution = true;
    static constexpr int needs = kNeedsWo | kNeedsHorizon | kNeedsSurface;
    static AL_MEMBER Pair<Direction> tangentsOf(const Given& p) { return {p.ownTriple(0), p.ownTriple(3)}; }
    static AL_MEMBER void prepare(const Rows& p) {
        p.common(vf(1), spreadOfRoughness(p), vf(0));
        const Pair<Direction> t = tangents(p.axis(), p.triple(kRowUdir));
        p.own(0, t.a), p.own(3, t.b);
        Facets::prepare(p);
    }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const Facet<vf> f = facetOfUnit(w, p.axis(), p.wo());
        const FacetValue v = Facets::evaluate(p, f, tangentsOf(p));
        const vm drawn = (f.nl > 0) & (f.oh > 1e-6f) & (f.nh > 1e-6f);
        return {select3(aboveHorizon(p, w), v.colour, none3<vf>()), where(drawn, divide(v.density, f.oh * vf(4)))};
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        const Direction a = Facets::draw(p, u);
        const Direction h = toWorld(Basis{p.ownTriple(0), p.ownTriple(3), p.axis()}, a);
        const vf oh = dot(p.wo(), h);
        w = normalize(mad3(h, oh * vf(2), -p.wo()));
        return (oh > 1e-6f) & (dot(p.axis(), w) > 0) & aboveHorizon(p, w);
    }
};

struct BlinnFacets {
    static constexpr const char* name = "blinn";
    static constexpr const char* doc = "Facets whose slopes follow a power of the cosine.";
    static AL_MEMBER void prepare(const Rows& p) {
        const vf e = exponentOf(p.number(kRowRoughness));
        p.own(6, e), p.own(7, vf(1) / (e + vf(1)));
    }
    static AL_MEMBER FacetValue evaluate(const Given& p, const Facet<vf>& f, const Pair<Direction>&) {
        const vf e = p.own(6), lobe = blinnLobe(f, e);
        return {blinn(f, e, lobe, p.triple(kRowEta), p.triple(kRowK)), (e + vf(1)) * vf(0.5f / kPi) * lobe};
    }
    static AL_MEMBER Direction draw(const Given& p, const Pair<vf>& u) { return samplePhong(p.own(7), u); }
};
struct AshikhminFacets {
    static constexpr const char* name = "ashikhmin-shirley";
    static constexpr const char* doc = "Anisotropic facets; roughness along udir, roughnessv across.";
    static AL_MEMBER void prepare(const Rows& p) {
        const vf eu = exponentOf(p.number(kRowRoughness)), ev = exponentOf(p.number(kRowRoughnessV));
        p.own(6, eu), p.own(7, ev), p.own(8, (eu + vf(1)) * (ev + vf(1)));
    }
    static AL_MEMBER FacetValue evaluate(const Given& p, const Facet<vf>& f, const Pair<Direction>& t) {
        const vf lobe = ashikhminLobe(f, t, p.own(6), p.own(7));
        return {ashikhminShirley(f, p.own(8), lobe, p.triple(kRowEta), p.triple(kRowK)),
                rootLanes(p.own(8)) * vf(0.5f / kPi) * lobe};
    }
    static AL_MEMBER Direction draw(const Given& p, const Pair<vf>& u) {
        const vf eu = p.own(6), ev = p.own(7);
        const Pair<vf> d = elliptic(u.b, rootLanes(ev + vf(1)), rootLanes(eu + vf(1)));
        const vf e = mad(eu * d.a, d.a, mad(ev * d.b, d.b, vf(1)));
        return withCosine(powLanes(vf(1) - u.a, vf(1) / e), d);
    }
};
struct BeckmannFacets {
    static constexpr const char* name = "cook-torrance";
    static constexpr const char* doc = "Facets with Beckmann's distribution of slopes.";
    static AL_MEMBER void prepare(const Rows& p) {
        const vf m = sane(p.number(kRowRoughness));
        p.own(6, m * m);
    }
    static AL_MEMBER FacetValue evaluate(const Given& p, const Facet<vf>& f, const Pair<Direction>&) {
        const vf d = beckmann(f, p.own(6));
        return {cookTorrance(f, d, p.triple(kRowEta), p.triple(kRowK)), d * f.nh};
    }
    static AL_MEMBER Direction draw(const Given& p, const Pair<vf>& u) {
        return fromSlope(-p.own(6) * logOfRest(u.a), unitCircle(u.b));
    }
};
struct WardFacets {
    static constexpr const char* name = "ward";
    static constexpr const char* doc = "Anisotropic Gaussian slopes; roughness along udir, roughnessv across.";
    static AL_MEMBER void prepare(const Rows& p) {
        p.own(6, sane(p.number(kRowRoughness))), p.own(7, sane(p.number(kRowRoughnessV)));
    }
    static AL_MEMBER FacetValue evaluate(const Given& p, const Facet<vf>& f, const Pair<Direction>& t) {
        const vf a = p.own(6), b = p.own(7), lobe = wardLobe(f, t, a, b), v = ward(f, lobe, a, b);
        return {{v, v, v}, divide(lobe * vf(1 / kPi), a * b * f.nh * f.nh * f.nh)};
    }
    static AL_MEMBER Direction draw(const Given& p, const Pair<vf>& u) {
        const vf a = p.own(6), b = p.own(7);
        const Pair<vf> d = elliptic(u.b, a, b);
        const vf x = d.a / a, y = d.b / b;
        return fromSlope(-logOfRest(u.a) / mad(x, x, y * y), d);
    }
};
using Blinn = FacetLobe<BlinnFacets>;
using AshikhminShirley = FacetLobe<AshikhminFacets>;
using CookTorrance = FacetLobe<BeckmannFacets>;
using Ward = FacetLobe<WardFacets>;

} // namespace alpenglow::transport::AL_NAMESPACE
