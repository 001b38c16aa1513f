// SHA-256 (FIPS 180-4), for the keys and checksums of the kernel cache.
#pragma once
#include <string>
#include <string_view>

namespace alpenglow::rsl::jit {

/// 64 lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);

} // namespace alpenglow::rsl::jit
