// The film of `path`: exact sums for each pixel (docs/design/sampling.md). Pictures and noise figures derive from them.
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
    /// Of the window, in pixels.
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    size_t pixels() const { return size_t(width()) * size_t(height()); }
    /// Whether a pixel is inside; x0 and y0 are, x1 and y1 are not.
    bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
    friend bool operator==(const Window&, const Window&) = default;
};

/// How a pixel is computed from the samples of an AOV channel.
enum class ChannelRule : uint8_t {
    Average,     ///< mean over the samples, like Ci
    Min,         ///< smallest value (depth filter "min"); +infinity without a finite sample
    Max,         ///< largest value; -infinity likewise
    PartOfRed,   ///< mean of a part of Ci: the parts of a component add up to it exactly, sample by sample. The rounding
    PartOfGreen, ///< error goes to the largest part
    PartOfBlue
};
/// Whether the samples of a channel are summed.
inline bool isSum(ChannelRule r) { return r != ChannelRule::Min && r != ChannelRule::Max; }

/// A channel of the film besides Ci and alpha.
struct Channel {
    std::string name;                        ///< name of the output, and of its component
    ChannelRule rule = ChannelRule::Average; ///< how its samples are joined
    friend bool operator==(const Channel&, const Channel&) = default;
};

/// Samples begin <= index < end of every pixel (--samples A:B).
struct SampleRange {
    uint32_t begin = 0, end = 0;
    friend bool operator==(const SampleRange&, const SampleRange&) = default;
};

/// Sample counts of pixels under adaptive sampling (adaptive.h). A pixel with rate 1 has n = base / 8 + kReplicas * steps
/// samples; others have n times their rate, in multiples of kReplicas; but at least `base`. The indices follow from these values,
/// so they suffice to continue a render. At first only pixels with the largest rate get more.
struct Spread {
    static constexpr uint16_t kOne = 256, kMost = 8 * kOne; ///< the rate 1, and the largest
    uint32_t base = 0, steps = 0;
    std::vector<uint16_t> rates; ///< by pixel of the window, in rows; kOne is 1; at most kMost
    /// Number of samples of a pixel with rate 1 after so many steps.
    uint64_t ofOne(uint64_t after) const { return base / 8 + kReplicas * after; }
    /// Samples 0 <= index < held() of pixel i are in the film, after so many steps.
    uint64_t held(size_t i, uint64_t after) const {
        return std::max<uint64_t>(base, rates[i] * ofOne(after) / (kOne * kReplicas) * kReplicas);
    }
    /// The same now.
    uint64_t held(size_t i) const { return held(i, steps); }
};

/// Identity of a render: films are parts of one render only if all of this is equal.
struct FilmDescription {
    int width = 0, height = 0;     ///< of the whole picture, pixels
    Window window;                 ///< the crop window; must lie inside the picture
    uint64_t seed = 0;             ///< of all random numbers
    std::string scene;             ///< a digest of the scene and of every option that changes the picture; chosen by the caller
    std::vector<Channel> channels; ///< AOVs
    /// For pixel filters with weighted samples (FilterSampler::negativePart()): integral of the negative part over the integral
    /// of the filter, >= 0. Samples of each sign are then summed separately, and each sum is divided by its weights: constant
    /// values stay exact, and a pixel with samples of both signs is unbiased.
    std::optional<double> negative;
    friend bool operator==(const FilmDescription&, const FilmDescription&) = default;
};

/// One sample of one pixel. Linear, unclamped.
struct FilmSample {
    Color radiance;              ///< premultiplied
    float alpha = 0;             ///< 0 to 1
    std::span<const float> aovs; ///< one value per channel; missing ones count as 0
    bool surface = true;         ///< the camera ray hit a surface of any opacity; false: background only
    float weight = 1;            ///< of the pixel filter: multiplies radiance, alpha and averaged AOVs, not the noise figures
};

/// The first sample that was dropped (by sample index, then y, then x), for reproduction.
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

/// Luminance of a pixel's samples, of one sign if they have weights, and of those that hit a surface.
struct LuminanceSums {
    double scale = 1;                               ///< factor of this sum in the pixel's value
    std::array<double, kReplicas> y{};              ///< by replica: sum, and number of samples
    std::array<uint32_t, kReplicas> count{};        ///< number of samples, by replica
    double surfaceY = 0;                            ///< sum over samples that hit a surface
    std::array<uint32_t, kReplicas> surfaceCount{}; ///< their number, by replica
    /// Sums over the replicas.
    uint32_t samples() const { return std::accumulate(count.begin(), count.end(), 0u); }
    uint32_t onSurface() const { return std::accumulate(surfaceCount.begin(), surfaceCount.end(), 0u); }
    double sum() const { return std::accumulate(y.begin(), y.end(), 0.0); }
};

/// Factors of the sums with positive and with negative weight in a pixel's value, from the sizes of their weights. A pixel with
/// samples of one sign only has their mean; in compensation the negative part counts more in pixels with both, by the probability
/// of that. `samples`: of both, by replica.
std::array<double, 2> signScales(double negative, const std::array<uint32_t, kReplicas>& samples, double plusWeights,
                                 double minusWeights);

/// Exact sums over a crop window. Radiance, alpha and luminance are fixed point (fixed.h): each value is rounded to 2^-40 and
/// saturates (counted) at 2^60; after that every sum is an integer. So sums do not depend on the order of samples, on threads, on
/// the distribution over machines, or on interruptions.
///
/// Thread safety: add() may run on different pixels at once, with one thread for a pixel at a time (tiles own their pixels). No
/// other member may run at the same time as add().
class Film {
public:
    /// The description must be valid: see check().
    explicit Film(FilmDescription);
    /// False with an error reported when sizes or channel counts are beyond the limits or the window is outside the picture.
    static bool check(const FilmDescription&, Diagnostics&, const SourcePlace& = {});

    /// As it was constructed.
    const FilmDescription& description() const { return description_; }
    const Window& window() const { return description_.window; }

    /// Adds a sample. A sample with a NaN or infinity in radiance or alpha is dropped and counted, and false is returned. Such a
    /// value in an averaged AOV counts as 0 and is counted; Min and Max channels accept infinities and ignore NaN, counted.
    bool add(int x, int y, uint32_t sampleIndex, const FilmSample&);

    /// Records that these samples of every pixel have been added (complete passes only). Returns false, without effect, if the
    /// range overlaps an existing one, is empty, or exceeds limits::kSamplesPerPixel.
    bool addRange(SampleRange);
    /// The ranges in the film, ascending, adjacent ones joined.
    const std::vector<SampleRange>& ranges() const { return ranges_; }
    /// Samples per pixel: total length of the ranges, equal for all pixels.
    uint32_t samplesPerPixel() const;
    /// Distributes samples beyond samplesPerPixel() by these rates, one for each pixel. Returns false unless the film holds
    /// samples 0 to n - 1 of every pixel and no rate exceeds Spread::kMost.
    bool spread(std::vector<uint16_t> rates);
    /// Null: all pixels have the same number of samples.
    const Spread* spread() const { return spread_ ? &*spread_ : nullptr; }
    /// Records that samples of further steps have been added. Returns false if a pixel would exceed limits::kSamplesPerPixel.
    bool addSteps(uint32_t steps);
    /// The sample indices of a pixel in so many further steps.
    SampleRange samplesOfSteps(int x, int y, uint32_t steps) const;
    /// Samples per pixel: mean, smallest and largest.
    struct Samples {
        double mean = 0;
        uint64_t least = 0, most = 0; ///< smallest and largest
    };
    /// Of all pixels of the window.
    Samples samples() const { return samplesAfter(0); }
    /// The same, after so many further steps.
    Samples samplesAfter(uint32_t steps) const;

    /// Adds the integers of another film. Returns false with an error if the descriptions differ, sample ranges overlap, or
    /// either film is adaptive.
    bool merge(const Film& other, Diagnostics&, const SourcePlace& = {});

    /// Samples of a pixel, which must be in the window.
    uint32_t count(int x, int y) const;
    Color mean(int x, int y) const;  ///< 0 without samples
    float alpha(int x, int y) const; ///< mean alpha
    /// A channel of a pixel by its rule; 0 without samples.
    float aov(int x, int y, int channel) const;
    /// Mean of the sum of channels, all isSum(); 0 if there are none.
    float aov(int x, int y, std::span<const int> channels) const;
    /// The integer sum of a channel, in units of 2^-40; of a component of Ci.
    Int128 fixedAov(int x, int y, int channel) const { // those of positive weight, if samples have weights
        return aovs_[index(x, y) * description_.channels.size() + size_t(channel)];
    }
    Int128 fixed(int x, int y, int component) const { return pixel(x, y).rgb[component]; }
    /// Of the luminance of a pixel's samples, for noise figures.
    Moments moments(int x, int y) const;
    /// Luminance sum and count of one replica. If samples have weights, the sums add up to the pixel's, and deviate from its mean
    /// as the replica's contribution to the pixel does.
    void replica(int x, int y, uint32_t r, double* sum, uint32_t* n) const;

    /// Of all samples; if they have weights, separately for positive and negative weight.
    std::vector<LuminanceSums> luminanceSums(int x, int y) const;

    uint64_t nonFinite() const { return nonFinite_; }         ///< samples dropped
    uint64_t nonFiniteAovs() const { return nonFiniteAovs_; } ///< AOV values not counted
    uint64_t saturated() const { return saturated_; }         ///< values clamped at 2^60
    /// The first sample with values that are not finite, by number, row and column; nothing if there is none.
    std::optional<DroppedSample> firstDropped() const;

    /// A 64-bit digest of all sums: equal films have equal digests.
    uint64_t digest() const;

    /// Free text in a part file (display names, version). merge() does not compare it: it keeps this film's entries and adds
    /// missing ones.
    std::map<std::string, std::string> metadata;

private:
    friend struct FilmIo;
    struct Pixel {
        Int128 rgb[3] = {0, 0, 0};
        Int128 alpha = 0;
        Int128 replicaY[kReplicas] = {}; ///< their sum is the first moment
        UInt256 y2;                      ///< unit 2^-80
        uint32_t replicaCount[kReplicas] = {};
        Int128 surfaceY = 0; ///< of the samples that hit a surface
        uint32_t surfaceCount[kReplicas] = {};
    };
    size_t layers() const { return description_.negative ? 2 : 1; }
    template <class SumOf> double average(int x, int y, SumOf) const;
    static Moments momentsOf(const Pixel&);
    std::array<uint32_t, kReplicas> countsAt(size_t pixel) const; ///< over both signs
    size_t index(int x, int y) const { return size_t(y - window().y0) * size_t(window().width()) + size_t(x - window().x0); }
    const Pixel& pixel(int x, int y) const { return pixels_[index(x, y)]; }
    /// Index of a pixel's sums for samples of negative weight, stored after those of all pixels.
    size_t below(size_t pixel) const { return pixel + window().pixels(); }
    void addParts(size_t pixel, const FilmSample&, const Int128 (&rgb)[3], bool* saturated);

    FilmDescription description_;
    std::vector<Pixel> pixels_;   ///< by sign, then pixel
    std::vector<Int128> weights_; ///< absolute weights, like pixels_; empty if all are 1
    std::vector<int> parts_[3];   ///< channels that are parts, by component
    std::vector<Int128> aovs_;    ///< like pixels_, by channel; Min and Max hold the key of the value (film.cpp)
    std::vector<SampleRange> ranges_;
    std::optional<Spread> spread_;
    uint64_t nonFinite_ = 0, nonFiniteAovs_ = 0, saturated_ = 0;
    uint64_t firstDropped_[2] = {~0ull, 0}; ///< {sample << 32 | y, x}; all ones: none
    std::vector<uint8_t> dropLock_ = {0};   ///< spin lock of firstDropped_, a vector so that films can move
};

} // namespace alpenglow::render
