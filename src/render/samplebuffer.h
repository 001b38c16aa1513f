// Image samples of `hidden` and `raytrace` and their reconstruction by RISpec: stratified samples, shared between neighbouring
// pixels, weighted by each display's own filter; depth by its depth filter.
//
// The value of a pixel is a sum over nearby samples in a fixed order; each sample is a function of (seed, pixel, index). Tiles,
// bands and threads change nothing: a buffer over a part of the raster, with its border, gives the same bits.
#pragma once
#include "base/numberlanes.h"
#include "render/film.h"
#include "render/filterweights.h"
#include <limits>

namespace alpenglow::render {

/// Hider parameter "jitter".
enum class Jitter {
    Grid = 0,      ///< centres of the nx x ny cells of a pixel
    Jittered = 1,  ///< one random position per cell
    Scrambled = 2, ///< the pixel's own (0,2)-sequence (sampler.h), no cells
    Middle = 3     ///< all at the centre of the pixel ("lensSamples")
};

/// Position of sample k (0 <= k < nx * ny) inside its pixel, each in [0,1).
Vec2 stratifiedOffset(uint64_t seed, int x, int y, int k, int nx, int ny, Jitter);

/// Computes the positions of many samples, with the same bits.
class PlaceRows {
public:
    /// nx, ny: samples of a pixel.
    PlaceRows(uint64_t seed, int nx, int ny, Jitter jitter) : seed_(seed), nx_(nx), ny_(ny), jitter_(jitter) {}
    /// Drops requests; memory stays.
    void clear();
    /// Requests sample k, 0 <= k < nx ny, of a pixel.
    void ask(int x, int y, int k);
    /// Computes the requested positions.
    void draw();
    /// After draw(): places()[i] is the position of the i-th request.
    std::span<const Vec2> places() const { return places_; }

private:
    SeedKey seed_;
    int nx_, ny_;
    Jitter jitter_;
    NumberRows numbers_;
    int x_ = 0, y_ = 0;
    std::optional<Sampler> pixel_; ///< the last one's, x_ and y_
    std::vector<int> asked_;
    std::vector<Vec2> places_;
};

/// An image sample: colour and AOVs composited over its surfaces, premultiplied by opacity.
struct ImageSample {
    Color color, opacity;                                   ///< premultiplied
    float z = std::numeric_limits<float>::infinity();       ///< camera-space depth of the first surface that counts; inf: none
    float zSecond = std::numeric_limits<float>::infinity(); ///< of the second surface, for depth filter "midpoint"
    std::span<const float> aovs;                            ///< in the order of the frame's AOVs
};

/// How the depths of the samples around a pixel become one (the hider's parameter "depthfilter").
enum class DepthFilter { Min, Max, Average, Midpoint };
/// "min" "max" "average" "midpoint", also "zmin" "zmax".
std::optional<DepthFilter> depthFilterByName(std::string_view);

/// A rectangle of pixels, channels interleaved, rows from the top.
struct Image {
    Window window;                     ///< what it covers
    std::vector<std::string> channels; ///< "r" "g" "b" "a" "Or" "Og" "Ob" "z", then the AOVs
    std::vector<float> data;           ///< window.width() numbers times channels a row
    /// X, y in the window; c: index of a channel.
    float at(int x, int y, int c) const {
        return data[(size_t(y - window.y0) * size_t(window.width()) + size_t(x - window.x0)) * channels.size() + size_t(c)];
    }
};
inline constexpr int kImageFixedChannels = 8;

/// Number of pixels beyond its own that a filter of full width w pixels, centred on a pixel, can reach.
int border(double w);

/// Samples of a part of the raster.
class SampleBuffer {
public:
    /// Samples for reconstructing `window` with filters whose full widths do not exceed maxXw, maxYw. nx, ny >= 1 per pixel.
    /// `memory`: from another buffer's takeMemory(), with any contents.
    SampleBuffer(Window window, double maxXw, double maxYw, int nx, int ny, std::vector<Channel> aovs, uint64_t seed, Jitter,
                 std::vector<float> memory = {});
    /// Number of floats for a window of so many pixels.
    static size_t floats(int width, int height, double maxXw, double maxYw, int samplesPerPixel, size_t aovs) {
        return size_t(width + 2 * border(maxXw)) * size_t(height + 2 * border(maxYw)) * size_t(samplesPerPixel) * (kAovs + aovs);
    }
    /// Takes the memory, for the next buffer.
    std::vector<float> takeMemory() && { return std::move(data_); }
    /// Moves to the window below, of the same width, and keeps the samples of shared rows. Returns the first row without samples.
    int moveDown(const Window&);

    /// All pixels that need samples: the window and its border. It may extend beyond the picture.
    const Window& sampled() const { return sampled_; }
    /// Nx times ny.
    int samplesPerPixel() const { return nx_ * ny_; }
    /// Raster position of a sample, pixels.
    Vec2 position(int x, int y, int k) const;
    /// Stores sample k of a pixel of sampled(), at stratifiedOffset() in the pixel. One thread for a pixel at a time. A sample
    /// whose colour or opacity is not finite is dropped and counted, and false is returned; a NaN in an AOV or depth becomes 0 or
    /// "none", counted.
    bool set(int x, int y, int k, Vec2 place, const ImageSample&);
    /// Sets sample k of a pixel; false: it is not finite and counts as "none".
    bool set(int x, int y, int k, const ImageSample&);
    /// Colour of a sample; black if there is none.
    Color color(int x, int y, int k) const;
    /// Number of samples that set() has refused.
    uint64_t nonFinite() const { return nonFinite_; }

    /// The pixels of `out`, which must be inside the constructor's window. Colours, opacities and averaged AOVs: weighted by the
    /// filter and divided by the sum of weights; if the filter covers no sample, or its weights cancel, the mean of the pixel's
    /// own samples. Alpha: mean of the three opacities. z and Min/Max AOVs: from the pixel's own samples. z: "max" counts misses
    /// as infinite; "average" is over hits; "midpoint" is the smallest mid-depth of two surfaces, infinite if no sample has a
    /// second surface (nothing behind could be shadowed).
    Image reconstruct(const PixelFilter&, DepthFilter, Window out) const;
    /// The same into rows of pixels with all channels, at a distance of `rowFloats`. The filter must not be wider than the buffer
    /// supports (weights()).
    void reconstruct(const FilterWeights&, DepthFilter, Window out, float* to, size_t rowFloats) const;
    /// Only the channel z.
    void reconstructDepth(DepthFilter, Window out, float* to, size_t rowFloats) const;
    /// Weights of a filter, cut to the border of the buffer if it is wider.
    FilterWeights weights(const PixelFilter&) const;

private:
    size_t base(int x, int y, int k) const {
        size_t pixel = size_t(y - sampled_.y0) * size_t(sampled_.width()) + size_t(x - sampled_.x0);
        return (pixel * size_t(nx_ * ny_) + size_t(k)) * stride_;
    }
    struct Scratch;
    bool hasSamples(const Window&) const;
    void block(const FilterWeights&, const Window&, Scratch&, float* to, size_t rowFloats) const;
    void weigh(const FilterWeights&, const Window& block, int row, Scratch&) const;
    void multiply(const FilterWeights&, const Window& block, int row, int y, Scratch&) const;
    void weighEach(const FilterWeights&, const Window& block, int row, int y, Scratch&) const;
    void addRow(const Window& block, int row, int y, Scratch&) const;
    void finish(double* sums, int x, int y, float* out) const;
    void addSample(const float* sample, double weight, double* sums) const;
    void ownValues(int x, int y, float* out) const;
    float depthOf(DepthFilter, int x, int y) const;
    size_t channels() const { return size_t(kImageFixedChannels) + aovs_.size(); }

    static constexpr int kColor = 2, kOpacity = 5, kDepth = 8, kDepth2 = 9; ///< floats of a sample
    static constexpr size_t kAovs = 10;
    Window window_, sampled_;
    int nx_, ny_;
    std::vector<Channel> aovs_;
    bool averagesAll_; ///< no AOV has rule Min or Max
    uint64_t seed_;
    Jitter jitter_;
    size_t stride_;
    /// For each sample: offset x (-1: no sample), offset y (of no sample, 1: dropped), colour, opacity, z, second z, AOVs.
    std::vector<float> data_;
    uint64_t nonFinite_ = 0;
};

} // namespace alpenglow::render
