#include "base/murmur.h"
#include <bit>

namespace alpenglow {

namespace {

uint32_t mixed(uint32_t block) { return std::rotl(block * 0xcc9e2d51u, 15) * 0x1b873593u; }

} // namespace

uint32_t murmur3(std::string_view text, uint32_t seed) {
    const auto byte = [&](size_t i) { return uint32_t(static_cast<unsigned char>(text[i])); };
    uint32_t h = seed;
    size_t i = 0;
    for (; i + 4 <= text.size(); i += 4) { // little-endian, whatever the machine
        h ^= mixed(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
        h = std::rotl(h, 13) * 5 + 0xe6546b64u;
    }
    uint32_t rest = 0;
    for (size_t k = text.size(); k > i; --k) rest = rest << 8 | byte(k - 1);
    if (i < text.size()) h ^= mixed(rest);
    h ^= uint32_t(text.size());
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return h ^ h >> 16;
}

} // namespace alpenglow
