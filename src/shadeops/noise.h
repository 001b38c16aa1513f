// Noise and random: 3Delight manual, 6.4.2. Code for all lane widths above, descriptors below (host only).
#pragma once
#include "shadeops/call.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

// The lattice: a coordinate times an odd constant plus an offset (without it a cell and its mirror image at the origin would
// share a hash), neighbours by addition; a corner is the xor of its coordinates, folded and multiplied. Sequences of corners
// along axes and diagonals have flat spectra (noise_test.cpp). Each channel multiplies by its own constant.
inline constexpr unsigned kLattice[4] = {0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du, 0x27d4eb2fu};
inline constexpr unsigned kOffset[4] = {0x68e31da4u, 0xb5297a4du, 0x1b56c4e9u, 0x7f4a7c15u};
inline constexpr unsigned kChannel[3] = {0x2c1b3c6du, 0x9c8f2d35u, 0x6a09e667u};
inline constexpr float kFarAway = 0x1p30f;
/// Largest |sum| of the interpolated gradients in 1 to 4 dimensions: suprema over the cell, rounded up.
inline constexpr float kNoiseBound[5] = {0, 0.5f, 0.71527f, 1.03632f, 1.5400f};

/// C independent noise values.
template <class T, int C> struct Channels {
    T c[C]; ///< one for each channel
};

/// One evaluation in N dimensions with C channels, depth first over the corners so that few values are alive at a time.
template <class T, int N, int C> struct NoiseCell {
    T low[N], high[N], fade[N]; // distances to the two lattice planes, and the weight of the high one
    vu hash[N][2];              ///< of the two lattice planes, by dimension

    /// Gradients: one dimension: slopes of random size; two: eight directions; three and four: to the middles of edges of the
    /// cube (one component 0, the others +-1).
    static AL_MEMBER T gradient(vu h, const T* d) {
        const vi s = __builtin_bit_cast(vi, h);
        if constexpr (N == 1) {
            return d[0] * signedSlope(h);
        } else if constexpr (N == 2) {
            const vm swap = maskOf(s < 0);
            const T u = select(swap, d[0], d[1]), v = select(swap, d[1], d[0]);
            return mad(flipSign(v, h << 3), vf(0.41421356f), flipSign(u, h << 2));
        } else if constexpr (N == 3) {
            const T u = select(maskOf(s < -715827883), d[1], d[0]), v = select(maskOf(s < 715827883), d[2], d[1]);
            return flipSign(u, h << 12) + flipSign(v, h << 13);
        } else {
            const T u = select(maskOf(s < -1073741824), d[1], d[0]), v = select(maskOf(s < 0), d[2], d[1]),
                    w = select(maskOf(s < 1073741824), d[3], d[2]);
            return flipSign(u, h << 12) + flipSign(v, h << 13) + flipSign(w, h << 14);
        }
    }

    /// The sum over the corners of the dimensions from D on; d: distances, h: hash so far.
    template <int D> AL_MEMBER Channels<T, C> sum(T* d, vu h) const {
        Channels<T, C> r;
        if constexpr (D < 0) {
            h = h ^ (h >> 15);
#pragma clang loop unroll(full)
            for (int i = 0; i < C; ++i) r.c[i] = gradient(h * kChannel[i], d);
        } else {
            d[D] = low[D];
            const Channels<T, C> a = sum<D - 1>(d, h ^ hash[D][0]);
            d[D] = high[D];
            const Channels<T, C> b = sum<D - 1>(d, h ^ hash[D][1]);
#pragma clang loop unroll(full)
            for (int i = 0; i < C; ++i) r.c[i] = mad(fade[D], b.c[i] - a.c[i], a.c[i]);
        }
        return r;
    }
};

/// 6t^5 - 15t^4 + 10t^3: value, first and second derivative vanish at the ends, so noise has continuous second derivatives.
template <class T> AL_INLINE T noiseFade(const T& x) {
    const vf t = value(x), u = t * t;
    const vf f = u * t * mad(t, mad(t, vf(6), vf(-15)), vf(10));
    const vf g = t * (1 - t); // 30 g^2, 60 g (1 - 2t)
    return chain(x, f, 30 * g * g, 60 * g * mad(t, vf(-2), vf(1)));
}

/// Periods: rounded, at least 1, at most 2^22.
AL_INLINE vf roundPeriod(vf p) { return minLanes(maxLanes(floorLanes(p + 0.5f), vf(1)), vf(4194304)); }
/// n - p floor(n / p), 0..p-1, for whole n: the quotient may round across an integer.
AL_INLINE vf wrapWhole(vf n, vf p) {
    const vf r = mad(floorLanes(n / p), -p, n);
    return select(r < 0, r + p, select(r >= p, r - p, r));
}
AL_INLINE vf clampFar(vf x) { return minLanes(maxLanes(x, vf(-kFarAway)), vf(kFarAway)); }

/// Noise at p; Periodic: with these periods, integers >= 1.
template <int N, int C, bool Periodic, class T> AL_INLINE Channels<T, C> noiseSum(const T* p, const T* period) {
    NoiseCell<T, N, C> cell;
#pragma clang loop unroll(full)
    for (int i = 0; i < N; ++i) {
        const vf x = clampFar(value(p[i])), n = floorLanes(x);
        cell.low[i] = withValue(p[i], x - n);
        cell.high[i] = cell.low[i] - vf(1);
        cell.fade[i] = noiseFade(cell.low[i]);
        if constexpr (Periodic) {
            const vf q = roundPeriod(value(period[i])), a = minLanes(maxLanes(wrapWhole(n, q), vf(0)), q), b = a + 1;
            cell.hash[i][0] = __builtin_bit_cast(vu, toInt(a)) * kLattice[i] + kOffset[i];
            cell.hash[i][1] = __builtin_bit_cast(vu, toInt(select(b >= q, vf(0), b))) * kLattice[i] + kOffset[i];
        } else {
            cell.hash[i][0] = __builtin_bit_cast(vu, toInt(n)) * kLattice[i] + kOffset[i];
            cell.hash[i][1] = cell.hash[i][0] + kLattice[i];
        }
    }
    T d[N];
    Channels<T, C> r = cell.template sum<N - 1>(d, vu(0));
#pragma clang loop unroll(full)
    for (int i = 0; i < C; ++i) r.c[i] = mad(r.c[i], vf(0.49999f / kNoiseBound[N]), vf(0.5f));
    return r;
}

/// Hash of the cell floor(p), mixed well enough to be shown as it is.
template <int N, class T> AL_INLINE vu cellHash(const T* p) {
    vu h = vu(0u);
#pragma clang loop unroll(full)
    for (int i = 0; i < N; ++i)
        h = h ^ (__builtin_bit_cast(vu, toInt(floorLanes(clampFar(value(p[i]))))) * kLattice[i] + kOffset[i]);
    h = (h ^ (h >> 16)) * 0x21f0aaadu;
    h = (h ^ (h >> 15)) * 0x735a2d97u;
    return h ^ (h >> 15);
}
template <class T> AL_INLINE Triple<T> tripleOf(const Channels<T, 3>& r) { return {r.c[0], r.c[1], r.c[2]}; }
template <class T> AL_INLINE Triple<T> unitTriple(vu h) {
    return {T(unitReal(h)), T(unitReal(h * kChannel[1])), T(unitReal(h * kChannel[2]))};
}

#define AL_NOISE_FORMS(N, PARAMETERS, PERIODS, POINT, PERIOD)                                                                    \
    template <class T> AL_INLINE T opNoise##N##f PARAMETERS {                                                                    \
        const T p[] = POINT;                                                                                                     \
        return noiseSum<N, 1, false, T>(p, nullptr).c[0];                                                                        \
    }                                                                                                                            \
    template <class T> AL_INLINE Triple<T> opNoise##N##t PARAMETERS {                                                            \
        const T p[] = POINT;                                                                                                     \
        return tripleOf(noiseSum<N, 3, false, T>(p, nullptr));                                                                   \
    }                                                                                                                            \
    template <class T> AL_INLINE T opPnoise##N##f PERIODS {                                                                      \
        const T p[] = POINT, q[] = PERIOD;                                                                                       \
        return noiseSum<N, 1, true, T>(p, q).c[0];                                                                               \
    }                                                                                                                            \
    template <class T> AL_INLINE Triple<T> opPnoise##N##t PERIODS {                                                              \
        const T p[] = POINT, q[] = PERIOD;                                                                                       \
        return tripleOf(noiseSum<N, 3, true, T>(p, q));                                                                          \
    }                                                                                                                            \
    template <class T> AL_INLINE T opCellnoise##N##f PARAMETERS {                                                                \
        const T p[] = POINT;                                                                                                     \
        return T(unitReal(cellHash<N, T>(p)));                                                                                   \
    }                                                                                                                            \
    template <class T> AL_INLINE Triple<T> opCellnoise##N##t PARAMETERS {                                                        \
        const T p[] = POINT;                                                                                                     \
        return unitTriple<T>(cellHash<N, T>(p));                                                                                 \
    }                                                                                                                            \
    AL_RUNTIME(al_noise##N##_f, opNoise##N##f)                                                                                   \
    AL_RUNTIME(al_noise##N##_t, opNoise##N##t)                                                                                   \
    AL_RUNTIME(al_pnoise##N##_f, opPnoise##N##f)                                                                                 \
    AL_RUNTIME(al_pnoise##N##_t, opPnoise##N##t)                                                                                 \
    AL_RUNTIME(al_cellnoise##N##_f, opCellnoise##N##f)                                                                           \
    AL_RUNTIME(al_cellnoise##N##_t, opCellnoise##N##t)
#define AL_LIST(...) {__VA_ARGS__}
AL_NOISE_FORMS(1, (const T& x), (const T& x, const T& px), AL_LIST(x), AL_LIST(px))
AL_NOISE_FORMS(2, (const T& x, const T& y), (const T& x, const T& y, const T& px, const T& py), AL_LIST(x, y), AL_LIST(px, py))
AL_NOISE_FORMS(3, (const Triple<T>& a), (const Triple<T>& a, const Triple<T>& b), AL_LIST(a.x, a.y, a.z), AL_LIST(b.x, b.y, b.z))
AL_NOISE_FORMS(4, (const Triple<T>& a, const T& w), (const Triple<T>& a, const T& w, const Triple<T>& b, const T& pw),
               AL_LIST(a.x, a.y, a.z, w), AL_LIST(b.x, b.y, b.z, pw))
#undef AL_NOISE_FORMS
#undef AL_LIST

/// The value of random() from a hash, which comes as the bits of a lane.
template <class T> AL_INLINE T opRandom(const T& hash) { return T(unitReal(payload(value(hash)))); }
template <class T> AL_INLINE Triple<T> opRandom3(const T& hash) { return unitTriple<T>(payload(value(hash))); }
AL_RUNTIME(al_random_f, opRandom)
AL_RUNTIME(al_random_t, opRandom3)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
namespace {
/// The forms of one family for the results float, color, point, vector, normal.
std::vector<Signature> noiseForms(const char* name, const char* symbol, bool period) {
    std::vector<Signature> list;
    for (const char* type : {"float", "color", "point", "vector", "normal"}) {
        const std::string head = std::string(type) + " " + name, tail = type == std::string("float") ? "_f" : "_t";
        const auto add = [&](const std::string& parameters, const char* form) {
            list.push_back(parseSignature(head + "(" + parameters + ")", std::string(symbol) + form + tail));
        };
        if (period) {
            add("float x, float period", "1");
            add("float x, float y, float xperiod, float yperiod", "2");
            add("point p, point period", "3");
            add("point p; float w; point period; float wperiod", "4");
        } else {
            add("float x", "1");
            add("float x, float y", "2");
            add("point p", "3");
            add("point p; float w", "4");
            add("color p", "3");
        }
    }
    return list;
}
} // namespace

std::vector<Shadeop> noiseShadeops() {
    std::vector<Shadeop> list;
    Shadeop op;
    op.section = "Noise";
    op.outOfLine = true;
    op.widest = 32;

    op.name = "noise";
    op.signatures = noiseForms("noise", "al_noise", false);
    op.doc = "Gradient noise of 1 to 4 dimensions in [0,1]: mean near 0.5, exactly 0.5 at integer points, continuous second "
             "derivatives, no "
             "period. The components of a color, point or vector result do not correlate. The result is in [0,1] for points and "
             "vectors too. "
             "Beyond 1e9 the argument counts as 1e9. Same bits for any number of lanes.";
    op.source = "3Delight manual, 6.4.2; RISpec 3.2, 15.1";
    op.examples = {{"noise(3)", "0.5"}, {"noise(point(1,2,3))", "0.5"}, {"noise(2, 5)", "0.5"}};
    list.push_back(op);

    op.name = "pnoise";
    op.signatures = noiseForms("pnoise", "al_pnoise", true);
    op.doc = "As noise, repeating with the given period in each coordinate. Periods are rounded to integers, at least 1; 256 and "
             "any other "
             "integer up to 2^22. No derivative with respect to a period.";
    op.examples = {{"pnoise(3, 4)", "0.5"}};
    list.push_back(op);

    op.name = "cellnoise";
    op.signatures = noiseForms("cellnoise", "al_cellnoise", false);
    op.doc = "A random value in [0,1), constant in every unit cell of floor(argument). Derivative 0.";
    op.derivative = DerivativeRule::Zero;
    op.examples = {{"cellnoise(0.25) - cellnoise(0.75)", "0"}};
    list.push_back(op);

    op = Shadeop{};
    op.section = "Noise";
    op.name = "random";
    op.signatures = sigs({{"float random()"}, {"color random()"}, {"point random()"}, {"vector random()"}, {"normal random()"}});
    op.lowering = Lowering::Special;
    op.derivative = DerivativeRule::Zero;
    op.pure = false;
    op.doc = "Uniform in [0,1), components independent. Varying: hashes pixel, sample and call site. Assigned to a uniform "
             "variable: hashes "
             "primitive, call site and seed, so that a value does not depend on how points are batched. al_random_f and "
             "al_random_t turn a "
             "hash into the value.";
    op.source = "3Delight manual, 6.4.2";
    op.examples = {{"x >= 0 && x < 1", "1", "float x = random();"}};
    list.push_back(op);
    return list;
}
} // namespace alpenglow::shadeops
#endif
