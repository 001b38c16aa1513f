// Irradiance caching: hemispheres are sampled at few points and interpolated where a shader allows it ("maxvariation").
//
// Ward, Rubinstein and Clear 1988; gradients by Ward and Heckbert 1992; their limits by Krivanek 2005. Records are made in passes
// of camera rays, coarse to fine. A pass reads only records of earlier passes, so neither threads nor the order of rays change a
// bit.
#pragma once
#include "base/vec.h"
#include "world/names.h"
#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace alpenglow::world {

/// Irradiance at a point, with gradients. Camera space.
struct LightRecord {
    Vec3 P, N;   ///< N unit
    Color light; ///< mean radiance over the hemisphere, weighted by the cosine
    /// By channel: rotational gradient (axis times angle, radians); translational gradient, per unit of distance
    std::array<Vec3, 3> turned, moved;
    float distance = 0; ///< mean distance of visible surfaces, approximate; > 0
    float change = 0;   ///< valid within this fraction of `distance`, or within this angle in radians
    uint64_t call = 0;  ///< key of the call; other calls ignore the record
    /// Pixel and path that made it: defines the order of records.
    std::tuple<int, int, uint32_t, uint32_t, uint32_t> place;

    /// Computes the record from strata: `rings` around N, each divided into `turns`, cells of equal cosine weight. The ray of
    /// cell (j, k) saw radiance seen[j * turns + k] at distance `way`, 1e38 without a hit. axes: azimuth 0, a quarter turn, N.
    /// `pixel`: width of a pixel there; `most`: maximum radius in pixels.
    void take(const std::array<Vec3, 3>& axes, int rings, int turns, const std::vector<Color>& seen,
              const std::vector<float>& way, float pixel, float most);
};

/// The records of a frame. Thread safe; lookups do not see records of the current pass.
class LightRecords {
public:
    /// Interpolates records at P with unit normal N. Returns false if too few are near. Thread safe, except against keep().
    bool find(uint64_t call, const Vec3& P, const Vec3& N, Color& light) const;
    /// Adds a record for the next passes. Thread safe.
    void add(const LightRecord&);
    /// Takes what was added; returns how many there are.
    size_t keep();
    size_t size() const { return records_.size(); }

private:
    struct Cell {
        int32_t x, y, z, level;
        bool operator==(const Cell&) const = default;
    };
    struct CellHash {
        size_t operator()(const Cell&) const;
    };
    static Cell cellOf(const Vec3&, int level);
    std::mutex mutex_;
    std::vector<LightRecord> added_, records_;
    std::unordered_map<Cell, std::vector<uint32_t>, CellHash> cells_; ///< records that reach into a cube of side 2^level
    std::vector<int> levels_;                                         ///< levels in use, ascending
};

} // namespace alpenglow::world
