// Curves against de Casteljau, the distance of lines from densely sampled curves, tessellations and closed forms.
#include "accel/accel.h"
#include "curves_make.h"
#include "geometry/bernstein.h"
#include <gtest/gtest.h>

namespace curves_test {

TEST(Bernstein, RootsAreThoseOfTheFactors) {
    Rng rng(1);
    for (int turn = 0; turn < 3000; ++turn) {
        const int degree = 1 + int(rng() % 8);
        std::vector<double> inside, c{1 + uniform(rng)};
        for (int i = 0; i < degree; ++i) {
            const double r = i % 2 ? uniform(rng) : 2 * uniform(rng) - 0.5;
            if (r > 0 && r < 1) inside.push_back(r);
            std::vector<double> next(c.size() + 1); // times (x - r)
            const double line[2] = {-r, 1 - r};
            const int n = int(c.size()) - 1;
            for (int a = 0; a <= n; ++a)
                for (int b = 0; b < 2; ++b)
                    next[size_t(a + b)] += binomial(n, a) / binomial(n + 1, a + b) * c[size_t(a)] * line[b];
            c = next;
        }
        std::sort(inside.begin(), inside.end());
        bool apart = true;
        for (size_t i = 1; i < inside.size(); ++i) apart &= inside[i] - inside[i - 1] > 0.02;
        if (!apart) continue;
        double found[8];
        ASSERT_EQ(bernsteinRoots(c.data(), degree, found), int(inside.size())) << turn;
        for (size_t i = 0; i < inside.size(); ++i) ASSERT_NEAR(found[i], inside[i], 1e-9) << turn; // 1e-16 over products of 0.02
    }
}

TEST(Curves, FollowTheirBasisInEveryStepAndWrap) {
    Rng rng(2);
    for (const NamedBasis& b : bases())
        for (const auto& [periodic, segments] : {std::pair{false, size_t(1)}, {false, 4}, {true, 1}, {true, 2}, {true, 4}}) {
            const size_t step = size_t(b.step), n = periodic ? segments * step : 4 + (segments - 1) * step;
            if (n < 2) continue; // no curve
            const std::vector<Vec3d> p = randomPoints(rng, n);
            Diagnostics diag;
            const Matrix m = skewed();
            auto request = curves("cubic", {int(n)}, periodic ? "periodic" : "nonperiodic", flat(p));
            request->params.push_back(normals(Class::Constant, {0.1f, 0.2f, 1}));
            const ShapeRef s = build(request, m, diag, withBasis(b.m, b.step));
            ASSERT_TRUE(s) << b.name;
            EXPECT_EQ(diag.all().size(), 0u);
            for (int k = 0; k < 40; ++k) {
                const double v = uniform(rng), x = v * double(segments);
                const size_t i = size_t(x);
                const SurfacePoint q = s->evaluate(0, 0.5, v);
                const Vec3d at = transformPoint(m, byBasis(b, p, i * step, x - double(i))),
                            along = transformVector(m, byBasis(b, p, i * step, x - double(i), true) * double(segments));
                EXPECT_LT(length(Vec3d(q.P) - at), 2e-6) << b.name;
                EXPECT_LT(length(Vec3d(q.dPdv) - along), 1e-5 * (1 + length(along))) << b.name;
                EXPECT_FLOAT_EQ(q.v, float(v));
                EXPECT_FLOAT_EQ(q.t, float(v));
                EXPECT_FLOAT_EQ(q.s, 0.5f);
            }
        }
}

TEST(Curves, AreAsWideAsTheySay) {
    Rng rng(3);
    for (const char* type : {"linear", "cubic"}) {
        auto request = curves(type, {4}, "nonperiodic", {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0});
        request->params[1] =
            floats("width", Class::Varying,
                   std::string(type) == "linear" ? std::vector<float>{.2f, .4f, .6f, .8f} : std::vector<float>{.2f, .8f});
        request->params.push_back(normals(Class::Constant, {0, 0, 1}));
        Diagnostics diag;
        const Matrix m = scaleMatrix(1, 3, 1) * translateMatrix(0, 0, 5); // widths are lengths of object space
        const ShapeRef s = build(request, m, diag);
        ASSERT_TRUE(s);
        for (double v : {0.1, 0.4, 0.9}) {
            const SurfacePoint a = s->evaluate(0, 0, v), b = s->evaluate(0, 1, v);
            const double width = 0.2 + 0.6 * v;
            EXPECT_NEAR(std::fabs(a.P.y - b.P.y), 3 * width, 1e-6) << type;
            EXPECT_NEAR(a.P.x, b.P.x, 1e-6);
            EXPECT_NEAR(length(a.dPdu), 3 * width, 1e-6);
            EXPECT_NEAR(std::fabs(a.n.z), 1, 1e-6);
            EXPECT_GT(a.n.z, 0) << "N is where Ng looks";
        }
        EXPECT_NEAR(s->area(), 3 * 0.5 * 3, 1e-5); // three long, 0.5 wide on average, stretched
    }
}

TEST(Curves, RibbonsThatFaceTheRayAreMetWhereItPassesTheMiddle) {
    Rng rng(4);
    int met = 0, passed = 0;
    for (int turn = 0; turn < 150; ++turn) {
        const std::vector<Vec3d> p = randomPoints(rng, 4);
        const float width = 0.02f + 0.3f * float(uniform(rng));
        Diagnostics diag;
        const ShapeRef s = build(curves("cubic", {4}, "nonperiodic", flat(p), width), Matrix(), diag);
        ASSERT_TRUE(s);
        for (int k = 0; k < 20; ++k) {
            const Vec3d o = within(rng, 6), aim = casteljau(p, uniform(rng)) + within(rng, 0.7 * width),
                        d = (aim - o) * (0.1 + uniform(rng));
            const Nearest n = nearest(o, d, [&](double f) { return casteljau(p, f); });
            if (n.f < 1e-3 || n.f > 1 - 1e-3 || std::fabs(n.distance - width / 2) < 1e-7) continue;
            std::vector<std::pair<uint32_t, ExactHit>> hits;
            const int count = allHits(*s, o, d, hits);
            if (n.distance > width / 2) {
                ASSERT_EQ(count, 0) << turn << " " << k;
                ++passed;
                continue;
            }
            ++met;
            bool there = false;
            for (const auto& [prim, h] : hits) {
                const SurfacePoint q = s->evaluateHit(prim, h.u, h.v);
                // Turned in steps of 4e-7 of a circle, and rounded.
                EXPECT_LT(length(o + d * h.t - Vec3d(q.P)), 5e-7 * width + 2 * roundingError(q.P));
                EXPECT_GT(dot(Vec3d(q.n), -d), 0);
                there |= std::fabs(h.v - n.f) < 1e-6;
                const double across = (q.u - 0.5) * width;
                if (std::fabs(h.v - n.f) < 1e-6) EXPECT_NEAR(std::fabs(across), n.distance, 1e-6);
            }
            ASSERT_TRUE(there) << turn << " " << k;
        }
    }
    EXPECT_GT(met, 1000);
    EXPECT_GT(passed, 300);
}

TEST(Curves, FacingCurvesAreSeenFromAllSidesWhateverTheirOrientation) {
    Rng rng(5);
    for (bool inside : {false, true})
        for (const Matrix& m : {skewed(), scaleMatrix(-1, 1, 1) * skewed()})
            for (Facing facing : {Facing::Ray, Facing::Eye, Facing::Picture})
                for (const char* type : {"linear", "cubic"}) {
                    auto a = std::make_shared<scene::Attributes>();
                    a->sides = 1;
                    a->inside = inside;
                    Diagnostics diag;
                    const ShapeRef s = buildShape(curves(type, {4}, "nonperiodic", {-1, 0, 0, 0, 1, 0, 0, 0, 1, 1, -1, 0}, 0.4f),
                                                  a, m, -1, diag, facing);
                    ASSERT_TRUE(s);
                    int met = 0;
                    for (int k = 0; k < 50; ++k) {
                        SurfacePoint to = s->evaluate(0, 0.5, uniform(rng));
                        const Vec3d o = facing == Facing::Picture ? Vec3d(to.P) * Vec3d(1, 1, 0) : Vec3d(0.0),
                                    d = Vec3d(to.P) - o;
                        std::vector<std::pair<uint32_t, ExactHit>> hits;
                        allHits(*s, o, d, hits, 0);
                        for (const auto& [prim, h] : hits) {
                            const SurfacePoint q = s->evaluateHit(prim, h.u, h.v);
                            EXPECT_LT(dot(Vec3d(q.n), d), 0) << type;
                            EXPECT_LT(dot(Vec3d(q.Ng), d), 0) << type;
                            met += std::fabs(h.t - 1) < 1e-5;
                        }
                    }
                    EXPECT_GE(met, 45) << type; // the others end where the ribbon is seen edge-on
                }
}

TEST(Curves, RibbonsWithNormalsAgreeWithTheirTessellation) {
    Rng rng(6);
    int met = 0, missed = 0;
    for (int turn = 0; turn < 40; ++turn) {
        const bool linear = turn % 4 == 0;
        const std::vector<Vec3d> p = randomPoints(rng, 4);
        auto request = curves(linear ? "linear" : "cubic", {4}, "nonperiodic", flat(p), 0.4f);
        const size_t count = linear ? 4 : turn % 2 ? 2 : 4;
        request->params.push_back(normals(count == 2 ? Class::Varying : Class::Vertex, flat(randomPoints(rng, count))));
        Diagnostics diag;
        const ShapeRef s = build(request, skewed(), diag);
        ASSERT_TRUE(s);
        constexpr int kAlong = 3000;
        std::vector<Vec3d> side[2];
        for (int i = 0; i <= kAlong; ++i)
            for (int u = 0; u < 2; ++u) side[u].push_back(Vec3d(s->evaluate(0, u, double(i) / kAlong).P));
        for (int k = 0; k < 12; ++k) {
            const size_t at = rng() % kAlong;
            const Vec3d aim = side[0][at] + (side[1][at] - side[0][at]) * (1.3 * uniform(rng) - 0.15), o = aim + within(rng, 4),
                        d = aim - o;
            // Where the line goes through the strip, by its quads' halves.
            std::vector<double> expected;
            for (size_t i = 0; i < kAlong; ++i) {
                const Vec3 a(side[0][i]), b(side[1][i]), c(side[1][i + 1]), e(side[0][i + 1]);
                double t, b1, b2, off;
                for (const auto& [x, y, z] : {std::tuple(a, b, c), std::tuple(a, c, e)})
                    if (accel::intersectTriangle(Vec3(o), Vec3(d), x, y, z, t, b1, b2, off) && off == 0) expected.push_back(t);
            }
            std::vector<std::pair<uint32_t, ExactHit>> hits;
            allHits(*s, Vec3d(Vec3(o)), Vec3d(Vec3(d)), hits);
            for (const auto& [prim, h] : hits) {
                const SurfacePoint q = s->evaluateHit(prim, h.u, h.v);
                EXPECT_LT(length(Vec3d(Vec3(o)) + Vec3d(Vec3(d)) * h.t - Vec3d(q.P)), 2 * roundingError(q.P) + 1e-9);
            }
            // Triangles stray from the strip and from each other at rims: there the two may differ.
            if (expected.size() > 4) continue;
            for (double t : expected) {
                const bool found =
                    std::any_of(hits.begin(), hits.end(), [&](const auto& h) { return std::fabs(h.second.t - t) < 2e-3; });
                found ? ++met : ++missed;
            }
        }
    }
    EXPECT_GT(met, 200);
    EXPECT_LE(missed, met / 100);
}

TEST(Curves, PartialsAreThoseOfDifferences) {
    Rng rng(9);
    for (int kind = 0; kind < 3; ++kind) {
        auto request = curves(kind == 2 ? "linear" : "cubic", {7}, "nonperiodic", flat(randomPoints(rng, 7)));
        request->params[1] = floats("width", kind == 1 ? Class::Vertex : Class::Varying,
                                    kind == 0 ? std::vector<float>{.3f, .1f, .4f} : std::vector<float>(7, 0.3f));
        if (kind != 1)
            request->params.push_back(normals(kind == 0 ? Class::Vertex : Class::Constant,
                                              kind == 0 ? flat(randomPoints(rng, 7)) : std::vector<float>{.3f, 1, .2f}));
        Diagnostics diag;
        const ShapeRef s = build(request, skewed(), diag, kind == 1 ? round() : scene::Attributes());
        ASSERT_TRUE(s);
        for (int k = 0; k < 30; ++k) {
            const double u = 0.05 + 0.9 * uniform(rng), e = 1.0 / 64;
            double v = 0.02 + 0.96 * uniform(rng), x = v * (kind == 2 ? 6 : 2);
            if (x - std::floor(x) < 0.1 || x - std::floor(x) > 0.9) continue;
            const SurfacePoint q = s->evaluate(0, u, v);
            // Central differences of fourth order of float points: 1e-6 / e of rounding, and what is left of the fifth
            // derivative.
            const auto slope = [&](bool byU, double h) {
                const auto at = [&](double by) { return Vec3d(s->evaluate(0, byU ? u + by : u, byU ? v : v + by).P); };
                return (at(-2 * h) - at(2 * h) + (at(h) - at(-h)) * 8.0) / (12 * h);
            };
            EXPECT_LT(length(slope(true, e) - Vec3d(q.dPdu)), 3e-3 * length(q.dPdu) + 2e-4) << kind;
            EXPECT_LT(length(slope(false, e / 16) - Vec3d(q.dPdv)), 2e-2 * length(q.dPdv) + 2e-3) << kind;
            EXPECT_GT(dot(cross(q.dPdu, q.dPdv) * q.orientation, q.n), 0);
        }
    }
}

TEST(Curves, VariablesOfAllClasses) {
    auto request = curves("cubic", {7, 4}, "nonperiodic", std::vector<float>{0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0,
                                                                             0, 6, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0, 3, 1, 0});
    request->params.push_back(floats("whole", Class::Constant, {7}));
    request->params.push_back(floats("each", Class::Uniform, {10, 20}));
    request->params.push_back(floats("corner", Class::Varying, {0, 1, 4, 5, 7})); // 3 and 2: segments + 1
    request->params.push_back(floats("vertex", Class::Vertex, {0, 1, 2, 3, 4, 5, 6, 0, 0, 0, 8}));
    Diagnostics diag;
    const ShapeRef s = build(request, Matrix(), diag);
    ASSERT_TRUE(s);
    EXPECT_EQ(diag.all().size(), 0u);
    EXPECT_EQ(s->faces(), 2);
    const auto value = [&](const char* name, int face, double v, float* slope = nullptr) {
        const SurfacePoint p = s->evaluate(face, 0.3, v);
        float f, du, dv;
        s->interpolate(s->findPrimvar(name), p, &f, &du, &dv);
        EXPECT_EQ(du, 0);
        EXPECT_EQ(p.face, face);
        if (slope) *slope = dv;
        return f;
    };
    float slope;
    EXPECT_FLOAT_EQ(value("whole", 1, 0.5), 7);
    EXPECT_FLOAT_EQ(value("each", 0, 0.5), 10);
    EXPECT_FLOAT_EQ(value("each", 1, 0.5), 20);
    EXPECT_FLOAT_EQ(value("corner", 0, 0.25, &slope), 0.5f);
    EXPECT_FLOAT_EQ(slope, 2);
    EXPECT_FLOAT_EQ(value("corner", 0, 0.75, &slope), 2.5f);
    EXPECT_FLOAT_EQ(slope, 6);
    EXPECT_FLOAT_EQ(value("corner", 1, 0.5), 6);
    EXPECT_FLOAT_EQ(value("vertex", 0, 0.75, &slope), 4.5f); // even steps: linear
    EXPECT_FLOAT_EQ(slope, 6);
    EXPECT_FLOAT_EQ(value("vertex", 1, 0.5, &slope), 1); // 8 t^3
    EXPECT_FLOAT_EQ(slope, 6);
}

TEST(Curves, LinearOnesAreJoined) {
    // A zigzag: rays at the joints' insides and outsides, up to the mitre, meet it; two quads share the joint's edge.
    Diagnostics diag;
    const ShapeRef s = build(curves("linear", {3}, "nonperiodic", {-1, 0, 5, 0, 1, 5, 1, 0, 5}, 0.2f), Matrix(), diag);
    const double tip = 1 + 0.1 * std::sqrt(2.0); // half a width beyond, over the sine of half the angle
    for (double y = 0.9; y < 1.2; y += 0.003) {
        std::vector<std::pair<uint32_t, ExactHit>> hits;
        const bool met = allHits(*s, Vec3d(0, y, 0), Vec3d(0, 0, 1), hits) > 0;
        if (std::fabs(y - tip) > 1e-6) EXPECT_EQ(met, y < tip) << y;
    }
}

TEST(Curves, RaysThatLeaveAStraightRibbonDoNotMeetIt) {
    for (double scale : {1e-3, 1.0, 1e3}) {
        const Matrix m = rotateMatrix(37, 1, 1, 0.2) * scaleMatrix(scale, scale, scale) * translateMatrix(scale, 0, 3 * scale);
        Diagnostics diag;
        const ShapeRef s = build(curves("cubic", {4}, "nonperiodic", {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}, 0.1f), m, diag);
        accel::Accel accel({s}, {}, diag);
        Rng rng(10);
        int again = 0, met = 0;
        for (int i = 0; i < 5000; ++i) {
            accel::Ray r;
            r.dir = Vec3(Vec3d(s->evaluate(0, 0.5, uniform(rng)).P) + within(rng, 0.04 * scale));
            accel::Hit h;
            if (!accel.intersect(r, h)) continue;
            ++met;
            const SurfacePoint p = accel.point(h);
            r.dir = Vec3(within(rng, 1));
            if (dot(r.dir, p.n) < 0) r.dir = -r.dir;
            r.org = offsetOrigin(p, r.dir);
            again += accel.intersect(r, h);
        }
        EXPECT_GT(met, 2000);
        EXPECT_EQ(again, 0);
    }
}

TEST(Curves, DensityIsOneOverTheArea) {
    Rng rng(11);
    for (int kind = 0; kind < 3; ++kind) {
        auto request = curves("cubic", {7}, "nonperiodic", flat(randomPoints(rng, 7)), 0.05f);
        if (kind == 1) request->params.push_back(normals(Class::Constant, {0, 0, 1}));
        Diagnostics diag;
        const ShapeRef s = build(request, translateMatrix(0, 0, 5), diag, kind == 2 ? round() : scene::Attributes());
        double sum = 0;
        const int n = 20000;
        for (int i = 0; i < n; ++i) {
            SurfacePoint p;
            s->sampleFrom(Vec3(0, 0, 0), uniform(rng), uniform(rng), p);
            sum += 1 / s->sampleDensity(p);
        }
        EXPECT_NEAR(sum / n, s->area(), 0.02 * s->area()) << kind; // 20000 draws: below 1 % at a spread of 1
    }
}

TEST(Curves, WhatIsFaultyIsSaidAndTheRestDrawn) {
    const float nan = NAN;
    const std::vector<float> good{0, 0, 5, 1, 0, 5, 2, 0, 5, 3, 0, 5};
    const auto with = [&](std::vector<float> second) {
        std::vector<float> P = good;
        P.insert(P.end(), second.begin(), second.end());
        return curves("cubic", {4, 4}, "nonperiodic", P);
    };
    const auto drawn = [&](const std::shared_ptr<scene::Primitive>& p, size_t segments, const char* text) {
        Diagnostics diag;
        const ShapeRef s = build(p, Matrix(), diag);
        EXPECT_EQ(s ? s->exactPrims() > 0 : false, segments > 0) << text;
        bool said = false;
        for (const Diagnostic& d : diag.all()) said |= d.message.find(text) != std::string::npos;
        EXPECT_TRUE(said) << text;
        if (!s) return;
        std::vector<std::pair<uint32_t, ExactHit>> hits;
        EXPECT_GE(allHits(*s, Vec3d(1.1, 0, 0), Vec3d(0, 0, 1), hits), 1);
        const SurfacePoint q = s->evaluate(1, 0.5, 0.5);
        EXPECT_TRUE(std::isfinite(q.P.x + q.n.x));
    };
    drawn(with({0, 0, nan, 1, 0, 5, 2, 0, 5, 3, 0, 5}), 1, "1 curve with a number that is not finite");
    drawn(with({1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3}), 1, "1 curve whose points coincide");
    auto p = with(good);
    p->params[1] = floats("width", Class::Uniform, {0.1f, -1});
    drawn(p, 1, "negative widths count as 0");
    drawn(p, 1, "1 curve without a width");
    p->params[1] = floats("width", Class::Uniform, {0.1f});
    drawn(p, 1, "1 values given, 2 needed");
    drawn(curves("cubic", {4}, "nonperiodic", {0, 0, 0}), 0, "1 points given, 4 needed");
    drawn(curves("cubic", {2000000000, 2000000000}, "nonperiodic", good), 0, "4 points given");
    drawn(curves("cubic", {2}, "nonperiodic", good), 0, "with too few points");
}

} // namespace curves_test
