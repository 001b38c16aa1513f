// Parts of what names a kernel in the caches.
#pragma once
#include "rsl/kernel.h"
#include <string>

namespace alpenglow::rsl {

/// Everything in the descriptors of shadeops that affects code.
const std::string& descriptorDigest();

/// Connections, in their order.
std::string connectionKey(const Connections&);
/// The co-shaders and the values of their parameters, which are part of the code.
std::string coShaderKey(const KernelOptions&);

} // namespace alpenglow::rsl
