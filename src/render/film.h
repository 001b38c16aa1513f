// The film of `path`: exact sums per pixel (docs/design/sampling.md). Images and noise figures derive from them.
#pragma once
#include "base/diagnostics.h"
#include "base/sampler.h"
#include "base/vec.h"
#include "render/fixed.h"
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::render {

/// Pixels x0 <= x < x1, y0 <= y < y1 of the raster; y grows downward.
struct Window {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    size_t pixels() const { return size_t(width()) * size_t(height()); }
    bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
    friend bool operator==(const Window&, const Window&) = default;
};

/// How the samples of an AOV channel become a pixel.
enum class ChannelRule : uint8_t {
    Average,     ///< mean over the samples, like Ci
    Min,         ///< least value (depth filter "min"); +infinity when no sample gave a finite one
    Max,         ///< greatest value; -infinity likewise
    PartOfRed,   ///< mean, like Ci, of which it is a part: those of a component add up to it exactly, sample by sample. What
    PartOfGreen, ///< rounding leaves goes to the largest
    PartOfBlue
};
/// Whether the samples of a channel are added up.
inline bool isSum(ChannelRule r) { return r != ChannelRule::Min && r != ChannelRule::Max; }

struct Channel {
    std::string name;
    ChannelRule rule = ChannelRule::Average;
    friend bool operator==(const Channel&, const Channel&) = default;
};

/// Samples begin <= index < end of every pixel (--samples A:B).
struct SampleRange {
    uint32_t begin = 0, end = 0;
    friend bool operator==(const SampleRange&, const SampleRange&) = default;
};

/// How many samples pixels have where they differ (adaptive sampling, adaptive.h). One whose rate is 1 has n = base / 8 +
/// kReplicas steps of them, and others n times their rate, in whole multiples of kReplicas; but each at least `base`. Which ones
/// follows from this alone, so it is all that a render needs to go on. At first only pixels of the greatest rate get more.
struct Spread {
    static constexpr uint16_t kOne = 256, kMost = 8 * kOne;
    uint32_t base = 0, steps = 0;
    std::vector<uint16_t> rates; ///< by pixel of the window, in rows; kOne is 1; at most kMost
    uint64_t ofOne(uint64_t after) const { return base / 8 + kReplicas * after; }
    /// Samples 0 <= index < held() of pixel i are in, after so many steps.
    uint64_t held(size_t i, uint64_t after) const {
        return std::max<uint64_t>(base, rates[i] * ofOne(after) / (kOne * kReplicas) * kReplicas);
    }
    uint64_t held(size_t i) const { return held(i, steps); }
};

/// What makes two films parts of one render. Parts merge only when all of it is equal.
struct FilmDescription {
    int width = 0, height = 0; ///< of the whole picture, pixels
    Window window;             ///< the crop window; must lie inside the picture
    uint64_t seed = 0;
    std::string scene;             ///< a digest of the scene and of every option that changes the picture; chosen by the caller
    std::vector<Channel> channels; ///< AOVs
    /// Of a pixel filter whose samples have weights (FilterSampler::negativePart()): the integral of its negative part by that of
    /// the filter, at least 0. Samples of either sign are then summed apart, and each sum is divided by its weights: what does
    /// not vary stays as it is, and a pixel that has samples of both signs is unbiased.
    std::optional<double> negative;
    friend bool operator==(const FilmDescription&, const FilmDescription&) = default;
};

/// One sample of one pixel. Linear, unclamped.
struct FilmSample {
    Color radiance;
    float alpha = 0;
    std::span<const float> aovs; ///< one value per channel; missing ones count as 0
    bool surface = true;         ///< the camera ray met a surface, whatever its opacity; false: it saw the background alone
    float weight = 1;            ///< of the pixel filter: multiplies radiance, alpha and averaged AOVs, not the noise figures
};

/// The first (least sample index, then y, then x) sample that was dropped: its reproducer.
struct DroppedSample {
    uint32_t sample = 0;
    int x = 0, y = 0;
};

/// The moments of a pixel's sample luminance Y (Rec. 709 weights), from exact sums.
struct Moments {
    uint32_t n = 0;        ///< samples counted
    double s1 = 0, s2 = 0; ///< sum Y, sum Y^2
    double variance = 0;   ///< (s2 - s1^2 / n) / (n - 1), the difference taken exactly; 0 for n < 2
};

/// Luminance of the samples of a pixel, of one sign where they have weights, and of those that met a surface.
struct LuminanceSums {
    double scale = 1; ///< what a sum counts in that of the pixel
    std::array<double, kReplicas> y{};
    std::array<uint32_t, kReplicas> count{};
    double surfaceY = 0;
    std::array<uint32_t, kReplicas> surfaceCount{};
    uint32_t samples() const { return std::accumulate(count.begin(), count.end(), 0u); }
    uint32_t onSurface() const { return std::accumulate(surfaceCount.begin(), surfaceCount.end(), 0u); }
    double sum() const { return std::accumulate(y.begin(), y.end(), 0.0); }
};

/// By what sums of samples of positive and of negative weight are multiplied to make a pixel, from the sizes of their weights.
/// A pixel that has samples of one sign only is their mean; in return the negative part counts more where there are samples of
/// both, by the chance that there are. `samples`: of both, by replica.
std::array<double, 2> signScales(double negative, const std::array<uint32_t, kReplicas>& samples, double plusWeights,
                                 double minusWeights);

/// Exact sums over a crop window. Radiance, alpha and luminance are fixed point (fixed.h): values are rounded to 2^-40 one by
/// one and saturate (counted) at 2^60; from there on every sum is an integer. So the sums do not depend on the order of the
/// samples, on threads, on how a render was split over machines, or on interruptions.
///
/// Threads: different pixels may be added to at the same time, one pixel by one thread at a time (tiles own their pixels). All
/// other members must not run beside add().
class Film {
public:
    /// The description must be valid: see check().
    explicit Film(FilmDescription);
    /// False with an error reported when sizes or channel counts are beyond the limits or the window is outside the picture.
    static bool check(const FilmDescription&, Diagnostics&, const SourcePlace& = {});

    const FilmDescription& description() const { return description_; }
    const Window& window() const { return description_.window; }

    /// Adds a sample. A sample with a NaN or an infinity in radiance or alpha is dropped, counted, and false returned. Such a
    /// value in an averaged AOV counts as 0 and is counted; Min and Max channels accept infinities and pass over NaN, counted.
    bool add(int x, int y, uint32_t sampleIndex, const FilmSample&);

    /// Says that these samples of every pixel have been added (whole passes only). False when they overlap a range already
    /// there, are empty, or make more samples than limits::kSamplesPerPixel; then nothing changes.
    bool addRange(SampleRange);
    /// The samples held, ascending, neighbours joined.
    const std::vector<SampleRange>& ranges() const { return ranges_; }
    /// Samples per pixel: the sum of the ranges' lengths, which all pixels have.
    uint32_t samplesPerPixel() const;
    /// From here on pixels get samples by these rates, one for each, beyond samplesPerPixel(). False unless the film holds
    /// samples 0 to n - 1 of every pixel and no rate is above Spread::kMost.
    bool spread(std::vector<uint16_t> rates);
    /// Null: all pixels have the same samples.
    const Spread* spread() const { return spread_ ? &*spread_ : nullptr; }
    /// Says that the samples of further steps have been added. False when a pixel would have more than limits::kSamplesPerPixel.
    bool addSteps(uint32_t steps);
    /// Which samples of a pixel so many further steps bring.
    SampleRange samplesOfSteps(int x, int y, uint32_t steps) const;
    /// Samples a pixel, of all on average, and of those with the fewest and the most.
    struct Samples {
        double mean = 0;
        uint64_t least = 0, most = 0;
    };
    Samples samples() const { return samplesAfter(0); }
    /// The same, after so many further steps.
    Samples samplesAfter(uint32_t steps) const;

    /// Adds the other film's integers. False with an error when the descriptions differ, sample ranges overlap, or either is
    /// spread.
    bool merge(const Film& other, Diagnostics&, const SourcePlace& = {});

    uint32_t count(int x, int y) const;
    Color mean(int x, int y) const;  ///< 0 where nothing was counted
    float alpha(int x, int y) const; ///< mean alpha
    float aov(int x, int y, int channel) const;
    /// Mean of the sum of such channels, all isSum(); 0 of none.
    float aov(int x, int y, std::span<const int> channels) const;
    /// The integer sum of one, in units of 2^-40; of a component of Ci.
    Int128 fixedAov(int x, int y, int channel) const { // of positive weight, where samples have weights
        return aovs_[index(x, y) * description_.channels.size() + size_t(channel)];
    }
    Int128 fixed(int x, int y, int component) const { return pixel(x, y).rgb[component]; }
    Moments moments(int x, int y) const;
    /// Luminance sum and count of one replica. Where samples have weights the sums are such that they add up to the pixel's, and
    /// depart from its mean as the replica's share of the pixel does.
    void replica(int x, int y, uint32_t r, double* sum, uint32_t* n) const;

    /// Of all samples; where they have weights of positive and of negative weight.
    std::vector<LuminanceSums> luminanceSums(int x, int y) const;

    uint64_t nonFinite() const { return nonFinite_; }         ///< samples dropped
    uint64_t nonFiniteAovs() const { return nonFiniteAovs_; } ///< AOV values not counted
    uint64_t saturated() const { return saturated_; }         ///< values clamped at 2^60
    std::optional<DroppedSample> firstDropped() const;

    /// A 64-bit digest of all sums: equal films have equal digests.
    uint64_t digest() const;

    /// Free text that travels with a part file (display names, version); not compared by merge, which keeps this film's own
    /// entries and adds the missing ones.
    std::map<std::string, std::string> metadata;

private:
    friend struct FilmIo;
    struct Pixel {
        Int128 rgb[3] = {0, 0, 0};
        Int128 alpha = 0;
        Int128 replicaY[kReplicas] = {}; ///< their sum is the first moment
        UInt256 y2;                      ///< unit 2^-80
        uint32_t replicaCount[kReplicas] = {};
        Int128 surfaceY = 0; ///< of the samples that met a surface
        uint32_t surfaceCount[kReplicas] = {};
    };
    size_t layers() const { return description_.negative ? 2 : 1; }
    template <class SumOf> double average(int x, int y, SumOf) const;
    static Moments momentsOf(const Pixel&);
    std::array<uint32_t, kReplicas> countsAt(size_t pixel) const; ///< of all layers
    size_t index(int x, int y) const { return size_t(y - window().y0) * size_t(window().width()) + size_t(x - window().x0); }
    const Pixel& pixel(int x, int y) const { return pixels_[index(x, y)]; }
    /// Where the sums of a pixel for samples of negative weight are, behind those of all pixels.
    size_t below(size_t pixel) const { return pixel + window().pixels(); }
    void addParts(size_t pixel, const FilmSample&, const Int128 (&rgb)[3], bool* saturated);

    FilmDescription description_;
    std::vector<Pixel> pixels_;   ///< by layer, then place
    std::vector<Int128> weights_; ///< sizes of the weights, like pixels_; empty where all are 1
    std::vector<int> parts_[3];   ///< channels that are parts, by component
    std::vector<Int128> aovs_;    ///< like pixels_, by channel; Min and Max hold the key of the value (film.cpp)
    std::vector<SampleRange> ranges_;
    std::optional<Spread> spread_;
    uint64_t nonFinite_ = 0, nonFiniteAovs_ = 0, saturated_ = 0;
    uint64_t firstDropped_[2] = {~0ull, 0}; ///< {sample << 32 | y, x}; all ones: none
    std::vector<uint8_t> dropLock_ = {0};   ///< spin lock of firstDropped_, a vector so that films can move
};

} // namespace alpenglow::render
