// bsdf(): "uniform": the same for every direction within a cone about n.
#pragma once
#include "shadeops/bsdf/common.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

template <class T> AL_INLINE T opBsdfUniform(const Triple<T>& l, const Triple<T>& n, const T& cone) {
    const T limit = cosine(larger(smaller(cone, T(vf(kPi))), T(vf(0))));
    const vm inside = (value(dot(normalize(n), normalize(l))) >= value(limit)) & (value(cone) > 0);
    return select(inside, divide(T(vf(0.5f / kPi)), vf(1) - limit), T(vf(0)));
}
AL_RUNTIME(al_bsdf_uniform, opBsdfUniform)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
inline Distribution bsdfUniform() {
    return bsdfOp("uniform", "float __bsdf_uniform(vector l, vector n; float cone)", "al_bsdf_uniform",
                  "1 / (2 PI (1 - cos cone)) within the cone of half angle cone about n, else 0; 0 for cone 0, "
                  "which is one direction.",
                  "3Delight manual, 6.4.5.2", {"__bsdf_uniform(vector(0,0,1), vector(0,0,1), 1.6)", "0.1546395"});
}
} // namespace alpenglow::shadeops
#endif
