// The numbers of a sample (docs/design/sampling.md): Owen-scrambled (0,2)-sequence pairs, padded by hash.
//
// Each pair of numbers is the first two dimensions of the Sobol sequence under a nested uniform scramble: the flip of digit k of
// a coordinate is a random bit that depends on the stream and on the k digits above it, and on nothing else. Such a scramble
// keeps every elementary interval filled as it was (Owen, "Randomly permuted (t,m,s)-nets", 1995), and each single point is
// uniform, so every estimate is unbiased at every sample count. Different pairs walk the sequence in independently shuffled
// orders (a nested shuffle, which keeps every aligned block of 2^m points a (0,m,2)-net), so they are not correlated. The
// scrambles are hashes (owen.h): a pair takes the same few operations whatever the index.
//
// A pixel has kReplicas = 2 independently scrambled sequences: sample i is point i / 2 of replica i % 2. So after 2 * 2^m samples
// each replica holds a complete (0,m,2)-net, and the difference of the two replica means shows the true error of their mean,
// which the spread of dependent samples does not (docs/noise.md). Two is the least that shows it, and leaves the most
// stratification: noise.h pools what two say too vaguely in one pixel.
#pragma once
#include "base/hash.h"
#include "base/owen.h"
#include "base/vec.h"

namespace alpenglow {

inline constexpr uint32_t kReplicas = 2; ///< independent sequences of a pixel (above)

/// A seed, hashed once for all pixels.
struct SeedKey {
    /// seed: any number.
    explicit SeedKey(uint64_t seed) : key(mix64(seed + 0x6a09e667f3bcc909ull)) {}
    uint64_t key; ///< the hashed seed
};

class SampleNumbers;
class NumberRows;

/// The stratified numbers of one pixel. Stateless: a number depends on (seed, pixel, sample, vertex, site, occurrence) only.
class Sampler {
public:
    /// Raster coordinates may be negative (filter borders); |x|, |y| < 2^29. Distinct pixels have distinct keys.
    Sampler(uint64_t seed, int x, int y) : Sampler(SeedKey(seed), x, y) {}
    Sampler(SeedKey seed, int x, int y)
        : seed_(seed.key),
          pixel_(uint64_t(uint32_t(x + (1 << 29)) & 0x3fffffffu) << 34 | uint64_t(uint32_t(y + (1 << 29)) & 0x3fffffffu) << 4) {}

    /// Two numbers in [0,1). vertex: path vertex, 0 = camera; site: call site, below 2^31; occurrence: number of earlier requests
    /// of that site at this vertex. sampleIndex counts the samples of the pixel from 0.
    Vec2 get2(uint32_t vertex, uint32_t site, uint32_t occurrence, uint32_t sampleIndex) const;
    /// One number in [0,1), stratified, and independent of get2 with the same arguments.
    float get1(uint32_t vertex, uint32_t site, uint32_t occurrence, uint32_t sampleIndex) const;

    /// The key of one stream, which get2 and get1 hash. Public for testing the absence of collisions.
    uint64_t streamKey(uint32_t replica, uint32_t vertex, uint32_t site, uint32_t occurrence) const;

private:
    friend class SampleNumbers;
    uint64_t seed_ = 0, pixel_ = 0;
};

/// The numbers of one sample of a pixel: equal to Sampler's for that sampleIndex, with common parts computed once.
class SampleNumbers {
public:
    /// Of that sample of the pixel.
    SampleNumbers(const Sampler& s, uint32_t sampleIndex) : index_(sampleIndex / kReplicas) {
        const uint64_t key = mix64(s.seed_ ^ (s.pixel_ | sampleIndex % kReplicas));
        low_ = uint32_t(key);
        high_ = uint32_t(key >> 32);
    }
    /// Sampler::get2() and get1() for this sample.
    Vec2 get2(uint32_t vertex, uint32_t site, uint32_t occurrence) const {
        const Scrambles<uint32_t> s(streamWords<uint32_t>(low_, high_, vertex, site << 1, occurrence));
        const uint32_t i = s.shuffledIndex(reverseBits<uint32_t>(index_));
        return {unitFloat(s.first(i)), unitFloat(s.second(i))};
    }
    float get1(uint32_t vertex, uint32_t site, uint32_t occurrence) const {
        // Separate words, so that the order of get1's points differs from get2's.
        const Scrambles<uint32_t> s(streamWords<uint32_t>(low_, high_, vertex, site << 1 | kSingle, occurrence));
        return unitFloat(s.first(s.shuffledIndex(reverseBits<uint32_t>(index_))));
    }

    /// The numbers of draw k of n that this sample makes alike (light samples, rays of one request): draw k of sample i is point
    /// i n + k of streams of their own, so the n draws of one sample are as well spread as those of n samples, and all together
    /// too. k < n. n = 1: these numbers. Other n have other streams, so n may vary from sample to sample.
    SampleNumbers draw(uint32_t k, uint32_t n) const {
        SampleNumbers r = *this;
        if (n <= 1) return r;
        r.high_ += n * 0x7feb352du;
        r.index_ = index_ * n + k;
        return r;
    }

    /// The key of this sample for NumberBlock: a stream is its site twice, with kSingle added for one number.
    static constexpr uint32_t kSingle = 1;
    /// For NumberBlock: the key of pixel and replica in two words, and the index of the point in its sequence.
    uint32_t low() const { return low_; }
    uint32_t high() const { return high_; }
    uint32_t index() const { return index_; }

private:
    friend class NumberRows; // numberlanes.h
    uint32_t low_, high_;
    uint32_t index_; ///< of the sample in its replica
};

/// Point i of the first (van der Corput) and second Sobol dimension, as 32-bit binary fractions.
inline uint32_t sobol0(uint32_t i) { return reverseBits<uint32_t>(i); }
inline uint32_t sobol1(uint32_t i) { return reverseBits<uint32_t>(sobol1Reversed<uint32_t>(i)); }

} // namespace alpenglow
