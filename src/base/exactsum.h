// A sum of floats that does not depend on the order of its terms: fixed point, 128 bits.
#pragma once
#include <cmath>
#include <cstdint>

namespace alpenglow {

/// Unit 2^-64, range +-2^62. Each term is rounded to the unit once, by itself, so any order, split or merge gives the same bits.
/// Terms beyond +-2^60 are clamped there and make saturated() true. Non-finite terms must be kept out by the caller.
class ExactSum {
public:
    void add(float f) { add(double(f)); }
    void add(double d) {
        constexpr double kMost = 0x1p60;
        if (!(d < kMost && d > -kMost)) { d = d > 0 ? kMost : -kMost; saturated_ = true; }
        // Split into whole and fraction, both exact; the fraction has at most 53 bits, so 62 of them hold it down to 2^-62.
        double high = std::trunc(d);
        double low = d - high;
        sum_ += (__int128(int64_t(high)) << 64) + __int128(int64_t(std::nearbyint(low * 0x1p62))) * 4 +
                int64_t(std::nearbyint((low * 0x1p62 - std::nearbyint(low * 0x1p62)) * 4));
    }
    void merge(const ExactSum& o) { sum_ += o.sum_; saturated_ |= o.saturated_; }
    double toDouble() const {
        __int128 s = sum_;
        bool negative = s < 0;
        unsigned __int128 u = negative ? -static_cast<unsigned __int128>(s) : static_cast<unsigned __int128>(s);
        double v = double(uint64_t(u >> 64)) + double(uint64_t(u)) * 0x1p-64;
        return negative ? -v : v;
    }
    float toFloat() const { return float(toDouble()); }
    bool saturated() const { return saturated_; }

private:
    __int128 sum_ = 0;
    bool saturated_ = false;
};

} // namespace alpenglow
