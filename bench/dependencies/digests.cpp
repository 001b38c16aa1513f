// Digests of data: ours and those of libraries, in GB/s.
#include "base/digest.h"
#include "base/hash.h"
#include "rsl/jit/sha256.h"
#include <chrono>
#include <cstdio>
#include <cstring>
#include <nettle/sha2.h>
#include <openssl/sha.h>

namespace {

volatile uint64_t sink;

template <class F> void time(const char* what, size_t bytes, F f) {
    double best = 1e99;
    for (int k = 0; k < 15; ++k) {
        const auto begin = std::chrono::steady_clock::now();
        sink = sink + f();
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    std::printf("%-24s %8zu bytes: %6.2f GB/s, %8.1f us\n", what, bytes, double(bytes) / best * 1e-9, best * 1e6);
}

} // namespace

int main() {
    for (size_t n : {20'000u, 200'000u}) {
        std::string s(n, ' ');
        for (size_t i = 0; i < n; ++i) s[i] = char(i * 2654435761u >> 13);
        const auto* bytes = reinterpret_cast<const unsigned char*>(s.data());
        time("SHA-256, ours", n, [&] { return uint64_t(alpenglow::rsl::jit::sha256(s)[0]); });
        time("SHA-256, OpenSSL", n, [&] {
            unsigned char out[32];
            return uint64_t(SHA256(bytes, n, out)[0]);
        });
        time("SHA-256, nettle", n, [&] {
            sha256_ctx c;
            uint8_t out[32];
            sha256_init(&c);
            sha256_update(&c, n, bytes);
            sha256_digest(&c, sizeof out, out);
            return uint64_t(out[0]);
        });
        time("XXH3 (base/digest.h)", n, [&] { return alpenglow::digest(s); });
        time("mix64 of eight bytes", n, [&] {
            uint64_t h = 0, v = 0;
            for (size_t k = 0; k + 8 <= n; k += 8) {
                std::memcpy(&v, s.data() + k, 8);
                h = alpenglow::mix64(h ^ v);
            }
            return h;
        });
        time("FNV-1a", n, [&] {
            uint64_t h = 14695981039346656037u;
            for (char c : s) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211u;
            return h;
        });
    }
}
