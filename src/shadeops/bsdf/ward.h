// bsdf(): "ward": anisotropic Gaussian slopes (Ward 1992).
#pragma once
#include "shadeops/bsdf/common.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// exp(-tan^2 th (cos^2 ph / a^2 + sin^2 ph / b^2)), t the tangents, and the value that it gives.
template <class T> AL_INLINE T wardLobe(const Facet<T>& f, const Pair<Triple<T>>& t, const T& a, const T& b) {
    const T hu = divide(dot(f.h, t.a), a), hv = divide(dot(f.h, t.b), b);
    return exponential(-divide(mad(hu, hu, hv * hv), f.nh * f.nh));
}
template <class T> AL_INLINE T ward(const Facet<T>& f, const T& lobe, const T& a, const T& b) {
    const T r = divide(lobe * vf(0.25f / kPi), a * b) * root(positive(divide(f.nl, f.no)));
    return select(f.seen, r, T(vf(0)));
}
template <class T>
AL_INLINE T opBsdfWard(const Triple<T>& l, const Triple<T>& n, const Triple<T>& o, const Triple<T>& udir, const T& roughness,
                       const T& roughnessv) {
    const Facet<T> f = facetOf(l, n, o);
    const Pair<Triple<T>> t = tangents(f.n, udir);
    const T a = sane(roughness), b = sane(roughnessv);
    return ward(f, wardLobe(f, t, a, b), a, b);
}
AL_RUNTIME(al_bsdf_ward, opBsdfWard)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
inline Distribution bsdfWard() {
    return bsdfOp("ward", "float __bsdf_ward(vector l, vector n, vector wo, vector udir; float roughness, float roughnessv)",
                  "al_bsdf_ward",
                  "sqrt(n . l / n . wo) exp(-tan^2 th (cos^2 ph / a^2 + sin^2 ph / b^2)) / (4 PI a b), a = roughness along udir, "
                  "b = roughnessv.",
                  "3Delight manual, 6.4.5.2; Ward 1992",
                  {"__bsdf_ward(vector(0,0,1), vector(0,0,1), vector(0,0,1), vector(1,0,0), 0.5, 0.5)", "0.3183099"});
}
} // namespace alpenglow::shadeops
#endif
