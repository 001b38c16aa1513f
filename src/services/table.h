// The list of services.
#pragma once
#include "world/service.h"

namespace alpenglow::services {

/// All services that have a descriptor. Immutable.
world::ServiceTable serviceTable();

} // namespace alpenglow::services
