// Weights for reconstruction: a pixel filter from tables.
#pragma once
#include "render/pixelfilter.h"
#include <memory>
#include <vector>

namespace alpenglow::render {

/// A filter interpolated linearly between exact values. Its support is exact.
class FilterWeights {
public:
    /// Tabulates the filter.
    explicit FilterWeights(const PixelFilter&);
    /// Largest error of a weight, relative to the filter's maximum: half of it for each axis.
    static constexpr double kError = 2e-6;

    /// The filter.
    const PixelFilter& filter() const { return filter_; }
    /// The filter at (x, y), in pixels from its centre.
    float operator()(double x, double y) const;
    /// True if the value is the product of across(x) and down(y).
    bool separable() const { return separable_; }
    /// The factor of a separable filter at an offset in pixels; 0 beyond its support.
    float across(double x) const { return axis(across_.get(), x, filter_.xw / 2); }
    float down(double y) const { return axis(down_.get(), y, filter_.yw / 2); }

private:
    /// A function on [0, end], 0 beyond.
    struct Table {
        struct Piece {
            float value, slope; ///< at the start of the piece; change over the piece
        };
        std::vector<Piece> pieces;
        double end, scale; ///< scale: pieces per unit
        template <class F> Table(double end_, int count, const F& f);
        float operator()(double t) const {
            if (!(t <= end)) return 0;
            const double at = t * scale;
            const size_t i = size_t(int(at));
            return pieces[i].value + float(at - double(int(i))) * pieces[i].slope;
        }
    };
    /// No table: a box.
    static float axis(const Table* table, double t, double half) {
        t = t < 0 ? -t : t;
        return table ? (*table)(t) : t <= half ? 1.f : 0.f;
    }

    PixelFilter filter_;
    bool separable_;
    std::shared_ptr<const Table> across_, down_; ///< separable filters except box
    /// Other filters: by distance in pixels, and by fraction of the distance to the rim
    std::shared_ptr<const Table> byDistance_, byPart_;
};

} // namespace alpenglow::render
