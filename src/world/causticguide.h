// The caustic guide: for each part of a surface that is lit via mirrors and glass, directions toward the last mirror. It is built
// from photons before the first sample and constant while rays are traced, so samples stay independent. Paths send additional
// rays in these directions (integrator/guiderays.h); the estimate is unbiased for any contents of the guide. After Jensen,
// "Importance Driven Path Tracing Using the Photon Map" (1995), and Ruppert et al., "Robust Fitting of Parallax-Aware Mixtures
// for Path Guiding" (2020).
#pragma once
#include "world/aimedlobes.h"
#include "world/surfacetree.h"
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
    Vec3 P;          ///< position
    Vec3 mirror;     ///< last mirror vertex
    int side = 0;    ///< SurfaceTree::sideOf() the normal on the side that it hit
    float power = 0; ///< luminance; sums over an emission to the flux that is stored
};

/// The guide of one pass. Immutable.
class CausticGuide {
public:
    static constexpr int kMostCode = 6; ///< largest result of chanceOf()
    /// What is known of caustic light at a place.
    struct Cell {
        int32_t lobes = 0;    ///< index in lobes_
        float irradiance = 0; ///< luminance of caustic light, approximate
    };
    /// brightness: mean luminance of the picture, > 0.
    CausticGuide(std::span<const GuidePhoton>, float brightness);
    /// The cell at P for a side of the surface; null: no caustic light there.
    const Cell* find(const Vec3& P, int side) const {
        const int32_t i = tree_.find(P, side);
        return i < 0 ? nullptr : &cells_[size_t(i)];
    }
    /// The same for at most SurfaceTree::kTogether points.
    void find(std::span<const SurfaceTree::Point> points, const Cell** found) const {
        int32_t at[SurfaceTree::kTogether];
        tree_.find(points, at);
        for (size_t i = 0; i < points.size(); ++i) {
            found[i] = at[i] < 0 ? nullptr : &cells_[size_t(at[i])];
            __builtin_prefetch(found[i]);
        }
    }
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
    /// The probability that a code above 0 stands for.
    static float chanceOf(int code) { return 1.f / float(1 << (code - 1)); }
    /// Density of draw() per steradian. w: unit, from P.
    float density(const Cell& c, const Vec3& P, const Vec3& w) const { return lobes_[size_t(c.lobes)].density(P, w); }
    /// Samples a direction from P. u: each in [0, 1).
    Vec3 draw(const Cell& c, const Vec3& P, Vec2 u) const { return lobes_[size_t(c.lobes)].draw(P, u); }

    /// Numbers of cells, and of the lobes in them.
    size_t cells() const { return cells_.size(); }
    size_t lobes() const { return lobeCount_; }

private:
    /// Guide rays at a vertex whose contribution equals the mean of the picture. Squared error times time is about constant from
    /// 2 to 20 (docs/noise.md).
    static constexpr float kGain = 2;
    static constexpr float kLeastWanted = 1.f / 256;
    struct Builder;
    SurfaceTree tree_;
    float mostIrradiance_ = 0; ///< over all cells
    float perBrightness_;      ///< one over the mean luminance of the picture
    std::vector<Cell> cells_;
    std::vector<AimedLobes> lobes_;
    size_t lobeCount_ = 0;
};

} // namespace alpenglow::world
