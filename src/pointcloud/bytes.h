// Little-endian numbers in files, whatever the machine.
#pragma once
#include "base/vec.h"
#include <bit>
#include <cstdint>
#include <span>
#include <vector>
#include <zlib.h>

namespace alpenglow::pointcloud {

/// Appends an unsigned integer.
template <class T> void putNumber(std::vector<uint8_t>& to, T v) {
    for (size_t i = 0; i < sizeof(T); ++i) to.push_back(uint8_t(v >> (8 * i)));
}
/// Reads an unsigned integer of sizeof(T) bytes.
template <class T> T takeNumber(const uint8_t* from) {
    T v = 0;
    for (size_t i = 0; i < sizeof(T); ++i) v = T(v | T(from[i]) << (8 * i));
    return v;
}
/// The same for a float and for three.
inline void putFloat(std::vector<uint8_t>& to, float f) { putNumber(to, std::bit_cast<uint32_t>(f)); }
inline float takeFloat(const uint8_t* from) { return std::bit_cast<float>(takeNumber<uint32_t>(from)); }
inline void putVec(std::vector<uint8_t>& to, const Vec3& v) {
    for (int k = 0; k < 3; ++k) putFloat(to, v[k]);
}
inline Vec3 takeVec(const uint8_t* from) { return {takeFloat(from), takeFloat(from + 4), takeFloat(from + 8)}; }

/// CRC-32 of any length.
inline uint32_t checksum(std::span<const uint8_t> bytes, uint32_t before = 0) {
    uLong crc = before;
    for (size_t at = 0; at < bytes.size(); at += size_t(1) << 30)
        crc = crc32(crc, bytes.data() + at, uInt(std::min(bytes.size() - at, size_t(1) << 30)));
    return uint32_t(crc);
}

} // namespace alpenglow::pointcloud
