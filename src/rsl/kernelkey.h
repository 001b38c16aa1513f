// Parts of what names a kernel in the caches.
#pragma once
#include "rsl/kernel.h"
#include <string>

namespace alpenglow::rsl {

/// Everything that the descriptors of shadeops say and that decides about code.
const std::string& descriptorDigest();

/// What the co-shaders are and what their parameters say: all of it is in the code.
std::string coShaderKey(const KernelOptions&);

} // namespace alpenglow::rsl
