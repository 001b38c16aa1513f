// Sample positions drawn from a pixel filter (docs/design/sampling.md): under `path` a sample belongs to one pixel only.
//
// The density is |f| / A, with A = integral of |f|. A sample's weight is its sign times A / T, with T = integral of f, so that
// E[weight * g(offset)] = integral f g / T: the filtered value, including negative lobes. The first number alone determines the
// sign: [0, s) gives the positive part of f, [s, 1) the negative. So stratified numbers fix the fraction of each sign to within
// one sample a replica, and the sign causes little noise. The film sums the signs separately (FilmDescription::negative).
#pragma once
#include "base/vec.h"
#include "render/pixelfilter.h"
#include <optional>
#include <vector>

namespace alpenglow::render {

/// One sample of a filter.
struct FilterSample {
    float dx = 0, dy = 0; ///< offset from the pixel centre, pixels
    float weight = 1;     ///< multiplies the sample; 1 for filters without negative parts
};

/// A filter prepared for sampling. Immutable.
class FilterSampler {
public:
    /// The filter's values may be negative.
    explicit FilterSampler(const PixelFilter&);
    /// u: two numbers in [0, 1). Continuous in u within each sign of the filter, so that stratified numbers stay stratified.
    FilterSample sample(Vec2 u) const;
    /// The density of sample()'s offsets, per square pixel; integrates to 1.
    double density(double x, double y) const;
    /// Integral of the filter and of its absolute value over its support, in square pixels.
    double integral() const { return total_; }
    double absIntegral() const { return absolute_; }
    /// True if the filter's integral is not positive, so it cannot be normalised; a box of its widths is sampled instead.
    bool degenerate() const { return degenerate_; }
    /// Integral of the filter's negative part over that of the filter; unset if all samples have weight 1.
    std::optional<double> negativePart() const;
    /// As given to the constructor.
    const PixelFilter& filter() const { return filter_; }

private:
    /// The part of an axis where the filter has one sign: its pieces and their cumulative masses, 0 to 1. `guide`: for uniform
    /// steps of 0 to 1, index of the last mass at or below the start of the step.
    struct Part {
        std::vector<int> piece;
        std::vector<double> cdf{0};
        std::vector<int> guide;
        double mass = 0;
    };
    /// One axis of a separable filter: |f| as linear pieces between nodes, cut at the zeros of f, masses by quadrature.
    struct Axis {
        std::vector<double> node, value, mass; ///< mass of the piece that starts at a node; total 1
        Part part[2];                          ///< positive, negative
        double total = 0, absolute = 0;
        void build(const PixelFilter&, double width);
        double invert(double u, const Part&) const;
        double density(double t) const;
    };
    /// One sign of a filter that is not separable: constant on cells; rows by their mass, cells within a row.
    struct Grid {
        std::vector<double> rowCdf, cellCdf, mass;
        double share = 0; ///< fraction of the integral of |f|
    };
    void buildGrids();

    PixelFilter filter_;
    Axis x_, y_;
    Grid grid_[2]; ///< positive, negative
    double total_ = 0, absolute_ = 0;
    bool degenerate_ = false;
};

} // namespace alpenglow::render
