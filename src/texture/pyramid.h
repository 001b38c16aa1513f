// MIP-map levels: how they are stored, built and read.
#pragma once
#include "display/image.h"
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::texture {

/// Continuation outside of 0..1. Black: zeros. Mirror: alternately mirrored copies.
enum class Wrap { Black, Clamp, Periodic, Mirror };
/// "black", "clamp", "periodic" or "mirror"; nothing for other names.
std::optional<Wrap> wrapByName(std::string_view name);
/// The name that wrapByName() reads.
const char* nameOf(Wrap);

/// A value for each of the 256 codes of a channel.
using CodeTable = std::array<float, 256>;
inline constexpr CodeTable kCodeValues = [] {
    CodeTable v{};
    for (int i = 0; i < 256; ++i) v[size_t(i)] = float(i) / 255.0f;
    return v;
}();

/// Numbers of a level, immutable: in memory, or in a mapped scratch file (texture/scratch.h). kBeyond undefined numbers may be
/// read after the last. Copies share the numbers.
template <class T> class Texels {
public:
    static constexpr size_t kBeyond = 4;
    Texels() = default;
    /// Keeps the numbers in memory.
    Texels(std::vector<T> own) : size_(own.size()) {
        if (own.empty()) return;
        own.resize(size_ + kBeyond);
        const auto kept = std::make_shared<const std::vector<T>>(std::move(own));
        data_ = kept->data();
        owner_ = kept;
    }
    /// Mapped: `owner` keeps the memory of `data` alive.
    Texels(std::shared_ptr<const void> owner, const T* data, size_t size)
        : owner_(std::move(owner)), data_(data), size_(size), mapped_(true) {}
    bool empty() const { return size_ == 0; }
    size_t size() const { return size_; }
    const T* data() const { return data_; }
    const T& operator[](size_t i) const { return data_[i]; }
    bool mapped() const { return mapped_; }
    /// Size of its memory in bytes.
    size_t bytes() const { return mapped_ ? 0 : size_ * sizeof(T); }

private:
    std::shared_ptr<const void> owner_;
    const T* data_ = nullptr;
    size_t size_ = 0;
    bool mapped_ = false;
};

/// One level. 8-bit pictures, and maps made of them, store codes at level 0 (a quarter of the memory; the values k/255 are the
/// same floats); reduced levels are floats. A map with a transfer curve has both the numbers of the file, and linear light. Each
/// level holds the mean of either, because the light of a mean is not the mean of the light.
struct Level {
    int width = 0, height = 0, channels = 0; ///< texels; numbers of a texel
    Texels<float> values;
    Texels<uint8_t> codes; ///< when not empty, instead of values
    Texels<float> light;   ///< the values as light; empty: where there are codes by `table`, else there is no difference
    std::shared_ptr<const CodeTable> table; ///< the light of codes; null: there is no difference
    uint32_t colours = 0;                   ///< bit c: `table` holds for channel c
    /// Memory of the level.
    size_t bytes() const { return values.bytes() + light.bytes() + codes.bytes(); }
    /// Channel c of a texel; `at` counts all channels.
    float texel(size_t at, int c, bool asLight) const {
        if (codes.empty()) return asLight && !light.empty() ? light[at] : values[at];
        return tableOf(c, asLight)[codes[at]];
    }
    /// The values of the codes of channel c.
    const CodeTable& tableOf(int c, bool asLight) const {
        return asLight && table && c < 32 && (colours >> c & 1) ? *table : kCodeValues;
    }

    /// Adds weight times the bilinearly interpolated channels first, first+1, ... (count, all present) at (s, t) to `sum`. Texel
    /// centres are at ((i + 1/2) / width, (j + 1/2) / height); row 0 is t = 0, the top. s and t may be anything, also not finite.
    void addBilinear(float s, float t, Wrap swrap, Wrap twrap, int first, int count, float weight, float* sum,
                     bool asLight = false) const;
    /// Adds weight times the channels of texel (x, y) of an endless map: also beyond the sides, by the wrap modes.
    void addTexel(int x, int y, Wrap swrap, Wrap twrap, int first, int count, float weight, float* sum, bool asLight) const;
    /// Adds weight times the derivatives of the same channels by s and t (change over the complete map) to ds[0..count) and
    /// dt[0..count): the difference of addBilinear half a texel further and half a texel before. So they are continuous, exact on
    /// ramps, and exactly 0 on constant maps.
    void addSlopes(float s, float t, Wrap swrap, Wrap twrap, int first, int count, float weight, float* ds, float* dt,
                   bool asLight = false) const;
    /// Adds weight times the second derivatives by s twice, s and t, t twice: differences of addSlopes() over one texel. Exact on
    /// parabolas.
    void addCurves(float s, float t, Wrap swrap, Wrap twrap, int first, int count, float weight, float* ss, float* st, float* tt,
                   bool asLight = false) const;
};

/// Reduction kernel, in texels of the resulting level. Widths are full widths and multiply the filter's own: box 1, triangle 2,
/// gaussian 2, catmull-rom, mitchell 4, lanczos 4 (sinc is lanczos, disk is box, bessel and others gaussian).
struct Reduction {
    std::string_view filter = "box";
    float swidth = 1, twidth = 1; ///< times the width of the filter
};
/// Whether Reduction supports a filter.
bool isReductionFilter(std::string_view name);

/// The next level: each side max(1, n / 2). A texel weights the texels that it covers by exact overlap (box), which preserves the
/// mean for any size; other kernels are sampled at texel centres and normalised.
display::Image reduced(const display::Image&, const Reduction& = {}, Wrap swrap = Wrap::Clamp, Wrap twrap = Wrap::Clamp);
/// All levels below a picture, down to 1x1.
std::vector<display::Image> reducedLevels(const display::Image&, const Reduction& = {}, Wrap swrap = Wrap::Clamp,
                                          Wrap twrap = Wrap::Clamp);
/// A picture that is read row by row: read(y, row) fills width times channels numbers.
struct PictureRows {
    int width = 0, height = 0; ///< in pixels
    std::vector<std::string> channels;
    /// Thread safe if the maker asks for threads.
    std::function<void(int, float*)> read;
};
/// The same of such a picture.
display::Image reduced(const PictureRows&, const Reduction& = {}, Wrap swrap = Wrap::Clamp, Wrap twrap = Wrap::Clamp);
/// All levels below the picture, each half the one before, down to one texel.
std::vector<display::Image> reducedLevels(const PictureRows&, const Reduction& = {}, Wrap swrap = Wrap::Clamp,
                                          Wrap twrap = Wrap::Clamp);
/// How many of image.levels, from the first on, are each half the one before and have its channels.
size_t storedLevels(const display::Image&);

} // namespace alpenglow::texture
