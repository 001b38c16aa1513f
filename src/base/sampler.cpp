#include "base/sampler.h"

namespace alpenglow {

uint64_t Sampler::streamKey(uint32_t replica, uint32_t vertex, uint32_t site, uint32_t occurrence) const {
    const uint64_t key = mix64(seed_ ^ (pixel_ | replica));
    const Words4<uint32_t> s = streamWords(uint32_t(key), uint32_t(key >> 32), vertex, site << 1, occurrence);
    return uint64_t(s.x) << 32 | s.y;
}

Vec2 Sampler::get2(uint32_t vertex, uint32_t site, uint32_t occurrence, uint32_t sampleIndex) const {
    return SampleNumbers(*this, sampleIndex).get2(vertex, site, occurrence);
}

float Sampler::get1(uint32_t vertex, uint32_t site, uint32_t occurrence, uint32_t sampleIndex) const {
    return SampleNumbers(*this, sampleIndex).get1(vertex, site, occurrence);
}

} // namespace alpenglow
