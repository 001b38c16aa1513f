// Irradiance of environment maps (indirectdiffuse(map, direction)).
#pragma once
#include "base/vec.h"
#include "texture/texture.h"
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace alpenglow::texture {

/// Irradiance of a plane by a map, by the plane's normal. Free of noise; light at the horizon has the error of a cell of some
/// degrees.
class IrradianceTable {
public:
    /// Null: black. `axes`: of maps that are no cubes.
    IrradianceTable(Handle, const LatLong& axes);
    /// Irradiance / pi of a plane with normal n, unit, in the map's space.
    Color about(const Vec3& n) const;

private:
    struct Cell {
        Vec3 light[3];
    }; ///< by channel: directions times light, over pi
    std::vector<Cell> cells_;
};

/// The tables of a world, made at first use. Thread safe.
class IrradianceTables {
public:
    /// The table of a map, made at its first use; valid as long as this. Thread safe.
    const IrradianceTable& of(Handle, const LatLong& axes) const;

private:
    mutable std::mutex mutex_;
    mutable std::map<Handle, std::unique_ptr<const IrradianceTable>> tables_;
};

} // namespace alpenglow::texture
