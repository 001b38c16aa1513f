// The caustic guide: for each part of a surface that is lit via mirrors and glass, directions toward the last mirror. It is built
// from photons before the first sample and constant while rays are traced, so samples stay independent. Paths send additional
// rays in these directions (integrator/guiderays.h); the estimate is unbiased for any contents of the guide. After Jensen,
// "Importance Driven Path Tracing Using the Photon Map" (1995), and Ruppert et al., "Robust Fitting of Parallax-Aware Mixtures
// for Path Guiding" (2020).
#pragma once
#include "base/vec.h"
#include "world/names.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace alpenglow::world {

/// A photon stored on a surface after delta reflection and transmission only. Camera space.
struct GuidePhoton {
    Vec3 P;
    Vec3 mirror;     ///< last mirror vertex
    int side = 0;    ///< CausticGuide::sideOf() the normal on the side that it hit
    float power = 0; ///< luminance; sums over an emission to the flux that is stored
};

class CausticGuide {
public:
    static constexpr int kSides = 6, kMostLobes = 8, kMostCode = 6;
    struct Cell {
        int32_t lobes = 0;    ///< index in lobes_
        float irradiance = 0; ///< luminance of caustic light, approximate
    };
    /// brightness: mean luminance of the picture, > 0.
    CausticGuide(std::span<const GuidePhoton>, float brightness);
    /// The axis nearest to a unit normal, 1 to kSides.
    static int sideOf(const Vec3& n) {
        const Vec3 a(std::fabs(n.x), std::fabs(n.y), std::fabs(n.z));
        const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
        return 1 + 2 * axis + (n[axis] < 0);
    }
    /// The cell at P for a side of the surface; null: no caustic light there.
    const Cell* find(const Vec3& P, int side) const;
    /// Frequency of guide rays toward the lobes of a cell, as a code: 1 to kMostCode, or 0 for never. brings: what the eye
    /// receives from there under uniform light of radiance 1. Sources of noise brighter than the picture get a ray each time.
    int codeFor(const Cell& c, float brings) const {
        const float wanted = kGain * perBrightness_ * brings * c.irradiance;
        if (!(wanted > kLeastWanted)) return 0;
        if (wanted >= 1) return 1;
        return std::min(128 - int(std::bit_cast<uint32_t>(wanted) >> 23), kMostCode); // one more than the number of halvings of 1
    }
    /// Whether codeFor() can be nonzero in any cell.
    bool maySend(float brings) const { return kGain * perBrightness_ * brings * mostIrradiance_ > kLeastWanted; }
    static float chanceOf(int code) { return 1.f / float(1 << (code - 1)); }
    /// Density of draw() per steradian. w: unit, from P.
    float density(const Cell&, const Vec3& P, const Vec3& w) const;
    /// Samples a direction from P. u: each in [0, 1).
    Vec3 draw(const Cell&, const Vec3& P, Vec2 u) const;

    size_t cells() const { return cells_.size(); }
    size_t lobes() const { return lobeCount_; }

private:
    /// Guide rays at a vertex whose contribution equals the mean of the picture. Squared error times time is about constant from
    /// 2 to 20 (docs/noise.md).
    static constexpr float kGain = 2;
    static constexpr float kLeastWanted = 1.f / 256;
    static constexpr int kLevels = 16; ///< halvings of the cube around all photons
    /// Lobes that aim at points, so they are valid from anywhere in their cell; stored in rows, by lobe. The density around the
    /// axis falls as 1 / (1 + k (1 - cosine))^2: its tail covers mirrors from which few photons came.
    struct alignas(32) Lobes {
        float aim[3][kMostLobes] = {};
        float perRadius2[kMostLobes] = {}; ///< two over the squared size that a lobe covers around its aim
        float share[kMostLobes] = {};      ///< mixture weight; 0: unused
    };
    struct Place {
        uint32_t x, y, z;
    };
    bool placeOf(const Vec3&, Place&) const;
    struct Builder;
    Vec3 corner_;                ///< of the cube
    float perSize_ = 0;          ///< 2^kLevels over its side
    float mostIrradiance_ = 0;   ///< over all cells
    float perBrightness_;        ///< one over the mean luminance of the picture
    std::vector<int32_t> nodes_; ///< eight children each: index of a node, or -1 - cell
    int32_t roots_[kSides + 1];  ///< by side, or kNone
    std::vector<Cell> cells_;
    std::vector<Lobes> lobes_;
    size_t lobeCount_ = 0;
};

} // namespace alpenglow::world
