// Sample positions drawn from a pixel filter (design decision 10): under `path` a sample belongs to one pixel only.
//
// The density is |f| / A, A = integral of |f|. A sample's weight is its sign times A / T, T = integral of f, so that
// E[weight * g(offset)] = integral f g / T: the filtered value, negative lobes included. The numbers are mapped monotonically
// on each axis, so the positive and the negative parts of f are fixed intervals of the unit square: with stratified numbers
// their shares are fixed too, and the sign costs little noise.
#pragma once
#include "base/vec.h"
#include "render/pixelfilter.h"
#include <vector>

namespace alpenglow::render {

struct FilterSample {
    float dx = 0, dy = 0; ///< offset from the pixel centre, pixels
    float weight = 1;     ///< multiplies the sample; 1 for filters without negative parts
};

class FilterSampler {
public:
    explicit FilterSampler(const PixelFilter&);
    FilterSample sample(Vec2 u) const;
    /// The density of sample()'s offsets, per square pixel; integrates to 1.
    double density(double x, double y) const;
    /// Integral of the filter and of its absolute value, over its support, in square pixels.
    double integral() const { return total_; }
    double absIntegral() const { return absolute_; }
    /// True when the filter's integral is not positive, so that it cannot be normalised; then a box of its widths is drawn.
    bool degenerate() const { return degenerate_; }
    const PixelFilter& filter() const { return filter_; }

private:
    /// One axis of a separable filter: |f| as straight pieces between nodes, pieces cut at the zeros of f, masses by quadrature.
    struct Axis {
        std::vector<double> node, value, cdf;
        std::vector<signed char> sign;
        double total = 0, absolute = 0;
        void build(const PixelFilter&, double width);
        double invert(double u, int* sign) const;
        double density(double t) const;
    };
    /// A filter that is no product: constant on cells; rows by their mass, cells within a row.
    struct Grid {
        int n = 0;
        std::vector<double> rowCdf, cellCdf, mass;
    };
    void buildGrid();

    PixelFilter filter_;
    Axis x_, y_;
    Grid grid_;
    double total_ = 0, absolute_ = 0;
    bool degenerate_ = false;
};

} // namespace alpenglow::render
