// Shutter times and lens positions of a pixel's image samples, from one net over all samples.
//
// A pixel of s x s samples has s^2 points in five dimensions: column and row (the cells of the positions, stratifiedOffset),
// time, and two of the lens. Each is a column of Bose's orthogonal array, level x + g y over the field of s elements with its own
// factor g: any two columns contain each pair of levels once, and a level is divided by s again, so that each column alone has
// all s^2 strata. That is a (0,2,5)-net in base s (Owen, "Orthogonal arrays for computer experiments", 1992; Jarosz et al.,
// "Orthogonal array sampling for Monte Carlo rendering", 2019). Digits are permuted independently in each pixel, including those
// of columns and rows: otherwise an edge along a diagonal of the cells would see few times.
//
// There are s - 1 factors if s is prime or a power of two, else one. If they do not suffice (the lens of 2 x 2 samples, of 3 x 3
// with motion, of 6 x 6), the lens uses the pixel's (0,2)-sequence; if nx differs from ny, time has nx ny strata in random order.
#pragma once
#include "base/sampler.h"
#include <vector>

namespace alpenglow::render {

/// The nets of one frame's pixels. Immutable.
class PixelNet {
public:
    /// The numbers of one sample.
    struct Numbers {
        float time = 0;        ///< each in [0, 1)
        Vec2 lens{0.5f, 0.5f}; ///< in the unit square
    };
    /// State of a pixel; reuse it for all of its samples.
    struct Pixel {
        Sampler sampler;                          ///< of the pixel
        Words4<uint32_t> all, time, lensX, lensY; ///< words that permute the digits of each dimension
    };
    /// Sample k is in column k % nx of row k / nx. `moves`, `lens`: the dimensions needed; others keep their defaults.
    PixelNet(int nx, int ny, bool moves, bool lens);
    /// Whether some dimension is needed.
    bool asked() const { return moves_ || lens_; }
    /// For the pixel of a sampler; the numbers of its sample k.
    Pixel pixel(const Sampler&) const;
    Numbers sample(const Pixel&, int k) const;

private:
    /// A column of the array: g times the level, by row of samples; and the column that divides its levels. Empty `part`: divided
    /// by rows.
    struct Column {
        std::vector<int> level, part;
    };
    Column column(int g) const;
    int sum(int a, int b) const;
    float number(const Column&, const Words4<uint32_t>& words, int x, int y, uint32_t within) const;

    int nx_, count_, side_ = 0; ///< side_: of the array; 0: none
    int factors_ = 0;
    bool two_ = false; ///< a power of two: sums are XOR of binary digits
    bool moves_, lens_;
    Column time_, lensX_, lensY_; ///< empty: not from the array
};

} // namespace alpenglow::render
