// Sums that do not depend on the order of their terms: 128-bit fixed point, so that any order, split, merge or resume gives the
// same bits (docs/design/sampling.md). The scheduler adds radiance in units of 2^-64, the film samples in units of 2^-40.
#pragma once
#include <cmath>
#include <cstdint>

namespace alpenglow {

/// 128-bit integers, a compiler extension.
using Int128 = __int128;
using UInt128 = unsigned __int128;

/// Largest absolute value of a term.
inline constexpr double kFixedMost = 0x1p60;

/// v in units of 2^-Bits (Bits <= 64), rounded to the nearest, ties to even. v must be finite; beyond +-2^60 it is clamped and
/// *saturated set.
template <int Bits> Int128 toFixed(double v, bool* saturated) {
    static_assert(Bits > 0 && Bits <= 64);
    if (!(v <= kFixedMost && v >= -kFixedMost)) {
        *saturated = true;
        v = v > 0 ? kFixedMost : -kFixedMost;
    }
    // Every step except the rounding is exact: the power of two, and the division into a multiple of 2^62 and a remainder, both
    // 64-bit integers.
    constexpr double kUnits = double(uint64_t(1) << (Bits / 2)) * double(uint64_t(1) << (Bits - Bits / 2));
    double units = std::nearbyint(v * kUnits);
    int64_t high = int64_t(units * 0x1p-62);
    int64_t low = int64_t(units - double(high) * 0x1p62);
    return Int128(high) * (int64_t(1) << 62) + low;
}

/// The double nearest to a sum of values in units of 2^-Bits.
template <int Bits> double fromFixed(Int128 v) {
    static_assert(Bits > 0 && Bits <= 64);
    constexpr double kUnits = double(uint64_t(1) << (Bits / 2)) * double(uint64_t(1) << (Bits - Bits / 2));
    return double(v) / kUnits;
}

/// A sum in units of 2^-64. Terms beyond +-2^60 are clamped, and saturated() becomes true; the sum has 192 bits, so it cannot
/// overflow. The caller must exclude non-finite terms.
class ExactSum {
public:
    /// Adds a finite term, rounded to a multiple of 2^-64.
    void add(double d) {
        Int128 term = toFixed<64>(d, &saturated_);
        addWide(UInt128(term), term < 0 ? -1 : 0);
    }
    /// Adds another sum. The result does not depend on the order of terms and sums.
    void merge(const ExactSum& o) {
        addWide(o.low_, o.top_);
        saturated_ |= o.saturated_;
    }
    /// The sum, rounded to double or float.
    double toDouble() const {
        Int128 low = Int128(low_);
        if (top_ == (low < 0 ? -1 : 0)) return fromFixed<64>(low);
        return (double(top_) * 0x1p128 + double(low_)) * 0x1p-64;
    }
    float toFloat() const { return float(toDouble()); }
    /// Whether a term was clamped.
    bool saturated() const { return saturated_; }

private:
    void addWide(UInt128 low, int64_t top) {
        low_ += low;
        top_ += top + (low_ < low ? 1 : 0);
    }

    UInt128 low_ = 0;
    int64_t top_ = 0; ///< with low_ one 192-bit number in two's complement
    bool saturated_ = false;
};

} // namespace alpenglow
