#include "ptex/numbers.h"
#include "base/half.h"
#include <algorithm>

namespace alpenglow::ptex {

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
