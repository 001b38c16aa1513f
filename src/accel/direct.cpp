#include "accel/direct.h"
#include "accel/accel.h"
#include <algorithm>
#include <cmath>
#include <immintrin.h>

namespace alpenglow::accel {

namespace {
float norm1(const Vec3& v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z); }
// Of a point that a ray meets: each product and sum rounds by 2^-24 of at most its reach, t by that over n.dir. 64 of them are more
// than are made.
float slackOf(float extent, const Vec3& origin) { return 64 * 0x1p-24f * (2 * extent + norm1(origin)) + 1e-30f; }
} // namespace

void DirectTriangles::add(const Triangle& t) {
    size_t lane = triangles_.size() % 8;
    if (lane == 0) { // lanes without a triangle: planes that no point is on
        Eight none{};
        for (int i = 0; i < 8; ++i) none.u0[i] = -1e30f;
        eights_.push_back(none);
    }
    triangles_.push_back(t);
    planes_.push_back({});
    for (const Vec3& p : {t.a, t.b, t.c}) extent_ = std::max(extent_, norm1(p));
    Eight& f = eights_.back();
    Vec3d a(t.a), e1 = Vec3d(t.b) - a, e2 = Vec3d(t.c) - a, c = cross(e1, e2);
    double l = length(c);
    if (!(l > 0)) return; // without an area: never met
    Vec3d n = c / l, u = cross(e2, n) / l, v = cross(n, e1) / l; // u.(p - a) is the weight of b, v.(p - a) that of c
    planes_.back() = {n, dot(n, a)};
    auto put = [&](float to[3][8], const Vec3d& x) { to[0][lane] = float(x.x), to[1][lane] = float(x.y), to[2][lane] = float(x.z); };
    put(f.n, n);
    put(f.u, u);
    put(f.v, v);
    f.d[lane] = float(dot(n, a));
    f.u0[lane] = float(-dot(u, a));
    f.v0[lane] = float(-dot(v, a));
    f.slope[lane] = float(2 * (length(u) + length(v)));
}

uint32_t DirectTriangles::findFour(const DirectTriangles& all, const Ray& r, Near& near) {
    const float slack = slackOf(all.extent_, r.org);
    const __m128 ox = _mm_set1_ps(r.org.x), oy = _mm_set1_ps(r.org.y), oz = _mm_set1_ps(r.org.z);
    const __m128 dx = _mm_set1_ps(r.dir.x), dy = _mm_set1_ps(r.dir.y), dz = _mm_set1_ps(r.dir.z);
    const __m128 one = _mm_set1_ps(1), lo = _mm_set1_ps(r.tnear), hi = _mm_set1_ps(r.tfar), sign = _mm_set1_ps(-0.f), zero = _mm_setzero_ps();
    const __m128 rounding = _mm_set1_ps(slack), length = _mm_set1_ps(norm1(r.dir));
    uint32_t found = 0;
    for (size_t k = 0; k < all.triangles_.size(); k += 4) {
        const Eight& f = all.eights_[k / 8];
        const size_t h = k % 8; // its first or second half
        __m128 inverse = _mm_div_ps(one, _mm_add_ps(_mm_add_ps(_mm_mul_ps(_mm_load_ps(f.n[0] + h), dx), _mm_mul_ps(_mm_load_ps(f.n[1] + h), dy)), _mm_mul_ps(_mm_load_ps(f.n[2] + h), dz)));
        __m128 t = _mm_mul_ps(_mm_sub_ps(_mm_load_ps(f.d + h), _mm_add_ps(_mm_add_ps(_mm_mul_ps(_mm_load_ps(f.n[0] + h), ox), _mm_mul_ps(_mm_load_ps(f.n[1] + h), oy)), _mm_mul_ps(_mm_load_ps(f.n[2] + h), oz))), inverse);
        // How far off t is, in lengths of dir; the point is off by as many lengths.
        __m128 off = _mm_mul_ps(_mm_andnot_ps(sign, inverse), rounding), nearest = _mm_sub_ps(t, off);
        // "Not outside", so that what is not a number counts as a candidate: a ray in the plane, an overflow.
        __m128 outside = _mm_or_ps(_mm_cmplt_ps(_mm_add_ps(t, off), lo), _mm_cmpgt_ps(nearest, hi));
        if (_mm_movemask_ps(outside) == 15) continue;
        _mm_storeu_ps(near + k, nearest);
        __m128 px = _mm_add_ps(ox, _mm_mul_ps(t, dx)), py = _mm_add_ps(oy, _mm_mul_ps(t, dy)), pz = _mm_add_ps(oz, _mm_mul_ps(t, dz));
        __m128 u = _mm_add_ps(_mm_add_ps(_mm_add_ps(_mm_mul_ps(_mm_load_ps(f.u[0] + h), px), _mm_mul_ps(_mm_load_ps(f.u[1] + h), py)), _mm_mul_ps(_mm_load_ps(f.u[2] + h), pz)), _mm_load_ps(f.u0 + h));
        __m128 v = _mm_add_ps(_mm_add_ps(_mm_add_ps(_mm_mul_ps(_mm_load_ps(f.v[0] + h), px), _mm_mul_ps(_mm_load_ps(f.v[1] + h), py)), _mm_mul_ps(_mm_load_ps(f.v[2] + h), pz)), _mm_load_ps(f.v0 + h));
        __m128 room = _mm_mul_ps(_mm_mul_ps(off, length), _mm_load_ps(f.slope + h)), least = _mm_sub_ps(zero, room);
        outside = _mm_or_ps(outside, _mm_or_ps(_mm_cmplt_ps(u, least), _mm_cmplt_ps(v, least)));
        outside = _mm_or_ps(outside, _mm_cmpgt_ps(_mm_add_ps(u, v), _mm_add_ps(one, _mm_add_ps(room, room))));
        found |= (~unsigned(_mm_movemask_ps(outside)) & 15) << k;
    }
    return found & ((1u << all.triangles_.size()) - 1);
}

__attribute__((target("avx2"))) uint32_t DirectTriangles::findEight(const DirectTriangles& all, const Ray& r, Near& near) {
    const float slack = slackOf(all.extent_, r.org);
    const __m256 ox = _mm256_set1_ps(r.org.x), oy = _mm256_set1_ps(r.org.y), oz = _mm256_set1_ps(r.org.z);
    const __m256 dx = _mm256_set1_ps(r.dir.x), dy = _mm256_set1_ps(r.dir.y), dz = _mm256_set1_ps(r.dir.z);
    const __m256 one = _mm256_set1_ps(1), lo = _mm256_set1_ps(r.tnear), hi = _mm256_set1_ps(r.tfar), sign = _mm256_set1_ps(-0.f), zero = _mm256_setzero_ps();
    const __m256 rounding = _mm256_set1_ps(slack), length = _mm256_set1_ps(norm1(r.dir));
    uint32_t found = 0;
    for (size_t k = 0; k < all.triangles_.size(); k += 8) {
        const Eight& f = all.eights_[k / 8];
        __m256 inverse = _mm256_div_ps(one, _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(_mm256_load_ps(f.n[0]), dx), _mm256_mul_ps(_mm256_load_ps(f.n[1]), dy)), _mm256_mul_ps(_mm256_load_ps(f.n[2]), dz)));
        __m256 t = _mm256_mul_ps(_mm256_sub_ps(_mm256_load_ps(f.d), _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(_mm256_load_ps(f.n[0]), ox), _mm256_mul_ps(_mm256_load_ps(f.n[1]), oy)), _mm256_mul_ps(_mm256_load_ps(f.n[2]), oz))), inverse);
        // How far off t is, in lengths of dir; the point is off by as many lengths.
        __m256 off = _mm256_mul_ps(_mm256_andnot_ps(sign, inverse), rounding), nearest = _mm256_sub_ps(t, off);
        // "Not outside", so that what is not a number counts as a candidate: a ray in the plane, an overflow.
        __m256 outside = _mm256_or_ps(_mm256_cmp_ps(_mm256_add_ps(t, off), lo, _CMP_LT_OS), _mm256_cmp_ps(nearest, hi, _CMP_GT_OS));
        if (_mm256_movemask_ps(outside) == 255) continue;
        _mm256_storeu_ps(near + k, nearest);
        __m256 px = _mm256_add_ps(ox, _mm256_mul_ps(t, dx)), py = _mm256_add_ps(oy, _mm256_mul_ps(t, dy)), pz = _mm256_add_ps(oz, _mm256_mul_ps(t, dz));
        __m256 u = _mm256_add_ps(_mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(_mm256_load_ps(f.u[0]), px), _mm256_mul_ps(_mm256_load_ps(f.u[1]), py)), _mm256_mul_ps(_mm256_load_ps(f.u[2]), pz)), _mm256_load_ps(f.u0));
        __m256 v = _mm256_add_ps(_mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(_mm256_load_ps(f.v[0]), px), _mm256_mul_ps(_mm256_load_ps(f.v[1]), py)), _mm256_mul_ps(_mm256_load_ps(f.v[2]), pz)), _mm256_load_ps(f.v0));
        __m256 room = _mm256_mul_ps(_mm256_mul_ps(off, length), _mm256_load_ps(f.slope)), least = _mm256_sub_ps(zero, room);
        outside = _mm256_or_ps(outside, _mm256_or_ps(_mm256_cmp_ps(u, least, _CMP_LT_OS), _mm256_cmp_ps(v, least, _CMP_LT_OS)));
        outside = _mm256_or_ps(outside, _mm256_cmp_ps(_mm256_add_ps(u, v), _mm256_add_ps(one, _mm256_add_ps(room, room)), _CMP_GT_OS));
        found |= (~unsigned(_mm256_movemask_ps(outside)) & 255) << k;
    }
    return found & ((1u << all.triangles_.size()) - 1);
}

DirectTriangles::Find DirectTriangles::choose() { return __builtin_cpu_supports("avx2") ? findEight : findFour; }

} // namespace alpenglow::accel
