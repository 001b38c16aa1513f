// Arguments of a ptexture() call, resolved when the kernel is bound.
#pragma once
#include "ptex/filter.h"
#include "world/sites.h"

namespace alpenglow::world {

/// Argument rows, or -1.
struct PtexSite {
    bool computed = false; ///< file name computed for each point, in row 0; else SiteInfo::nameId
    int channel = -1, face = -1;
    std::vector<int> rows; ///< s, t and their differences (ds/dx, dt/dx, ds/dy, dt/dy); or eight numbers: four corners
    bool own = false;      ///< no coordinates given: uses those of the face, if any
    int count = 1;
    int fill = -1, width = -1, swidth = -1, twidth = -1, blur = -1, sblur = -1, tblur = -1;
    ptex::Kernel kernel = ptex::Kernel::Gaussian;
};

std::shared_ptr<const PtexSite> ptexSite(const SiteInfo&, const rsl::CompiledKernel&, WorldImpl&);

} // namespace alpenglow::world
