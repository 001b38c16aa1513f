// bsdf(): "ggx": reflection at facets with Trowbridge and Reitz' distribution of slopes (Walter et al. 2007).
#pragma once
#include "shadeops/bsdf/smith.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

template <class T>
AL_INLINE Triple<T> opBsdfGgx(const Triple<T>& l, const Triple<T>& n, const Triple<T>& o, const Triple<T>& udir,
                              const T& roughness, const T& roughnessv, const Triple<T>& eta, const Triple<T>& k) {
    const Facet<T> f = facetOf(l, n, o);
    const Pair<Triple<T>> t = tangents(f.n, udir);
    const T a = sane(roughness), b = sane(roughnessv);
    const T lambdas = ggxLambda(stretched2(f.o, t, a, b), f.no) + ggxLambda(stretched2(f.l, t, a, b), f.nl);
    return smithReflection(f, ggxFacets(f, t, a, b), lambdas, eta, k);
}
AL_RUNTIME(al_bsdf_ggx, opBsdfGgx)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
inline Distribution bsdfGgx() {
    return bsdfOp(
        "ggx",
        "color __bsdf_ggx(vector l, vector n, vector wo, vector udir; float roughness, float roughnessv; color eta, color k)",
        "al_bsdf_ggx",
        "D G F / (4 n . wo), D = 1 / (PI a b cos^4 th (1 + tan^2 th (cos^2 ph / a^2 + sin^2 ph / b^2))^2) with a = "
        "roughness along udir, b = roughnessv, G = 1 / (1 + A(l) + A(wo)), A(w) = (sqrt(1 + tan^2 th_w (a^2 cos^2 ph_w + b^2 "
        "sin^2 ph_w)) - 1) / 2, F by eta and k (eta 0: 1). For metals give \"eta\" two colours, index and extinction.",
        "Walter et al. 2007; G of heights: Heitz 2014",
        {"__bsdf_ggx(vector(0,0,1), vector(0,0,1), vector(0,0,1), vector(1,0,0), 1, 1, color(0,0,0), color(0,0,0))",
         "0.07957747 0.07957747 0.07957747"});
}
} // namespace alpenglow::shadeops
#endif
