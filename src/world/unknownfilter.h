// The warning about a texture() call with an unknown filter.
#pragma once
#include "base/diagnostics.h"
#include <string>

namespace alpenglow::transport {

Diagnostic unknownFilter(const std::string& name, const std::string& op, const SourcePlace&);

} // namespace alpenglow::transport
