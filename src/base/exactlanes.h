// Functions of base/exact.h over vectors of doubles (V: an ext_vector_type), with the same bits in each lane. No standard header,
// as in exactseries.h.
#pragma once
#include "base/exactseries.h"

namespace alpenglow::exact {

template <class V> using MaskOf = decltype(V() < V()); ///< -1 or 0 by lane; also 64-bit integers

/// Converts integral |x| < 2^31: after adding 1.5 x 2^52 they are in the low bits.
template <class V> AL_EXACT MaskOf<V> wholeLanes(V x) { return __builtin_bit_cast(MaskOf<V>, x + 0x1.8p52) & 0xffffffffll; }
/// |x|: clears the sign, also of zeros and NaN.
template <class V> AL_EXACT V absoluteLanes(V x) {
    return __builtin_bit_cast(V, __builtin_bit_cast(MaskOf<V>, x) & 0x7fffffffffffffffll);
}
/// x with the opposite sign where the top bit of `bits` is set.
template <class V> AL_EXACT V flippedLanes(V x, MaskOf<V> bits) {
    return __builtin_bit_cast(V, __builtin_bit_cast(MaskOf<V>, x) ^ (bits & MaskOf<V>(-0x7fffffffffffffffll - 1)));
}

/// sinCos() for |x| <= 1e6.
template <class V> AL_EXACT void sinCosLanes(V x, V& sine, V& cosine) {
    const V turns = __builtin_elementwise_nearbyint(x * (1 / kHalfPi));
    const V r = ((x - turns * kHalfPi1) - turns * kHalfPi2) - turns * kHalfPi3;
    const V s = sineNear(r), c = cosineNear(r);
    const MaskOf<V> k = wholeLanes(turns), odd = (k & 1) != 0;
    sine = flippedLanes<V>(odd ? c : s, k << 62);
    cosine = flippedLanes<V>(odd ? s : c, (k + 1) << 62);
}

/// atan2() of finite numbers.
template <class V> AL_EXACT V atan2Lanes(V y, V x) {
    const V ax = absoluteLanes(x), ay = absoluteLanes(y);
    const MaskOf<V> steep = ay > ax;
    V large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
    const V scale = large > 0x1p1000 ? V(0x1p-100) : large < 0x1p-900 ? V(0x1p200) : V(1);
    large = large * scale, small = small * scale;
    large = large > 0 ? large : V(1); // then both are 0, as is their angle
    const V ratio = small / large, steps = __builtin_elementwise_trunc(16 * (ratio <= 1 ? ratio : V(0)) + 0.5);
    const MaskOf<V> k = wholeLanes(steps);
    V high, low;
    for (unsigned i = 0; i < sizeof(V) / sizeof(double); ++i) high[i] = kAtan[k[i]], low[i] = kAtanLo[k[i]];
    const V c = steps / 16., z = (small - c * large) / (large + c * small); // the ratio itself if c is 0
    V r = high + (z + (low - z * atanSeries(z)));
    r = steep ? kHalfPi - (r - kHalfPiLo) : r;
    r = __builtin_bit_cast(MaskOf<V>, x) < 0 ? 2 * kHalfPi - (r - 2 * kHalfPiLo) : r;
    return flippedLanes(absoluteLanes(r), __builtin_bit_cast(MaskOf<V>, y));
}

} // namespace alpenglow::exact
