// bsdf(): "ashikhmin-shirley": anisotropic facets (Ashikhmin and Shirley 2000), the specular part.
#pragma once
#include "shadeops/bsdf/common.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// (n . h)^(eu cos^2 ph + ev sin^2 ph), t the tangents, and the value that it gives; both = (eu + 1)(ev + 1).
template <class T> AL_INLINE T ashikhminLobe(const Facet<T>& f, const Pair<Triple<T>>& t, const T& eu, const T& ev) {
    const T hu = dot(f.h, t.a), hv = dot(f.h, t.b);
    return exponential(mad(eu * hu, hu, ev * hv * hv) * logRatio(f.sine2) * vf(-0.5f));
}
template <class T>
AL_INLINE Triple<T> ashikhminShirley(const Facet<T>& f, const T& both, const T& lobe, const Triple<T>& eta, const Triple<T>& k) {
    const T scale = root(both) * vf(0.125f / kPi);
    const T r = divide(scale * lobe * f.nl, f.oh * larger(f.nl, f.no));
    return select3(f.seen, times(fresnelOrFull3(f.oh, eta, k), r), none3<T>());
}
template <class T>
AL_INLINE Triple<T> opBsdfAshikhminShirley(const Triple<T>& l, const Triple<T>& n, const Triple<T>& o, const Triple<T>& udir,
                                           const T& roughness, const T& roughnessv, const Triple<T>& eta, const Triple<T>& k) {
    const Facet<T> f = facetOf(l, n, o);
    const Pair<Triple<T>> t = tangents(f.n, udir);
    const T eu = exponentOf(roughness), ev = exponentOf(roughnessv);
    return ashikhminShirley(f, (eu + vf(1)) * (ev + vf(1)), ashikhminLobe(f, t, eu, ev), eta, k);
}
AL_RUNTIME(al_bsdf_ashikhminshirley, opBsdfAshikhminShirley)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
inline Distribution bsdfAshikhminShirley() {
    return bsdfOp(
        "ashikhmin-shirley",
        "color __bsdf_ashikhminshirley(vector l, vector n, vector wo, vector udir; float roughness, float roughnessv; color eta, "
        "color k)",
        "al_bsdf_ashikhminshirley",
        "n . l sqrt((eu + 1)(ev + 1)) / (8 PI) (n . h)^(eu cos^2 ph + ev sin^2 ph) F / (h . l max(n . l, "
        "n . wo)), exponents as "
        "for blinn, ph the angle between h and udir on the surface.",
        "3Delight manual, 6.4.5.2 (exponents); Ashikhmin and Shirley 2000",
        {"__bsdf_ashikhminshirley(vector(0,0,1), vector(0,0,1), vector(0,0,1), vector(1,0,0), 1, 1, color(1,1,1), color(0,0,0))",
         "0 0 0"});
}
} // namespace alpenglow::shadeops
#endif
