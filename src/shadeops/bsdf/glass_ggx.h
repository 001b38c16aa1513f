// bsdf(): "glass-ggx": reflection and refraction at facets with Trowbridge and Reitz' distribution of slopes (Walter et al.
// 2007).
#pragma once
#include "shadeops/bsdf/common.h"
#include "shadeops/lighting_fresnel.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// Smith's shadowing for one direction: a2 = (roughness w_u)^2 + (roughnessv w_v)^2, c its cosine with the normal.
template <class T> AL_INLINE T smithGgx(const T& a2, const T& c) {
    return divide(T(vf(2)), root(vf(1) + divide(a2, c * c)) + vf(1));
}

/// Index of refraction of a call that gives none.
inline constexpr float kGlassEta = 1.5f;

/// A surface of glass as the viewer sees it.
template <class T> struct GlassSide {
    Triple<T> o, n;    ///< unit; n on the viewer's side
    Pair<Triple<T>> t; ///< tangents
    T here, there;     ///< indices on the viewer's and the other side
    T a, b;            ///< roughness along and across
};
/// `front` and o are unit; `eta` is the index behind `front` over that before it.
template <class T>
AL_INLINE GlassSide<T> glassSide(const Triple<T>& front, const Triple<T>& o, const Triple<T>& udir, const T& roughness,
                                 const T& roughnessv, const T& eta) {
    const vm inside = value(dot(front, o)) < 0;
    const Triple<T> n = select3(inside, -front, front);
    // Facets between equal indices have no normal: a way straight on has all. An index next to it bends by as good as nothing.
    const T one = T(vf(1)), given = larger(eta, T(vf(kLeastRoughness)));
    const T index = select(absLanes(value(given) - vf(1)) < vf(1e-3f), T(vf(1.001f)), given);
    const T here = select(inside, index, one), there = select(inside, one, index);
    return {o, n, tangents(n, udir), here, there, sane(roughness), sane(roughnessv)};
}
/// The values; the density by solid angle of l of the facets that the viewer sees, as far as the choice between the two leaves
/// it; and what such a facet reflects.
template <class T> struct GlassValue {
    T reflected, refracted, density, fresnel; ///< f cos for l above and below; per solid angle; 0 to 1
    vm reflects;
};
/// First the part reflected, then the part refracted. The viewer may be on either side of n. l is unit.
template <class T> AL_INLINE GlassValue<T> glassValue(const GlassSide<T>& side, const Triple<T>& l) {
    const Triple<T>&o = side.o, &n = side.n;
    const T one = T(vf(1)), &here = side.here, &there = side.there;
    const T nl = dot(n, l), no = dot(n, o);
    const vm reflects = value(nl) > 0;
    const Triple<T> bent = mad3(o, here, times(l, there));
    Triple<T> h = normalize(select3(reflects, l + o, bent));
    h = select3(value(dot(n, h)) < 0, -h, h);
    const Pair<Triple<T>>& t = side.t;
    const T &a = side.a, &b = side.b;
    const auto slopes = [&](const Triple<T>& w) __attribute__((always_inline)) {
        const T u = dot(w, t.a) * a, v = dot(w, t.b) * b;
        return mad(u, u, v * v);
    };
    const T nh = dot(n, h), oh = dot(o, h), lh = dot(l, h), hu = divide(dot(h, t.a), a), hv = divide(dot(h, t.b), b);
    const T q = mad(hu, hu, mad(hv, hv, nh * nh));
    const T d = divide(T(vf(1 / kPi)), a * b * q * q);
    // A facet seen from behind neither reflects nor refracts.
    const vm met = (value(oh) > 0) & (select(reflects, value(lh), -value(lh)) > 0), facing = met & (value(no) > 0);
    const T masked = smithGgx(slopes(o), no), g = masked * smithGgx(slopes(l), nl);
    const T f = dielectricReflectance(smaller(oh, one), divide(here, there));
    const T reflected = divide(f * d * g, no * vf(4));
    const T s = mad(here, oh, there * lh);
    const T refracted = divide((vf(1) - f) * d * g * oh * -lh * there * there, no * s * s);
    const T zero = T(vf(0));
    const T visible = divide(d * masked, no);
    const T density = select(reflects, visible * vf(0.25f), divide(visible * oh * -lh * there * there, s * s));
    return {select(facing & reflects, reflected, zero), select(facing & ~reflects & (value(nl) < 0), refracted, zero),
            select(facing, density, zero), f, reflects};
}
template <class T>
AL_INLINE void opBsdfGlassParts(const Triple<T>& l, const Triple<T>& n, const Triple<T>& o, const Triple<T>& udir,
                                const T& roughness, const T& roughnessv, const T& eta, T& reflected, T& refracted) {
    const GlassValue<T> r = glassValue(glassSide(normalize(n), normalize(o), udir, roughness, roughnessv, eta), normalize(l));
    reflected = r.reflected, refracted = r.refracted;
}
AL_RUNTIME(al_bsdf_glassggx, opBsdfGlassParts)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
inline Distribution bsdfGlass() {
    Distribution d =
        bsdfOp("glass-ggx",
               "void __bsdf_glassggx(vector l, vector n, vector wo, vector udir; float roughness, float roughnessv, float eta; "
               "output float reflected, "
               "output float refracted)",
               "al_bsdf_glassggx",
               "reflected: D G F / (4 n . wo) for light on the viewer's side; refracted: |l . h| (wo . h) nl^2 (1 "
               "- F) G D / (n . wo (no wo . h + nl "
               "l . h)^2) for light on the other, no and nl the indices on the two sides. D of Trowbridge and Reitz with "
               "roughness as its width, G of Smith. "
               "Refracted light is counted as energy, as Kt of fresnel() is: it has no factor for the change of solid angle.",
               "3Delight manual, 6.4.5.2; Walter et al. 2007", {"", ""});
    d.eta = AL_NAMESPACE::kGlassEta;
    d.parts = 2;
    return d;
}
} // namespace alpenglow::shadeops
#endif
