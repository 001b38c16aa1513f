#include "base/digest.h"
#include <fmt/format.h>
#include <new>
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace alpenglow {
namespace {

static_assert(sizeof(XXH3_state_t) <= sizeof(Digest) && alignof(XXH3_state_t) <= alignof(Digest));

XXH3_state_t* stateOf(std::byte* b) { return std::launder(reinterpret_cast<XXH3_state_t*>(b)); }
const XXH3_state_t* stateOf(const std::byte* b) { return std::launder(reinterpret_cast<const XXH3_state_t*>(b)); }

} // namespace

Digest::Digest() {
    auto* s = new (state_.data()) XXH3_state_t;
    XXH3_INITSTATE(s);
    XXH3_64bits_reset(s);
}

void Digest::add(const void* data, size_t bytes) {
    if (bytes > 0) XXH3_64bits_update(stateOf(state_.data()), data, bytes); // an empty range may have no address
}

uint64_t Digest::value() const { return XXH3_64bits_digest(stateOf(state_.data())); }

uint64_t digest(std::string_view bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

std::string digestText(uint64_t d) { return fmt::format("{:016x}", d); }

} // namespace alpenglow
