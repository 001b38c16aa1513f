// Directions in proportion to the light of an environment map: gather("environment:MAP") and generateSamplesEnv().
#pragma once
#include "base/vec.h"
#include "texture/texture.h"
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace alpenglow::texture {

/// Directions in the space of a map, drawn by what it shows there, from a table over the sphere. A part of them goes everywhere
/// alike, so that no direction has a density of 0.
class SkyDirections {
public:
    /// Null: all directions alike. `axes`: of maps that are no cubes.
    SkyDirections(Handle, const LatLong& axes);
    /// w: of length 1. density: per steradian, > 0. light: what the map shows there, as light.
    struct Direction {
        Vec3 w;
        float density;
        Color light;
    };
    /// random: two numbers from 0 to 1; strata of them stay strata.
    Direction at(Vec2 random) const;
    /// The density with which at() gives a direction of length 1, and the light there.
    Direction of(const Vec3& w) const;

private:
    Handle map_;
    LatLong axes_;
    std::vector<float> sums_; ///< by cell, of its chance and all before
};

/// Those of a world, made when first asked for. Thread safe.
class SkyDirectionTables {
public:
    const SkyDirections& of(Handle, const LatLong& axes) const;

private:
    mutable std::mutex mutex_;
    mutable std::map<Handle, std::unique_ptr<const SkyDirections>> tables_;
};

} // namespace alpenglow::texture
