// Photons: light of a scene stored at points of surfaces.
#pragma once
#include "base/vec.h"
#include <algorithm>
#include <cstdint>

namespace alpenglow::photonmap {

/// Packs a unit vector into 32 bits, 16 for each coordinate of the octahedral map (Meyer and others, "On Floating-Point Normal
/// Vectors", 2010). Error below 5e-5 radians.
inline uint32_t packUnit(const Vec3& v) {
    const float sum = std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
    float x = sum > 0 ? v.x / sum : 0, y = sum > 0 ? v.y / sum : 0;
    if (v.z < 0) {
        const float fx = (1 - std::fabs(y)) * (x < 0 ? -1.f : 1.f), fy = (1 - std::fabs(x)) * (y < 0 ? -1.f : 1.f);
        x = fx, y = fy;
    }
    const auto bits = [](float c) { return uint32_t(int(std::clamp(c, -1.f, 1.f) * 32767 + (c < 0 ? -.5f : .5f)) + 32767); };
    return bits(x) << 16 | bits(y);
}
/// The reverse.
inline Vec3 unpackUnit(uint32_t u) {
    float x = (float(u >> 16) - 32767) / 32767, y = (float(u & 0xffffu) - 32767) / 32767;
    const float z = 1 - std::fabs(x) - std::fabs(y);
    if (z < 0) {
        const float fx = (1 - std::fabs(y)) * (x < 0 ? -1.f : 1.f), fy = (1 - std::fabs(x)) * (y < 0 ? -1.f : 1.f);
        x = fx, y = fy;
    }
    return normalize(Vec3(x, y, z));
}

/// A photon in 36 bytes. Camera space in memory, world space in files.
struct Photon {
    Vec3 P;              ///< position
    Color power;         ///< fraction of the light's power: all photons of an emission sum to the power of the lights
    uint32_t from = 0;   ///< packUnit(): unit, toward its origin
    uint32_t normal = 0; ///< packUnit(): surface normal on the side of arrival
    uint8_t reflected[3] = {0, 0, 0}; ///< diffuse reflectance of the surface by channel; 255: 1
    uint8_t bounces = 0;              ///< since the light; 255: that, or more
    /// Unit direction from which it came.
    Vec3 direction() const { return unpackUnit(from); }
};
static_assert(sizeof(Photon) == 36);

} // namespace alpenglow::photonmap
