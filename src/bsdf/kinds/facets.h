// What lobes of microfacet reflection share. axis = normal. Samples a facet and takes the direction that it
// mirrors to wo; directions below the surface are lost.
#pragma once
#include "bsdf/kinds/lobe.h"
#include "shadeops/bsdf/common.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// Footprint of rays reflected by rough facets.
AL_INLINE vf spreadOfRoughness(const Given& p) {
    return minLanes(vf(0.7f), sane(minLanes(p.number(kRowRoughness), p.number(kRowRoughnessV))));
}
/// Azimuth whose tangent is second / first times that of 2 pi u.
AL_INLINE Pair<vf> elliptic(vf u, vf first, vf second) {
    const Pair<vf> c = unitCircle(u);
    const vf x = c.a * first, y = c.b * second, l = vf(1) / rootLanes(mad(x, x, y * y));
    return {x * l, y * l};
}
/// log(1 - u), finite for u = 1.
AL_INLINE vf logOfRest(vf u) { return logLanes(maxLanes(vf(1) - u, vf(1e-30f))); }

/// Value of facets: colour, and density of the half vector h per solid angle of h.
struct FacetValue {
    Direction colour;
    vf density;
};

/// Random number within one of many equal sectors of a circle: as good as an independent number if the integrand varies little
/// between sectors.
AL_INLINE vf withinTurn(vf u) {
    const vf x = u * vf(4093);
    return x - floorLanes(x);
}

/// About what facets reflect by Fresnel's law, for choosing between lobes: at the cosine that their mean facet has with the
/// viewer (a fit for facets of Trowbridge and Reitz). Never 0.
AL_INLINE vf reflectanceOfFacets(const Given& p) {
    const vf a = minLanes(vf(1), rootLanes(sane(p.number(kRowRoughness)) * sane(p.number(kRowRoughnessV))));
    const vf least = rootLanes(a) * vf(.5f), c = mad(absLanes(dot(p.axis(), p.wo())), vf(1) - a * vf(.13f) - least, least);
    const Direction f = fresnelOrFull3(minLanes(c, vf(1)), p.triple(kRowEta), p.triple(kRowK));
    return maxLanes((f.x + f.y + f.z) * vf(1 / 3.f), vf(.02f));
}

/// Facets draws half vectors about +z, x along udir, in rows of its own from 6 on; 0 to 5 are the tangents. `o`: wo in these
/// axes.
template <class Facets> struct FacetLobe {
    static constexpr const char* name = Facets::name;
    static constexpr const char* doc = Facets::doc;
    static constexpr bool distribution = true;
    static constexpr int needs = kNeedsWo | kNeedsHorizon | kNeedsSurface;
    static constexpr int traits = kCosineOfAxis | kSameFromBoth;
    /// The axes along and across udir.
    static AL_MEMBER Pair<Direction> tangentsOf(const Given& p) { return {p.ownTriple(0), p.ownTriple(3)}; }
    static AL_MEMBER void prepare(const Rows& p) {
        p.common(Facets::kFresnel ? reflectanceOfFacets(p) : vf(1), spreadOfRoughness(p), vf(0));
        const Pair<Direction> t = tangents(p.axis(), p.triple(kRowUdir));
        p.own(0, t.a), p.own(3, t.b);
        Facets::prepare(p);
    }
    static AL_MEMBER Value evaluate(const Given& p, const Direction& w) {
        const Facet<vf> f = facetOfUnit(w, p.axis(), p.wo());
        const FacetValue v = Facets::evaluate(p, f, tangentsOf(p));
        const vm drawn = (f.nl > 0) & (f.no > 0) & (f.oh > 1e-6f) & (f.nh > 1e-6f);
        return {select3(aboveHorizon(p, w), v.colour, none3<vf>()), where(drawn, divide(v.density, f.oh * vf(4)))};
    }
    static AL_MEMBER vm sample(const Given& p, const Pair<vf>& u, Direction& w) {
        const Basis axes{p.ownTriple(0), p.ownTriple(3), p.axis()};
        const Direction o{dot(axes.t, p.wo()), dot(axes.u, p.wo()), dot(axes.n, p.wo())};
        const Direction h = toWorld(axes, Facets::draw(p, u, o));
        const vf oh = dot(p.wo(), h);
        w = normalize(mad3(h, oh * vf(2), -p.wo()));
        return (o.z > 0) & (oh > 1e-6f) & (dot(p.axis(), w) > 0) & aboveHorizon(p, w);
    }
};

/// Azimuth (cosine and sine) of a facet of given slope relative to the viewer, where one of two opposite facets is chosen by
/// visible area: (1 + k cos) / 2 clamped to [0, 1], with k the product of the tangents of facet and viewer. Inverts the
/// distribution, which preserves stratification of u, by Newton steps on a convex function. From the dark end on, at angle t:
/// (1 - k) t + k (t - sin t) for k <= 1, else t - sin t + sqrt(k^2 - 1) (1 - cos t).
AL_INLINE Pair<vf> seenInGroove(vf k, vf u) {
    const vf y = mad(u, vf(2), vf(-1)), rest = (vf(1) - absLanes(y)) * vf(kPi);
    const vf alone = acosLanes(vf(1) / maxLanes(k, vf(1))); // so far the other facet is not visible at all
    const vf end = vf(kPi) - alone * vf(2);
    const vf a = maxLanes(vf(1) - k, vf(0)), b = minLanes(k, vf(1)), s = rootOf(mad(k, k, vf(-1)));
    const vf tiny = vf(1e-20f), third = powLanes(rest * vf(6) / maxLanes(b, tiny), vf(1 / 3.f));
    vf t = minLanes(minLanes(rest / maxLanes(a, tiny), rootLanes(rest * vf(2) / maxLanes(s, tiny))), minLanes(third, end));
    for (int step = 0; step < 4; ++step) {
        const Pair<vf> half = unitCircle(t * vf(.25f / kPi));
        const vf sine = half.a * half.b * vf(2), rise = half.b * half.b * vf(2); // 1 - cos t
        const vf value = mad(a, t, mad(b, t - sine, s * rise)) - rest, slope = mad(b, rise, mad(s, sine, a));
        t = minLanes(maxLanes(t - value / maxLanes(slope, tiny), vf(0)), end);
    }
    const vf turned = select(rest > end, absLanes(y) * vf(.5f * kPi), vf(kPi) - alone - t);
    const Pair<vf> c = unitCircle(turned * vf(.5f / kPi));
    return {c.a, copySign(c.b, y)};
}
/// The visible side of a V-groove (Heitz and d'Eon, "Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible
/// Normals", 2014) with facets as steep as h, which lies over x. Values then do not exceed densities. dn: density of facets times
/// n . h, by which they are sampled.
AL_INLINE Direction visibleInGroove(const Direction& h, const Direction& o, vf u) {
    const vf flat = rootLanes(mad(o.x, o.x, o.y * o.y)), per = vf(1) / maxLanes(flat, vf(1e-30f));
    const vf x = select(flat > 0, o.x * per, vf(1)), y = o.y * per;
    const vf k = minLanes(h.x * flat / maxLanes(h.z * o.z, vf(1e-20f)), vf(1e6f));
    const Pair<vf> d = seenInGroove(k, u);
    return {h.x * mad(x, d.a, -y * d.b), h.x * mad(y, d.a, x * d.b), h.z};
}
AL_INLINE vf visibleInGroove(const Facet<vf>& f, vf dn) { return minLanes(divide(dn * f.oh, f.nh * f.no), dn * vf(2)); }

} // namespace alpenglow::bsdf::AL_NAMESPACE
