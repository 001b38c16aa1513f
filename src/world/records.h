// Light of hemispheres that is found at few points and interpolated between them, where a shader asks for that ("maxvariation").
//
// Ward, Rubinstein and Clear 1988; gradients of Ward and Heckbert 1992; their limits of Krivanek 2005. Records are found in
// passes of camera rays, coarse to fine. While a pass runs only those of the passes before it are read, so neither threads nor
// the order of rays change a bit.
#pragma once
#include "base/vec.h"
#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace alpenglow::transport {

/// What arrives at a point, and how that changes about it. Camera space.
struct LightRecord {
    Vec3 P, N;                         ///< N unit
    Color light;                       ///< mean radiance over the hemisphere, weighted by the cosine
    std::array<Vec3, 3> turned, moved; ///< by channel: by an axis times an angle, radians; per unit of distance
    float distance = 0;                ///< about how far away is what it sees; never 0
    float change = 0;                  ///< it is used as far as this part of `distance`, or so many radians
    uint64_t call = 0;                 ///< of what it is a record: others do not read it
    /// Pixel and path that found it: the order of records.
    std::tuple<int, int, uint32_t, uint32_t, uint32_t> place;

    /// Takes the record's strata: `rings` about N, each cut into `turns`, cells of equal weight by the cosine. The ray of cell
    /// (j, k) brings seen[j * turns + k] from `way` away, 1e38 for nothing. axes: turn 0, a quarter of a turn, N. `pixel`: the
    /// width of a pixel there; `most`: pixels that the record may reach at most.
    void take(const std::array<Vec3, 3>& axes, int rings, int turns, const std::vector<Color>& seen,
              const std::vector<float>& way, float pixel, float most);
};

class LightRecords {
public:
    /// What the records say at P with the normal N, unit. False: too few are near. Thread safe, but not against keep().
    bool find(uint64_t call, const Vec3& P, const Vec3& N, Color& light) const;
    /// For the next passes. Thread safe.
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
    std::vector<int> levels_;                                         ///< that have some, ascending
};

} // namespace alpenglow::transport
