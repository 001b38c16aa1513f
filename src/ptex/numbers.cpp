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

Face faceOf(const uint8_t* b) {
    Face f;
    f.ulog = b[0];
    f.vlog = b[1];
    f.constant = b[3] & 1;
    f.subface = b[3] & 8;
    for (size_t k = 0; k < 4; ++k) {
        f.edge[k] = b[2] >> (2 * k) & 3;
        f.adjacent[k] = int32_t(take<uint32_t>(b + 4 + 4 * k));
    }
    return f;
}

void addUp(size_t size, std::vector<uint8_t>& data) {
    if (size == 1)
        for (size_t i = 1; i < data.size(); ++i) data[i] = uint8_t(data[i] + data[i - 1]);
    if (size == 2)
        for (size_t i = 2; i < data.size(); i += 2) {
            const uint16_t v = uint16_t(take<uint16_t>(&data[i]) + take<uint16_t>(&data[i - 2]));
            data[i] = uint8_t(v), data[i + 1] = uint8_t(v >> 8);
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
