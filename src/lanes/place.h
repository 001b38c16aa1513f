// Stage place: Emitter::sample() for emitters of a few flat triangles. Solid angles are computed in double, half a register of
// points at a time.
#pragma once
#include "base/exactlanes.h"
#include "lanes/rows.h"

namespace alpenglow::lanes::AL_NAMESPACE {

inline constexpr int kH = kW / 2; ///< points in half a vector: doubles of the same size
/// Floats and doubles of half the lanes.
typedef float hf __attribute__((ext_vector_type(ALPENGLOW_LANES / 2)));
typedef double hd __attribute__((ext_vector_type(ALPENGLOW_LANES / 2)));
typedef exact::MaskOf<hd> hm; ///< mask, and integers

/// Three rows in double.
struct D3 {
    hd x, y, z; ///< by lane
};
/// As of Vec3d, by lane.
AL_INLINE D3 operator+(const D3& a, const D3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
AL_INLINE D3 operator-(const D3& a, const D3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
AL_INLINE D3 operator*(const D3& a, hd s) { return {a.x * s, a.y * s, a.z * s}; }
AL_INLINE D3 operator/(const D3& a, hd s) { return {a.x / s, a.y / s, a.z / s}; }
AL_INLINE hd dot(const D3& a, const D3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
AL_INLINE D3 cross(const D3& a, const D3& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
/// Rounded correctly.
AL_INLINE hd rootOf(hd x) { return __builtin_elementwise_sqrt(x); }
/// Root of a value that rounding may have made negative.
AL_INLINE hd rootAbove(hd x) { return rootOf(x > 0 ? x : hd(0)); }
/// By lane, as of Vec3d and of the standard library; wide() and storeNarrow() convert from and to floats.
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
    D3 c = constant(e.corner[e.corners[0][corner]]);
    for (int k = 1; k < e.count; ++k) c = choose(t == k, constant(e.corner[e.corners[k][corner]]), c);
    return c;
}

/// Whether the emitter is so near that solid angles count (TriangleLamp::see()).
AL_INLINE hm isNear(const FlatEmitter& e, const D3& from) {
    const D3 middle = constant(e.centre) - from;
    return dot(middle, middle) < e.near2;
}

/// The triangles seen from points: TriangleLamp::see().
struct SeenLanes {
    hd angle[FlatEmitter::kMost], total; ///< solid angles, steradians: of each triangle, and their sum
    D3 way[3 * FlatEmitter::kMost];      ///< unit, toward the corners
};
/// Fills s; returns the points that see the lamp by solid angle.
AL_INLINE hm seeLamp(const FlatEmitter& e, const D3& from, SeenLanes& s) {
    hm seen = isNear(e, from);
    for (int i = 0; i < e.cornerCount; ++i) {
        const D3 c = constant(e.corner[i]) - from;
        const hd l2 = dot(c, c);
        seen &= l2 > e.least2;
        s.way[i] = c / rootOf(l2);
    }
    s.total = hd(0);
    for (int t = 0; t < e.count; ++t) {
        const D3 &a = s.way[e.corners[t][0]], &b = s.way[e.corners[t][1]], &c = s.way[e.corners[t][2]];
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
    const D3 across = c1 - b * dot(c1, b);
    return choose(dot(across, across) > 0, b * z + normalize(across) * rootAbove(1 - z * z), b);
}

/// TriangleLamp::place().
AL_INLINE void placeByAngle(const FlatEmitter& e, const D3& from, const SeenLanes& s, hd x, hd y, hm& t, hd& b1, hd& b2) {
    hd left = x * s.total;
    hm goes = hm(-1);
    t = hm(0);
    for (int k = 0; k + 1 < e.count; ++k) {
        goes &= left >= s.angle[k];
        left = goes ? left - s.angle[k] : left;
        t -= goes;
    }
    for (int k = e.count - 1; k > 0; --k) t += (t == k) & ~(s.angle[k] > 0);
    hd angle = s.angle[0];
    D3 way[3] = {s.way[e.corners[0][0]], s.way[e.corners[0][1]], s.way[e.corners[0][2]]};
    for (int k = 1; k < e.count; ++k) {
        const hm here = t == k;
        angle = here ? s.angle[k] : angle;
        for (int i = 0; i < 3; ++i) way[i] = choose(here, s.way[e.corners[k][i]], way[i]);
    }
    const D3 a = cornerOf(e, t, 0) - from, b = cornerOf(e, t, 1) - from, c = cornerOf(e, t, 2) - from;
    const D3 w = withinAngle(way[0], way[1], way[2], angle, clamp(left / angle, hd(0), hd(1)), y);
    const D3 e1 = b - a, e2 = c - a, q = cross(a, w);
    const hd facing = dot(cross(e1, e2), w);
    const hm there = facing != 0;
    b1 = there ? clamp(dot(q, e2) / facing, hd(0), hd(1)) : hd(1 / 3.);
    b2 = there ? clamp(-dot(q, e1) / facing, hd(0), 1.0 - b1) : hd(1 / 3.);
}

/// PolygonMesh::sampleArea().
AL_INLINE void placeByArea(const FlatEmitter& e, hd x, hd y, hm& t, hd& b1, hd& b2) {
    const hd target = x * e.cumulative[e.count - 1];
    t = hm(0);
    hd low = hd(0), high = hd(e.cumulative[0]);
    for (int k = 0; k + 1 < e.count; ++k) t -= hd(e.cumulative[k]) <= target;
    for (int k = 1; k < e.count; ++k) {
        low = t == k ? hd(e.cumulative[k - 1]) : low;
        high = t == k ? hd(e.cumulative[k]) : high;
    }
    const hd size = high - low, side = rootOf(size > 0 ? clamp((target - low) / size, hd(0), hd(1)) : hd(0.5));
    b1 = side * (1 - y), b2 = side * y;
}

/// Points of a block and their positions on the emitter, in double.
struct alignas(64) PlaceRows {
    double from[3][kBlock], u[2][kBlock];         ///< current space; random numbers in [0, 1)
    double b1[kBlock], b2[kBlock], total[kBlock]; ///< total: solid angle; 0: uniform by area
    int64_t triangle[kBlock];                     ///< of the emitter
};
/// Doubles of half the lanes, from p on; the points of a block.
AL_INLINE hd loadHalf(const double* p) {
    hd v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
AL_INLINE D3 fromHalf(const PlaceRows& r, int at) {
    return {loadHalf(r.from[0] + at), loadHalf(r.from[1] + at), loadHalf(r.from[2] + at)};
}

/// Replaces positions from `at` on by uniform ones in solid angle.
AL_INLINE void placeNear(const FlatEmitter& e, PlaceRows& r, int at) {
    const D3 from = fromHalf(r, at);
    SeenLanes s;
    const hm seen = seeLamp(e, from, s);
    hm triangle, t;
    hd b1, b2;
    placeByAngle(e, from, s, loadHalf(r.u[0] + at), loadHalf(r.u[1] + at), t, b1, b2);
    __builtin_memcpy(&triangle, r.triangle + at, sizeof triangle);
    store(r.triangle + at, seen ? t : triangle);
    store(r.b1 + at, seen ? b1 : loadHalf(r.b1 + at));
    store(r.b2 + at, seen ? b2 : loadHalf(r.b2 + at));
    store(r.total + at, seen ? s.total : hd(0));
}

/// The same for any points of a block, packed together: solid angles are most of the work.
static void placeTogether(const FlatEmitter& e, PlaceRows& r, const int* lanes, int count) {
    PlaceRows g;
    for (int k = 0; k < (count + kH - 1) / kH * kH; ++k) {
        const int i = lanes[k < count ? k : 0];
        for (int q = 0; q < 3; ++q) g.from[q][k] = r.from[q][i];
        for (int q = 0; q < 2; ++q) g.u[q][k] = r.u[q][i];
        g.b1[k] = r.b1[i], g.b2[k] = r.b2[i], g.triangle[k] = r.triangle[i];
    }
    for (int at = 0; at < count; at += kH) placeNear(e, g, at);
    for (int k = 0; k < count; ++k) {
        const int i = lanes[k];
        r.b1[i] = g.b1[k], r.b2[i] = g.b2[k], r.triangle[i] = g.triangle[k], r.total[i] = g.total[k];
    }
}

/// Positions on the emitter for all points of the block.
AL_INLINE void placeAll(const VertexBlock& v, const FlatEmitter& e, const float* x, const float* y, PlaceRows& r) {
    int near[kBlock], count = 0, halves = 0; // halves: half registers with some near points
    bool some[kBlock / kH];
    for (int at = 0; at < kBlock; at += kH) {
        const hd u0 = wide(x + at), u1 = wide(y + at);
        for (int q = 0; q < 3; ++q) store(r.from[q] + at, wide(v.P[q] + at));
        store(r.u[0] + at, u0), store(r.u[1] + at, u1);
        hm t;
        hd b1, b2;
        placeByArea(e, u0, u1, t, b1, b2);
        store(r.b1 + at, b1), store(r.b2 + at, b2), store(r.total + at, hd(0)), store(r.triangle + at, t);
        const hm m = isNear(e, fromHalf(r, at));
        halves += some[at / kH] = any(m);
        for (int k = 0; some[at / kH] && k < kH; ++k)
            if (m[k]) near[count++] = at + k;
    }
    if ((count + kH - 1) / kH < halves) return placeTogether(e, r, near, count);
    for (int at = 0; at < kBlock; at += kH)
        if (some[at / kH]) placeNear(e, r, at);
}

/// P and triangle normals for the positions from `at` on.
AL_INLINE void pointsOf(const FlatEmitter& e, const PlaceRows& r, int at, float* P, float* N, int stride) {
    hm t;
    __builtin_memcpy(&t, r.triangle + at, sizeof t);
    const D3 a = cornerOf(e, t, 0), e1 = cornerOf(e, t, 1) - a, e2 = cornerOf(e, t, 2) - a;
    const D3 p = a + e1 * loadHalf(r.b1 + at) + e2 * loadHalf(r.b2 + at);
    storeNarrow(P, p.x), storeNarrow(P + stride, p.y), storeNarrow(P + 2 * stride, p.z);
    for (int q = 0; q < 3; ++q) {
        hd n = hd(double(e.normal[0][q]));
        for (int k = 1; k < e.count; ++k) n = t == k ? hd(double(e.normal[k][q])) : n;
        storeNarrow(N + q * stride, n);
    }
}

/// geometry::roundingError().
AL_INLINE vf roundingError(const V3& p) {
    return vf(1.1920929e-7f) * (absLanes(p.x) + absLanes(p.y) + absLanes(p.z)) + vf(1e-37f);
}

/// Directions, densities and shadow ray ends for points at P with normals N. perArea: by point. oneSided: points whose emitters
/// emit on one side.
AL_INLINE Lanes seenFrom(const VertexBlock& v, const PlaceRows& r, const double* perArea, Lanes oneSided, const double* share,
                         LightBlock& to, const float* P, const float* N, int stride) {
    Lanes placed = 0;
    for (int at = 0; at < kBlock; at += kH) {
        const hd total = loadHalf(r.total + at);
        storeNarrow(to.density + at, total > 0 ? loadHalf(share + at) / total : hd(0));
    }
    for (int at = 0; at < kBlock; at += kW) {
        const V3 p = load3(P + at, stride), n = load3(N + at, stride), d = p - load3(v.P, at);
        const vf angular = load(to.density + at), d2 = dot(d, d), way = rootLanes(d2), cosine = absLanes(dot(d, n)) / way;
        vd chance, even;
        __builtin_memcpy(&chance, share + at, sizeof chance);
        __builtin_memcpy(&even, perArea + at, sizeof even);
        const vd area = chance * even * __builtin_convertvector(d2, vd) / __builtin_convertvector(cosine, vd);
        const vf byArea = select((d2 > 0) & (cosine > vf(1e-7f)), __builtin_convertvector(area, vf), vf(0));
        vm angle;
        for (int k = 0; k < kW; ++k) angle[k] = -(r.total[at + k] > 0);
        const vf density = select(angle, angular, byArea);
        const V3 w = d / way;
        const vm ok = (way > 0) & (density > 0) & finite(density) & (~maskFrom(oneSided, at) | (dot(n, w) < 0));
        store3(to.w, at, w);
        store(to.density + at, density);
        store3(to.end, at, offsetOrigin(p, n, roundingError(p), -w));
        placed |= bitsFrom(ok, at);
    }
    return placed;
}

/// Stages::place.
static Lanes placeOnEmitter(const VertexBlock& v, const FlatEmitter& e, const float* x, const float* y, const double* share,
                            LightBlock& to, float* P, float* N, int stride) {
    PlaceRows r;
    placeAll(v, e, x, y, r);
    alignas(64) double perArea[kBlock];
    for (int at = 0; at < kBlock; at += kH) {
        pointsOf(e, r, at, P + at, N + at, stride);
        store(perArea + at, hd(e.perArea));
    }
    return seenFrom(v, r, perArea, e.oneSided ? 0xffffu : 0, share, to, P, N, stride);
}

/// placeAll() with an emitter for each point.
AL_INLINE void placeEach(const VertexBlock& v, const FlatEmitter* const* lamps, const float* x, const float* y, PlaceRows& r) {
    alignas(64) double target[kBlock], low[kBlock], high[kBlock];
    int near[kBlock], count = 0;
    for (int i = 0; i < kBlock; ++i) {
        const FlatEmitter& e = *lamps[i];
        target[i] = double(x[i]) * e.cumulative[e.count - 1];
        int t = 0;
        for (int k = 0; k + 1 < e.count; ++k) t += e.cumulative[k] <= target[i];
        r.triangle[i] = t;
        low[i] = t ? e.cumulative[t - 1] : 0;
        high[i] = e.cumulative[t];
        r.u[0][i] = double(x[i]), r.u[1][i] = double(y[i]), r.total[i] = 0;
        double middle[3];
        for (int q = 0; q < 3; ++q) {
            r.from[q][i] = double(v.P[q][i]);
            middle[q] = e.centre[q] - r.from[q][i];
        }
        if (middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2] < e.near2) near[count++] = i;
    }
    for (int at = 0; at < kBlock; at += kH) {
        const hd l = loadHalf(low + at), size = loadHalf(high + at) - l, y0 = loadHalf(r.u[1] + at);
        const hd side = rootOf(size > 0 ? clamp((loadHalf(target + at) - l) / size, hd(0), hd(1)) : hd(0.5));
        store(r.b1 + at, side * (1 - y0)), store(r.b2 + at, side * y0);
    }
    for (int first = 0, last; first < count; first = last) { // near ones of the same emitter together
        for (last = first + 1; last < count && lamps[near[last]] == lamps[near[first]];) ++last;
        placeTogether(*lamps[near[first]], r, near + first, last - first);
    }
}

/// Stages::placeEach.
static Lanes placeOnEmitters(const VertexBlock& v, const FlatEmitter* const* lamps, const float* x, const float* y,
                             const double* share, LightBlock& to, float* P, float* N, int stride) {
    PlaceRows r;
    placeEach(v, lamps, x, y, r);
    alignas(64) double corner[3][3][kBlock], perArea[kBlock];
    Lanes oneSided = 0;
    for (int i = 0; i < kBlock; ++i) {
        const FlatEmitter& e = *lamps[i];
        const int64_t t = r.triangle[i];
        for (int c = 0; c < 3; ++c)
            for (int q = 0; q < 3; ++q) corner[c][q][i] = e.corner[e.corners[t][c]][q];
        for (int q = 0; q < 3; ++q) N[q * stride + i] = e.normal[t][q];
        perArea[i] = e.perArea;
        oneSided |= Lanes(e.oneSided) << i;
    }
    for (int at = 0; at < kBlock; at += kH) {
        const auto load3d = [&](int c) {
            return D3{loadHalf(corner[c][0] + at), loadHalf(corner[c][1] + at), loadHalf(corner[c][2] + at)};
        };
        const D3 a = load3d(0), e1 = load3d(1) - a, e2 = load3d(2) - a;
        const D3 p = a + e1 * loadHalf(r.b1 + at) + e2 * loadHalf(r.b2 + at);
        storeNarrow(P + at, p.x), storeNarrow(P + at + stride, p.y), storeNarrow(P + at + 2 * stride, p.z);
    }
    return seenFrom(v, r, perArea, oneSided, share, to, P, N, stride);
}

} // namespace alpenglow::lanes::AL_NAMESPACE
