// The Muttenzer box, twelve triangles and two balls, and the search for what rays meet in it: float bounds decide, and where they
// cannot, doubles do, ray by ray.
#pragma once
#include "bench/columns/columns.h"
#include <algorithm>
#include <cmath>
#include <cstring>

namespace alpenglow::bench::columns {

constexpr int kTri = 12, kBalls = 2;
struct Scene {
    float n[kTri][3], d[kTri], u[kTri][3], u0[kTri], v[kTri][3], v0[kTri], slope[kTri];
    int plane[kTri];
    alignas(32) double nd[16][4]; // n, d in double
    float planeN[16][3];          // by prim, as a table of columns
    float tabNx[16], tabNy[16], tabNz[16], albR[16], albG[16], albB[16];
    int group[16];
    float extent = 0;
    double c[kBalls][3], r[kBalls];
    double a[kTri][3], e1[kTri][3], e2[kTri][3];
    alignas(32) double ud[16][4], vd[16][4];
};
static Scene sc;
static void addQuad(int q, const double p[4][3], float r, float g, float b, int group) {
    for (int h = 0; h < 2; ++h) {
        int k = 2 * q + h;
        const double *A = p[0], *B = p[1 + h], *C = p[2 + h];
        double e1[3], e2[3], n[3];
        for (int i = 0; i < 3; ++i)
            e1[i] = B[i] - A[i], e2[i] = C[i] - A[i], sc.a[k][i] = A[i], sc.e1[k][i] = e1[i], sc.e2[k][i] = e2[i];
        auto cross = [](const double* x, const double* y, double* o) {
            o[0] = x[1] * y[2] - x[2] * y[1];
            o[1] = x[2] * y[0] - x[0] * y[2];
            o[2] = x[0] * y[1] - x[1] * y[0];
        };
        auto dot = [](const double* x, const double* y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; };
        cross(e1, e2, n);
        double l = std::sqrt(dot(n, n));
        for (double& x : n) x /= l;
        double u[3], v[3];
        cross(e2, n, u);
        cross(n, e1, v);
        for (int i = 0; i < 3; ++i) u[i] /= l, v[i] /= l;
        for (int i = 0; i < 3; ++i)
            sc.n[k][i] = float(n[i]), sc.u[k][i] = float(u[i]), sc.v[k][i] = float(v[i]), sc.nd[k][i] = n[i];
        sc.nd[k][3] = dot(n, A);
        for (int i = 0; i < 3; ++i) sc.ud[k][i] = u[i], sc.vd[k][i] = v[i];
        sc.ud[k][3] = -dot(u, A);
        sc.vd[k][3] = -dot(v, A);
        sc.d[k] = float(dot(n, A));
        sc.u0[k] = float(-dot(u, A));
        sc.v0[k] = float(-dot(v, A));
        sc.slope[k] = float(2 * (std::sqrt(dot(u, u)) + std::sqrt(dot(v, v))));
        sc.plane[k] = q;
        sc.tabNx[k] = float(n[0]);
        sc.tabNy[k] = float(n[1]);
        sc.tabNz[k] = float(n[2]);
        sc.albR[k] = r;
        sc.albG[k] = g;
        sc.albB[k] = b;
        sc.group[k] = group;
        for (int c = 0; c < 4; ++c)
            sc.extent = std::max(sc.extent, float(std::fabs(p[c][0]) + std::fabs(p[c][1]) + std::fabs(p[c][2])));
    }
}
static void makeScene() {
    memset((void*)&sc, 0, sizeof sc);
    const double x = 1.48, lo = -1.25, hi = 1.19, b = -1.55, f = 1.79, l = 1.18;
    const double q[6][4][3] = {
        {{-x, lo, f}, {x, lo, f}, {x, lo, b}, {-x, lo, b}}, {{-x, hi, b}, {x, hi, b}, {x, hi, f}, {-x, hi, f}},
        {{-x, lo, b}, {x, lo, b}, {x, hi, b}, {-x, hi, b}}, {{-x, lo, f}, {-x, lo, b}, {-x, hi, b}, {-x, hi, f}},
        {{x, lo, b}, {x, lo, f}, {x, hi, f}, {x, hi, b}},   {{-.5, l, -.075}, {.5, l, -.075}, {.5, l, .575}, {-.5, l, .575}}};
    for (int i = 0; i < 3; ++i) addQuad(i, q[i], .75f, .75f, .75f, 1);
    addQuad(3, q[3], .75f, .25f, .25f, 1);
    addQuad(4, q[4], .25f, .25f, .75f, 1);
    addQuad(5, q[5], 0, 0, 0, 0);
    const double c[2][3] = {{-.65, -.75, -.55}, {.73, -.80, .10}};
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 3; ++k) sc.c[i][k] = c[i][k];
    sc.r[0] = .5;
    sc.r[1] = .45;
    sc.group[12] = 2;
    sc.group[13] = 3;
    for (int k = 12; k < 14; ++k) sc.albR[k] = sc.albG[k] = sc.albB[k] = 1;
}

/// What float cannot decide: the nearest primitive of one ray, or -1.
[[gnu::noinline]] static int meetScalar(const double* o, const double* d, double tfar, int from, int to, double& tb) {
    ++amb;
    int id = -1;
    tb = tfar;
    for (int k = 0; k < kTri; ++k) {
        if (sc.plane[k] == from || sc.plane[k] == to) continue;
        const double* n = sc.nd[k];
        double den = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
        if (den == 0) continue;
        double t = (n[3] - n[0] * o[0] - n[1] * o[1] - n[2] * o[2]) / den;
        if (!(t > 0 && t < tb)) continue;
        double p[3], l2 = 0, u = 0, v = 0;
        for (int i = 0; i < 3; ++i) p[i] = o[i] + t * d[i] - sc.a[k][i];
        double a11 = 0, a12 = 0, a22 = 0, b1 = 0, b2 = 0;
        for (int i = 0; i < 3; ++i)
            a11 += sc.e1[k][i] * sc.e1[k][i], a12 += sc.e1[k][i] * sc.e2[k][i], a22 += sc.e2[k][i] * sc.e2[k][i],
                b1 += p[i] * sc.e1[k][i], b2 += p[i] * sc.e2[k][i];
        l2 = a11 * a22 - a12 * a12;
        u = (b1 * a22 - b2 * a12) / l2;
        v = (b2 * a11 - b1 * a12) / l2;
        if (u < -1e-12 || v < -1e-12 || u + v > 1 + 1e-12) continue;
        tb = t;
        id = k;
    }
    for (int k = 0; k < kBalls; ++k) {
        double oc[3], b = 0, aa = 0, cc = -sc.r[k] * sc.r[k];
        for (int i = 0; i < 3; ++i) oc[i] = o[i] - sc.c[k][i], b += oc[i] * d[i], cc += oc[i] * oc[i], aa += d[i] * d[i];
        double q = b * b - aa * cc;
        if (q <= 0) continue;
        double s = std::sqrt(q), t = (-b - s > 0 ? -b - s : -b + s) / aa;
        if (t > 0 && t < tb) tb = t, id = 12 + k;
    }
    return id;
}
typedef double D4 __attribute__((ext_vector_type(4)));
/// Plane of prim in double for W lanes: rows of 4 transposed.
INL void planes(I id, D& nx, D& ny, D& nz, D& pd, const double (*table)[4] = sc.nd) {
    for (int h = 0; h < W; h += 4) {
        D4 a = *(const D4*)table[id[h]], b = *(const D4*)table[id[h + 1]], c = *(const D4*)table[id[h + 2]],
           d = *(const D4*)table[id[h + 3]];
        D4 ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7),
           cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
        D4 r0 = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5), r1 = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5),
           r2 = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7), r3 = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
        for (int k = 0; k < 4; ++k) nx[h + k] = r0[k], ny[h + k] = r1[k], nz[h + k] = r2[k], pd[h + k] = r3[k];
    }
}
INL D toD(F f) { return __builtin_convertvector(f, D); }
INL F toF(D f) { return __builtin_convertvector(f, F); }
/// The ball's double test: t or 1e300.
INL D ballT(int b, D ox, D oy, D oz, D dx, D dy, D dz) {
    D x = ox - sc.c[b][0], y = oy - sc.c[b][1], z = oz - sc.c[b][2];
    D a = dx * dx + dy * dy + dz * dz, bq = x * dx + y * dy + z * dz,
      q = bq * bq - a * ((x * x + y * y + z * z) - sc.r[b] * sc.r[b]);
    D s = __builtin_elementwise_sqrt(q > 0 ? q : D(0)), ia = 1 / a, t0 = (-bq - s) * ia, t1 = (-bq + s) * ia,
      t = t0 > 0 ? t0 : t1;
    return (q > 0) & (t > 0) ? t : D(1e300);
}
static void meet(const Cols& r, int n, const Cols& h) {
    for (int k = 0; k < n; k += W) {
        const F ox = ld(r[OX] + k), oy = ld(r[OY] + k), oz = ld(r[OZ] + k), dx = ld(r[DX] + k), dy = ld(r[DY] + k),
                dz = ld(r[DZ] + k);
        const I from = ldi(r[FROM] + k);
        const F slack = (64 * 0x1p-24f) * (2 * sc.extent + ab(ox) + ab(oy) + ab(oz)), len = ab(dx) + ab(dy) + ab(dz);
        F lo = all(INFINITY), hi = all(INFINITY);
        I id = I(-1), am = I(0);
        for (int t = 0; t < kTri; ++t) {
            const F inv = 1.f / fma(F(sc.n[t][2]), dz, fma(F(sc.n[t][1]), dy, sc.n[t][0] * dx));
            const F hgt = sc.d[t] - fma(F(sc.n[t][2]), oz, fma(F(sc.n[t][1]), oy, sc.n[t][0] * ox));
            const F tt = hgt * inv, off = ab(inv) * slack, l = tt - off, u2 = tt + off;
            const F px = fma(tt, dx, ox), py = fma(tt, dy, oy), pz = fma(tt, dz, oz);
            const F u = fma(F(sc.u[t][2]), pz, fma(F(sc.u[t][1]), py, fma(F(sc.u[t][0]), px, F(sc.u0[t]))));
            const F v = fma(F(sc.v[t][2]), pz, fma(F(sc.v[t][1]), py, fma(F(sc.v[t][0]), px, F(sc.v0[t]))));
            const F room = off * len * sc.slope[t], least = mn(mn(u, v), 1 - (u + v)); // u+v>1+2room -> least < -2room
            const I maybe = ~((u2 < 0) | (l > hi) | (least < -(room + room))) & (from != sc.plane[t]);
            const I sure = (l > 0) & (least > room + room);
            const I closer = maybe & (u2 < lo);
            const I over = maybe & ~closer;
            am = closer ? ~sure : (am | over);
            lo = closer ? l : over ? mn(lo, l) : lo;
            hi = closer ? u2 : over ? mx(hi, u2) : hi;
            id = maybe & (closer | (id < 0)) ? I(t) : id;
        }
        const D Ox = toD(ox), Oy = toD(oy), Oz = toD(oz), Dx = toD(dx), Dy = toD(dy), Dz = toD(dz);
        D nx, ny, nz, pd;
        planes(id < 0 ? I(15) : id, nx, ny, nz, pd);
        D t = (pd - (nx * Ox + ny * Oy + nz * Oz)) / (nx * Dx + ny * Dy + nz * Dz);
        const L none = __builtin_convertvector(id < 0, L);
        t = none ? D(1e300) : t;
        for (int b = 0; b < kBalls; ++b) {
            const F x = ox - float(sc.c[b][0]), y = oy - float(sc.c[b][1]), z = oz - float(sc.c[b][2]),
                    r2 = all(float(sc.r[b] * sc.r[b]));
            const F bq = x * dx + y * dy + z * dz, cc = x * x + y * y + z * z - r2,
                    room = all(1e-4f) + 1e-4f * (x * x + y * y + z * z);
            if (!mask((bq * bq - cc > -room) & ((bq < 1e-4f) | (cc < room)))) continue;
            const D tb = ballT(b, Ox, Oy, Oz, Dx, Dy, Dz);
            const L nearer = tb < t;
            t = nearer ? tb : t;
            const I ni = __builtin_convertvector(nearer, I);
            id = ni ? I(12 + b) : id;
        }
        if (unsigned m = mask(am); __builtin_expect(m != 0, 0)) {
            for (; m; m &= m - 1) {
                int q = __builtin_ctz(m);
                double o[3] = {ox[q], oy[q], oz[q]}, d[3] = {dx[q], dy[q], dz[q]}, tb;
                id[q] = meetScalar(o, d, 1e300, from[q], -1, tb);
                t[q] = tb;
            }
        }
        st(h[HT] + k, toF(t));
        st(h[HX] + k, toF(fma(t, Dx, Ox)));
        st(h[HY] + k, toF(fma(t, Dy, Oy)));
        st(h[HZ] + k, toF(fma(t, Dz, Oz)));
        st(h[HPRIM] + k, id);
    }
}
/// Shadow rays; 0xffffffff: blocked.
static void occlude(const Cols& s, int n, uint32_t* open) {
    for (int k = 0; k < n; k += W) {
        const F ox = ld(s[SOX] + k), oy = ld(s[SOY] + k), oz = ld(s[SOZ] + k), dx = ld(s[SDX] + k), dy = ld(s[SDY] + k),
                dz = ld(s[SDZ] + k), far = ld(s[SFAR] + k);
        const I from = ldi(s[SFROM] + k), to = ldi(s[STO] + k);
        const F slack = (64 * 0x1p-24f) * (2 * sc.extent + ab(ox) + ab(oy) + ab(oz)), len = ab(dx) + ab(dy) + ab(dz);
        I am = I(0), blocked = I(0);
        for (int t = 0; t < kTri; ++t) {
            const F inv = 1.f / fma(F(sc.n[t][2]), dz, fma(F(sc.n[t][1]), dy, sc.n[t][0] * dx));
            const F hgt = sc.d[t] - fma(F(sc.n[t][2]), oz, fma(F(sc.n[t][1]), oy, sc.n[t][0] * ox));
            const F tt = hgt * inv, off = ab(inv) * slack, l = tt - off, u2 = tt + off;
            const I counts = ~((u2 < 0) | (l > far)) & (from != sc.plane[t]) & (to != sc.plane[t]), inside = (l > 0) & (u2 < far);
            if (!mask(counts)) continue; // walls behind and beyond: most
            const F px = fma(tt, dx, ox), py = fma(tt, dy, oy), pz = fma(tt, dz, oz);
            const F u = fma(F(sc.u[t][2]), pz, fma(F(sc.u[t][1]), py, fma(F(sc.u[t][0]), px, F(sc.u0[t]))));
            const F v = fma(F(sc.v[t][2]), pz, fma(F(sc.v[t][1]), py, fma(F(sc.v[t][0]), px, F(sc.v0[t]))));
            const F room = off * len * sc.slope[t], least = mn(mn(u, v), 1 - (u + v));
            const I maybe = counts & ~(least < -(room + room)), sure = inside & (least > room + room);
            blocked |= maybe & sure;
            am |= maybe & ~sure;
        }
        am &= ~blocked;
        for (int b = 0; b < kBalls; ++b) {
            const F x = ox - float(sc.c[b][0]), y = oy - float(sc.c[b][1]), z = oz - float(sc.c[b][2]),
                    r2 = all(float(sc.r[b] * sc.r[b]));
            const F bq = x * dx + y * dy + z * dz, cc = x * x + y * y + z * z - r2,
                    room = all(1e-4f) + 1e-4f * (x * x + y * y + z * z);
            if (!mask((bq * bq - cc > -room) & ((bq < 1e-4f) | (cc < room)))) continue;
            const D tb = ballT(b, toD(ox), toD(oy), toD(oz), toD(dx), toD(dy), toD(dz));
            blocked |= __builtin_convertvector(tb < toD(far), I);
        }
        if (unsigned m = mask(am & ~blocked); __builtin_expect(m != 0, 0))
            for (; m; m &= m - 1) {
                int q = __builtin_ctz(m);
                double o[3] = {ox[q], oy[q], oz[q]}, d[3] = {dx[q], dy[q], dz[q]}, tb;
                if (meetScalar(o, d, far[q], from[q], to[q], tb) >= 0) blocked[q] = -1;
            }
        __builtin_memcpy(open + k, &blocked, sizeof blocked);
    }
}

} // namespace alpenglow::bench::columns
