// Elementary functions over lanes: our own range reductions and polynomials (tools/fit_elementary.py derives the coefficients).
// Errors in ulp are the largest seen against double precision over the ranges that tests/shadeops/elementary_test.cpp walks.
// No argument traps; NaN gives NaN or a bounded number, and counts as 0 in logarithms. Its sign and payload, which differ from
// one instruction set to the next, never show in a result. Included by lanes.h.
#pragma once

namespace alpenglow::shadeops::AL_NAMESPACE {

inline constexpr float kMagic = 0x1.8p23f;           ///< x + kMagic rounds x to an integer, which is then in the low bits
inline constexpr float kInfinity = __builtin_inff(); ///< positive
inline constexpr float kPi = 0x1.921fb6p+1f, kPiLo = -0x1.777a5cp-24f, kPiLoLo = -0x1.ee59dap-49f; ///< sum: PI to 70 bits
inline constexpr float kLn2 = 0x1.62e430p-1f, kLn2Lo = -0x1.05c610p-29f;                           ///< sum: ln 2
inline constexpr float kLog2e = 0x1.715476p+0f, kLog2eLo = 0x1.4ae0c0p-26f;                        ///< sum: 1 / ln 2
inline constexpr float kSmallest = 0x1p-126f; ///< below it numbers count as 0 in logarithms

/// Coefficients of the polynomials below, from the first term that is not exact. Error bounds: tests/shadeops.
inline constexpr float kSin[] = {-0x1.55554cp-3f, 0x1.110ed6p-7f, -0x1.9f6fbap-13f, 0x1.5db2dep-19f};
inline constexpr float kTan[] = {0x1.5554dep-2f, 0x1.112deap-3f, 0x1.b5851ep-5f, 0x1.9072a0p-6f, 0x1.96847ap-9f, 0x1.33e7c6p-7f};
inline constexpr float kAsin[] = {0x1.5555c8p-3f, 0x1.3301fcp-4f, 0x1.747d06p-5f, 0x1.8c2d82p-6f, 0x1.596d66p-5f};
inline constexpr float kAtan[] = {-0x1.5554dcp-2f, 0x1.9978ecp-3f, -0x1.230a9cp-3f, 0x1.b4df74p-4f,
                                  -0x1.3553f2p-4f, 0x1.61f9c8p-5f, -0x1.0c2b62p-6f, 0x1.7ede4ap-9f};
inline constexpr float kExp[] = {0x1.fffffcp-2f, 0x1.555490p-3f, 0x1.5558f4p-5f, 0x1.123a6cp-7f, 0x1.6a2352p-10f};
inline constexpr float kExp2[] = {0x1.62e430p-1f, 0x1.ebfbdcp-3f,  0x1.c6aee6p-5f,
                                  0x1.3b2d52p-7f, 0x1.5f400ep-10f, 0x1.41fa9ep-13f};
inline constexpr float kLog[] = {0x1.555554p-2f, -0x1.000228p-2f, 0x1.99a012p-3f, -0x1.5471f6p-3f,
                                 0x1.22d90ap-3f, -0x1.0d875ap-3f, 0x1.05649ap-3f, -0x1.38c1b0p-4f};
inline constexpr float kLog2[] = {0x1.ec7098p-2f, -0x1.71587ap-2f, 0x1.277ceap-2f, -0x1.eaf4d2p-3f,
                                  0x1.a34194p-3f, -0x1.8641e6p-3f, 0x1.7bdfc0p-3f, -0x1.c307ccp-4f};

/// Polynomial with coefficients from the constant term up.
template <int N> AL_INLINE vf polynomial(const float (&c)[N], vf x) {
    vf r = vf(c[N - 1]);
#pragma clang loop unroll(full)
    for (int i = N - 2; i >= 0; --i) r = mad(r, x, vf(c[i]));
    return r;
}

/// sin(r) for |r| <= 1.577.
AL_INLINE vf sinReduced(vf r) {
    const vf s = r * r;
    return mad(r * s, polynomial(kSin, s), r);
}

/// x - k PI in three fused steps, kept bounded where x is too large to have a phase.
AL_INLINE vf reducePi(vf x, vf k) {
    vf r = mad(k, vf(-kPi), x);
    r = mad(k, vf(-kPiLo), r);
    r = mad(k, vf(-kPiLoLo), r);
    return maxLanes(minLanes(r, vf(1.577f)), vf(-1.577f)); // PI/2 and what a rounded k may add
}

/// |x| <= 1e5: 1.5 ulp. Bounded by 1 everywhere.
AL_INLINE vf sinLanes(vf x) {
    const vf t = mad(x, vf(1 / kPi), vf(kMagic));
    return flipSign(sinReduced(reducePi(x, t - kMagic)), bitsOf(t) << 31);
}

/// |x| <= 1e5: 1.5 ulp. cos(r + (k + 1/2) PI) = -(-1)^k sin(r).
AL_INLINE vf cosLanes(vf x) {
    const vf t = mad(x, vf(1 / kPi), vf(-0.5f)) + kMagic;
    return flipSign(sinReduced(reducePi(x, (t - kMagic) + 0.5f)), ~bitsOf(t) << 31);
}

/// |x| <= 1e5: 3 ulp.
AL_INLINE vf tanLanes(vf x) {
    const vf t = mad(x, vf(2 / kPi), vf(kMagic)), k = t - kMagic;
    vf r = mad(k, vf(-0.5f * kPi), x);
    r = mad(k, vf(-0.5f * kPiLo), r);
    r = mad(k, vf(-0.5f * kPiLoLo), r);
    r = maxLanes(minLanes(r, vf(0.8f)), vf(-0.8f));
    const vf s = r * r, y = mad(r * s, polynomial(kTan, s), r);
    const vm odd = __builtin_bit_cast(vi, bitsOf(t) << 31) < 0;
    return select(odd, select(y == 0, vf(0), -1.0f / y), y);
}

/// asin(r) for 0 <= r <= 1/2, from r and r^2.
AL_INLINE vf asinReduced(vf r, vf s) { return mad(r * s, polynomial(kAsin, s), r); }

/// 2 ulp; the argument is clamped to [-1,1].
AL_INLINE vf asinLanes(vf x) {
    const vf a = minLanes(vf(1), absLanes(x)); // NaN stays NaN
    const vm big = a > 0.5f;
    const vf s = select(big, mad(a, vf(-0.5f), vf(0.5f)), a * a), r = select(big, rootLanes(s), a);
    const vf p = asinReduced(r, s);
    return copySign(select(big, mad(p, vf(-2), vf(0.5f * kPi)), p), x);
}

/// 2 ulp; the argument is clamped to [-1,1].
AL_INLINE vf acosLanes(vf x) {
    const vf a = minLanes(vf(1), absLanes(x)); // NaN stays NaN
    const vm big = a > 0.5f, negative = x < 0;
    const vf s = select(big, mad(a, vf(-0.5f), vf(0.5f)), a * a), r = select(big, rootLanes(s), a);
    const vf p = asinReduced(r, s);
    const vf small = 0.5f * kPi - (copySign(p, x) - 0.5f * kPiLo);
    return select(big, select(negative, kPi - (p + p - kPiLo), p + p), small);
}

/// 2 ulp. atan2(0, 0) = 0; the sign of a zero x does not count.
AL_INLINE vf atan2Lanes(vf y, vf x) {
    const vf ay = absLanes(y), ax = absLanes(x), large = maxLanes(ax, ay), small = minLanes(ay, ax);
    const vf q = select(large == 0, vf(0), small / large), s = q * q;
    vf p = mad(q * s, polynomial(kAtan, s), q);
    p = select(ay > ax, 0.5f * kPi - (p - 0.5f * kPiLo), p);
    p = select(x < 0, kPi - (p - kPiLo), p);
    return copySign(p, y);
}

/// -PI/2..PI/2.
AL_INLINE vf atanLanes(vf x) { return atan2Lanes(x, vf(1)); }

/// p * 2^k for the whole number k = t - kMagic; 0 for k <= -126, infinity overflow for k > 128.
AL_INLINE vf scaleBy(vf p, vf t) { return (p * fromBits((bitsOf(t) + 126u) << 23)) * 2.0f; }

/// -86.9 <= x <= 88.72: 1.5 ulp; 0 below, infinity above.
AL_INLINE vf expLanes(vf x) {
    const vf t = mad(x, vf(kLog2e), vf(kMagic)), k = t - kMagic;
    vf r = mad(k, vf(-kLn2), x);
    r = mad(k, vf(-kLn2Lo), r);
    const vf p = mad(r * r, polynomial(kExp, r), r) + 1.0f;
    return select(x > 88.7228f, vf(kInfinity), select(x < -86.9f, vf(0), scaleBy(p, t)));
}

/// Splits x >= 2^-126 into f and e: x = (1 + f) 2^e with sqrt(1/2) <= 1 + f < sqrt(2).
AL_INLINE void splitExponent(vf x, vf& f, vf& e) {
    const vi high = __builtin_bit_cast(vi, bitsOf(x) - 0x3f3504f3u) >> 23;
    e = toReal(high);
    f = fromBits(bitsOf(x) - (__builtin_bit_cast(vu, high) << 23)) - 1.0f;
}

/// 1.5 ulp; -infinity for x < 2^-126.
AL_INLINE vf logLanes(vf x) {
    vf f, e;
    splitExponent(x, f, e);
    const vf s = f * f;
    const vf t = mad(vf(-0.5f), s, mad(f * s, polynomial(kLog, f), e * kLn2Lo));
    return select(x >= kSmallest, mad(e, vf(kLn2), f + t), vf(-kInfinity));
}

/// log2(x) as hi + lo with about 32 bits, for x >= 2^-126.
AL_INLINE void log2Extended(vf x, vf& hi, vf& lo) {
    vf f, e;
    splitExponent(x, f, e);
    const vf s = f * f, sLo = mad(f, f, -s);
    const vf a = f * kLog2e, aLo = mad(f, vf(kLog2eLo), mad(f, vf(kLog2e), -a));
    const vf c = vf(-0.5f * kLog2e), b = s * c, bLo = mad(s, vf(-0.5f * kLog2eLo), mad(sLo, c, mad(s, c, -b)));
    const vf h = a + b, l = ((a - h) + b) + mad(f * s, polynomial(kLog2, f), aLo + bLo);
    const vf g = h + l, gLo = (h - g) + l; // l holds up to 0.03: lo must end below the last place of hi
    hi = e + g;
    lo = ((e - hi) + g) + gLo;
}

/// 1 ulp, exact for powers of two; -infinity for x < 2^-126.
AL_INLINE vf log2Lanes(vf x) {
    vf hi, lo;
    log2Extended(x, hi, lo);
    return select(x >= kSmallest, hi + lo, vf(-kInfinity));
}

/// 1.5 ulp while |y log2 x| < 16, growing to about 12 where the result nears overflow. x < 0: integer y as multiplication would,
/// else 0. |x| < 2^-126 counts as 0: 0 for y > 0, 1 for y = 0, infinity for y < 0.
AL_INLINE vf powLanes(vf x, vf y) {
    const vf a = absLanes(x);
    vf hi, lo;
    log2Extended(a, hi, lo);
    const vf z = y * hi, zLo = mad(y, lo, mad(y, hi, -z));
    const vf t = z + kMagic, f = (z - (t - kMagic)) + zLo;
    vf r = scaleBy(mad(f, polynomial(kExp2, f), vf(1)), t);
    r = select(z >= 128.0f, vf(kInfinity), select(z < -125.5f, vf(0), r));
    r = select(a < kSmallest, select(y > 0, vf(0), select(y == 0, vf(1), vf(kInfinity))), r);
    const vf half = 0.5f * y;
    const vm whole = floorLanes(y) == y, even = floorLanes(half) == half;
    return select(x < 0, select(whole, select(even, r, -r), vf(0)), r);
}

} // namespace alpenglow::shadeops::AL_NAMESPACE
