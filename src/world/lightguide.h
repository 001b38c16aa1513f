// The light guide: for places from which only a part of a light is visible (a sky behind a window, a lamp behind a shade), that
// part. It is built from the light samples of some paths before the first sample and constant while rays are traced. Light
// samples are drawn from a mixture of the light's own density and the guide's, so the estimate is unbiased for any contents of
// the guide.
#pragma once
#include "world/lightdomain.h"
#include "world/surfacetree.h"
#include <memory>

namespace alpenglow::world {

/// A direction in which a point sees a light. Camera space.
struct SeenLight {
    Vec3 P, w;          ///< the point; unit direction
    float radiance = 0; ///< luminance from there, > 0
    float weight = 0;   ///< radiance over the density with which w was drawn
    float pdf = 0;      ///< density per steradian of light samples there, without a guide
};

/// The guide of one light. Immutable.
class LightGuide {
public:
    /// For a light that is sampled.
    LightGuide(const LightDomain&, std::span<const SeenLight>);
    /// For a light that rays of lobes find, and that is sampled by the guide only. blocked: origins of rays that found surfaces.
    LightGuide(const LightDomain&, std::span<const SeenLight>, std::span<const Vec3> blocked);
    struct Cell {
        float share = 0;                     ///< of the light samples that follow the guide; 0: it would be no gain
        float until[LightDomain::kMostBins]; ///< probability of the bins up to this one, inclusive
    };
    /// The cell at P; null: samples follow the light's own density.
    const Cell* find(const Vec3& P) const {
        const int32_t i = tree_.find(P, kSide);
        return i < 0 || !(cells_[size_t(i)].share > 0) ? nullptr : &cells_[size_t(i)];
    }
    /// Density of draw() per steradian. w: unit.
    float density(const Cell&, const Vec3& P, const Vec3& w) const;
    /// Samples a direction from P. u: each in [0, 1).
    Vec3 draw(const Cell&, const Vec3& P, Vec2 u) const;
    /// Density of the mixture; ofLight: of the light alone.
    float mixed(const Cell& c, float ofLight, const Vec3& P, const Vec3& w) const {
        return (1 - c.share) * ofLight + c.share * density(c, P, w);
    }
    size_t cells() const { return cells_.size(); }
    size_t used() const; ///< cells with a share

private:
    static constexpr int kSide = 1; ///< of all points: who meets the light by chance does not know the side of its surface
    using Ids = std::span<const uint32_t>;
    void count(std::span<const SeenLight>, Ids, size_t step, double most, double* bins) const;
    Cell fit(std::span<const SeenLight>, Ids, Ids around, size_t step) const;
    float shareOf(std::span<const SeenLight>, Ids, Ids around) const;
    LightGuide(const LightDomain&, std::span<const SeenLight>, bool alone);
    int32_t add(std::span<const SeenLight>, Ids, Ids around);
    bool alone_;
    LightDomain domain_;
    SurfaceTree tree_;
    std::vector<Cell> cells_;
};

/// By light; empty: no light has one; null: that one has none.
using LightGuides = std::vector<std::shared_ptr<const LightGuide>>;

} // namespace alpenglow::world
