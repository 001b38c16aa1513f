// What "ggx" and "beckmann" share: facets whose slopes are spread by one roughness along udir and another across, masked and
// shadowed by Smith's model at the heights of their points (Heitz, "Understanding the Masking-Shadowing Function in
// Microfacet-Based BRDFs", 2014).
#pragma once
#include "shadeops/bsdf/common.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// Squared length of w's part in the plane where facets of roughness a along and b across become round ones of roughness 1.
template <class T> AL_INLINE T stretched2(const Triple<T>& w, const Pair<Triple<T>>& t, const T& a, const T& b) {
    const T u = dot(w, t.a) * a, v = dot(w, t.b) * b;
    return mad(u, u, v * v);
}
/// d: density of facets; lambdas: the sum of Smith's functions of both directions. D G F / (4 n . wo), G = 1 / (1 + lambdas).
template <class T>
AL_INLINE Triple<T> smithReflection(const Facet<T>& f, const T& d, const T& lambdas, const Triple<T>& eta, const Triple<T>& k) {
    const T r = divide(d, (lambdas + vf(1)) * f.no * vf(4));
    return select3(f.seen, times(fresnelOrFull3(f.oh, eta, k), r), none3<T>());
}

/// Trowbridge and Reitz' density of facets.
template <class T> AL_INLINE T ggxFacets(const Facet<T>& f, const Pair<Triple<T>>& t, const T& a, const T& b) {
    const T hu = divide(dot(f.h, t.a), a), hv = divide(dot(f.h, t.b), b), q = mad(hu, hu, mad(hv, hv, f.nh * f.nh));
    return divide(T(vf(1 / kPi)), a * b * q * q);
}
/// Smith's function of a direction: s2 of stretched2(), c its cosine with the normal.
template <class T> AL_INLINE T ggxLambda(const T& s2, const T& c) { return (root(vf(1) + divide(s2, c * c)) - vf(1)) * vf(0.5f); }

/// Beckmann's density of facets.
template <class T> AL_INLINE T beckmannFacets(const Facet<T>& f, const Pair<Triple<T>>& t, const T& a, const T& b) {
    const T hu = divide(dot(f.h, t.a), a), hv = divide(dot(f.h, t.b), b), c2 = f.nh * f.nh;
    return divide(exponential(-divide(mad(hu, hu, hv * hv), c2)) * vf(1 / kPi), a * b * c2 * c2);
}
/// exp(x^2) (1 - erf x) for x >= 0, to 1.5e-7 exp(x^2) (Abramowitz and Stegun 7.1.26).
template <class T> AL_INLINE T scaledErfc(const T& x) {
    const T t = divide(T(vf(1)), mad(x, vf(0.3275911f), T(vf(1))));
    T r = mad(t, vf(1.061405429f), T(vf(-1.453152027f)));
    r = mad(r, t, T(vf(1.421413741f)));
    r = mad(r, t, T(vf(-0.284496736f)));
    return mad(r, t, T(vf(0.254829592f))) * t;
}
/// Smith's lambda for Beckmann's slopes; s2, c: stretched2() and cosine of the direction.
template <class T> AL_INLINE T beckmannLambda(const T& s2, const T& c) {
    const T x = divide(c, root(larger(s2, c * c * vf(1e-2f))));                               // 10: as good as straight on
    return exponential(-x * x) * (divide(T(vf(0.564189584f)), x) - scaledErfc(x)) * vf(0.5f); // 1 / sqrt(pi)
}

} // namespace alpenglow::shadeops::AL_NAMESPACE
