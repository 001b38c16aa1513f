// Numbers of binary RIB (RISpec 3.2, appendix C.2). Integers and fixed point numbers are signed.
#pragma once
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace alpenglow::ri {

/// From and to the byte order of binary RIB, highest byte first.
inline uint32_t fromBig(uint32_t v) { return std::endian::native == std::endian::little ? __builtin_bswap32(v) : v; }

/// Bytes of the longest number with its code.
constexpr size_t kNumberBytes = 9;

/// The number whose code is at p, which has kNumberBytes behind it. Null: another code; else where it ends.
inline const char* numberAt(const char* p, double& out) {
    const auto c = static_cast<unsigned char>(*p++);
    if (c >= 0200 && c <= 0217) {
        const unsigned w = c & 3, d = (c >> 2) & 3;
        uint32_t bits;
        std::memcpy(&bits, p, 4);
        const int32_t v = int32_t(fromBig(bits)) >> (8 * (3 - w));
        out = d == 0 ? double(v) : std::ldexp(double(v), -8 * int(d));
        return p + w + 1;
    }
    if (c == 0244) {
        uint32_t bits;
        std::memcpy(&bits, p, 4);
        out = double(std::bit_cast<float>(fromBig(bits)));
        return p + 4;
    }
    if (c == 0245) {
        uint64_t bits;
        std::memcpy(&bits, p, 8);
        out = std::bit_cast<double>(std::endian::native == std::endian::little ? __builtin_bswap64(bits) : bits);
        return p + 8;
    }
    return nullptr;
}

/// n floats of an array, which lie at p.
inline void floatsAt(const char* p, size_t n, double* to) {
    for (size_t i = 0; i < n; ++i) {
        uint32_t bits;
        std::memcpy(&bits, p + 4 * i, 4);
        to[i] = double(std::bit_cast<float>(fromBig(bits)));
    }
}

} // namespace alpenglow::ri
