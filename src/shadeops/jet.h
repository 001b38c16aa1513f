// Values with exact derivatives: Jet1 carries d/du and d/dv, Jet2 the second derivatives as well. Shadeops are templates over
// T = vf, Jet1 or Jet2; the value part is computed by the same operations in all three, so it has the same bits.
#pragma once
#include "shadeops/lanes.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// A value with its first derivatives by u and v, for each lane.
struct Jet1 {
    vf v, du, dv; ///< value and derivatives
    Jet1() = default;
    /// A constant.
    AL_MEMBER Jet1(vf x) : v(x), du(vf(0)), dv(vf(0)) {}
    /// Value; derivatives by u and v.
    AL_MEMBER Jet1(vf x, vf a, vf b) : v(x), du(a), dv(b) {}
};

/// A value with its first and second derivatives by u and v, for each lane.
struct Jet2 {
    vf v, du, dv, duu, duv, dvv; ///< value and derivatives
    Jet2() = default;
    /// A constant.
    AL_MEMBER Jet2(vf x) : v(x), du(vf(0)), dv(vf(0)), duu(vf(0)), duv(vf(0)), dvv(vf(0)) {}
    /// Value; first derivatives; second derivatives uu, uv, vv.
    AL_MEMBER Jet2(vf x, vf a, vf b, vf aa, vf ab, vf bb) : v(x), du(a), dv(b), duu(aa), duv(ab), dvv(bb) {}
};

/// The value alone.
AL_INLINE vf value(vf x) { return x; }
AL_INLINE vf value(const Jet1& x) { return x.v; }
AL_INLINE vf value(const Jet2& x) { return x.v; }

/// The same derivatives with another value (a constant or a piecewise constant was added).
AL_INLINE vf withValue(vf, vf v) { return v; }
AL_INLINE Jet1 withValue(const Jet1& x, vf v) { return {v, x.du, x.dv}; }
AL_INLINE Jet2 withValue(const Jet2& x, vf v) { return {v, x.du, x.dv, x.duu, x.duv, x.dvv}; }

/// f(x), given f, f', f'' at x.
AL_INLINE vf chain(vf, vf f, vf, vf) { return f; }
AL_INLINE Jet1 chain(const Jet1& x, vf f, vf d, vf) { return {f, d * x.du, d * x.dv}; }
AL_INLINE Jet2 chain(const Jet2& x, vf f, vf d, vf dd) {
    return {
        f, d * x.du, d * x.dv, mad(dd * x.du, x.du, d * x.duu), mad(dd * x.du, x.dv, d * x.duv), mad(dd * x.dv, x.dv, d * x.dvv)};
}

/// f(x, y), given its partial derivatives.
struct Partials {
    vf x, y, xx, xy, yy; ///< at (x, y)
};
AL_INLINE vf chain2(vf, vf, vf f, const Partials&) { return f; }
AL_INLINE Jet1 chain2(const Jet1& x, const Jet1& y, vf f, const Partials& p) {
    return {f, mad(p.x, x.du, p.y * y.du), mad(p.x, x.dv, p.y * y.dv)};
}
AL_INLINE Jet2 chain2(const Jet2& x, const Jet2& y, vf f, const Partials& p) {
    const auto second = [&](vf xa, vf xb, vf xab, vf ya, vf yb, vf yab) __attribute__((always_inline)) {
        return p.xx * xa * xb + p.xy * (xa * yb + xb * ya) + p.yy * ya * yb + p.x * xab + p.y * yab;
    };
    return {f,
            mad(p.x, x.du, p.y * y.du),
            mad(p.x, x.dv, p.y * y.dv),
            second(x.du, x.du, x.duu, y.du, y.du, y.duu),
            second(x.du, x.dv, x.duv, y.du, y.dv, y.duv),
            second(x.dv, x.dv, x.dvv, y.dv, y.dv, y.dvv)};
}

/// By lane: a where m is set, else b, with derivatives.
AL_INLINE Jet1 select(vm m, const Jet1& a, const Jet1& b) {
    return {select(m, a.v, b.v), select(m, a.du, b.du), select(m, a.dv, b.dv)};
}
AL_INLINE Jet2 select(vm m, const Jet2& a, const Jet2& b) {
    return {select(m, a.v, b.v),     select(m, a.du, b.du),   select(m, a.dv, b.dv),
            select(m, a.duu, b.duu), select(m, a.duv, b.duv), select(m, a.dvv, b.dvv)};
}
/// Changes the sign where the highest bit of `bits` is set, with derivatives.
AL_INLINE Jet1 flipSign(const Jet1& x, vu bits) { return {flipSign(x.v, bits), flipSign(x.du, bits), flipSign(x.dv, bits)}; }
AL_INLINE Jet2 flipSign(const Jet2& x, vu bits) {
    return {flipSign(x.v, bits),   flipSign(x.du, bits),  flipSign(x.dv, bits),
            flipSign(x.duu, bits), flipSign(x.duv, bits), flipSign(x.dvv, bits)};
}

/// Sums and differences, with derivatives; a plain vf is a constant.
AL_INLINE Jet1 operator-(const Jet1& a) { return {-a.v, -a.du, -a.dv}; }
AL_INLINE Jet2 operator-(const Jet2& a) { return {-a.v, -a.du, -a.dv, -a.duu, -a.duv, -a.dvv}; }
AL_INLINE Jet1 operator+(const Jet1& a, const Jet1& b) { return {a.v + b.v, a.du + b.du, a.dv + b.dv}; }
AL_INLINE Jet2 operator+(const Jet2& a, const Jet2& b) {
    return {a.v + b.v, a.du + b.du, a.dv + b.dv, a.duu + b.duu, a.duv + b.duv, a.dvv + b.dvv};
}
AL_INLINE Jet1 operator-(const Jet1& a, const Jet1& b) { return {a.v - b.v, a.du - b.du, a.dv - b.dv}; }
AL_INLINE Jet2 operator-(const Jet2& a, const Jet2& b) {
    return {a.v - b.v, a.du - b.du, a.dv - b.dv, a.duu - b.duu, a.duv - b.duv, a.dvv - b.dvv};
}
AL_INLINE Jet1 operator+(const Jet1& a, vf b) { return withValue(a, a.v + b); }
AL_INLINE Jet2 operator+(const Jet2& a, vf b) { return withValue(a, a.v + b); }
AL_INLINE Jet1 operator-(const Jet1& a, vf b) { return withValue(a, a.v - b); }
AL_INLINE Jet2 operator-(const Jet2& a, vf b) { return withValue(a, a.v - b); }
AL_INLINE Jet1 operator-(vf a, const Jet1& b) { return {a - b.v, -b.du, -b.dv}; }
AL_INLINE Jet2 operator-(vf a, const Jet2& b) { return {a - b.v, -b.du, -b.dv, -b.duu, -b.duv, -b.dvv}; }

/// a * b + c with the value rounded once.
AL_INLINE Jet1 mad(const Jet1& a, const Jet1& b, const Jet1& c) {
    return {mad(a.v, b.v, c.v), mad(a.v, b.du, mad(b.v, a.du, c.du)), mad(a.v, b.dv, mad(b.v, a.dv, c.dv))};
}
AL_INLINE Jet2 mad(const Jet2& a, const Jet2& b, const Jet2& c) {
    const vf two = vf(2);
    return {mad(a.v, b.v, c.v),
            mad(a.v, b.du, mad(b.v, a.du, c.du)),
            mad(a.v, b.dv, mad(b.v, a.dv, c.dv)),
            mad(a.v, b.duu, mad(b.v, a.duu, mad(two * a.du, b.du, c.duu))),
            mad(a.v, b.duv, mad(b.v, a.duv, mad(a.du, b.dv, mad(a.dv, b.du, c.duv)))),
            mad(a.v, b.dvv, mad(b.v, a.dvv, mad(two * a.dv, b.dv, c.dvv)))};
}
/// x * factor + c with constants.
AL_INLINE Jet1 mad(const Jet1& x, vf k, vf c) { return {mad(x.v, k, c), x.du * k, x.dv * k}; }
AL_INLINE Jet2 mad(const Jet2& x, vf k, vf c) { return {mad(x.v, k, c), x.du * k, x.dv * k, x.duu * k, x.duv * k, x.dvv * k}; }
AL_INLINE Jet1 operator*(const Jet1& a, const Jet1& b) {
    return {a.v * b.v, mad(a.v, b.du, b.v * a.du), mad(a.v, b.dv, b.v * a.dv)};
}
AL_INLINE Jet2 operator*(const Jet2& a, const Jet2& b) {
    const vf two = vf(2);
    return {a.v * b.v,
            mad(a.v, b.du, b.v * a.du),
            mad(a.v, b.dv, b.v * a.dv),
            mad(a.v, b.duu, mad(b.v, a.duu, two * a.du * b.du)),
            mad(a.v, b.duv, mad(b.v, a.duv, mad(a.du, b.dv, a.dv * b.du))),
            mad(a.v, b.dvv, mad(b.v, a.dvv, two * a.dv * b.dv))};
}
AL_INLINE Jet1 operator*(const Jet1& a, vf k) { return {a.v * k, a.du * k, a.dv * k}; }
AL_INLINE Jet2 operator*(const Jet2& a, vf k) { return {a.v * k, a.du * k, a.dv * k, a.duu * k, a.duv * k, a.dvv * k}; }

/// a / b, and 0 (with derivative 0) where b is 0.
AL_INLINE vf divide(vf a, vf b) { return select(b == 0, vf(0), a / b); }
AL_INLINE Jet1 divide(const Jet1& a, const Jet1& b) {
    const vf q = divide(a.v, b.v), r = divide(vf(1), b.v);
    return {q, (a.du - q * b.du) * r, (a.dv - q * b.dv) * r};
}
AL_INLINE Jet2 divide(const Jet2& a, const Jet2& b) {
    const vf q = divide(a.v, b.v), r = divide(vf(1), b.v);
    const vf qu = (a.du - q * b.du) * r, qv = (a.dv - q * b.dv) * r;
    return {q,
            qu,
            qv,
            (a.duu - (qu + qu) * b.du - q * b.duu) * r,
            (a.duv - qu * b.dv - qv * b.du - q * b.duv) * r,
            (a.dvv - (qv + qv) * b.dv - q * b.dvv) * r};
}

// Elementary functions with their derivatives. Where a derivative is infinite it is taken as 0.

/// Sine, cosine and tangent of radians, with derivatives.
template <class T> AL_INLINE T sine(const T& x) {
    const vf s = sinLanes(value(x)), c = cosLanes(value(x));
    return chain(x, s, c, -s);
}
template <class T> AL_INLINE T cosine(const T& x) {
    const vf s = sinLanes(value(x)), c = cosLanes(value(x));
    return chain(x, c, -s, -c);
}
template <class T> AL_INLINE T tangent(const T& x) {
    const vf t = tanLanes(value(x)), d = mad(t, t, vf(1));
    return chain(x, t, d, 2 * t * d);
}
/// 1 / sqrt(1 - x^2) inside the open interval (-1, 1), else 0.
AL_INLINE vf arcSlope(vf x) {
    const vf k = mad(-x, x, vf(1));
    return select(k > 0, 1 / rootLanes(maxLanes(k, vf(1e-30f))), vf(0));
}
template <class T> AL_INLINE T arcSine(const T& x) {
    const vf d = arcSlope(value(x));
    return chain(x, asinLanes(value(x)), d, value(x) * d * d * d);
}
template <class T> AL_INLINE T arcCosine(const T& x) {
    const vf d = arcSlope(value(x));
    return chain(x, acosLanes(value(x)), -d, -value(x) * d * d * d);
}
template <class T> AL_INLINE T arcTangent(const T& x) {
    const vf d = 1 / mad(value(x), value(x), vf(1));
    return chain(x, atanLanes(value(x)), d, -2 * value(x) * d * d);
}
template <class T> AL_INLINE T arcTangent2(const T& y, const T& x) {
    const vf a = value(y), b = value(x), r = divide(vf(1), mad(a, a, b * b)), ar = a * r, br = b * r;
    return chain2(y, x, atan2Lanes(a, b), Partials{br, -ar, -2 * ar * br, (ar - br) * (ar + br), 2 * ar * br});
}
template <class T> AL_INLINE T root(const T& x) {
    const vf v = value(x), s = rootLanes(maxLanes(v, vf(0))), d = select(v > 0, 0.5f / s, vf(0));
    return chain(x, s, d, select(v > 0, -0.5f * d / v, vf(0)));
}
template <class T> AL_INLINE T inverseRoot(const T& x) {
    const vf v = value(x);
    const vm inside = v > 0;
    const vf s = select(inside, 1 / rootLanes(maxLanes(v, vf(0))), vf(1e38f));
    const vf d = select(inside, -0.5f * s / v, vf(0));
    return chain(x, s, d, select(inside, -1.5f * d / v, vf(0)));
}
template <class T> AL_INLINE T exponential(const T& x) {
    const vf e = expLanes(value(x));
    return chain(x, e, e, e);
}
template <class T> AL_INLINE T logarithm(const T& x) {
    const vf v = value(x), d = select(v > 0, 1 / v, vf(0));
    return chain(x, logLanes(v), d, -d * d);
}
template <class T> AL_INLINE T logarithm2(const T& x) {
    const vf v = value(x), d = select(v > 0, kLog2e / v, vf(0));
    return chain(x, log2Lanes(v), d, select(v > 0, -d / v, vf(0)));
}
/// x^y. At x = 0 only the first derivative of x^1 and the second of x^2 are kept; d/dy is 0 where x <= 0.
template <class T> AL_INLINE T power(const T& x, const T& y) {
    const vf a = value(x), b = value(y), f = powLanes(a, b), zero = vf(0);
    const vm nonzero = a != 0, positive = a > 0;
    const vf fx = select(nonzero, f * b / a, select(b == 1, vf(1), zero));
    const vf fxx = select(nonzero, fx * (b - 1) / a, select(b == 2, vf(2), zero));
    const vf ln = select(positive, logLanes(a), zero);
    const vf fxy = select(positive, f * mad(b, ln, vf(1)) / a, zero);
    return chain2(x, y, f, Partials{fx, f * ln, fxx, fxy, f * ln * ln});
}

/// The smaller and the larger of two, with the derivatives of that one; b if they are equal or one is NaN.
template <class T> AL_INLINE T smaller(const T& a, const T& b) { return select(value(a) < value(b), a, b); }
template <class T> AL_INLINE T larger(const T& a, const T& b) { return select(value(a) > value(b), a, b); }
/// The absolute value, with derivatives; at 0 those of a.
template <class T> AL_INLINE T absolute(const T& a) { return select(value(a) < 0, -a, withValue(a, absLanes(value(a)))); }
template <> AL_MEMBER vf absolute<vf>(const vf& a) { return absLanes(a); }

} // namespace alpenglow::shadeops::AL_NAMESPACE
