// The random numbers of one sample, by path vertex, call site and occurrence (docs/design/sampling.md).
#pragma once
#include "base/numberlanes.h"
#include "services/names.h"

namespace alpenglow::services {

/// Dimensions other than call sites of shaders, which are below 2^20.
enum RandomUse : uint32_t {
    kChooseLobe = 1u << 20,
    kRoulette,
    kPassThrough,
    kChooseLight,
    kSampleBase,
    kLevel,
    kSegmentEvent,
    kDrawAgain,
    kAmbient,
    kAlbedo,
    kGuideRay,
    kShadowRoulette,
    kSpecularSearch,
    kSpecularSeed,
    kSpecularCone,
    kLightPoint = 1u << 21
};

/// The random numbers of one camera sample. Each depends on (seed, pixel, sample, vertex, use, occurrence) alone.
class Random {
public:
    /// Of a sample of a pixel, given by its numbers, or by seed, raster position and number of the sample.
    explicit Random(const SampleNumbers& numbers) : numbers_(numbers) {}
    Random(SeedKey seed, int px, int py, uint32_t sample) : numbers_(Sampler(seed, px, py), sample) {}
    /// Two numbers in [0, 1). use: a call site, or one of the constants above; occurrence: earlier requests of the same use at
    /// this vertex.
    Vec2 pair(uint32_t vertex, uint32_t use, uint32_t occurrence) const { return numbers_.get2(vertex, use, occurrence); }
    /// One number in [0, 1), independent of pair().
    float one(uint32_t vertex, uint32_t use, uint32_t occurrence) const { return numbers_.get1(vertex, use, occurrence); }

    /// For drawing many at once (NumberRows).
    const SampleNumbers& numbers() const { return numbers_; }

    /// Numbers of draw k of n equal draws: stratified over the draws as over samples (SampleNumbers::draw).
    Random draw(uint32_t k, uint32_t n) const { return Random(numbers_.draw(k, n)); }

private:
    SampleNumbers numbers_;
};

/// Random number key of the next vertex: a hash of the path of calls.
inline uint32_t childVertex(uint32_t vertex, uint32_t site, uint32_t occurrence) {
    uint64_t h = mix64((uint64_t(vertex) << 32 | site) ^ mix64(occurrence + 0x9e3779b97f4a7c15ull));
    uint32_t v = uint32_t(h >> 32);
    return v ? v : 1;
}

} // namespace alpenglow::services
