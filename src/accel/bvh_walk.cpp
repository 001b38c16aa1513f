// Bvh traversal, compiled for several processor levels with equal results: see bvh.h.
#include "accel/impl.h"
#include <algorithm>
#include <bit>

namespace alpenglow::accel {

namespace common {
#define WALK_AVX2 0
#include "accel/bvh_walk.inc"
#undef WALK_AVX2
} // namespace common

#pragma clang attribute push(__attribute__((target("avx2,fma,bmi,bmi2,lzcnt,popcnt"))), apply_to = function)
namespace avx2 {
#define WALK_AVX2 1
#include "accel/bvh_walk.inc"
#undef WALK_AVX2
} // namespace avx2
#pragma clang attribute pop

static bool hasAvx2() {
    static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                            __builtin_cpu_supports("bmi2");
    return has;
}

void Accel::Impl::walkNearest(std::span<const Ray> rays, std::span<Hit> hits, bool plain, const StopFlag* stop) const {
    if (tree.empty()) std::fill(hits.begin(), hits.end(), Hit());
    else (hasAvx2() && !plain ? avx2::nearest : common::nearest)(*this, rays, hits, stop);
}

void Accel::Impl::walkNearestTogether(std::span<const Ray> rays, std::span<Hit> hits, bool plain, const StopFlag* stop) const {
    if (tree.empty() || placesMove) return walkNearest(rays, hits, plain, stop);
    (hasAvx2() && !plain ? avx2::nearestTogether : common::nearestTogether)(*this, rays, hits, stop);
}

void Accel::Impl::walkAny(std::span<const Ray> rays, std::span<uint8_t> met, const StopFlag* stop) const {
    if (tree.empty()) std::fill(met.begin(), met.end(), uint8_t(0));
    else (hasAvx2() ? avx2::any : common::any)(*this, rays, met, stop);
}

} // namespace alpenglow::accel
