// The pixel filters of RISpec, by its formulas and others (RISpec 3.2, appendix E; docs/design/sampling.md).
#pragma once
#include "base/diagnostics.h"
#include <optional>
#include <string_view>

namespace alpenglow::render {

/// RISpec's filters, and those that other renderers add (docs/options.md).
enum class FilterKind {
    Box,
    Triangle,
    CatmullRom,
    SeparableCatmullRom,
    BSpline,
    Gaussian,
    Sinc,
    Bessel,
    Disk,
    Mitchell,
    BlackmanHarris,
    Lanczos
};
inline constexpr int kFilterKinds = 12; ///< number of kinds

/// The name used in RIB: "box", "catmull-rom", ...
const char* filterName(FilterKind);
/// The reverse; nothing: there is no such filter.
std::optional<FilterKind> filterByName(std::string_view name);

/// A filter with its full widths, in pixels. Values are not normalised: users divide by the sum of weights.
struct PixelFilter {
    FilterKind kind = FilterKind::Gaussian; ///< shape
    double xw = 2, yw = 2;                  ///< > 0

    /// The filter at (x, y), in pixels from its centre; 0 outside |x| <= xw/2, |y| <= yw/2.
    double operator()(double x, double y) const;
    /// True if the filter is the product of axis(x, xw) and axis(y, yw).
    bool separable() const;
    /// One factor of a separable filter, t in pixels from the centre, w the full width on that axis.
    double axis(double t, double w) const;
    bool operator==(const PixelFilter&) const = default;
};

/// A filter from a request. An unknown name is reported with the nearest name and becomes gaussian; a width that is not positive
/// and finite, or exceeds limits::kFilterWidth, is reported and becomes 1 or the limit.
PixelFilter makePixelFilter(std::string_view name, double xw, double yw, const SourcePlace&, Diagnostics&);

} // namespace alpenglow::render
