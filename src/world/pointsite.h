// Arguments of a point-based occlusion(), indirectdiffuse() or subsurface(), resolved when the kernel is bound.
#pragma once
#include "pointcloud/hemisphere.h"
#include "world/sites.h"

namespace alpenglow::world {

/// Argument rows, or -1; from `value` on: result rows, or -1.
struct PointSite {
    std::vector<int32_t> names;  ///< names of clouds, interned
    std::vector<int> nameRows;   ///< of names computed at run time
    std::string space = "world"; ///< of positions
    int spaceRow = -1;           ///< of a space computed at run time
    int point = -1, normal = -1; ///< of P and N
    /// Of parameters of these names.
    int cone = -1, axis = -1, maxDistance = -1, maxHit = -1, bias = -1, solidAngle = -1, clamp = -1, sort = -1;
    FadeSite fade;                                                    ///< "falloff"
    int sidesRow = -1;                                                ///< of "hitsides"
    pointcloud::DiskSides sides = pointcloud::DiskSides::Both;        ///< where that is the same for all points
    bool uniform = false;                                             ///< all arguments are the same for all points
    bool blocks = false;                                              ///< occlusion()
    texture::Handle map = nullptr;                                    ///< "environmentmap"
    Matrix toMap;                                                     ///< current space to "environmentspace"
    int value = -1, environment = -1, openTowards = -1, blocked = -1; ///< first rows
    SubsurfaceSite subsurface;                                        ///< of subsurface()
};

/// Whether a call reads point clouds.
bool readsPoints(const SiteInfo&);
/// Reads the arguments of a call site.
std::shared_ptr<const PointSite> pointSite(const SiteInfo&, const rsl::CompiledKernel&, const WorldImpl&);
/// "front", "back", "both" or "reversed".
pointcloud::DiskSides diskSides(const std::string& word);

} // namespace alpenglow::world
