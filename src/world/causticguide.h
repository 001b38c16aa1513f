// The caustic guide: for each piece of a surface that mirrors and glass light, directions toward the last mirror of that light.
// It is learned from photons before the first sample and does not change while rays are followed, so samples stay independent.
// Paths send extra rays that way (integrator/guiderays.h); what they bring is unbiased whatever the guide holds.
// After Jensen, "Importance Driven Path Tracing Using the Photon Map" (1995), and Ruppert et al., "Robust Fitting of
// Parallax-Aware Mixtures for Path Guiding" (2020).
#pragma once
#include "base/vec.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace alpenglow::transport {

/// Light that came to rest on a surface, from a light by way of perfect mirrors and clear glass alone. Camera space.
struct GuidePhoton {
    Vec3 P;
    Vec3 mirror;     ///< the point that sent it to P
    int side = 0;    ///< CausticGuide::sideOf() the normal on the side that it came to
    float power = 0; ///< luminance; all photons of an emission sum up to the flux that rests
};

class CausticGuide {
public:
    static constexpr int kSides = 6, kMostLobes = 8, kMostCode = 6;
    struct Cell {
        int32_t lobes = 0;    ///< which
        float irradiance = 0; ///< luminance that comes by way of mirrors, about
    };
    /// brightness: mean luminance of the picture, above 0.
    CausticGuide(std::span<const GuidePhoton>, float brightness);
    /// 1 to kSides: the axis of space that a unit normal is nearest to.
    static int sideOf(const Vec3& n) {
        const Vec3 a(std::fabs(n.x), std::fabs(n.y), std::fabs(n.z));
        const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
        return 1 + 2 * axis + (n[axis] < 0);
    }
    /// The cell about P for that side of a surface; null: no light comes there by way of mirrors.
    const Cell* find(const Vec3& P, int side) const;
    /// How often a ray is sent toward the lobes of a cell, from where the eye gets `brings` of even light of radiance 1: as code,
    /// 1 to kMostCode, or 0 for never. Sources of noise that are bright beside the picture get a ray each time.
    int codeFor(const Cell& c, float brings) const {
        const float wanted = kGain * perBrightness_ * brings * c.irradiance;
        if (!(wanted > kLeastWanted)) return 0;
        if (wanted >= 1) return 1;
        return std::min(128 - int(std::bit_cast<uint32_t>(wanted) >> 23), kMostCode); // 1 more than halvings of 1
    }
    /// Whether codeFor() may be other than 0 in some cell.
    bool maySend(float brings) const { return kGain * perBrightness_ * brings * mostIrradiance_ > kLeastWanted; }
    static float chanceOf(int code) { return 1.f / float(1 << (code - 1)); }
    /// Of directions that draw() gives, per steradian. w: unit, from P.
    float density(const Cell&, const Vec3& P, const Vec3& w) const;
    /// A direction from P by u, each from 0 to 1.
    Vec3 draw(const Cell&, const Vec3& P, Vec2 u) const;

    size_t cells() const { return cells_.size(); }
    size_t lobes() const { return lobeCount_; }

private:
    /// Rays of the guide at a vertex, for one that brings as much as the picture shows in the mean. From 2 to 20 error squared
    /// times time is about the same (docs/noise.md).
    static constexpr float kGain = 2;
    static constexpr float kLeastWanted = 1.f / 256;
    static constexpr int kLevels = 16; ///< of halvings of the cube about all photons
    /// Lobes toward points, so that they are right from everywhere in their cell; by lobe, in rows. About its axis a lobe's
    /// density falls as 1 / (1 + k (1 - cosine))^2: its tail reaches mirrors that few photons came from.
    struct alignas(32) Lobes {
        float aim[3][kMostLobes] = {};
        float perRadius2[kMostLobes] = {}; ///< two over the square of the size that a lobe covers about its aim
        float share[kMostLobes] = {};      ///< of the density; 0: there are no more
    };
    struct Place {
        uint32_t x, y, z;
    };
    bool placeOf(const Vec3&, Place&) const;
    struct Builder;
    Vec3 corner_;                ///< of the cube
    float perSize_ = 0;          ///< 2^kLevels over its side
    float mostIrradiance_ = 0;   ///< of all cells
    float perBrightness_;        ///< one over the mean luminance of the picture
    std::vector<int32_t> nodes_; ///< eight children each: a node, or -1 - cell
    int32_t roots_[kSides + 1];  ///< by side; kNone
    std::vector<Cell> cells_;
    std::vector<Lobes> lobes_;
    size_t lobeCount_ = 0;
};

} // namespace alpenglow::transport
