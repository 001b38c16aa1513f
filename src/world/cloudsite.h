// Arguments of a bake(), bake3d() or texture3d() call, resolved when the kernel is bound.
#pragma once
#include "pointcloud/bakelog.h"
#include "world/sites.h"

namespace alpenglow::world {

/// Argument rows, or -1.
struct CloudSite {
    std::string name;                ///< file name; "" if `computed`, or missing
    bool computed = false;           ///< file name computed for each point, in row 0
    bool writes = false;             ///< bake() or bake3d() with a file name; without one they do nothing
    bool steady = false;             ///< writing calls: all points of a primitive reach the call, or none do
    int point = -1, normal = -1;     ///< bake3d(), texture3d()
    int s = -1, t = -1;              ///< bake()
    int du = -1, dv = -1;            ///< texture3d(): differences of P between samples
    std::string space = "world";     ///< of P, N and the result
    int spaceRow = -1;               ///< of a space computed at run time
    int radius = -1, scale = -1;     ///< of the disk or the filter
    int centres = -1, maxDepth = -1; ///< of parameters of these names
    /// An optional argument: a channel of the map and where its value lies in the call's rows.
    struct Part {
        std::string name;             ///< of the channel
        pointcloud::ChannelType type; ///< of the value
        int row;                      ///< first row
    }; ///< row: of arguments; texture3d(): of results
    std::vector<Part> parts;
    pointcloud::BakeLayout layout; ///< unused by texture3d()
    bool addsArea = false;         ///< bake3d() without "_area": appends that channel
};

/// Reads the arguments of a call site.
std::shared_ptr<const CloudSite> cloudSite(const SiteInfo&, const rsl::CompiledKernel&, const WorldImpl&);

} // namespace alpenglow::world
