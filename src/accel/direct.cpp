#include "accel/direct.h"
#include "accel/accel.h"
#include "accel/directblock.h"
#include <algorithm>
#include <cmath>
#include <cstring>

namespace alpenglow::accel {

namespace {
float norm1(const Vec3& v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z); }
// Rounding error bound of a hit point: each product and sum rounds by 2^-24 of at most its magnitude, t by that over n.dir. 64
// exceeds their number.
float slackOf(float extent, const Vec3& origin) { return 64 * 0x1p-24f * (2 * extent + norm1(origin)) + 1e-30f; }
} // namespace

void DirectTriangles::add(const Triangle& t) {
    const size_t lane = size_++;
    if (lane == 0) std::fill_n(rows_.u0, kRoom, -1e30f); // lanes without a triangle: planes without points
    triangles_.push_back(t);
    planes_.push_back({});
    for (const Vec3& p : {t.a, t.b, t.c}) extent_ = std::max(extent_, norm1(p));
    Vec3d a(t.a), e1 = Vec3d(t.b) - a, e2 = Vec3d(t.c) - a, c = cross(e1, e2);
    double l = length(c);
    if (!(l > 0)) return;                                        // no area: never hit
    Vec3d n = c / l, u = cross(e2, n) / l, v = cross(n, e1) / l; // u.(p - a) is the weight of b, v.(p - a) that of c
    planes_.back() = {n, dot(n, a)};
    auto put = [&](float to[3][kRoom], const Vec3d& x) {
        to[0][lane] = float(x.x), to[1][lane] = float(x.y), to[2][lane] = float(x.z);
    };
    put(rows_.n, n);
    put(rows_.u, u);
    put(rows_.v, v);
    rows_.d[lane] = float(dot(n, a));
    rows_.u0[lane] = float(-dot(u, a));
    rows_.v0[lane] = float(-dot(v, a));
    rows_.slope[lane] = float(2 * (length(u) + length(v)));
}

void DirectTriangles::copyTo(DirectScene& to) const {
    static_assert(DirectScene::kTriangles == kMost);
    to.triangles = int(size_);
    to.extent = extent_;
    for (size_t k = 0; k < size_; ++k) {
        for (int q = 0; q < 3; ++q) {
            to.n[q][k] = rows_.n[q][k], to.u[q][k] = rows_.u[q][k], to.v[q][k] = rows_.v[q][k];
            to.planeN[q][k] = planes_[k].n[q];
            to.corner[k][q] = triangles_[k].a[q], to.corner[k][3 + q] = triangles_[k].b[q],
            to.corner[k][6 + q] = triangles_[k].c[q];
        }
        to.d[k] = rows_.d[k], to.u0[k] = rows_.u0[k], to.v0[k] = rows_.v0[k], to.slope[k] = rows_.slope[k];
        to.planeD[k] = planes_[k].d;
    }
}

template <int Lanes> struct DirectTriangles::Search {
    typedef float Floats __attribute__((vector_size(4 * Lanes)));
    typedef int32_t Ints __attribute__((vector_size(4 * Lanes)));
    typedef bool Bools __attribute__((ext_vector_type(Lanes)));
    static constexpr uint32_t kAll = (1u << Lanes) - 1;

    static const Floats& lanes(const float* p) { return *reinterpret_cast<const Floats*>(p); }

    // Inlined into functions for the instruction set of one width; its types have no registers elsewhere.
    [[gnu::always_inline]] static inline uint32_t find(const DirectTriangles& all, const Ray& r, Near& near) {
        const float slack = slackOf(all.extent_, r.org), length = norm1(r.dir);
        // Copies: the compiler must assume that `near` aliases the ray, and would reload it.
        const float dx = r.dir.x, dy = r.dir.y, dz = r.dir.z, ox = r.org.x, oy = r.org.y, oz = r.org.z, from = r.tnear,
                    to = r.tfar;
        const size_t size = all.size_;
        const Rows& f = all.rows_;
        uint32_t found = 0;
        for (size_t k = 0; k < size; k += Lanes) {
            const Floats inverse = 1.f / (lanes(f.n[0] + k) * dx + lanes(f.n[1] + k) * dy + lanes(f.n[2] + k) * dz);
            const Floats height = lanes(f.n[0] + k) * ox + lanes(f.n[1] + k) * oy + lanes(f.n[2] + k) * oz;
            const Floats t = (lanes(f.d + k) - height) * inverse;
            // Error of t, in lengths of dir; the point has the same error.
            const Floats off = reinterpret_cast<Floats>(reinterpret_cast<Ints>(inverse) & 0x7fffffff) * slack, nearest = t - off;
            *reinterpret_cast<Floats*>(near + k) = nearest;
            const Floats px = ox + t * dx, py = oy + t * dy, pz = oz + t * dz;
            const Floats u = lanes(f.u[0] + k) * px + lanes(f.u[1] + k) * py + lanes(f.u[2] + k) * pz + lanes(f.u0 + k);
            const Floats v = lanes(f.v[0] + k) * px + lanes(f.v[1] + k) * py + lanes(f.v[2] + k) * pz + lanes(f.v0 + k);
            const Floats room = off * length * lanes(f.slope + k);
            // "Not outside", so that NaN counts as a candidate: a ray in the plane, an overflow.
            const Ints outside = (t + off < from) | (nearest > to) | (u < -room) | (v < -room) | (u + v > 1.f + (room + room));
            const Bools mask = __builtin_convertvector(outside, Bools);
            std::conditional_t<Lanes == 16, uint16_t, uint8_t> bits;
            std::memcpy(&bits, &mask, sizeof bits);
            found |= (~uint32_t(bits) & kAll) << k;
        }
        return found & ((1u << size) - 1);
    }
};

uint32_t DirectTriangles::findFour(const DirectTriangles& all, const Ray& r, Near& near) { return Search<4>::find(all, r, near); }
[[gnu::target("avx2")]] uint32_t DirectTriangles::findEight(const DirectTriangles& all, const Ray& r, Near& near) {
    return Search<8>::find(all, r, near);
}

[[gnu::target("avx512f,avx512dq,avx512vl,avx512bw")]] uint32_t DirectTriangles::findSixteen(const DirectTriangles& all,
                                                                                            const Ray& r, Near& near) {
    return Search<16>::find(all, r, near);
}

DirectTriangles::Find DirectTriangles::choose() {
    const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
    return wide ? findSixteen : __builtin_cpu_supports("avx2") ? findEight : findFour;
}

} // namespace alpenglow::accel
