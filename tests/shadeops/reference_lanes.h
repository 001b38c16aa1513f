// Stands in for shadeops/lanes.h in jets_test.cpp: the same templates over double, elementary functions from the C library,
// written with the edge rules of 3Delight manual, 6.4.1. An independent reference for values, and smooth enough to difference.
#pragma once
#include <cmath>
#include <cstring>
#define AL_NAMESPACE reference
#define AL_INLINE static inline __attribute__((unused))
#define AL_MEMBER inline

namespace alpenglow::shadeops::AL_NAMESPACE {

typedef double vf __attribute__((ext_vector_type(4)));
typedef int vi __attribute__((ext_vector_type(4)));
typedef unsigned vu __attribute__((ext_vector_type(4)));
typedef long vm __attribute__((ext_vector_type(4)));

inline constexpr double kPi = 3.14159265358979323846, kLog2e = 1.44269504088896340736;

template <class F> inline vf map(vf x, F f) { return vf{f(x[0]), f(x[1]), f(x[2]), f(x[3])}; }
template <class F> inline vf map2(vf x, vf y, F f) { return vf{f(x[0], y[0]), f(x[1], y[1]), f(x[2], y[2]), f(x[3], y[3])}; }

inline vf select(vm m, vf a, vf b) { return m ? a : b; }
inline vm maskOf(vi m) { return __builtin_convertvector(m, vm); }
inline vu bitsForFlip(vm m) { return __builtin_convertvector(m, vu); }
inline vf mad(vf a, vf b, vf c) { return a * b + c; }
inline vf floorLanes(vf x) { return __builtin_elementwise_floor(x); }
inline vf ceilLanes(vf x) { return __builtin_elementwise_ceil(x); }
inline vf truncLanes(vf x) { return __builtin_elementwise_trunc(x); }
inline vf absLanes(vf x) { return __builtin_elementwise_abs(x); }
inline vf minLanes(vf a, vf b) { return a < b ? a : b; }
inline vf maxLanes(vf a, vf b) { return a > b ? a : b; }
inline vf rootLanes(vf x) { return __builtin_elementwise_sqrt(x); }
inline vf flipSign(vf x, vu bits) { return select(maskOf(__builtin_bit_cast(vi, bits) < 0), -x, x); }
inline vf copySign(vf x, vf s) {
    return map2(x, s, [](double a, double b) { return std::copysign(a, b); });
}
inline vi toInt(vf x) { return __builtin_convertvector(x, vi); }
inline vf unitReal(vu h) { return __builtin_convertvector(h >> 8, vf) * 0x1p-24; }
inline vf signedSlope(vu h) {
    const vu bits = (h & 0x807fffffu) | 0x3f000000u;
    vf r;
    for (int i = 0; i < 4; ++i) {
        const unsigned b = bits[i];
        float f;
        std::memcpy(&f, &b, sizeof f);
        r[i] = f;
    }
    return r;
}
inline vu payload(vf x) { return __builtin_convertvector(x, vu); }

inline vf sinLanes(vf x) {
    return map(x, [](double a) { return std::sin(a); });
}
inline vf cosLanes(vf x) {
    return map(x, [](double a) { return std::cos(a); });
}
inline vf tanLanes(vf x) {
    return map(x, [](double a) { return std::tan(a); });
}
inline vf asinLanes(vf x) {
    return map(x, [](double a) { return std::asin(std::fmin(std::fmax(a, -1), 1)); });
}
inline vf acosLanes(vf x) {
    return map(x, [](double a) { return std::acos(std::fmin(std::fmax(a, -1), 1)); });
}
inline vf atanLanes(vf x) {
    return map(x, [](double a) { return std::atan(a); });
}
inline vf atan2Lanes(vf y, vf x) {
    return map2(y, x, [](double a, double b) { return std::atan2(a, b + 0.0); });
}
inline vf expLanes(vf x) {
    return map(x, [](double a) { return std::exp(a); });
}
inline vf logLanes(vf x) {
    return map(x, [](double a) { return a > 0 ? std::log(a) : -INFINITY; });
}
inline vf log2Lanes(vf x) {
    return map(x, [](double a) { return a > 0 ? std::log2(a) : -INFINITY; });
}
inline vf powLanes(vf x, vf y) {
    return map2(x, y, [](double a, double b) { return a < 0 && b != std::floor(b) ? 0.0 : std::pow(a, b); });
}

} // namespace alpenglow::shadeops::AL_NAMESPACE
