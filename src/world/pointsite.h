// Arguments of a point-based occlusion(), indirectdiffuse() or subsurface(), resolved when the kernel is bound.
#pragma once
#include "pointcloud/hemisphere.h"
#include "world/sites.h"

namespace alpenglow::world {

/// Argument rows, or -1; from `value` on: result rows, or -1.
struct PointSite {
    std::vector<int32_t> names; ///< names of clouds, interned
    std::vector<int> nameRows;  ///< of names computed at run time
    std::string space = "world";
    int spaceRow = -1;
    int point = -1, normal = -1;
    int cone = -1, axis = -1, maxDistance = -1, maxHit = -1, bias = -1, solidAngle = -1, clamp = -1, sort = -1;
    FadeSite fade;
    int sidesRow = -1;
    pointcloud::DiskSides sides = pointcloud::DiskSides::Both;
    bool uniform = false;
    bool blocks = false;           ///< occlusion()
    texture::Handle map = nullptr; ///< "environmentmap"
    Matrix toMap;                  ///< current space to "environmentspace"
    int value = -1, environment = -1, openTowards = -1, blocked = -1;
    SubsurfaceSite below; ///< of subsurface()
};

/// Whether a call reads point clouds.
bool readsPoints(const SiteInfo&);
/// Reads the arguments of a call site.
std::shared_ptr<const PointSite> pointSite(const SiteInfo&, const rsl::CompiledKernel&, const WorldImpl&);
/// "front", "back", "both" or "reversed".
pointcloud::DiskSides diskSides(const std::string& word);

} // namespace alpenglow::world
