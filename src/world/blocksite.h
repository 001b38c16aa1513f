// Calls whose lobes are made for whole blocks of points (lanes/stages.h).
#pragma once
#include "world/sites.h"

namespace alpenglow::transport {

/// Where the arguments of a call lie that asks for a lobe and nothing that needs a look at each point; null: another call.
std::shared_ptr<const LobeArguments> blockSite(const SiteInfo&);
/// The index of refraction of a distribution whose call gives none.
float defaultEta(const LobeKind&);
/// Whether lobes are asked for by such calls alone.
bool asksBlocks(const BoundKernel&);

} // namespace alpenglow::transport
