#include "ptex/numbers.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::ptex {

namespace {

float ofHalf(uint16_t h) {
    const uint32_t sign = uint32_t(h & 0x8000) << 16, exponent = h >> 10 & 31, fraction = h & 1023;
    if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000u | fraction << 13);
    if (exponent == 0) return std::bit_cast<float>(sign | std::bit_cast<uint32_t>(float(fraction) * 0x1p-24f));
    return std::bit_cast<float>(sign | (exponent + 112) << 23 | fraction << 13);
}

/// To the nearest, ties to even.
uint16_t toHalf(float f) {
    const uint32_t bits = std::bit_cast<uint32_t>(f), sign = bits >> 16 & 0x8000;
    const float a = std::fabs(f);
    if (!(a < 65520.f)) return uint16_t(sign | (std::isnan(f) ? 0x7e00 : 0x7c00));
    if (a < 0x1p-14f) return uint16_t(sign | uint32_t(std::nearbyint(a * 0x1p24f)));
    const uint32_t m = (bits & 0x7fffffff) - (112u << 23);
    return uint16_t(sign | ((m + 0xfff + (m >> 13 & 1)) >> 13));
}

} // namespace

float toFloat(Number n, const uint8_t* from) {
    switch (n) {
    case Number::Byte:
        return float(*from) / 255;
    case Number::Word:
        return float(take<uint16_t>(from)) / 65535;
    case Number::Half:
        return ofHalf(take<uint16_t>(from));
    default:
        return std::bit_cast<float>(take<uint32_t>(from));
    }
}

void fromFloat(Number n, float f, std::vector<uint8_t>& to) {
    const auto whole = [&](float most) { return uint32_t(std::clamp(f > 0 ? f : 0.f, 0.f, 1.f) * most + .5f); };
    switch (n) {
    case Number::Byte:
        return put(to, uint8_t(whole(255)));
    case Number::Word:
        return put(to, uint16_t(whole(65535)));
    case Number::Half:
        return put(to, toHalf(f));
    default:
        return put(to, std::bit_cast<uint32_t>(f));
    }
}

bool inflated(std::span<const uint8_t> from, size_t size, std::vector<uint8_t>& to) {
    if (size > mostInflated(from.size())) return false;
    to.resize(size);
    uLongf got = uLongf(size);
    uint8_t none = 0;
    return uncompress(size ? to.data() : &none, &got, from.data(), uLong(from.size())) == Z_OK && got == size;
}

std::vector<uint8_t> deflated(std::span<const uint8_t> from) {
    uLongf size = compressBound(uLong(from.size()));
    std::vector<uint8_t> to(size);
    compress2(to.data(), &size, from.data(), uLong(from.size()), 6);
    to.resize(size);
    return to;
}

} // namespace alpenglow::ptex
