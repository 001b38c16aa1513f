// The oracle itself against the published figures of the box (docs/design/muttenzer-box.md: standard error below
// 0.0002, figures to four digits). Two-sided z at alpha 2e-6 is 4.753.
#include "nightly.h"
#include "oracle/box_oracle_embree.h"
#include <gtest/gtest.h>
#include <string_view>

namespace oracle_test {

using namespace oracle;

namespace {

struct Place {
    const char* name;
    V p, n, albedo, direct, empty, full;
    double seFull;
};
const Place kPlaces[] = {
    {"floor",
     {0, -1.25, .25},
     {0, 1, 0},
     {.75, .75, .75},
     {.1769, .1769, .1769},
     {.2415, .2164, .2416},
     {.2535, .2308, .2586},
     2e-4},
    {"far wall",
     {0, 0, -1.55},
     {0, 0, 1},
     {.75, .75, .75},
     {.1055, .1055, .1055},
     {.1846, .1592, .1847},
     {.1862, .1628, .1904},
     2e-4},
    {"red wall",
     {-1.48, 0, 0},
     {1, 0, 0},
     {.75, .25, .25},
     {.1434, .0478, .0478},
     {.2209, .0689, .0787},
     {.2258, .0694, .0792},
     2e-4},
    {"ceiling", {1, 1.19, .25}, {0, -1, 0}, {.75, .75, .75}, {0, 0, 0}, {.0805, .0640, .1079}, {.0881, .0725, .1180}, 2e-4},
    {"caustic",
     {.73, -1.25, .1},
     {0, 1, 0},
     {.75, .75, .75},
     {.1501, .1501, .1501},
     {.2093, .1912, .2286},
     {.4912, .4804, .5069},
     9e-4},
};

void compare(const char* what, V got, V se, V want, double wantSe) {
    for (int c = 0; c < 3; ++c) {
        double g = c == 0   ? got.x
                   : c == 1 ? got.y
                            : got.z,
               s = c == 0   ? se.x
                   : c == 1 ? se.y
                            : se.z,
               w = c == 0   ? want.x
                   : c == 1 ? want.y
                            : want.z;
        // The figures are rounded to 5e-5 on top of their standard error.
        double z = (std::fabs(g - w) - 5e-5) / std::sqrt(s * s + wantSe * wantSe);
        EXPECT_LT(z, 4.753) << what << " channel " << c << ": " << g << " +- " << s << ", reference " << w;
    }
}

TEST(Oracle, ListedPlaces) {
    for (const Place& p : kPlaces) {
        for (int kind = 0; kind < 3; ++kind) {
            // With spheres this point is where glass touches the floor: whether rays start in air or in glass is undecided there
            // (0.86 beside it, 0.38 when they start inside); docs/deviations.md.
            if (kind == 2 && std::string_view(p.name) == "caustic") continue;
            Box box;
            box.spheres = kind == 2;
            box.indirect = kind > 0;
            std::mt19937_64 rng(42 + kind);
            Mean m;
            const int n = (kind == 0 ? 200000 : 150000) / (alpenglow::nightly() ? 1 : 4);
            for (int i = 0; i < n; ++i) m.add(box.leaving(p.p, p.n, p.albedo, rng));
            compare(p.name, m.mean(), m.se(), kind == 0 ? p.direct : kind == 1 ? p.empty : p.full, kind == 2 ? p.seFull : 2e-4);
        }
    }
}

TEST(Oracle, FrameMeans) {
    const V want[3] = {{.0989, .0926, .0989}, {.1504, .1235, .1505}, {.1523, .1250, .1535}};
    for (int kind = 0; kind < 3; ++kind) {
        Box box;
        box.spheres = kind == 2;
        box.indirect = kind > 0;
        std::mt19937_64 rng(7 + kind);
        Mean m;
        for (int i = 0; i < 400000; ++i) {
            V o, d;
            Box::camera(640 * Box::u01(rng), 480 * Box::u01(rng), o, d);
            m.add(box.radiance(o, d, rng));
        }
        compare("frame", m.mean(), m.se(), want[kind], 2e-4);
    }
}

// From points of the room and of the inside of both spheres, in all directions. Embree meets in float: coordinates here are below
// 2, so t is off by some 1e-6 over the cosine; rays that pass an edge or a rim within that may meet its other side.
TEST(Oracle, EmbreeMeetsTheSame) {
    Analytic analytic;
    ThroughEmbree embree;
    std::mt19937_64 rng(11);
    auto u = [&](double lo, double hi) { return lo + (hi - lo) * Box::u01(rng); };
    int met = 0, inGlass = 0, different = 0;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
        V o{u(-1.47, 1.47), u(-1.24, 1.17), u(-1.54, 3)}, d = unit({u(-1, 1), u(-1, 1), u(-1, 1)});
        if (i % 4 == 0) o = V{.73, -.8, .1} + unit({u(-1, 1), u(-1, 1), u(-1, 1)}) * u(0, .44);
        Hit a, e;
        bool ma = analytic.meet(o, d, a), me = embree.meet(o, d, e);
        met += ma;
        inGlass += ma && a.m == Glass && dot(a.n, d) > 0;
        if (ma != me ||
            (ma && (a.m != e.m || std::fabs(a.t - e.t) * std::fabs(dot(a.n, d)) > 1e-5 || dot(a.n, e.n) < 1 - 1e-4))) {
            ++different;
            continue;
        }
        if (!ma || a.t < 1e-3) continue; // hides() through Embree stops 1e-4 short
        EXPECT_EQ(a.albedo.x, e.albedo.x);
        EXPECT_EQ(a.albedo.z, e.albedo.z);
        for (double distance : {.5 * a.t, 2 * a.t}) EXPECT_EQ(embree.hides(o, d, distance), analytic.hides(o, d, distance));
    }
    EXPECT_GT(met, n / 2);
    EXPECT_GT(inGlass, n / 5);
    EXPECT_LT(different, 5);
}

} // namespace

} // namespace oracle_test
