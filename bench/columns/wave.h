// The wavefront: rays of some thousand paths at a time through the stages, as the program's integrator does it
// (docs/architecture.md).
#pragma once
#include "base/hash.h"
#include "bench/columns/shading.h"

namespace alpenglow::bench::columns {

using mix64;

struct Wave {
    int slice, chunk, call, w, h, spp;
    Cols rays, next, hits, pts, shadow;
    std::vector<uint32_t> blocked;
    int n = 0, nn = 0, ns = 0;
    std::vector<float> low, high, index;
    std::vector<int> list[4];
    int count[4];
    std::vector<__int128> film;
    long first = 0;
    int made = 0, inCall = 0;
    void make() {
        rays.make(NRAY, slice);
        next.make(NRAY, slice);
        hits.make(NHIT, slice);
        pts.make(NPOINT, chunk);
        shadow.make(NSHADOW, slice);
        blocked.resize(size_t(slice) + 64);
        low.resize(size_t(call) + 64);
        high = index = low;
        for (auto& l : list) l.resize(size_t(slice) + 64);
        film.resize(size_t(w) * h * 4);
        acc.resize(size_t(call));
        accD.resize(size_t(call));
        for (int i = 0; i < NRAY; ++i) memset(rays[i], 0, size_t(rays.cap) * 4), memset(next[i], 0, size_t(next.cap) * 4);
        for (int i = 0; i < NPOINT; ++i) memset(pts[i], 0, size_t(pts.cap) * 4);
        for (int i = 0; i < NSHADOW; ++i) memset(shadow[i], 0, size_t(shadow.cap) * 4);
    }
    void generate() {
        const int m = std::min(slice - n, inCall - made);
        if (m <= 0) return;
        const struct {
            uint64_t key;
        } seed{mix64(0x6a09e667f3bcc909ull)};
        for (int i = 0; i < m; ++i) { // keys: two a pixel
            const long s = first + made + i;
            const int px = int(s / spp % w), py = int(s / spp / w), sn = int(s % spp);
            const uint64_t key = mix64(seed.key ^ ((uint64_t(uint32_t(px + (1 << 29)) & 0x3fffffffu) << 34 |
                                                    uint64_t(uint32_t(py + (1 << 29)) & 0x3fffffffu) << 4) |
                                                   unsigned(sn % 2)));
            uint32_t a = uint32_t(key), b = uint32_t(key >> 32), c = uint32_t(sn / 2);
            const int at = made + i;
            memcpy(&low[size_t(at)], &a, 4);
            memcpy(&high[size_t(at)], &b, 4);
            memcpy(&index[size_t(at)], &c, 4);
        }
        const float tn = float(std::tan(13.5 * M_PI / 180));
        for (int i = 0; i < m; i += W) {
            const int at = made + i;
            const Scrambles<U> s(streamWords<U>(ldu(&low[size_t(at)]), ldu(&high[size_t(at)]), U(0), U(1 << 1), U(0)));
            const U ix = s.shuffledIndex(reverseBits<U>(ldu(&index[size_t(at)])));
            const F ux = unitF(s.first(ix)), uy = unitF(s.second(ix));
            F px, py;
            for (int q = 0; q < W; ++q) {
                const long sm = (first + at + q) / spp;
                px[q] = float(sm % w);
                py[q] = float(sm / w);
            }
            const F x = ((px + ux) * (2.f / float(w)) - 1) * (tn * 4 / 3), y = (1 - (py + uy) * (2.f / float(h))) * tn,
                    il = 1 / sq(x * x + y * y + 1);
            const int k = n + i;
            st(rays[OX] + k, all(0));
            st(rays[OY] + k, all(0));
            st(rays[OZ] + k, all(7.2f));
            st(rays[DX] + k, x * il);
            st(rays[DY] + k, y * il);
            st(rays[DZ] + k, -il);
            for (int c = WR; c <= WB; ++c) st(rays[c] + k, all(1));
            st(rays[PDF] + k, all(-1));
            st(rays[PATH] + k, iota() + at);
            st(rays[VERTEX] + k, I(0));
            st(rays[BOUNCES] + k, I(0));
            st(rays[FROM] + k, I(-1));
            st(rays[WIDTH] + k, all(0));
            st(rays[SPREAD] + k, all(.001f));
            st(rays[KIND] + k, I(0));
            st(rays[BINDING] + k, I(-1));
            st(rays[EXTRA] + k, I(-1));
        }
        n += m;
        made += m;
    }
    void sort() {
        for (int& c : count) c = 0;
        for (int k = 0; k < n; k += W) {
            const I id = ldi(hits[HPRIM] + k), g = __builtin_bit_cast(I, gather((const float*)sc.group, id < 0 ? I(15) : id)),
                    in = iota() + k, ok = (id >= 0) & (in < n);
            for (int q = 0; q < 4; ++q) {
                const unsigned m = mask(ok & (g == q));
                put((float*)list[q].data() + count[q], in, m);
                count[q] += __builtin_popcount(m);
            }
        }
    }
    void settle(const Group& g, const int* idx, int m) {
        for (int k = 0; k < m; k += W) {
            I i;
            memcpy(&i, idx + k, sizeof i);
            i = (iota() + k < m) ? i : I(idx[m - 1]);
            const F x = gather(hits[HX], i), y = gather(hits[HY], i), z = gather(hits[HZ], i), t = gather(hits[HT], i);
            const I prim = __builtin_bit_cast(I, gather(hits[HPRIM], i));
            st(pts[PX] + k, x);
            st(pts[PY] + k, y);
            st(pts[PZ] + k, z);
            st(pts[PPRIM] + k, prim);
            if (g.ball) {
                const float r = float(1 / sc.r[g.shape]);
                st(pts[NX] + k, (x - float(sc.c[g.shape][0])) * r);
                st(pts[NY] + k, (y - float(sc.c[g.shape][1])) * r);
                st(pts[NZ] + k, (z - float(sc.c[g.shape][2])) * r);
                st(pts[PFROM] + k, I(-1));
            } else {
                st(pts[NX] + k, gather(sc.tabNx, prim));
                st(pts[NY] + k, gather(sc.tabNy, prim));
                st(pts[NZ] + k, gather(sc.tabNz, prim));
                st(pts[PFROM] + k, prim >> 1);
            }
            st(pts[IX] + k, gather(rays[DX], i));
            st(pts[IY] + k, gather(rays[DY], i));
            st(pts[IZ] + k, gather(rays[DZ], i));
            st(pts[PW] + k, gather(rays[WR], i));
            st(pts[PG] + k, gather(rays[WG], i));
            st(pts[PB] + k, gather(rays[WB], i));
            const I path = __builtin_bit_cast(I, gather(rays[PATH], i));
            st(pts[PPATH] + k, path);
            st(pts[PVERTEX] + k, gather(rays[VERTEX], i));
            st(pts[PBOUNCES] + k, gather(rays[BOUNCES], i));
            const F sp = gather(rays[SPREAD], i);
            st(pts[PSPREAD] + k, sp);
            st(pts[PWIDTH] + k, fma(sp, t, gather(rays[WIDTH], i)));
            st(pts[PKIND] + k, gather(rays[KIND], i));
            st(pts[PEXTRA] + k, gather(rays[EXTRA], i));
            st(pts[PPDF] + k, gather(rays[PDF], i));
            st(pts[LOW] + k, gather(low.data(), path));
            st(pts[HIGH] + k, gather(high.data(), path));
            st(pts[INDEX] + k, gather(index.data(), path));
        }
    }
    void shine(const int* idx, int m) {
        for (int k = 0; k < m; k += W) {
            I i;
            memcpy(&i, idx + k, sizeof i);
            i = (iota() + k < m) ? i : I(idx[m - 1]);
            const F dy = gather(rays[DY], i), pdf = gather(rays[PDF], i), t = gather(hits[HT], i);
            const F lp = t * t / (mx(ab(dy), all(1e-7f)) * kArea), r = lp / pdf, mis = pdf < 0 ? all(1) : 1 / (1 + r * r);
            const F l = dy > 0 ? 7 * mis : all(0), R = l * gather(rays[WR], i), G = l * gather(rays[WG], i),
                    B = l * gather(rays[WB], i);
            const I path = __builtin_bit_cast(I, gather(rays[PATH], i));
            for (int q = 0; q < W && k + q < m; ++q)
                if (l[q] > 0) deposit(path[q], R[q], G[q], B[q]);
        }
    }
    void choose(const Group& g, int m) {
        if (g.sites == 1) { // scale: what is reflected is at most what arrives
            g.lobe[0]->albedo(pts, 0, m, pts[SCALE]);
            for (int k = 0; k < m; k += W) {
                const F s = ld(pts[SCALE] + k) * mx(mx(ld(pts[KR] + k), ld(pts[KG] + k)), ld(pts[KB] + k));
                st(pts[SCALE] + k, s > 1 ? 1 / s : all(1));
                st(pts[CHOSEN] + k, all(1));
            }
            return;
        }
        g.lobe[0]->albedo(pts, 0, m, pts[SCALE]);
        g.lobe[1]->albedo(pts, 1, m, pts[CHOSEN]);
        for (int k = 0; k < m; k += W) {
            const F a0 = ld(pts[SCALE] + k), a1 = ld(pts[CHOSEN] + k);
            const F r = ld(pts[KR] + k) * a0 + ld(pts[K2R] + k) * a1, gg = ld(pts[KG] + k) * a0 + ld(pts[K2G] + k) * a1,
                    b = ld(pts[KB] + k) * a0 + ld(pts[K2B] + k) * a1, s = mx(r, mx(gg, b));
            const auto lum = [&](int c) {
                return .2126f * ld(pts[c] + k) + .7152f * ld(pts[c + 1] + k) + .0722f * ld(pts[c + 2] + k);
            };
            const F l0 = lum(KR) * a0, l1 = lum(K2R) * a1;
            st(pts[SCALE] + k, s > 1 ? 1 / s : all(1));
            st(pts[CHOSEN] + k, l0 / (l0 + l1));
        }
    }
    void connect(const Group& g, int m) {
        g.lobe[0]->value(pts, 0, m);
        for (int k = 0; k < m; k += W) {
            const F fc = ld(pts[FCOS] + k), drawn = ld(pts[LPDF] + k), r = ld(pts[FPDF] + k) / drawn,
                    f = fc / (drawn * (1 + r * r));
            const F R = ld(pts[PW] + k) * ld(pts[KR] + k) * ld(pts[CR] + k) * f,
                    G = ld(pts[PG] + k) * ld(pts[KG] + k) * ld(pts[CG] + k) * f,
                    B = ld(pts[PB] + k) * ld(pts[KB] + k) * ld(pts[CB] + k) * f;
            const unsigned go = mask((fc > 0) & (ld(pts[CR] + k) > 0) & (iota() + k < m)); // as send(): fcos, Cl above 0
            if (!go) continue;
            const F lx = ld(pts[LX] + k), ly = ld(pts[LY] + k), lz = ld(pts[LZ] + k);
            F ox, oy, oz, ex, ey, ez;
            offset(ld(pts[PX] + k), ld(pts[PY] + k), ld(pts[PZ] + k), ld(pts[NX] + k), ld(pts[NY] + k), ld(pts[NZ] + k), lx, ly,
                   lz, ox, oy, oz);
            offset(ld(pts[QX] + k), ld(pts[QY] + k), ld(pts[QZ] + k), all(0), all(-1), all(0), -lx, -ly, -lz, ex, ey, ez);
            const F x = ex - ox, y = ey - oy, z = ez - oz, d = sq(x * x + y * y + z * z), i = 1 / d;
            put(shadow[SOX] + ns, ox, go);
            put(shadow[SOY] + ns, oy, go);
            put(shadow[SOZ] + ns, oz, go);
            put(shadow[SDX] + ns, x * i, go);
            put(shadow[SDY] + ns, y * i, go);
            put(shadow[SDZ] + ns, z * i, go);
            put(shadow[SFAR] + ns, d * (1 - 1e-6f), go);
            put(shadow[SR] + ns, R, go);
            put(shadow[SG] + ns, G, go);
            put(shadow[SB] + ns, B, go);
            put(shadow[SPATH] + ns, ldi(pts[PPATH] + k), go);
            put(shadow[SFROM] + ns, ldi(pts[PFROM] + k), go);
            put(shadow[STO] + ns, I(5), go);
            ns += __builtin_popcount(go);
        }
    }
    void scatter(const Group& g, int m) {
        int lobeSites = g.sites;
        if (lobeSites == 2) { // which lobe: rows of the chosen go to site 0
            for (int k = 0; k < m; k += W) {
                const F c = ld(pts[CHOSEN] + k);
                const I a = ld(pts[TX] + k) < c;
                const F p = a ? c : 1 - c;
                for (int q = 0; q < 3; ++q)
                    st(pts[KR + q] + k, (a ? ld(pts[KR + q] + k) : ld(pts[K2R + q] + k)) / p),
                        st(pts[AX + q] + k, a ? ld(pts[AX + q] + k) : ld(pts[BX + q] + k));
            }
        }
        g.lobe[0]->sample(pts, 0, m);
        for (int k = 0; k < m; k += W) {
            const F sx = ld(pts[SX] + k), sy = ld(pts[SY] + k), sz = ld(pts[SZ] + k), scl = ld(pts[SCALE] + k);
            const I b = ldi(pts[PBOUNCES] + k);
            F R = ld(pts[PW] + k) * ld(pts[KR] + k) * (ld(pts[FR] + k) * scl),
              G = ld(pts[PG] + k) * ld(pts[KG] + k) * (ld(pts[FG] + k) * scl),
              B = ld(pts[PB] + k) * ld(pts[KB] + k) * (ld(pts[FB] + k) * scl);
            const F q0 = 1.5f * sq(mx(R, mx(G, B)));
            const F q = (b >= 3) & (q0 < 1) ? q0 : all(1);
            const unsigned go = mask((ld(pts[TY] + k) < q) & (q > 0) & (b < 32) & (iota() + k < m));
            if (!go) continue;
            const F iq = 1 / q;
            R *= iq;
            G *= iq;
            B *= iq;
            F ox, oy, oz;
            offset(ld(pts[PX] + k), ld(pts[PY] + k), ld(pts[PZ] + k), ld(pts[NX] + k), ld(pts[NY] + k), ld(pts[NZ] + k), sx, sy,
                   sz, ox, oy, oz);
            U v = ldu(pts[PVERTEX] + k);
            v = (v ^ 0x9e3779b9u) * 0x85ebca6bu;
            v ^= v >> 15;
            v *= 0x2c1b3c6du;
            v ^= v >> 13;
            v |= 1u;
            const Cols& t = next;
            const int at = nn;
            put(t[OX] + at, ox, go);
            put(t[OY] + at, oy, go);
            put(t[OZ] + at, oz, go);
            put(t[DX] + at, sx, go);
            put(t[DY] + at, sy, go);
            put(t[DZ] + at, sz, go);
            put(t[WR] + at, R, go);
            put(t[WG] + at, G, go);
            put(t[WB] + at, B, go);
            put(t[PDF] + at, ld(pts[FPDF] + k), go);
            put(t[PATH] + at, ldi(pts[PPATH] + k), go);
            put(t[VERTEX] + at, v, go);
            put(t[BOUNCES] + at, b + 1, go);
            put(t[FROM] + at, ldi(pts[PFROM] + k), go);
            put(t[WIDTH] + at, ld(pts[PWIDTH] + k), go);
            put(t[SPREAD] + at, ld(pts[PSPREAD] + k), go);
            put(t[KIND] + at, ldi(pts[PKIND] + k), go);
            put(t[BINDING] + at, ldi(pts[PPRIM] + k), go);
            put(t[EXTRA] + at, ldi(pts[PEXTRA] + k), go);
            nn += __builtin_popcount(go);
        }
    }
    void run() {
        const long total = long(w) * h * spp;
        for (first = 0; first < total; first += call) {
            inCall = int(std::min<long>(call, total - first));
            made = 0;
            n = 0;
            if (exactSums) std::fill(acc.begin(), acc.end(), Acc());
            else std::fill(accD.begin(), accD.end(), std::array<double, 3>{});
            for (;;) {
                tick();
                generate();
                tock(TGEN);
                if (n == 0) break;
                meet(rays, n, hits);
                tock(TMEET);
                columns::rays += uint64_t(n);
                sort();
                tock(TSORT);
                nn = ns = 0;
                shine(list[0].data(), count[0]);
                tock(TSHINE);
                for (int g = 1; g < 4; ++g)
                    for (int b = 0; b < count[g]; b += chunk) {
                        const int m = std::min(chunk, count[g] - b);
                        const Group& G = groups[g];
                        ++batches;
                        verts += uint64_t(m);
                        settle(G, list[g].data() + b, m);
                        tock(TSETTLE);
                        G.kernel(pts, m);
                        tock(TKERNEL);
                        choose(G, m);
                        tock(TCHOOSE);
                        if (!G.lobe[0]->delta) {
                            drawPairs(pts, m, 2, pts[U0], pts[U1]);
                            tock(TNUM);
                            light.sample(pts, m);
                            light.kernel(pts, m);
                            tock(TLIGHT);
                            connect(G, m);
                            tock(TCONNECT);
                            drawPairs(pts, m, 3, pts[U0], pts[U1]);
                        }
                        if (G.sites > 1) drawOnes(pts, m, 4, pts[TX]);
                        bool deep = false;
                        for (int k = 0; k < m && !deep; k += W) deep = mask(ldi(pts[PBOUNCES] + k) >= 3) != 0;
                        if (deep) drawOnes(pts, m, 5, pts[TY]);
                        else
                            for (int k = 0; k < m; k += W) st(pts[TY] + k, all(0));
                        tock(TNUM);
                        scatter(G, m);
                        tock(TSCATTER);
                    }
                occlude(shadow, ns, blocked.data());
                shadowsN += uint64_t(ns);
                tock(TOCCL);
                for (int k = 0; k < ns; ++k)
                    if (!blocked[size_t(k)]) {
                        int path;
                        memcpy(&path, shadow[SPATH] + k, 4);
                        deposit(path, shadow[SR][k], shadow[SG][k], shadow[SB][k]);
                    }
                tock(TDEP);
                std::swap(rays.row, next.row);
                n = nn;
            }
            bool sat = false;
            for (int i = 0; i < inCall; ++i) {
                float c[3];
                for (int q = 0; q < 3; ++q) c[q] = exactSums ? acc[size_t(i)].e[q].toFloat() : float(accD[size_t(i)][size_t(q)]);
                __int128* f = &film[size_t((first + i) / spp) * 4];
                for (int q = 0; q < 3; ++q) f[q] += toFixed<40>(c[q], &sat);
                f[3] += toFixed<40>(1, &sat);
            }
            tock(TFILM);
        }
    }
};

} // namespace alpenglow::bench::columns
