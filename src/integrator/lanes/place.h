// Stage place: Emitter::sample() for emitters of a few flat triangles. Solid angles are in doubles, half a register's worth of
// points at a time.
#pragma once
#include "base/exactlanes.h"
#include "integrator/lanes/rows.h"

namespace alpenglow::transport::AL_NAMESPACE {

inline constexpr int kH = kW / 2;
typedef float hf __attribute__((ext_vector_type(ALPENGLOW_LANES / 2)));
typedef double hd __attribute__((ext_vector_type(ALPENGLOW_LANES / 2)));
typedef exact::MaskOf<hd> hm; ///< mask, and whole numbers

struct D3 {
    hd x, y, z;
};
AL_INLINE D3 operator+(const D3& a, const D3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
AL_INLINE D3 operator-(const D3& a, const D3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
AL_INLINE D3 operator*(const D3& a, hd s) { return {a.x * s, a.y * s, a.z * s}; }
AL_INLINE D3 operator/(const D3& a, hd s) { return {a.x / s, a.y / s, a.z / s}; }
AL_INLINE hd dot(const D3& a, const D3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
AL_INLINE D3 cross(const D3& a, const D3& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
AL_INLINE hd rootOf(hd x) { return __builtin_elementwise_sqrt(x); }
/// Of what rounding may have made negative.
AL_INLINE hd rootAbove(hd x) { return rootOf(x > 0 ? x : hd(0)); }
AL_INLINE hd length(const D3& a) { return rootOf(dot(a, a)); }
AL_INLINE D3 choose(hm m, const D3& a, const D3& b) { return {m ? a.x : b.x, m ? a.y : b.y, m ? a.z : b.z}; }
AL_INLINE D3 normalize(const D3& a) {
    const hd l = length(a);
    return choose(l > 0, a / l, a);
}
AL_INLINE hd clamp(hd x, hd low, hd high) { return x < low ? low : high < x ? high : x; }
AL_INLINE bool any(hm m) { return __builtin_reduce_or(m) != 0; }
AL_INLINE hd wide(const float* p) {
    hf v;
    __builtin_memcpy(&v, p, sizeof v);
    return __builtin_convertvector(v, hd);
}
AL_INLINE void storeNarrow(float* p, hd v) { store(p, __builtin_convertvector(v, hf)); }
AL_INLINE D3 constant(const double (&v)[3]) { return {hd(v[0]), hd(v[1]), hd(v[2])}; }

/// A corner of triangle t.
AL_INLINE D3 cornerOf(const FlatEmitter& e, hm t, int corner) {
    D3 c = constant(e.corner[0][corner]);
    for (int k = 1; k < e.count; ++k) c = choose(t == k, constant(e.corner[k][corner]), c);
    return c;
}

/// The triangles as seen from points: TriangleLamp::see().
struct SeenLanes {
    hd angle[FlatEmitter::kMost], total;
    D3 way[FlatEmitter::kMost][3]; ///< unit, to the corners
};
AL_INLINE hm seeLamp(const FlatEmitter& e, const D3& from, SeenLanes& s) {
    const D3 middle = constant(e.centre) - from;
    hm seen = dot(middle, middle) < e.near2;
    if (!any(seen)) return seen;
    s.total = hd(0);
    for (int t = 0; t < e.count; ++t) {
        for (int i = 0; i < 3; ++i) {
            const D3 c = constant(e.corner[t][i]) - from;
            const hd l2 = dot(c, c);
            seen &= l2 > e.least2;
            s.way[t][i] = c / rootOf(l2);
        }
        const D3 &a = s.way[t][0], &b = s.way[t][1], &c = s.way[t][2];
        s.angle[t] = 2 * exact::atan2Lanes(exact::absoluteLanes(dot(a, cross(b, c))), 1 + dot(a, b) + dot(b, c) + dot(c, a));
        seen &= s.angle[t] < e.mostAngle;
        s.total += s.angle[t];
    }
    return seen & (s.total > e.leastAngle);
}

/// direction() of world/trianglelamp.cpp.
AL_INLINE D3 withinAngle(const D3& a, const D3& b, const D3& c, hd angle, hd u, hd v) {
    const D3 ab = cross(a, b), ac = cross(a, c);
    const hd lengths = length(ab) * length(ac), cosA = dot(ab, ac) / lengths;
    const hd sinA = exact::absoluteLanes(dot(a, cross(b, c))) / lengths;
    hd sinS, cosS;
    exact::sinCosLanes(u * angle, sinS, cosS);
    const hd s = sinS * cosA - cosS * sinA, t = cosS * cosA + sinS * sinA;
    const hd p = t - cosA, q = s + sinA * dot(a, b), divisor = (q * s + p * t) * sinA;
    const hd cosB1 = divisor != 0 ? clamp(((q * t - p * s) * cosA - q) / divisor, hd(-1), hd(1)) : hd(1);
    const D3 c1 = a * cosB1 + normalize(c - a * dot(c, a)) * rootAbove(1 - cosB1 * cosB1);
    const hd z = 1 - v * (1 - dot(c1, b));
    const D3 aside = c1 - b * dot(c1, b);
    return choose(dot(aside, aside) > 0, b * z + normalize(aside) * rootAbove(1 - z * z), b);
}

struct PlaceLanes {
    hm triangle;
    hd b1, b2;
};
/// TriangleLamp::place().
AL_INLINE PlaceLanes placeByAngle(const FlatEmitter& e, const D3& from, const SeenLanes& s, hd x, hd y) {
    hd left = x * s.total;
    hm t = hm(0), goes = hm(-1);
    for (int k = 0; k + 1 < e.count; ++k) {
        goes &= left >= s.angle[k];
        left = goes ? left - s.angle[k] : left;
        t -= goes;
    }
    for (int k = e.count - 1; k > 0; --k) t += (t == k) & ~(s.angle[k] > 0);
    hd angle = s.angle[0];
    D3 way[3] = {s.way[0][0], s.way[0][1], s.way[0][2]};
    for (int k = 1; k < e.count; ++k) {
        const hm here = t == k;
        angle = here ? s.angle[k] : angle;
        for (int i = 0; i < 3; ++i) way[i] = choose(here, s.way[k][i], way[i]);
    }
    const D3 a = cornerOf(e, t, 0) - from, b = cornerOf(e, t, 1) - from, c = cornerOf(e, t, 2) - from;
    const D3 w = withinAngle(way[0], way[1], way[2], angle, clamp(left / angle, hd(0), hd(1)), y);
    const D3 e1 = b - a, e2 = c - a, q = cross(a, w);
    const hd facing = dot(cross(e1, e2), w);
    const hm there = facing != 0;
    const hd b1 = there ? clamp(dot(q, e2) / facing, hd(0), hd(1)) : hd(1 / 3.);
    return {t, b1, there ? clamp(-dot(q, e1) / facing, hd(0), 1.0 - b1) : hd(1 / 3.)};
}

/// PolygonMesh::sampleArea().
AL_INLINE PlaceLanes placeByArea(const FlatEmitter& e, hd x, hd y) {
    const hd target = x * e.cumulative[e.count - 1];
    hm t = hm(0);
    hd low = hd(0), high = hd(e.cumulative[0]);
    for (int k = 0; k + 1 < e.count; ++k) t -= hd(e.cumulative[k]) <= target;
    for (int k = 1; k < e.count; ++k) {
        low = t == k ? hd(e.cumulative[k - 1]) : low;
        high = t == k ? hd(e.cumulative[k]) : high;
    }
    const hd size = high - low, side = rootOf(size > 0 ? clamp((target - low) / size, hd(0), hd(1)) : hd(0.5));
    return {t, side * (1 - y), side * y};
}

/// Of the points from `at` on: P, the normals of their triangles, and their density by solid angle, 0 where it is by area.
AL_INLINE void placeHalf(const VertexBlock& v, const FlatEmitter& e, int at, const float* x, const float* y, float* P, float* N,
                         int stride, float* density) {
    const D3 from = {wide(v.P[0] + at), wide(v.P[1] + at), wide(v.P[2] + at)};
    const hd u0 = wide(x + at), u1 = wide(y + at);
    SeenLanes s;
    const hm near = seeLamp(e, from, s);
    PlaceLanes p{};
    hd pdf = hd(0);
    if (any(~near)) p = placeByArea(e, u0, u1);
    if (any(near)) {
        const PlaceLanes n = placeByAngle(e, from, s, u0, u1);
        p = {near ? n.triangle : p.triangle, near ? n.b1 : p.b1, near ? n.b2 : p.b2};
        pdf = near ? e.share / s.total : pdf;
    }
    const D3 a = cornerOf(e, p.triangle, 0), e1 = cornerOf(e, p.triangle, 1) - a, e2 = cornerOf(e, p.triangle, 2) - a;
    const D3 to = a + e1 * p.b1 + e2 * p.b2;
    storeNarrow(P, to.x), storeNarrow(P + stride, to.y), storeNarrow(P + 2 * stride, to.z);
    for (int q = 0; q < 3; ++q) {
        hd n = hd(double(e.normal[0][q]));
        for (int k = 1; k < e.count; ++k) n = p.triangle == k ? hd(double(e.normal[k][q])) : n;
        storeNarrow(N + q * stride, n);
    }
    storeNarrow(density, pdf);
}

/// geometry::roundingError().
AL_INLINE vf roundingError(const V3& p) {
    return vf(1.1920929e-7f) * (absLanes(p.x) + absLanes(p.y) + absLanes(p.z)) + vf(1e-37f);
}

static Lanes placeOnEmitter(const VertexBlock& v, const FlatEmitter& e, const float* x, const float* y, LightBlock& to, float* P,
                            float* N, int stride) {
    Lanes placed = 0;
    for (int at = 0; at < kBlock; at += kH) placeHalf(v, e, at, x, y, P + at, N + at, stride, to.density + at);
    for (int at = 0; at < kBlock; at += kW) {
        const V3 p = load3(P + at, stride), n = load3(N + at, stride), d = p - load3(v.P, at);
        const vf angular = load(to.density + at), d2 = dot(d, d), way = rootLanes(d2), cosine = absLanes(dot(d, n)) / way;
        const vd area = vd(e.perArea) * __builtin_convertvector(d2, vd) / __builtin_convertvector(cosine, vd);
        const vf byArea = select((d2 > 0) & (cosine > vf(1e-7f)), __builtin_convertvector(area, vf), vf(0));
        const vf density = select(angular > 0, angular, byArea);
        const V3 w = d / way;
        vm ok = (way > 0) & (density > 0) & finite(density);
        if (e.oneSided) ok &= dot(n, w) < 0;
        store3(to.w, at, w);
        store(to.density + at, density);
        store3(to.end, at, offsetOrigin(p, n, roundingError(p), -w));
        placed |= bitsFrom(ok, at);
    }
    return placed;
}

} // namespace alpenglow::transport::AL_NAMESPACE
