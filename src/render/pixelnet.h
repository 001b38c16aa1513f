// When the shutter is open and where on the lens: the numbers of a pixel's image samples, from one net over all of them.
//
// A pixel of s x s samples has s^2 points in five dimensions: its columns and rows (the cells of the places, stratifiedOffset),
// time, and two of the lens. Each is a column of Bose's orthogonal array, level x + g y over the field of s elements with a
// factor g of its own: any two have each pair of levels once, and a level is cut in s again, so that alone each has all s^2
// strata. That is a (0,2,5)-net in base s (Owen, "Orthogonal arrays for computer experiments", 1992; Jarosz et al., "Orthogonal
// array sampling for Monte Carlo rendering", 2019). Digits are permuted anew in each pixel, those of columns and rows too, or an
// edge along a diagonal of the cells would meet few times.
//
// There are s - 1 factors where s is prime or a power of two, and one else. Where they do not suffice (the lens of 2 x 2 samples,
// of 3 x 3 that move, of 6 x 6) the lens has the pixel's (0,2)-sequence, all samples of it in one; where nx is not ny, time has
// nx ny strata in random order.
#pragma once
#include "base/sampler.h"
#include <vector>

namespace alpenglow::render {

class PixelNet {
public:
    struct Numbers {
        float time = 0; ///< each in [0, 1)
        Vec2 lens{0.5f, 0.5f};
    };
    /// Of a pixel; keep it from sample to sample.
    struct Pixel {
        Sampler sampler;
        Words4<uint32_t> all, time, lensX, lensY;
    };
    /// Sample k is in column k % nx of row k / nx. `moves`, `lens`: what is asked for; the rest stays as above.
    PixelNet(int nx, int ny, bool moves, bool lens);
    bool asked() const { return moves_ || lens_; }
    Pixel pixel(const Sampler&) const;
    Numbers sample(const Pixel&, int k) const;

private:
    /// A column of the array: by row of samples, g times it; and the same of the column that cuts its levels. No `part`: rows do.
    struct Column {
        std::vector<int> level, part;
    };
    Column column(int g) const;
    int sum(int a, int b) const;
    float number(const Column&, const Words4<uint32_t>& words, int x, int y, uint32_t within) const;

    int nx_, count_, side_ = 0; ///< side_: of the array; 0: there is none
    int factors_ = 0;
    bool two_ = false; ///< a power of two: sums are of binary digits
    bool moves_, lens_;
    Column time_, lensX_, lensY_; ///< empty: not of the array
};

} // namespace alpenglow::render
