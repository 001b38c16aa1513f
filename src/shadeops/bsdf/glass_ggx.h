// bsdf(): "glass-ggx": reflection and refraction at facets with Trowbridge and Reitz' distribution of slopes (Walter et al. 2007).
#pragma once
#include "shadeops/bsdf/common.h"
#include "shadeops/lighting_fresnel.h"

namespace alpenglow::rsl::AL_NAMESPACE {

/// Smith's shadowing for one direction: a2 = (roughness w_u)^2 + (roughnessv w_v)^2, c its cosine with the normal.
template <class T> AL_INLINE T smithGgx(const T& a2, const T& c) { return divide(T(vf(2)), root(vf(1) + divide(a2, c * c)) + vf(1)); }

/// First the part reflected, then the part refracted. The viewer may be on either side of n; `eta` is the index behind n over that before it.
template <class T>
AL_INLINE Pair<T> opBsdfGlass(const Triple<T>& l0, const Triple<T>& n0, const Triple<T>& o0, const Triple<T>& udir, const T& roughness,
                              const T& roughnessv, const T& eta) {
    const Triple<T> l = normalize(l0), o = normalize(o0), front = normalize(n0);
    const vm inside = value(dot(front, o)) < 0;
    const Triple<T> n = select3(inside, -front, front);
    const T one = T(vf(1)), index = larger(eta, T(vf(kLeastRoughness)));
    const T here = select(inside, index, one), there = select(inside, one, index); // indices on the viewer's and the other side
    const T nl = dot(n, l), no = dot(n, o);
    const vm reflects = value(nl) > 0;
    const Triple<T> bent = mad3(o, here, times(l, there));
    Triple<T> h = normalize(select3(reflects, l + o, bent));
    h = select3(value(dot(n, h)) < 0, -h, h);
    const Pair<Triple<T>> t = tangents(n, udir);
    const T a = sane(roughness), b = sane(roughnessv);
    const auto slopes = [&](const Triple<T>& w) __attribute__((always_inline)) {
        const T u = dot(w, t.a) * a, v = dot(w, t.b) * b;
        return mad(u, u, v * v);
    };
    const T nh = dot(n, h), oh = dot(o, h), lh = dot(l, h), hu = divide(dot(h, t.a), a), hv = divide(dot(h, t.b), b);
    const T q = mad(hu, hu, mad(hv, hv, nh * nh));
    const T d = divide(T(vf(1 / kPi)), a * b * q * q);
    // A facet seen from behind neither reflects nor refracts.
    const vm facing = (value(oh) > 0) & (value(no) > 0) & (select(reflects, value(lh), -value(lh)) > 0);
    const T g = smithGgx(slopes(o), no) * smithGgx(slopes(l), nl);
    const T f = dielectricReflectance(smaller(oh, one), divide(here, there));
    const T reflected = divide(f * d * g, no * vf(4));
    const T s = mad(here, oh, there * lh);
    const T refracted = divide((vf(1) - f) * d * g * oh * -lh * there * there, no * s * s);
    const T zero = T(vf(0));
    return {select(facing & reflects, reflected, zero), select(facing & ~reflects & (value(nl) < 0), refracted, zero)};
}
template <class T>
AL_INLINE void opBsdfGlassParts(const Triple<T>& l, const Triple<T>& n, const Triple<T>& o, const Triple<T>& udir, const T& roughness, const T& roughnessv,
                                const T& eta, T& reflected, T& refracted) {
    const Pair<T> r = opBsdfGlass(l, n, o, udir, roughness, roughnessv, eta);
    reflected = r.a, refracted = r.b;
}
AL_RUNTIME(al_bsdf_glassggx, opBsdfGlassParts)

} // namespace alpenglow::rsl::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::rsl {
inline Shadeop bsdfGlass() {
    Shadeop op = bsdfOp("void __bsdf_glassggx(vector l, vector n, vector wo, vector udir; float roughness, float roughnessv, float eta; output float reflected, "
                        "output float refracted)",
                        "al_bsdf_glassggx",
                        "\"glass-ggx\": reflected: D G F / (4 n . wo) for light on the viewer's side; refracted: |l . h| (wo . h) nl^2 (1 - F) G D / (n . wo (no wo . h + nl "
                        "l . h)^2) for light on the other, no and nl the indices on the two sides. D of Trowbridge and Reitz with roughness as its width, G of Smith. "
                        "Refracted light is counted as energy, as Kt of fresnel() is: it has no factor for the change of solid angle.",
                        "seed; formula (k)", {"", ""});
    op.examples.clear();
    return op;
}
} // namespace alpenglow::rsl
#endif
