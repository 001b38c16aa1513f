// What a bake(), bake3d() or texture3d() says, worked out when the kernel is bound.
#pragma once
#include "clouds/bakelog.h"
#include "world/sites.h"

namespace alpenglow::transport {

/// Rows of arguments, or -1.
struct CloudSite {
    std::string name;            ///< of the file; "" where `computed`, or there is none
    bool computed = false;       ///< each point names its file, in row 0
    bool writes = false;         ///< bake(), bake3d() with a name: without one they do nothing
    bool steady = false;         ///< of what writes: all points of a primitive reach it, or none
    int point = -1, normal = -1; ///< bake3d(), texture3d()
    int s = -1, t = -1;          ///< bake()
    int du = -1, dv = -1;        ///< texture3d(): steps of P from one sample to the next
    std::string space = "world";
    int spaceRow = -1;
    int radius = -1, scale = -1; ///< of the disk, or of the filter
    int centres = -1, maxDepth = -1;
    struct Part {
        std::string name;
        clouds::ChannelType type;
        int row;
    }; ///< row: of arguments; texture3d(): of results
    std::vector<Part> parts;
    clouds::BakeLayout layout; ///< not of texture3d()
    bool addsArea = false;     ///< bake3d() without "_area": its channel follows the parts
};

std::shared_ptr<const CloudSite> cloudSite(const SiteInfo&, const rsl::CompiledKernel&, WorldImpl&);

} // namespace alpenglow::transport
