// Round curves: where rays meet them, that they are closed, their area.
#include "accel/accel.h"
#include "curves_make.h"
#include <gtest/gtest.h>

namespace curves_test {

TEST(Curves, TubesAreMetOnTheirCircles) {
    Rng rng(7);
    int met = 0, passed = 0;
    for (int turn = 0; turn < 60; ++turn) {
        const bool wide = turn % 3 == 0;
        const std::vector<Vec3d> p = {within(rng, 0.2) + Vec3d(-1, 0, 0), within(rng, 0.6), within(rng, 0.6),
                                      within(rng, 0.2) + Vec3d(1, 0, 0)};
        const double r = wide ? 0.08 : 0.01;
        Diagnostics diag;
        const ShapeRef s = build(curves("cubic", {4}, "nonperiodic", flat(p), float(2 * r)), Matrix(), diag, round());
        ASSERT_TRUE(s);
        std::vector<Vec3d> given;
        for (size_t i = 0; i < 4; ++i) given.push_back(Vec3d(Vec3(p[i])));
        for (int k = 0; k < 30; ++k) {
            const Vec3d o = within(rng, 6), aim = casteljau(given, 0.1 + 0.8 * uniform(rng)) + within(rng, 1.2 * r), d = aim - o;
            const Nearest n = nearest(o, d, [&](double f) { return casteljau(given, f); });
            const double radius = 0.5 * double(float(2 * r));
            if (n.f < 0.1 || n.f > 0.9 || std::fabs(n.distance - radius) < 1e-3 * radius) continue;
            std::vector<std::pair<uint32_t, ExactHit>> hits;
            const int count = allHits(*s, o, d, hits);
            ++(n.distance > radius ? passed : met);
            if (n.distance > radius) {
                ASSERT_EQ(count, 0);
                continue;
            }
            ASSERT_GE(count, 1) << turn << " " << k << " " << n.distance / radius;
            for (const auto& [prim, h] : hits) {
                if (h.v < -1 || h.v > 2) continue; // on a disc that closes it
                const Vec3d x = o + d * h.t, c = casteljau(given, h.v);
                EXPECT_NEAR(length(x - c), radius, 1e-9);
                const SurfacePoint q = s->evaluateHit(prim, h.u, h.v);
                EXPECT_LT(length(x - Vec3d(q.P)), 2 * roundingError(q.P) + 1e-9);
                EXPECT_GT(dot(Vec3d(q.n), x - c), 0.99 * radius);
            }
        }
    }
    EXPECT_GT(met, 600);
    EXPECT_GT(passed, 200);
}

TEST(Curves, NoRayLeavesAClosedTube) {
    for (const char* type : {"cubic", "linear"}) {
        Diagnostics diag;
        auto a = round();
        const scene::Attributes spline = withBasis(bases()[1].m, 1);
        a.vbasis = spline.vbasis;
        const ShapeRef s = build(curves(type, {12}, "periodic", ring(12, 1), 0.4f), skewed(), diag, a);
        ASSERT_TRUE(s);
        accel::Accel accel({s}, {}, diag);
        // The middle of the tube is the mean of two opposite points.
        Rng rng(8);
        const Vec3d inside = (Vec3d(s->evaluate(0, 0.1, 0.3).P) + Vec3d(s->evaluate(0, 0.6, 0.3).P)) * 0.5;
        int leaks = 0;
        for (int i = 0; i < 20'000; ++i) {
            accel::Ray r;
            r.org = Vec3(inside);
            r.dir = Vec3(within(rng, 1));
            accel::Hit h;
            leaks += !accel.intersect(r, h);
        }
        EXPECT_EQ(leaks, 0) << type;
    }
}

TEST(Curves, AreaOfATubeIsItsLengthTimesItsGirth) {
    Diagnostics diag;
    auto a = round();
    a.vbasis = withBasis(bases()[1].m, 1).vbasis;
    const ShapeRef s = build(curves("cubic", {12}, "periodic", ring(12, 1), 0.2f), Matrix(), diag, a);
    ASSERT_TRUE(s);
    std::vector<Vec3d> p;
    const std::vector<float> P = ring(12, 1);
    for (size_t i = 0; i < 12; ++i) p.push_back(Vec3d(P[3 * i], P[3 * i + 1], P[3 * i + 2]));
    double l = 0;
    for (size_t i = 0; i < 12; ++i)
        for (int k = 0; k < 1000; ++k) l += length(byBasis(bases()[1], p, i, (k + 0.5) / 1000, true)) / 1000;
    EXPECT_NEAR(s->area(), l * kPi * double(0.2f), 1e-5 * l); // Pappus: curvature does not matter
}

} // namespace curves_test
