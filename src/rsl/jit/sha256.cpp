#include "rsl/jit/sha256.h"
#include <array>
#include <cstdint>
#include <cstring>

namespace alpenglow::rsl::jit {
namespace {

using Words = std::array<uint32_t, 64>;

// The constants are the first 32 bits of the fractional parts of the cube (K) and square (H) roots of the first primes: computed
// here by integer roots, exactly.
struct Constants {
    Words k{};
    std::array<uint32_t, 8> h{};
    static uint32_t rootFraction(uint32_t prime, int power) {
        // Largest x with x^power <= prime * 2^(32 * power); its low 32 bits are the fraction.
        uint64_t lo = 0, hi = uint64_t(32) << 32;
        auto fits = [&](uint64_t x) {
            using Wide = unsigned __int128;
            if (power == 2) return Wide(x) * x <= (Wide(prime) << 64);
            // x < 2^37: x^3 < 2^111; prime << 96 < 2^105.
            return Wide(x) * x * x <= (Wide(prime) << 96);
        };
        while (hi - lo > 1) {
            const uint64_t mid = (lo + hi) / 2;
            (fits(mid) ? lo : hi) = mid;
        }
        return uint32_t(lo);
    }
    Constants() {
        int n = 0;
        for (uint32_t p = 2; n < 64; p++) {
            bool prime = true;
            for (uint32_t d = 2; d * d <= p; d++) prime &= p % d != 0;
            if (!prime) continue;
            k[size_t(n)] = rootFraction(p, 3);
            if (n < 8) h[size_t(n)] = rootFraction(p, 2);
            n++;
        }
    }
};

uint32_t rotate(uint32_t x, int n) { return x >> n | x << (32 - n); }

void compress(std::array<uint32_t, 8>& state, const unsigned char* block, const Words& k) {
    Words w;
    for (size_t i = 0; i < 16; i++)
        w[i] =
            uint32_t(block[4 * i]) << 24 | uint32_t(block[4 * i + 1]) << 16 | uint32_t(block[4 * i + 2]) << 8 | block[4 * i + 3];
    for (size_t i = 16; i < 64; i++) {
        const uint32_t a = w[i - 15], b = w[i - 2];
        w[i] = w[i - 16] + w[i - 7] + (rotate(a, 7) ^ rotate(a, 18) ^ a >> 3) + (rotate(b, 17) ^ rotate(b, 19) ^ b >> 10);
    }
    auto [a, b, c, d, e, f, g, h] = state;
    for (size_t i = 0; i < 64; i++) {
        const uint32_t t1 = h + (rotate(e, 6) ^ rotate(e, 11) ^ rotate(e, 25)) + ((e & f) ^ (~e & g)) + k[i] + w[i];
        const uint32_t t2 = (rotate(a, 2) ^ rotate(a, 13) ^ rotate(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
        h = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + t2;
    }
    const std::array<uint32_t, 8> add{a, b, c, d, e, f, g, h};
    for (size_t i = 0; i < 8; i++) state[i] += add[i];
}

} // namespace

std::string sha256(std::string_view bytes) {
    static const Constants constants;
    auto state = constants.h;
    size_t at = 0;
    for (; at + 64 <= bytes.size(); at += 64)
        compress(state, reinterpret_cast<const unsigned char*>(bytes.data()) + at, constants.k);
    unsigned char tail[128] = {};
    const size_t left = bytes.size() - at, padded = left < 56 ? 64 : 128;
    std::memcpy(tail, bytes.data() + at, left);
    tail[left] = 0x80;
    const uint64_t bits = uint64_t(bytes.size()) * 8;
    for (size_t i = 0; i < 8; i++) tail[padded - 1 - i] = static_cast<unsigned char>(bits >> (8 * i));
    for (size_t b = 0; b < padded; b += 64) compress(state, tail + b, constants.k);
    std::string text;
    for (uint32_t s : state)
        for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789abcdef"[s >> shift & 15];
    return text;
}

} // namespace alpenglow::rsl::jit
