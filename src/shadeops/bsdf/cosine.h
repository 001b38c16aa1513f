// bsdf(): "cosine": in proportion to the cosine with n, within a cone. With a cone of PI/2 an ideal diffuse surface.
#pragma once
#include "shadeops/bsdf/common.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

template <class T> AL_INLINE T opBsdfCosine(const Triple<T>& l, const Triple<T>& n, const T& cone) {
    const T c = larger(smaller(cone, T(vf(kPi / 2))), T(vf(0))), s = sine(c), nl = dot(normalize(n), normalize(l));
    const vm inside = (value(nl) >= value(cosine(c))) & (value(nl) > 0) & (value(cone) > 0);
    return select(inside, divide(nl * vf(1 / kPi), s * s), T(vf(0)));
}
AL_RUNTIME(al_bsdf_cosine, opBsdfCosine)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
inline Distribution bsdfCosine() {
    return bsdfOp("cosine", "float __bsdf_cosine(vector l, vector n; float cone)", "al_bsdf_cosine",
                  "n . l / (PI sin^2 cone) within the cone of half angle cone about n (at most PI/2), else 0; 0 for cone 0.",
                  "3Delight manual, 6.4.5.2", {"__bsdf_cosine(vector(0,0,1), vector(0,0,1), 2)", "0.3183099"});
}
} // namespace alpenglow::shadeops
#endif
