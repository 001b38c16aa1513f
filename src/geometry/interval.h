// Intervals of numbers, for bounds.
#pragma once
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

/// The numbers from lo to hi, both included; either may be infinite.
struct Interval {
    double lo = 0, hi = 0;
    /// X is one of them.
    bool has(double x) const { return lo <= x && x <= hi; }
};

/// Bounds of the products of their numbers.
inline Interval multiply(const Interval& a, const Interval& b) {
    const double x[4] = {a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi};
    Interval r{INFINITY, -INFINITY};
    for (double v : x) {
        if (std::isnan(v)) v = 0; // 0 times infinity, for an unbounded value
        r.lo = std::min(r.lo, v);
        r.hi = std::max(r.hi, v);
    }
    return r;
}
/// Bounds of the quotients, where a quotient by 0 is 0 if only that is possible, and else unbounded.
inline Interval divide(const Interval& a, const Interval& b) {
    if (b.lo == 0 && b.hi == 0) return {0, 0};
    if (b.lo <= 0 && b.hi >= 0) return {-INFINITY, INFINITY};
    return multiply(a, {1 / b.hi, 1 / b.lo});
}

} // namespace alpenglow::geometry
