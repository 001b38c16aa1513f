#include "accel/direct.h"
#include "accel/accel.h"
#include <algorithm>
#include <cmath>
#include <xmmintrin.h>

namespace alpenglow::accel {

namespace {
float norm1(const Vec3& v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z); }
} // namespace

void DirectTriangles::add(const Triangle& t) {
    size_t lane = triangles_.size() % 4;
    if (lane == 0) { // lanes without a triangle: planes that no point is on
        Four none{};
        for (int i = 0; i < 4; ++i) none.u0[i] = -1e30f;
        fours_.push_back(none);
    }
    triangles_.push_back(t);
    planes_.push_back({});
    for (const Vec3& p : {t.a, t.b, t.c}) extent_ = std::max(extent_, norm1(p));
    Four& f = fours_.back();
    Vec3d a(t.a), e1 = Vec3d(t.b) - a, e2 = Vec3d(t.c) - a, c = cross(e1, e2);
    double l = length(c);
    if (!(l > 0)) return; // without an area: never met
    Vec3d n = c / l, u = cross(e2, n) / l, v = cross(n, e1) / l; // u.(p - a) is the weight of b, v.(p - a) that of c
    planes_.back() = {n, dot(n, a)};
    auto put = [&](float to[3][4], const Vec3d& x) { to[0][lane] = float(x.x), to[1][lane] = float(x.y), to[2][lane] = float(x.z); };
    put(f.n, n);
    put(f.u, u);
    put(f.v, v);
    f.d[lane] = float(dot(n, a));
    f.u0[lane] = float(-dot(u, a));
    f.v0[lane] = float(-dot(v, a));
    f.slope[lane] = float(2 * (length(u) + length(v)));
}

uint32_t DirectTriangles::candidates(const Ray& r) const {
    auto all = [](float x) { return _mm_set1_ps(x); };
    auto dot3 = [](const float m[3][4], __m128 x, __m128 y, __m128 z) {
        return _mm_add_ps(_mm_add_ps(_mm_mul_ps(_mm_load_ps(m[0]), x), _mm_mul_ps(_mm_load_ps(m[1]), y)), _mm_mul_ps(_mm_load_ps(m[2]), z));
    };
    // Of a point that a ray meets: each product and sum rounds by 2^-24 of at most `reach`, t by that over n.dir. 64 of them are more
    // than are made.
    const float slack = 64 * 0x1p-24f * (2 * extent_ + norm1(r.org)) + 1e-30f;
    const __m128 ox = all(r.org.x), oy = all(r.org.y), oz = all(r.org.z), dx = all(r.dir.x), dy = all(r.dir.y), dz = all(r.dir.z);
    const __m128 one = all(1), lo = all(r.tnear), hi = all(r.tfar), rounding = all(slack), length = all(norm1(r.dir)), sign = all(-0.f), zero = _mm_setzero_ps();
    uint32_t found = 0;
    for (size_t k = 0; k < fours_.size(); ++k) {
        const Four& f = fours_[k];
        __m128 inverse = _mm_div_ps(one, dot3(f.n, dx, dy, dz));
        __m128 t = _mm_mul_ps(_mm_sub_ps(_mm_load_ps(f.d), dot3(f.n, ox, oy, oz)), inverse);
        // How far off t is, in lengths of dir; the point is off by as many lengths.
        __m128 off = _mm_mul_ps(_mm_andnot_ps(sign, inverse), rounding);
        // "Not outside", so that what is not a number counts as a candidate: a ray in the plane, an overflow.
        __m128 outside = _mm_or_ps(_mm_cmplt_ps(_mm_add_ps(t, off), lo), _mm_cmpgt_ps(_mm_sub_ps(t, off), hi));
        if (_mm_movemask_ps(outside) == 15) continue;
        __m128 px = _mm_add_ps(ox, _mm_mul_ps(t, dx)), py = _mm_add_ps(oy, _mm_mul_ps(t, dy)), pz = _mm_add_ps(oz, _mm_mul_ps(t, dz));
        __m128 u = _mm_add_ps(dot3(f.u, px, py, pz), _mm_load_ps(f.u0)), v = _mm_add_ps(dot3(f.v, px, py, pz), _mm_load_ps(f.v0));
        __m128 room = _mm_mul_ps(_mm_mul_ps(off, length), _mm_load_ps(f.slope)), least = _mm_sub_ps(zero, room);
        outside = _mm_or_ps(outside, _mm_or_ps(_mm_cmplt_ps(u, least), _mm_cmplt_ps(v, least)));
        outside = _mm_or_ps(outside, _mm_cmpgt_ps(_mm_add_ps(u, v), _mm_add_ps(one, _mm_add_ps(room, room))));
        found |= (~unsigned(_mm_movemask_ps(outside)) & 15) << (4 * k);
    }
    return found & ((1u << triangles_.size()) - 1);
}

} // namespace alpenglow::accel
