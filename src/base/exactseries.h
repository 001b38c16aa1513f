// Shared by exact.cpp and exactlanes.h: constants, and series over numbers or vectors. No standard header: code for newer
// processors must not leave a copy of a library's inline function for others.
#pragma once
#define AL_EXACT static inline __attribute__((always_inline))

namespace alpenglow::exact {

// pi / 2 in parts of 33 bits, so that products with integers below 2^20 are exact.
inline constexpr double kHalfPi1 = 0x1.921fb544p+0, kHalfPi2 = 0x1.0b4611a6p-34, kHalfPi3 = 0x1.3198a2e037073p-69;
inline constexpr double kHalfPi = 0x1.921fb54442d18p+0, kHalfPiLo = 0x1.1a62633145c07p-54;

/// sin and cos for |r| <= pi / 4 by series, to the precision of the type; even and odd terms are separate, so that they run in
/// parallel.
template <class V> AL_EXACT V sineNear(V r) {
    const V q = r * r, w = q * q;
    const V even = 1 / 120. + w * (1 / 362880. + w * (1 / 6227020800. + w * (1 / 355687428096000.)));
    const V odd = 1 / 5040. + w * (1 / 39916800. + w * (1 / 1307674368000.));
    return r - r * q * (1 / 6. - q * (even - q * odd));
}
template <class V> AL_EXACT V cosineNear(V r) {
    const V q = r * r, w = q * q;
    const V even = 1 / 24. + w * (1 / 40320. + w * (1 / 479001600. + w * (1 / 20922789888000.)));
    const V odd = 1 / 720. + w * (1 / 3628800. + w * (1 / 87178291200. + w * (1 / 6402373705728000.)));
    const V h = 0.5 * q, c = 1 - h;
    return c + (((1 - c) - h) + w * (even - q * odd));
}

/// atan(k / 16), rounded, and the rounding error.
inline constexpr double kAtan[17] = {0,
                                     0x1.ff55bb72cfdeap-5,
                                     0x1.fd5ba9aac2f6ep-4,
                                     0x1.7b97b4bce5b02p-3,
                                     0x1.f5b75f92c80ddp-3,
                                     0x1.362773707ebccp-2,
                                     0x1.6f61941e4def1p-2,
                                     0x1.a64eec3cc23fdp-2,
                                     0x1.dac670561bb4fp-2,
                                     0x1.0657e94db30d0p-1,
                                     0x1.1e00babdefeb4p-1,
                                     0x1.345f01cce37bbp-1,
                                     0x1.4978fa3269ee1p-1,
                                     0x1.5d58987169b18p-1,
                                     0x1.700a7c5784634p-1,
                                     0x1.819d0b7158a4dp-1,
                                     0x1.921fb54442d18p-1};
inline constexpr double kAtanLo[17] = {0,
                                       -0x1.c934d86d23f1dp-60,
                                       -0x1.cd37686760c17p-59,
                                       0x1.347b0b4f881cap-58,
                                       0x1.8ab6e3cf7afbdp-57,
                                       -0x1.963a544b672d8p-57,
                                       -0x1.c63aae6f6e918p-56,
                                       -0x1.24dec1b50b7ffp-56,
                                       0x1.a2b7f222f65e2p-56,
                                       -0x1.d5b495f6349e6p-56,
                                       -0x1.928df287a668fp-58,
                                       0x1.1021137c71102p-55,
                                       0x1.2419a87f2a458p-56,
                                       0x1.0028e4bc5e7cap-57,
                                       -0x1.8c34d25aadef6p-56,
                                       -0x1.bf76229d3b917p-56,
                                       0x1.1a62633145c07p-55};

/// atan(z) is z - z times this, |z| <= 1 / 32.
template <class V> AL_EXACT V atanSeries(V z) {
    const V q = z * z;
    return q * (1 / 3. - q * (1 / 5. - q * (1 / 7. - q * (1 / 9. - q * (1 / 11. - q * (1 / 13.))))));
}

} // namespace alpenglow::exact
