// bsdf(): "oren-nayar": rough diffuse surfaces (Oren and Nayar 1994, the qualitative model).
#pragma once
#include "shadeops/bsdf/common.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// l, n and o are unit.
template <class T> AL_INLINE T orenNayar(const Triple<T>& l, const Triple<T>& n, const Triple<T>& o, const T& roughness) {
    const T nl = dot(n, l), no = dot(n, o), s2 = roughness * roughness;
    const T a = vf(1) - divide(s2 * vf(0.5f), s2 + vf(0.33f)), b = divide(s2 * vf(0.45f), s2 + vf(0.09f));
    // cos(difference of azimuths) sin(alpha) tan(beta): the sines of both angles come out of l . o, one cosine is divided out.
    const T slant = divide(positive(dot(l, o) - nl * no), larger(nl, no));
    const vm seen = (value(nl) > 0) & (value(no) > 0);
    return select(seen, mad(b, slant, a) * nl * vf(1 / kPi), T(vf(0)));
}
template <class T> AL_INLINE T opBsdfOrenNayar(const Triple<T>& l, const Triple<T>& n, const Triple<T>& o, const T& roughness) {
    return orenNayar(normalize(l), normalize(n), normalize(o), roughness);
}
AL_RUNTIME(al_bsdf_orennayar, opBsdfOrenNayar)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
namespace alpenglow::shadeops {
inline Distribution bsdfOrenNayar() {
    return bsdfOp("oren-nayar", "float __bsdf_orennayar(vector l, vector n, vector wo; float roughness)", "al_bsdf_orennayar",
                  "n . l (A + B max(0, cos(dphi)) sin(a) tan(b)) / PI, s = roughness (radians, no upper limit), "
                  "A = 1 - 0.5 s^2 / (s^2 + 0.33), B = 0.45 s^2 / (s^2 + 0.09), a and b the larger and the smaller angle. "
                  "Roughness 0 is n . l / PI.",
                  "3Delight manual, 6.4.5.2; Oren and Nayar 1994",
                  {"__bsdf_orennayar(vector(0,0,1), vector(0,0,1), vector(0,0,1), 0)", "0.3183099"});
}
} // namespace alpenglow::shadeops
#endif
