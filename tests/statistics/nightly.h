// Sizes and seeds of statistical tests: small with fixed seeds on every change, large with fresh seeds under `./check --all`.
#pragma once
#include "../nightly.h"
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace alpenglow::teststat {

using alpenglow::chosen, alpenglow::nightly;
/// The first here, the second nightly.
inline int samples(int fast, int night) { return nightly() ? night : fast; }
/// Sixteen times as many nightly.
inline int samples(int fast) { return samples(fast, 16 * fast); }

/// Added to every seed: 0 on every change, fresh nightly (printed, so that a failure can be repeated with ALPENGLOW_SEED).
inline uint32_t seedBase() {
    static const uint32_t base = [] {
        const char* given = std::getenv("ALPENGLOW_SEED");
        uint32_t s = given ? uint32_t(std::strtoul(given, nullptr, 10)) : nightly() ? uint32_t(std::time(nullptr)) * 1000u : 0u;
        if (s) std::printf("ALPENGLOW_SEED=%u\n", s);
        return s;
    }();
    return base;
}

} // namespace alpenglow::teststat
