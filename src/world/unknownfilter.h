// The warning about a texture() call with an unknown filter.
#pragma once
#include "base/diagnostics.h"
#include "world/names.h"
#include <string>

namespace alpenglow::world {

/// op: name of the call. Names the filters that there are.
Diagnostic unknownFilter(const std::string& name, const std::string& op, const SourcePlace&);

} // namespace alpenglow::world
