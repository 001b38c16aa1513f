// MurmurHash3_x86_32 (Austin Appleby, public domain), a hash of 32 bits that file formats name.
#pragma once
#include <cstdint>
#include <string_view>

namespace alpenglow {

/// The hash of the bytes of a text, the same on every machine.
uint32_t murmur3(std::string_view text, uint32_t seed = 0);

} // namespace alpenglow
