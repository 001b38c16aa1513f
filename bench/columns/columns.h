// Columns: a row of floats for each number of a ray, of what it met, of a shaded point and of a shadow ray; the clock of the
// stages; sums of light by path.
#pragma once
#include "base/exactsum.h"
#include "bench/columns/lanes.h"
#include <array>
#include <cstdlib>
#include <vector>

namespace alpenglow::bench::columns {

// Rows of rays, of what they meet, of shadow rays and of points.
struct Cols {
    std::vector<float*> row;
    int cap = 0;
    void make(int rows, int n) {
        cap = n + 64;
        for (int i = 0; i < rows; ++i) row.push_back((float*)aligned_alloc(64, (size_t(cap) * 4 + 63 + (i % 16) * 64) / 64 * 64));
    }
    float* operator[](int i) const { return row[size_t(i)]; }
};
enum { OX, OY, OZ, DX, DY, DZ, WR, WG, WB, PDF, PATH, VERTEX, BOUNCES, FROM, WIDTH, SPREAD, KIND, BINDING, EXTRA, NRAY };
enum { HT, HX, HY, HZ, HPRIM, NHIT };
enum { SOX, SOY, SOZ, SDX, SDY, SDZ, SFAR, SR, SG, SB, SPATH, SFROM, STO, NSHADOW };
enum {
    PX,
    PY,
    PZ,
    NX,
    NY,
    NZ,
    IX,
    IY,
    IZ,
    PW,
    PG,
    PB,
    PPATH,
    PVERTEX,
    PBOUNCES,
    PPRIM,
    PWIDTH,
    PSPREAD,
    PKIND,
    PEXTRA,
    LOW,
    HIGH,
    INDEX,
    PFROM,
    PPDF,
    POX,
    POY,
    POZ,
    KR,
    KG,
    KB,
    AX,
    AY,
    AZ, // request of site 0: weight, arguments
    K2R,
    K2G,
    K2B,
    BX,
    BY,
    BZ, // site 1
    CHOSEN,
    SCALE,
    U0,
    U1,
    QX,
    QY,
    QZ,
    LX,
    LY,
    LZ,
    LDIST,
    LPDF,
    CR,
    CG,
    CB,
    FCOS,
    FPDF,
    SX,
    SY,
    SZ,
    FR,
    FG,
    FB,
    TX,
    TY,
    TZ,
    NPOINT
};

// Clock ticks by stage, and what was counted.
enum { TGEN, TMEET, TSORT, TSETTLE, TKERNEL, TCHOOSE, TNUM, TLIGHT, TCONNECT, TOCCL, TDEP, TSCATTER, TSHINE, TFILM, NT };
static const char* tname[NT] = {"generate", "meet",    "sort by group", "settle",  "kernel",  "choose", "numbers",
                                "light",    "connect", "occlude",       "deposit", "scatter", "shine",  "film"};
static uint64_t tt[NT], tlast;
static uint64_t rays, shadowsN, verts, amb, batches;
INL void tick() { tlast = __rdtsc(); }
INL void tock(int s) {
    uint64_t n = __rdtsc();
    tt[s] += n - tlast;
    tlast = n;
}

static bool exactSums = true;
struct Acc {
    ExactSum e[3];
};
static std::vector<Acc> acc;
static std::vector<std::array<double, 3>> accD;
INL void deposit(int path, float r, float g, float b) {
    if (exactSums) {
        Acc& a = acc[size_t(path)];
        if (r != 0) a.e[0].add(r);
        if (g != 0) a.e[1].add(g);
        if (b != 0) a.e[2].add(b);
    } else {
        auto& a = accD[size_t(path)];
        a[0] += r;
        a[1] += g;
        a[2] += b;
    }
}

} // namespace alpenglow::bench::columns
