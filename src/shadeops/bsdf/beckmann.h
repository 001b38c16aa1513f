// bsdf(): "beckmann": reflection at facets with a Gaussian distribution of slopes.
#pragma once
#include "shadeops/bsdf/smith.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

template <class T>
AL_INLINE Triple<T> opBsdfBeckmann(const Triple<T>& l, const Triple<T>& n, const Triple<T>& o, const Triple<T>& udir,
                                   const T& roughness, const T& roughnessv, const Triple<T>& eta, const Triple<T>& k) {
    const Facet<T> f = facetOf(l, n, o);
    const Pair<Triple<T>> t = tangents(f.n, udir);
    const T a = sane(roughness), b = sane(roughnessv);
    const T lambdas = beckmannLambda(stretched2(f.o, t, a, b), f.no) + beckmannLambda(stretched2(f.l, t, a, b), f.nl);
    return smithReflection(f, beckmannFacets(f, t, a, b), lambdas, eta, k);
}
AL_RUNTIME(al_bsdf_beckmann, opBsdfBeckmann)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
inline Distribution bsdfBeckmann() {
    return bsdfOp(
        "beckmann",
        "color __bsdf_beckmann(vector l, vector n, vector wo, vector udir; float roughness, float roughnessv; color eta, color "
        "k)",
        "al_bsdf_beckmann",
        "as ggx, with D = exp(-tan^2 th (cos^2 ph / a^2 + sin^2 ph / b^2)) / (PI a b cos^4 th) and A(w) = "
        "(exp(-x^2) "
        "/ (x sqrt(PI)) - erfc(x)) / 2, 1 / x^2 = tan^2 th_w (a^2 cos^2 ph_w + b^2 sin^2 ph_w). cook-torrance has the same D "
        "with "
        "one roughness, and grooves for G.",
        "Walter et al. 2007; G of heights: Heitz 2014",
        {"__bsdf_beckmann(vector(0,0,1), vector(0,0,1), vector(0,0,1), vector(1,0,0), 1, 1, color(0,0,0), color(0,0,0))",
         "0.07957747 0.07957747 0.07957747"});
}
} // namespace alpenglow::shadeops
#endif
