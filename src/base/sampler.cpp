#include "base/sampler.h"
#include <array>
#include <bit>

namespace alpenglow::render {
namespace {

enum Domain : uint32_t { kFirst = 0, kSecond = 1, kOrder = 2, kSingle = 3 };

// 32 random bits of all nodes whose path from the root, continued by zeros, reads `prefix`; bit k belongs to the node at depth
// k. Node and (prefix, bit) correspond one to one, so no two nodes share a bit. Odd multiplier: the packing stays injective.
uint32_t nodeBits(uint64_t key, uint32_t domain, uint32_t prefix) {
    return uint32_t(mix64(key ^ ((uint64_t(domain) << 32 | prefix) * 0x9e3779b97f4a7c15ull)) >> 32);
}

uint32_t nested(uint32_t v, uint64_t key, uint32_t domain, uint32_t bits) {
    // `bits` are the flips along the path read so far; they change only below a 1 bit of v, so one hash per 1 bit is enough.
    uint32_t out = v, open = ~0u, prefix = 0, rest = v;
    while (rest) {
        uint32_t top = std::bit_floor(rest);
        out ^= bits & open & ~(top - 1);
        open &= top - 1;
        prefix |= top;
        rest ^= top;
        bits = nodeBits(key, domain, prefix);
    }
    return out ^ (bits & open);
}

constexpr std::array<uint32_t, 32> sobol1Directions() {
    // Primitive polynomial x + 1: each direction number is the previous one XOR itself shifted (Pascal's triangle mod 2).
    std::array<uint32_t, 32> d{};
    d[0] = 1u << 31;
    for (int i = 1; i < 32; ++i)
        d[i] = d[i - 1] ^ (d[i - 1] >> 1);
    return d;
}
constexpr std::array<uint32_t, 32> kSobol1 = sobol1Directions();

} // namespace

uint32_t nestedScramble(uint32_t v, uint64_t key, uint32_t domain) { return nested(v, key, domain, nodeBits(key, domain, 0)); }

uint32_t nestedShuffle(uint32_t v, uint64_t key, uint32_t domain) { return nested(v, key, domain, 0); }

uint32_t sobol0(uint32_t i) {
    i = (i >> 16) | (i << 16);
    i = ((i & 0xff00ff00u) >> 8) | ((i & 0x00ff00ffu) << 8);
    i = ((i & 0xf0f0f0f0u) >> 4) | ((i & 0x0f0f0f0fu) << 4);
    i = ((i & 0xccccccccu) >> 2) | ((i & 0x33333333u) << 2);
    return ((i & 0xaaaaaaaau) >> 1) | ((i & 0x55555555u) << 1);
}

uint32_t sobol1(uint32_t i) {
    uint32_t r = 0;
    for (; i; i &= i - 1)
        r ^= kSobol1[std::countr_zero(i)];
    return r;
}

namespace {
// For one seed the first step maps (pixel, replica) one to one (`sample` is what it gives); so do the next two for (vertex, site) and
// occurrence.
uint64_t keyOf(uint64_t sample, uint32_t vertex, uint32_t site, uint32_t occurrence) {
    return mix64(mix64(sample ^ (uint64_t(site) << 32 | vertex)) + occurrence);
}
} // namespace

uint64_t Sampler::streamKey(uint32_t replica, uint32_t vertex, uint32_t site, uint32_t occurrence) const {
    return keyOf(mix64(seed_ ^ (pixel_ | replica)), vertex, site, occurrence);
}

Vec2 SampleNumbers::get2(uint32_t vertex, uint32_t site, uint32_t occurrence) const {
    uint64_t key = keyOf(key_, vertex, site, occurrence);
    uint32_t i = nestedShuffle(index_, key, kOrder);
    return {unitFloat(nestedScramble(sobol0(i), key, kFirst)), unitFloat(nestedScramble(sobol1(i), key, kSecond))};
}

float SampleNumbers::get1(uint32_t vertex, uint32_t site, uint32_t occurrence) const {
    // A flipped key: the order of get1's points must not be that of get2's.
    uint64_t key = ~keyOf(key_, vertex, site, occurrence);
    uint32_t i = nestedShuffle(index_, key, kOrder);
    return unitFloat(nestedScramble(sobol0(i), key, kSingle));
}

Vec2 Sampler::get2(uint32_t vertex, uint32_t site, uint32_t occurrence, uint32_t sampleIndex) const {
    return SampleNumbers(*this, sampleIndex).get2(vertex, site, occurrence);
}

float Sampler::get1(uint32_t vertex, uint32_t site, uint32_t occurrence, uint32_t sampleIndex) const {
    return SampleNumbers(*this, sampleIndex).get1(vertex, site, occurrence);
}

} // namespace alpenglow::render
