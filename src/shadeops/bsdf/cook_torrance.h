// bsdf(): "cook-torrance": facets with Beckmann's distribution of slopes (Cook and Torrance 1982).
#pragma once
#include "shadeops/bsdf/common.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// Beckmann's density of slopes, m2 = roughness^2, and the value that it gives.
template <class T> AL_INLINE T beckmann(const Facet<T>& f, const T& m2) {
    const T c2 = f.nh * f.nh;
    return divide(exponential(-divide(f.sine2, c2 * m2)) * vf(1 / kPi), m2 * c2 * c2);
}
template <class T> AL_INLINE Triple<T> cookTorrance(const Facet<T>& f, const T& d, const Triple<T>& eta, const Triple<T>& k) {
    const T r = divide(d * grooves(f), f.no * vf(4));
    return select3(f.seen, times(fresnelOrFull3(f.oh, eta, k), r), none3<T>());
}
template <class T>
AL_INLINE Triple<T> opBsdfCookTorrance(const Triple<T>& l, const Triple<T>& n, const Triple<T>& o, const T& roughness,
                                       const Triple<T>& eta, const Triple<T>& k) {
    const Facet<T> f = facetOf(l, n, o);
    const T m = sane(roughness);
    return cookTorrance(f, beckmann(f, m * m), eta, k);
}
AL_RUNTIME(al_bsdf_cooktorrance, opBsdfCookTorrance)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
inline Distribution bsdfCookTorrance() {
    return bsdfOp("cook-torrance",
                  "color __bsdf_cooktorrance(vector l, vector n, vector wo; float roughness; color eta, color k)",
                  "al_bsdf_cooktorrance",
                  "D G F / (4 n . wo), D = exp(-tan^2 th / m^2) / (PI m^2 cos^4 th) with m = roughness, G and "
                  "F as for blinn.",
                  "3Delight manual, 6.4.5.2; Cook and Torrance 1982",
                  {"__bsdf_cooktorrance(vector(0,0,1), vector(0,0,1), vector(0,0,1), 1, color(0,0,0), color(0,0,0))",
                   "0.07957747 0.07957747 0.07957747"});
}
} // namespace alpenglow::shadeops
#endif
