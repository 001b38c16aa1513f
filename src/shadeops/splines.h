// Splines: 3Delight manual, 6.4.1. The code generator chooses the four control points; the code here places and evaluates.
#pragma once
#include "shadeops/call.h"

namespace alpenglow::shadeops::AL_NAMESPACE {

/// Segment number and parameter within it, for v over `segments` segments; v is clamped to [0,1].
template <class T> AL_INLINE Pair<T> opSplineSegment(const T& v, const T& segments) {
    const vf n = maxLanes(floorLanes(value(segments)), vf(1));
    const T inside = larger(T(vf(0)), smaller(v, T(vf(1)))) * n;
    const vf s = minLanes(floorLanes(value(inside)), n - 1);
    return {T(s), inside - s};
}

/// A basis gives the cubic a + t (b + t (c + t d)) of four control points.
template <class T> struct Cubic {
    T a, b, c, d;
};
template <class T> AL_INLINE T evaluate(const Cubic<T>& k, const T& t) { return mad(mad(mad(k.d, t, k.c), t, k.b), t, k.a); }

/// The cubic between q and r of four control points.
struct CatmullRom {
    /// Control points in their order.
    template <class T> static AL_MEMBER Cubic<T> of(const T& p, const T& q, const T& r, const T& s) {
        return {q, (r - p) * vf(0.5f), p + r * vf(2) - q * vf(2.5f) - s * vf(0.5f), (s - p) * vf(0.5f) + (q - r) * vf(1.5f)};
    }
};
/// The cubic of four control points.
struct BSpline {
    /// Control points in their order.
    template <class T> static AL_MEMBER Cubic<T> of(const T& p, const T& q, const T& r, const T& s) {
        return {(p + q * vf(4) + r) * vf(1.0f / 6), (r - p) * vf(0.5f), (p + r) * vf(0.5f) - q,
                ((s - p) + (q - r) * vf(3)) * vf(1.0f / 6)};
    }
};
/// The cubic from p to s.
struct Bezier {
    /// Control points in their order.
    template <class T> static AL_MEMBER Cubic<T> of(const T& p, const T& q, const T& r, const T& s) {
        return {p, (q - p) * vf(3), (p + r) * vf(3) - q * vf(6), (s - p) + (q - r) * vf(3)};
    }
};
/// Point, tangent, point, tangent.
struct Hermite {
    /// P and r are points, q and s tangents.
    template <class T> static AL_MEMBER Cubic<T> of(const T& p, const T& q, const T& r, const T& s) {
        return {p, q, (r - p) * vf(3) - q * vf(2) - s, (p - r) * vf(2) + q + s};
    }
};
/// Between the second and the third point.
struct Linear {
    /// Q + t (r - q).
    template <class T> static AL_MEMBER Cubic<T> of(const T&, const T& q, const T& r, const T&) {
        return {q, r - q, T(vf(0)), T(vf(0))};
    }
};

/// The point of a segment at t, 0 to 1.
template <class Basis, class T> AL_INLINE T spline1(const T& t, const T& p, const T& q, const T& r, const T& s) {
    return evaluate(Basis::of(p, q, r, s), t);
}
template <class Basis, class T>
AL_INLINE Triple<T> spline3(const T& t, const Triple<T>& p, const Triple<T>& q, const Triple<T>& r, const Triple<T>& s) {
    return {spline1<Basis>(t, p.x, q.x, r.x, s.x), spline1<Basis>(t, p.y, q.y, r.y, s.y), spline1<Basis>(t, p.z, q.z, r.z, s.z)};
}

/// t in [0,1] where the segment takes a value: 24 bisections find it, then two Newton steps carry the derivatives (implicit
/// function).
template <class Basis, class T> AL_INLINE T solve1(const T& target, const T& p, const T& q, const T& r, const T& s) {
    const Cubic<T> k = Basis::of(p, q, r, s);
    const Cubic<vf> plain{value(k.a), value(k.b), value(k.c), value(k.d)};
    const vf goal = value(target);
    const vu falling = bitsForFlip(evaluate(plain, vf(1)) < evaluate(plain, vf(0)));
    vf lo = vf(0), step = vf(0.5f);
    for (int i = 0; i < 24; ++i) {
        const vf middle = lo + step;
        lo = select(flipSign(goal - evaluate(plain, middle), falling) >= 0, middle, lo);
        step = step * 0.5f;
    }
    T t = T(lo);
    for (int i = 0; i < 2; ++i) {
        const T slope = mad(mad(k.d * vf(3), t, k.c * vf(2)), t, k.b);
        t = t - divide(evaluate(k, t) - target, slope);
        t = larger(T(vf(0)), smaller(t, T(vf(1))));
    }
    return t;
}

#define AL_SPLINE(name, Basis)                                                                                                   \
    template <class T> AL_INLINE T opSpline_##name(const T& t, const T& p, const T& q, const T& r, const T& s) {                 \
        return spline1<Basis>(t, p, q, r, s);                                                                                    \
    }                                                                                                                            \
    template <class T>                                                                                                           \
    AL_INLINE Triple<T> opSpline3_##name(const T& t, const Triple<T>& p, const Triple<T>& q, const Triple<T>& r,                 \
                                         const Triple<T>& s) {                                                                   \
        return spline3<Basis>(t, p, q, r, s);                                                                                    \
    }                                                                                                                            \
    template <class T> AL_INLINE T opSolve_##name(const T& v, const T& p, const T& q, const T& r, const T& s) {                  \
        return solve1<Basis>(v, p, q, r, s);                                                                                     \
    }                                                                                                                            \
    AL_RUNTIME(al_spline_##name##_f, opSpline_##name)                                                                            \
    AL_RUNTIME(al_spline_##name##_t, opSpline3_##name)                                                                           \
    AL_RUNTIME(al_splinesolve_##name, opSolve_##name)
AL_SPLINE(catmullrom, CatmullRom)
AL_SPLINE(bspline, BSpline)
AL_SPLINE(bezier, Bezier)
AL_SPLINE(hermite, Hermite)
AL_SPLINE(linear, Linear)
#undef AL_SPLINE
AL_RUNTIME(al_splinesegment, opSplineSegment)

} // namespace alpenglow::shadeops::AL_NAMESPACE

#ifdef ALPENGLOW_DESCRIBE
#include "shadeops/describe.h"

namespace alpenglow::shadeops {
std::vector<Shadeop> splineShadeops() {
    Shadeop op;
    op.section = "Mathematics";
    op.name = "spline";
    for (const char* type : {"float", "color", "point", "vector", "normal"}) {
        const std::string t = type;
        op.signatures.push_back(parseSignature(t + " spline(float v; " + t + " p, ...)"));
        op.signatures.push_back(parseSignature(t + " spline(string basis; float v; " + t + " p, ...)"));
        op.signatures.push_back(parseSignature(t + " spline(float v; " + t + " p[])"));
        op.signatures.push_back(parseSignature(t + " spline(string basis; float v; " + t + " p[])"));
    }
    op.lowering = Lowering::Special;
    op.derivative = DerivativeRule::Inherent;
    op.doc = "Point on a curve through or near control points; v in [0,1], outside it is clamped. Bases: catmull-rom (default), "
             "bezier, bspline, "
             "hermite, linear; an unknown name means linear. Segment s uses the points p[s step .. s step + 3], step = 1 for "
             "catmull-rom, bspline "
             "and linear (which ignores the first and the last), 3 for bezier, 2 for hermite (point, tangent, point, tangent); "
             "the number of segments "
             "is (n - 4) / step + 1. al_splinesegment(v, segments) gives s and the local parameter t; al_spline_BASIS_f and "
             "_t(t, p0, p1, p2, p3) "
             "evaluate, basis spelled catmullrom, bezier, bspline, hermite, linear. The prefix \"solve\" (floats only) inverts: "
             "the v for which the spline "
             "has the given value, for control points that rise or fall; the first such segment; outside the range the nearer "
             "end, 0 or 1. A segment "
             "contains the value when it lies between the segment's values at t = 0 and t = 1; al_splinesolve_BASIS(value, p0, "
             "p1, p2, p3) then "
             "gives t, and v = (s + t) / segments.";
    op.source = "3Delight manual, 6.4.1; RISpec 3.2, 15.1";
    op.examples = {{"spline(0.5, 0, 0, 1, 1)", "0.5"}, {"spline(\"linear\", 0.25, 9, 0, 1, 9)", "0.25"}};
    return {op};
}
} // namespace alpenglow::shadeops
#endif
