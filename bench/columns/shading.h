// Random numbers, lobes, kernels of the three materials and the lamp, each a function from columns to columns.
#pragma once
#include "base/owen.h"
#include "bench/columns/box.h"

namespace alpenglow::bench::columns {

using Scrambles, reverseBits, streamWords;

static void drawPairs(const Cols& p, int n, uint32_t stream, float* x, float* y) {
    for (int k = 0; k < n; k += W) {
        const Scrambles<U> s(streamWords<U>(ldu(p[LOW] + k), ldu(p[HIGH] + k), ldu(p[PVERTEX] + k), U(stream << 1), U(0)));
        const U i = s.shuffledIndex(reverseBits<U>(ldu(p[INDEX] + k)));
        st(x + k, unitF(s.first(i)));
        st(y + k, unitF(s.second(i)));
    }
}
static void drawOnes(const Cols& p, int n, uint32_t stream, float* x) {
    for (int k = 0; k < n; k += W) {
        const Scrambles<U> s(streamWords<U>(ldu(p[LOW] + k), ldu(p[HIGH] + k), ldu(p[PVERTEX] + k), U(stream << 1 | 1), U(0)));
        st(x + k, unitF(s.first(s.shuffledIndex(reverseBits<U>(ldu(p[INDEX] + k))))));
    }
}
INL void unitCircle(F turns, F& c, F& s) {
    const F quarters = __builtin_convertvector(__builtin_convertvector(4 * turns + 0.5f, I), F);
    const I k = __builtin_convertvector(quarters, I);
    const F x = (turns - 0.25f * quarters) * float(2 * M_PI), q = x * x;
    const F ss = x * (1 - q * (1 / 6.f - q * (1 / 120.f - q * (1 / 5040.f - q * (1 / 362880.f))))),
            cc = 1 - q * (0.5f - q * (1 / 24.f - q * (1 / 720.f - q * (1 / 40320.f))));
    const I odd = (k & 1) != 0;
    const F a = odd ? ss : cc, b = odd ? cc : ss;
    c = ((k + 1) & 2) != 0 ? -a : a;
    s = (k & 2) != 0 ? -b : b;
}
// ---- tables: lobes, lights, kernels
struct Lobe {
    bool delta;
    void (*albedo)(const Cols&, int site, int n, float* out);
    void (*value)(const Cols&, int site, int n);
    void (*sample)(const Cols&, int site, int n);
};
static void diffuseAlbedo(const Cols&, int, int n, float* out) {
    for (int k = 0; k < n; k += W) st(out + k, all(1));
}
static void diffuseValue(const Cols& p, int site, int n) {
    const int a = site ? BX : AX;
    for (int k = 0; k < n; k += W) {
        const F c =
            mx(all(0), ld(p[LX] + k) * ld(p[a] + k) + ld(p[LY] + k) * ld(p[a + 1] + k) + ld(p[LZ] + k) * ld(p[a + 2] + k)) *
            float(1 / M_PI);
        st(p[FCOS] + k, c);
        st(p[FPDF] + k, c);
    }
}
static void diffuseSample(const Cols& p, int site, int n) { // U0, U1 -> direction, f/pdf, pdf
    const int a = site ? BX : AX;
    for (int k = 0; k < n; k += W) {
        const F u = ld(p[U0] + k), nx = ld(p[a] + k), ny = ld(p[a + 1] + k), nz = ld(p[a + 2] + k);
        F c, s;
        unitCircle(ld(p[U1] + k), c, s);
        const F r = sq(mx(all(0), 1 - u)), z = sq(u), x = r * c, y = r * s;
        const F sg = __builtin_bit_cast(F, (__builtin_bit_cast(I, nz) & INT32_MIN) | 0x3f800000), q = -1 / (sg + nz),
                b = nx * ny * q;
        st(p[SX] + k, x * (1 + sg * nx * nx * q) + y * b + nx * z);
        st(p[SY] + k, x * (sg * b) + y * (sg + ny * ny * q) + ny * z);
        st(p[SZ] + k, -x * (sg * nx) - y * ny + nz * z);
        st(p[FR] + k, all(1));
        st(p[FG] + k, all(1));
        st(p[FB] + k, all(1));
        st(p[FPDF] + k, z * float(1 / M_PI));
    }
}
static void deltaSample(const Cols& p, int site, int n) {
    const int a = site ? BX : AX;
    for (int k = 0; k < n; k += W) {
        st(p[SX] + k, ld(p[a] + k));
        st(p[SY] + k, ld(p[a + 1] + k));
        st(p[SZ] + k, ld(p[a + 2] + k));
        st(p[FR] + k, all(1));
        st(p[FG] + k, all(1));
        st(p[FB] + k, all(1));
        st(p[FPDF] + k, all(-1));
    }
}
static Lobe lobes[2] = {{false, diffuseAlbedo, diffuseValue, diffuseSample}, {true, diffuseAlbedo, nullptr, deltaSample}};
// kernels: fill the rows of their sites
static void kernelMatte(const Cols& p, int n) {
    for (int k = 0; k < n; k += W) {
        const F nx = ld(p[NX] + k), ny = ld(p[NY] + k), nz = ld(p[NZ] + k);
        const F il = 1 / sq(nx * nx + ny * ny + nz * nz); // normalize(N)
        const F x = nx * il, y = ny * il, z = nz * il;
        const F f = ld(p[IX] + k) * x + ld(p[IY] + k) * y + ld(p[IZ] + k) * z, s = f > 0 ? all(-1) : all(1);
        const I prim = ldi(p[PPRIM] + k);
        st(p[KR] + k, gather(sc.albR, prim));
        st(p[KG] + k, gather(sc.albG, prim));
        st(p[KB] + k, gather(sc.albB, prim));
        st(p[AX] + k, x * s);
        st(p[AY] + k, y * s);
        st(p[AZ] + k, z * s);
    }
}
static void kernelMirror(const Cols& p, int n) {
    for (int k = 0; k < n; k += W) {
        const F nx = ld(p[NX] + k), ny = ld(p[NY] + k), nz = ld(p[NZ] + k), ix = ld(p[IX] + k), iy = ld(p[IY] + k),
                iz = ld(p[IZ] + k);
        const F d = 2 * (ix * nx + iy * ny + iz * nz);
        for (int c = KR; c <= KB; ++c) st(p[c] + k, all(1));
        F rx = ix - d * nx, ry = iy - d * ny, rz = iz - d * nz;
        const F il = 1 / sq(rx * rx + ry * ry + rz * rz);
        st(p[AX] + k, rx * il);
        st(p[AY] + k, ry * il);
        st(p[AZ] + k, rz * il);
    }
}
static void kernelGlass(const Cols& p, int n) {
    for (int k = 0; k < n; k += W) {
        F nx = ld(p[NX] + k), ny = ld(p[NY] + k), nz = ld(p[NZ] + k);
        const F ix = ld(p[IX] + k), iy = ld(p[IY] + k), iz = ld(p[IZ] + k);
        F d = ix * nx + iy * ny + iz * nz;
        const I in = d > 0;
        const F s = in ? all(-1) : all(1);
        nx *= s;
        ny *= s;
        nz *= s;
        const F eta = in ? all(1.5f) : all(1 / 1.5f), c = ab(d), kk = 1 - eta * eta * (1 - c * c), ct = sq(mx(kk, all(0)));
        const F rs = (eta * c - ct) / (eta * c + ct), rp = (eta * ct - c) / (eta * ct + c);
        const F f = kk > 0 ? .5f * (rs * rs + rp * rp) : all(1);
        F rx = ix + 2 * c * nx, ry = iy + 2 * c * ny, rz = iz + 2 * c * nz;
        F il = 1 / sq(rx * rx + ry * ry + rz * rz);
        for (int q = KR; q <= KB; ++q) st(p[q] + k, f), st(p[q - KR + K2R] + k, 1 - f);
        st(p[AX] + k, rx * il);
        st(p[AY] + k, ry * il);
        st(p[AZ] + k, rz * il);
        const F m = eta * c - ct;
        rx = ix * eta + nx * m;
        ry = iy * eta + ny * m;
        rz = iz * eta + nz * m;
        il = 1 / sq(mx(rx * rx + ry * ry + rz * rz, all(1e-20f)));
        st(p[BX] + k, rx * il);
        st(p[BY] + k, ry * il);
        st(p[BZ] + k, rz * il);
    }
}
struct Group {
    void (*kernel)(const Cols&, int n);
    int sites;
    const Lobe* lobe[2];
    bool ball;
    int shape;
};
static Group groups[4] = {{nullptr, 0, {}, false, 0},
                          {kernelMatte, 1, {&lobes[0]}, false, 0},
                          {kernelMirror, 1, {&lobes[1]}, true, 0},
                          {kernelGlass, 2, {&lobes[1], &lobes[1]}, true, 1}};
struct Light {
    void (*sample)(const Cols&, int n);
    void (*kernel)(const Cols&, int n);
};
constexpr float kArea = .65f;
static void rectSample(const Cols& p, int n) {
    for (int k = 0; k < n; k += W) {
        const F qx = ld(p[U0] + k) - .5f, qy = all(1.18f), qz = .25f + .65f * (ld(p[U1] + k) - .5f);
        const F x = qx - ld(p[PX] + k), y = qy - ld(p[PY] + k), z = qz - ld(p[PZ] + k), d2 = x * x + y * y + z * z, d = sq(d2),
                i = 1 / d;
        st(p[QX] + k, qx);
        st(p[QY] + k, qy);
        st(p[QZ] + k, qz);
        st(p[LX] + k, x * i);
        st(p[LY] + k, y * i);
        st(p[LZ] + k, z * i);
        st(p[LDIST] + k, d);
        st(p[LPDF] + k, d2 / (ab(y * i) * kArea));
    }
}
static void rectKernel(const Cols& p, int n) { // illuminate(P, N, PI/2) Cl = intensity
    for (int k = 0; k < n; k += W) {
        const F c = ld(p[LY] + k) > 0 ? all(7) : all(0);
        st(p[CR] + k, c);
        st(p[CG] + k, c);
        st(p[CB] + k, c);
    }
}
static Light light = {rectSample, rectKernel};
INL F away(F x, F by) { // one float away, in the direction of `by`
    const I bits = __builtin_bit_cast(I, x), dir = __builtin_bit_cast(I, by);
    I moved = bits + (((bits ^ dir) >> 31) | 1);
    moved = (x == 0) ? ((dir & INT32_MIN) | 1) : moved;
    return __builtin_bit_cast(F, (by != 0) & (ab(x) < INFINITY) ? moved : bits);
}
INL void offset(F px, F py, F pz, F nx, F ny, F nz, F dx, F dy, F dz, F& ox, F& oy, F& oz) {
    const F err = 1.1920929e-7f * (ab(px) + ab(py) + ab(pz)) + 1e-37f, d = dx * nx + dy * ny + dz * nz >= 0 ? 2 * err : -2 * err;
    const F x = nx * d, y = ny * d, z = nz * d;
    ox = away(px + x, x);
    oy = away(py + y, y);
    oz = away(pz + z, z);
}

} // namespace alpenglow::bench::columns
