// Directions in proportion to the light of an environment map: gather("environment:MAP") and generateSamplesEnv().
#pragma once
#include "base/vec.h"
#include "texture/texture.h"
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace alpenglow::texture {

/// Directions sampled in proportion to a map's radiance, from a table over the sphere in the map's space. A fraction is uniform,
/// so that no direction has density 0.
class SkyDirections {
public:
    /// Null: all directions alike. `axes`: of maps that are no cubes.
    SkyDirections(Handle, const LatLong& axes);
    /// w: unit. density: per steradian, > 0. light: linear radiance of the map.
    struct Direction {
        Vec3 w;
        float density;
        Color light;
    };
    /// random: two numbers from 0 to 1; strata of them stay strata.
    Direction at(Vec2 random) const;
    /// Density of at() for a unit direction, and the radiance there.
    Direction of(const Vec3& w) const;

private:
    Handle map_;
    LatLong axes_;
    std::vector<float> sums_; ///< cumulative probabilities, by cell
};

/// The tables of a world, made at first use. Thread safe.
class SkyDirectionTables {
public:
    /// The table of a map, made at its first use; valid as long as this. Thread safe.
    const SkyDirections& of(Handle, const LatLong& axes) const;

private:
    mutable std::mutex mutex_;
    mutable std::map<Handle, std::unique_ptr<const SkyDirections>> tables_;
};

} // namespace alpenglow::texture
