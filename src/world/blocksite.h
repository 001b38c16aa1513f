// Calls whose lobes can be processed in blocks of points (lanes/stages.h).
#pragma once
#include "world/sites.h"

namespace alpenglow::world {

/// Argument rows of a call that requests a lobe without any work for each point; null: another kind of call.
std::shared_ptr<const LobeArguments> blockSite(const SiteInfo&);
/// Whether a call requests lobes.
bool asksLobes(SiteKind);
/// Whether all lobe requests of the kernel are such calls.
bool asksBlocks(const BoundKernel&);

} // namespace alpenglow::world
