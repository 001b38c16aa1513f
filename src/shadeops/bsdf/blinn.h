// bsdf(): "blinn": facets whose slopes follow a power of the cosine (Blinn 1977).
#pragma once
#include "shadeops/bsdf/common.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// (n . h)^e, e the exponent, and the value that it gives.
template <class T> AL_INLINE T blinnLobe(const Facet<T>& f, const T& e) {
    return exponential(e * f.sine2 * logRatio(f.sine2) * vf(-0.5f));
}
template <class T>
AL_INLINE Triple<T> blinn(const Facet<T>& f, const T& e, const T& lobe, const Triple<T>& eta, const Triple<T>& k) {
    const T d = lobe * (e + vf(2)) * vf(0.5f / kPi);
    const T r = divide(d * grooves(f), f.no * vf(4));
    return select3(f.seen, times(fresnelOrFull3(f.oh, eta, k), r), none3<T>());
}
template <class T>
AL_INLINE Triple<T> opBsdfBlinn(const Triple<T>& l, const Triple<T>& n, const Triple<T>& o, const T& roughness,
                                const Triple<T>& eta, const Triple<T>& k) {
    const Facet<T> f = facetOf(l, n, o);
    const T e = exponentOf(roughness);
    return blinn(f, e, blinnLobe(f, e), eta, k);
}
AL_RUNTIME(al_bsdf_blinn, opBsdfBlinn)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
inline Distribution bsdfBlinn() {
    return bsdfOp("blinn", "color __bsdf_blinn(vector l, vector n, vector wo; float roughness; color eta, color k)",
                  "al_bsdf_blinn",
                  "D G F / (4 n . wo), e = roughness^-3.5 - 1, D = (e + 2) / (2 PI) (n . h)^e, G of V-shaped grooves, "
                  "F by eta and k (eta 0: 1).",
                  "3Delight manual, 6.4.5.2 (exponent); Blinn 1977",
                  {"__bsdf_blinn(vector(0,0,1), vector(0,0,1), vector(0,0,1), 1, color(0,0,0), color(0,0,0))",
                   "0.07957747 0.07957747 0.07957747"});
}
} // namespace alpenglow::shadeops
#endif
