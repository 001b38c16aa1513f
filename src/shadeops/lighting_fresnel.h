// Fresnel's equation for surfaces of glass, as fresnel() and bsdf() use it.
#pragma once
#include "shadeops/call.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// Reflectance at a dielectric; c = cosine of the incident angle, eta = index before / index behind.
template <class T> AL_INLINE T dielectricReflectance(const T& c, const T& eta) {
    const T k = vf(1) - eta * eta * (vf(1) - c * c), cosT = root(k);
    const T s = divide(eta * c - cosT, eta * c + cosT), p = divide(eta * cosT - c, eta * cosT + c);
    return select(value(k) <= 0, T(vf(1)), smaller((s * s + p * p) * vf(0.5f), T(vf(1))));
}

} // namespace alpenglow::shadeops::AL_NAMESPACE
