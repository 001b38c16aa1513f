// Caustic seeds: photons of lights that no ray meets (point, spot, distant), which came to surfaces by mirrors and glass alone. A
// path finds such light only by solving for the path through the mirrors; seeds are where the search begins
// (integrator/specularsearch.h). Built before the first sample and constant while rays are traced.
#pragma once
#include "base/vec.h"
#include "world/surfacetree.h"
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace alpenglow::world {

/// The start of a photon, from which it can be sent again. Camera space.
struct CausticSeed {
    int32_t light = -1;  ///< in WorldImpl::lights()
    uint32_t pass = 0;   ///< with `number`: the key of its random numbers
    uint32_t number = 0; ///< in its pass
    int32_t bounces = 0; ///< mirrors and refractions on its way, 1 or more
    Vec3 start;          ///< a light with a place: its unit direction; a distant light: its origin
    float step = 0;      ///< distance of differences: in `start`, small relative to what it meets first
    Vec3 P, dir;         ///< where it came to rest; unit direction in which it came
    Vec3 columns[2];     ///< derivatives of P, in the plane that faces `dir`, by `start`, along t and u of Basis(start); of a
                         ///< distant light along those of the direction of its rays
    int32_t side = 0;    ///< SurfaceTree::sideOf() the normal there, on the lit side
    float power = 0;     ///< luminance; sums over an emission to the flux that is stored; 0: of another emission
};

/// The seeds of a world by place. Immutable.
class CausticSeeds {
public:
    /// Some seeds: in the order of seed().
    struct Range {
        uint32_t first = 0, count = 0; ///< index, and number
    };
    /// Seeds that came to rest near a point.
    struct Cell {
        Range own, around;    ///< in its cube; in the cube that was divided into it and others
        float irradiance = 0; ///< luminance of their light, approximate
    };
    /// brightness: mean luminance of the picture, > 0. gain: searches at a point that brings as much as that. At least one seed.
    CausticSeeds(std::vector<CausticSeed>, float brightness, float gain);
    /// The cell at P for a side of a surface. Where none is, a cell of all seeds, with the irradiance that may have been missed.
    const Cell& find(const Vec3& P, int side) const {
        const int32_t i = tree_.find(P, side);
        return i < 0 ? anywhere_ : cells_[size_t(i)];
    }
    /// All seeds.
    const Range& anywhere() const { return anywhere_.own; }
    /// Seed i of a range; i below its count.
    const CausticSeed& seed(const Range& r, uint32_t i) const { return seeds_[order_[r.first + i]]; }
    /// Probability of a search at a point of a cell. brings: luminance that the eye receives from there under uniform light of
    /// radiance 1. 0 only where `brings` is 0.
    float chanceOf(const Cell& c, float brings) const {
        const float wanted = gain_ * perBrightness_ * brings * c.irradiance;
        return brings > 0 ? std::clamp(wanted, &c == &anywhere_ ? kLeastAnywhere : kLeast, 1.f) : 0;
    }
    size_t cells() const { return cells_.size(); }
    size_t seeds() const { return seeds_.size(); }

private:
    static constexpr float kLeast = 1.f / 512, kLeastAnywhere = 1.f / 2048;
    SurfaceTree tree_;
    float perBrightness_, gain_;
    std::vector<CausticSeed> seeds_;
    std::vector<uint32_t> order_; ///< indices of seeds, by cell; then all of them
    std::vector<Range> around_;   ///< of the cells that were divided
    std::vector<Cell> cells_;
    Cell anywhere_;
};

} // namespace alpenglow::world
