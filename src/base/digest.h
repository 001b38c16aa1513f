// Digests against accidental damage of files: XXH3 of xxHash. Not cryptographic. The keys of compiled shaders, whose text may be
// untrusted, are SHA-256 (rsl/jit/sha256.h).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace alpenglow {

/// A digest of data in pieces: equal to that of the complete data.
class Digest {
public:
    /// Of no data yet.
    Digest();
    /// Appends a piece of the data.
    void add(const void* data, size_t bytes);
    void add(std::string_view text) { add(text.data(), text.size()); }
    /// The digest of all pieces so far; more may follow.
    uint64_t value() const;

private:
    alignas(64) std::array<std::byte, 576> state_; ///< XXH3_state_t
};

/// The digest of complete data.
uint64_t digest(std::string_view bytes);
/// Sixteen hexadecimal digits.
std::string digestText(uint64_t);

} // namespace alpenglow
