// What a ptexture() says, worked out when the kernel is bound.
#pragma once
#include "ptex/filter.h"
#include "world/sites.h"

namespace alpenglow::transport {

/// Rows of arguments, or -1.
struct PtexSite {
    bool computed = false; ///< each point names its file, in row 0; else SiteInfo::nameId
    int channel = -1, face = -1;
    std::vector<int> rows; ///< s, t, and steps of them (ds/dx, dt/dx, ds/dy, dt/dy); or eight numbers: four corners
    bool own = false;      ///< no coordinates are given: those of the face, where it has some
    int count = 1;
    int fill = -1, width = -1, swidth = -1, twidth = -1, blur = -1, sblur = -1, tblur = -1;
    ptex::Kernel kernel = ptex::Kernel::Gaussian;
};

std::shared_ptr<const PtexSite> ptexSite(const SiteInfo&, const rsl::CompiledKernel&, WorldImpl&);

} // namespace alpenglow::transport
