// What is said of a texture() that names a filter that there is not.
#pragma once
#include "base/diagnostics.h"
#include <string>

namespace alpenglow::transport {

Diagnostic unknownFilter(const std::string& name, const std::string& op, const SourcePlace&);

} // namespace alpenglow::transport
