// Fixed-point sums of the film (base/exactsum.h) and the 256 bits their squares need.
#pragma once
#include "base/exactsum.h"
#include <cstdint>

namespace alpenglow::render {

/// Unit 2^-40: 2^27 values (limits::kSamplesPerPixel) of up to 2^60 fit the 128 bits.
inline constexpr int kFixedBits = 40;

/// In units of 2^-40; beyond 2^60 the value is clamped and *saturated is set.
inline Int128 toFixed(double v, bool* saturated) { return alpenglow::toFixed<kFixedBits>(v, saturated); }
/// The nearest double.
inline double fromFixed(Int128 v) { return alpenglow::fromFixed<kFixedBits>(v); }

/// 256 bits, unsigned, for sums of squares (unit 2^-80) and their differences. Least significant limb first.
struct UInt256 {
    uint64_t limb[4] = {0, 0, 0, 0};

    /// Modulo 2^256.
    UInt256& operator+=(const UInt256& o) {
        uint64_t carry = 0;
        for (int i = 0; i < 4; ++i) {
            UInt128 s = UInt128(limb[i]) + o.limb[i] + carry;
            limb[i] = uint64_t(s);
            carry = uint64_t(s >> 64);
        }
        return *this;
    }
    UInt256& operator-=(const UInt256& o) {
        uint64_t borrow = 0;
        for (int i = 0; i < 4; ++i) {
            UInt128 d = UInt128(limb[i]) - o.limb[i] - borrow;
            limb[i] = uint64_t(d);
            borrow = uint64_t(d >> 64) & 1;
        }
        return *this;
    }
    /// Multiplies by a 32-bit number, modulo 2^256.
    UInt256& operator*=(uint32_t n) {
        uint64_t carry = 0;
        for (int i = 0; i < 4; ++i) {
            UInt128 p = UInt128(limb[i]) * n + carry;
            limb[i] = uint64_t(p);
            carry = uint64_t(p >> 64);
        }
        return *this;
    }
    friend bool operator==(const UInt256&, const UInt256&) = default;
    /// Accurate to 2^-52 relative.
    double toDouble() const {
        double v = 0;
        for (int i = 3; i >= 0; --i) v = v * 0x1p64 + double(limb[i]);
        return v;
    }
};

/// v * v, exactly.
inline UInt256 square(Int128 v) {
    UInt128 a = v < 0 ? -UInt128(v) : UInt128(v);
    uint64_t lo = uint64_t(a), hi = uint64_t(a >> 64);
    UInt128 ll = UInt128(lo) * lo, lh = UInt128(lo) * hi, hh = UInt128(hi) * hi;
    UInt256 r{{uint64_t(ll), uint64_t(ll >> 64), uint64_t(hh), uint64_t(hh >> 64)}};
    UInt256 cross{{0, uint64_t(lh), uint64_t(lh >> 64), 0}};
    r += cross;
    r += cross;
    return r;
}

} // namespace alpenglow::render
