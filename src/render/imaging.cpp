#include "render/imaging.h"
#include "base/exact.h"
#include "base/hash.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::render {

float expose(float v, float gain, float gamma) {
    v *= gain;
    if (gamma == 1 || !(gamma > 0)) return v;
    return std::copysign(float(exact::pow(double(std::fabs(v)), 1.0 / double(gamma))), v);
}

Color expose(Color c, float gain, float gamma) {
    return {expose(c.x, gain, gamma), expose(c.y, gain, gamma), expose(c.z, gain, gamma)};
}

double ditherValue(uint64_t seed, int x, int y, int channel) {
    uint64_t h = mix64(mix64(seed ^ (uint64_t(uint32_t(x)) << 32 | uint32_t(y))) + uint64_t(uint32_t(channel)));
    return double(h >> 11) * 0x1p-52 - 1;
}

double quantize(double v, const QuantizeRule& q, uint64_t seed, int x, int y, int channel) {
    if (q.floating()) return v;
    double d = q.dither != 0 ? q.dither * ditherValue(seed, x, y, channel) : 0;
    double r = std::nearbyint(q.zero + v * (q.one - q.zero) + d);
    if (!(r >= q.min)) return q.min;
    return std::min(r, q.max);
}

Color clampSample(Color c, float limit) {
    float m = maxComponent(c);
    return limit > 0 && m > limit ? c * (limit / m) : c;
}

} // namespace alpenglow::render
