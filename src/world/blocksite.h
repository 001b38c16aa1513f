// Calls whose lobes can be processed in blocks of points (lanes/stages.h).
#pragma once
#include "world/sites.h"

namespace alpenglow::world {

/// Argument rows of a call that requests a lobe without any work for each point; null: another kind of call. path:
/// BoundKernel::path.
std::shared_ptr<const LobeArguments> blockSite(const SiteInfo&, bool path);
/// Whether a call only records a request: trace() and transmission() always do; lobe shadeops only if the integrator estimates
/// them (`path`).
inline bool isRequest(SiteKind k, bool path) {
    return k == SiteKind::Trace || k == SiteKind::Transmission || k == SiteKind::Occlusion || k == SiteKind::Subsurface ||
           k == SiteKind::Gather || (path && k >= SiteKind::Ambient && k <= SiteKind::LightVisibility);
}
/// Whether a call requests lobes.
bool asksLobes(SiteKind);
/// Whether all lobe requests of the kernel are such calls.
bool asksBlocks(const BoundKernel&);

} // namespace alpenglow::world
