// Trim curves and NURBS of high order against closed forms and against slow, independent evaluation.
#include "base/limits.h"
#include "geometry/trim.h"
#include "make.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace trim_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;

namespace {

using scene::Class;
using scene::Type;

/// One loop of TrimCurve, homogeneous.
struct Curve {
    int order;
    std::vector<float> knot, u, v, w;
};

scene::ParamList trimList(const std::vector<std::vector<Curve>>& loops) {
    std::vector<float> ncurves, order, knot, min, max, n, u, v, w;
    for (auto& loop : loops) {
        ncurves.push_back(float(loop.size()));
        for (auto& c : loop) {
            order.push_back(float(c.order));
            knot.insert(knot.end(), c.knot.begin(), c.knot.end());
            min.push_back(c.knot[size_t(c.order) - 1]);
            max.push_back(c.knot[c.u.size()]);
            n.push_back(float(c.u.size()));
            u.insert(u.end(), c.u.begin(), c.u.end());
            v.insert(v.end(), c.v.begin(), c.v.end());
            w.insert(w.end(), c.w.begin(), c.w.end());
        }
    }
    auto p = [](const char* name, std::vector<float> x) { return param(name, Class::Constant, Type::Float, std::move(x)); };
    return {p("ncurves", ncurves),
            p("order", order),
            p("knot", knot),
            p("min", min),
            p("max", max),
            p("n", n),
            p("u", u),
            p("v", v),
            p("w", w)};
}

/// A circle as four rational quadratics. Of sqrt(1/2) only its float is known to the curve; radius() knows by how much that moves
/// it.
Curve circle(double cu, double cv, double r) {
    Curve c{3, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, {}, {}, {}};
    const double x[9] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[9] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
    for (int i = 0; i < 9; ++i) {
        const double w = i % 2 ? std::sqrt(0.5) : 1;
        c.u.push_back(float((cu + r * x[i]) * w));
        c.v.push_back(float((cv + r * y[i]) * w));
        c.w.push_back(float(w));
    }
    return c;
}
constexpr double kFloat = 4e-7; // what rounding the control points to float moves a curve of this size

Curve lines(std::vector<float> u, std::vector<float> v) {
    Curve c{2, {0}, std::move(u), std::move(v), {}};
    for (size_t i = 0; i < c.u.size(); ++i) c.knot.push_back(float(i)), c.w.push_back(1);
    c.knot.push_back(float(c.u.size() - 1));
    return c;
}

constexpr TrimRegion::Domain kUnit{{0, 0}, {1, 1}};

std::shared_ptr<const TrimRegion> region(const std::vector<std::vector<Curve>>& loops, bool keepInside,
                                         TrimRegion::Domain d = kUnit) {
    std::string why;
    double gap;
    auto r = TrimRegion::make(trimList(loops), d, keepInside, why, gap);
    EXPECT_TRUE(r) << why;
    return r;
}

/// By definition: Cox and de Boor's recursion.
double basis(const std::vector<float>& t, int i, int order, double x, size_t points) {
    auto at = [&](int k) { return double(t[size_t(k)]); };
    if (order == 1) {
        const bool last = x == at(int(points)) && at(i + 1) == x && at(i) < x;
        return (at(i) <= x && x < at(i + 1)) || last;
    }
    double s = 0;
    if (at(i + order - 1) > at(i)) s += (x - at(i)) / (at(i + order - 1) - at(i)) * basis(t, i, order - 1, x, points);
    if (at(i + order) > at(i + 1)) s += (at(i + order) - x) / (at(i + order) - at(i + 1)) * basis(t, i + 1, order - 1, x, points);
    return s;
}

std::shared_ptr<scene::Primitive> sheet(float size) { // u, v over [0, 1] on a square of this size about the axis, at z = 5
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "NuPatch";
    p->ints = {2, 2, 2, 2};
    p->numbers = {0, 1, 0, 1};
    const float a = size / 2;
    p->params = {param("uknot", Class::Constant, Type::Float, {0, 0, 1, 1}),
                 param("vknot", Class::Constant, Type::Float, {0, 0, 1, 1}), points({-a, -a, 5, a, -a, 5, -a, a, 5, a, a, 5})};
    return p;
}

scene::Attributes trimmed(const std::vector<std::vector<Curve>>& loops, const char* sense = nullptr) {
    scene::Attributes a;
    a.trimCurve = std::make_shared<scene::ParamList>(trimList(loops));
    if (sense) {
        scene::Param p = param("sense", Class::Constant, Type::String, {});
        p.strings = {sense};
        a.values["trimcurve:sense"] = p;
    }
    return a;
}

} // namespace

TEST(Trim, ACircleIsRound) {
    auto r = region({{circle(0.5, 0.5, 0.25)}}, true);
    EXPECT_NEAR(r->area(), kPi / 16, 2 * kPi * 0.25 * kFloat);
    std::mt19937 rng(3);
    auto random = [&] { return double(rng()) / 4294967296.0; };
    for (int i = 0; i < 100000; ++i) {
        const double u = random(), v = random(), d = std::hypot(u - 0.5, v - 0.5) - 0.25;
        if (std::fabs(d) > kFloat) ASSERT_EQ(r->keeps(u, v), d < 0) << u << " " << v;
    }
    for (int i = 0; i < 100000; ++i) { // close to the curve
        const double a = 2 * kPi * random(), e = (random() < 0.5 ? -1 : 1) * (kFloat + 1e-5 * random() * random());
        ASSERT_EQ(r->keeps(0.5 + (0.25 + e) * std::cos(a), 0.5 + (0.25 + e) * std::sin(a)), e < 0) << a << " " << e;
    }
}

TEST(Trim, InsideIsWhatIsLeftThroughAnOddNumberOfCurves) {
    // A ring with an island, drawn in either direction; and two overlapping squares, whose common part is outside.
    auto back = circle(0.5, 0.5, 0.2);
    std::reverse(back.u.begin(), back.u.end());
    std::reverse(back.v.begin(), back.v.end());
    auto r = region({{circle(0.5, 0.5, 0.4)}, {back}, {circle(0.5, 0.5, 0.1)}}, true);
    EXPECT_TRUE(r->keeps(0.5, 0.5));
    EXPECT_FALSE(r->keeps(0.65, 0.5));
    EXPECT_TRUE(r->keeps(0.8, 0.5));
    EXPECT_FALSE(r->keeps(0.95, 0.5));
    EXPECT_NEAR(r->area(), kPi * (0.16 - 0.04 + 0.01), 2 * kPi * 0.7 * kFloat);
    auto removed = region({{circle(0.5, 0.5, 0.4)}, {back}, {circle(0.5, 0.5, 0.1)}}, false);
    EXPECT_NEAR(removed->area() + r->area(), 1, 1e-12);
    auto two = region({{lines({.1f, .6f, .6f, .1f, .1f}, {.1f, .1f, .6f, .6f, .1f})},
                       {lines({.4f, .9f, .9f, .4f, .4f}, {.4f, .4f, .9f, .9f, .4f})}},
                      true);
    EXPECT_FALSE(two->keeps(0.5, 0.5));
    EXPECT_NEAR(two->area(), 2 * 0.25 - 2 * 0.04, 1e-6);
}

TEST(Trim, CurvesAreThoseOfTheirDefinition) {
    // Loops of any order over uneven and repeated knots, partly outside of the patch, against a polygon of 4,000 points of the
    // recursion.
    std::mt19937 rng(11);
    auto random = [&] { return double(rng()) / 4294967296.0; };
    for (int scene = 0; scene < 12; ++scene) {
        const int order = 2 + scene % 6, n = order + 1 + int(rng() % 6);
        Curve c{order, {}, {}, {}, {}};
        float t = 0;
        for (int i = 0; i < n + order; ++i)
            c.knot.push_back(t += (i < order || i >= n) ? (i == n ? 1.f : 0.f) : float(rng() % 3 == 0 ? 0 : 0.2 + random()));
        for (int i = 0; i < n; ++i) {
            const float w = float(0.3 + random());
            c.u.push_back(float(1.6 * random() - 0.3) * w);
            c.v.push_back(float(1.6 * random() - 0.3) * w);
            c.w.push_back(w);
        }
        auto r = region({{c}}, true);
        ASSERT_TRUE(r);
        std::vector<std::pair<double, double>> polygon;
        const double lo = c.knot[size_t(order) - 1], hi = c.knot[size_t(n)];
        for (int k = 0; k <= 4000; ++k) {
            const double x = lo + (hi - lo) * k / 4000.0;
            double u = 0, v = 0, w = 0;
            for (int i = 0; i < n; ++i) {
                const double b = basis(c.knot, i, order, x, size_t(n));
                u += b * c.u[size_t(i)], v += b * c.v[size_t(i)], w += b * c.w[size_t(i)];
            }
            if (w > 0) polygon.push_back({u / w, v / w});
        }
        int asked = 0;
        for (int k = 0; k < 200; ++k) {
            const double u = random(), v = random();
            bool in = false;
            double nearest = 1;
            for (size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
                const auto [ax, ay] = polygon[i];
                const auto [bx, by] = polygon[j];
                // Distance to the segment that closes the loop too.
                const double dx = bx - ax, dy = by - ay, l = dx * dx + dy * dy;
                const double f = l > 0 ? std::clamp(((u - ax) * dx + (v - ay) * dy) / l, 0.0, 1.0) : 0;
                nearest = std::min(nearest, std::hypot(ax + f * dx - u, ay + f * dy - v));
                if ((ay > v) != (by > v) && u < ax + (v - ay) / (by - ay) * (bx - ax)) in = !in;
            }
            if (nearest < 1e-4) continue;
            ++asked;
            ASSERT_EQ(r->keeps(u, v), in) << "scene " << scene << " at " << u << " " << v << ", " << nearest << " off";
        }
        EXPECT_GT(asked, 150);
    }
}

TEST(Trim, SamplesAreKeptAndDenseAsTheySay) {
    // Integrals over what is kept by samples of the region, against closed forms: area and second moments of a ring.
    auto r = region({{circle(0.45, 0.55, 0.4)}, {circle(0.45, 0.55, 0.3)}}, true);
    double one = 0, uu = 0, vv = 0;
    constexpr int kSide = 400;
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
            double u, v;
            ASSERT_TRUE(r->sample((j + 0.5) / kSide, (i + 0.5) / kSide, u, v) || true);
            const double d = r->density(v);
            if (!(d > 0)) continue;
            EXPECT_TRUE(r->keeps(u, v) || std::fabs(std::hypot(u - 0.45, v - 0.55) - 0.3) < 1e-6 ||
                        std::fabs(std::hypot(u - 0.45, v - 0.55) - 0.4) < 1e-6);
            one += 1 / d;
            uu += (u - 0.45) * (u - 0.45) / d;
            vv += (v - 0.55) * (v - 0.55) / d;
        }
    const double n = double(kSide) * kSide, area = kPi * (0.16 - 0.09), moment = kPi / 4 * (std::pow(0.4, 4) - std::pow(0.3, 4));
    // Midpoints of a square of 400 lines: the error of one line in 400, of integrands with edges.
    EXPECT_NEAR(one / n, area, area / kSide);
    EXPECT_NEAR(uu / n, moment, moment / kSide);
    EXPECT_NEAR(vv / n, moment, moment / kSide);
}

TEST(Trim, AHitOutsideIsNone) {
    Diagnostics diag;
    ShapeRef s = build(sheet(2), Matrix(), diag, trimmed({{circle(0.5, 0.5, 0.4)}}, "outside"));
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->area(), kPi * 0.64, 1e-5);
    s->dice({}, diag);
    ASSERT_TRUE(s->trimmed());
    // Every triangle of the mesh, many of its points: kept where the disk is.
    size_t kept = 0, cut = 0;
    for (uint32_t t = 0; t < s->mesh().triangles(); ++t)
        for (int j = 0; j <= 40; ++j)
            for (int i = 0; i + j <= 40; ++i) {
                const double b1 = i / 40.0, b2 = j / 40.0;
                const SurfacePoint p = s->evaluateHit(t, b1, b2);
                const double d = std::hypot(double(p.P.x), double(p.P.y)) - 0.8;
                if (std::fabs(d) < 2e-6) continue;
                ASSERT_EQ(s->keepsHit(t, b1, b2), d < 0) << p.P.x << " " << p.P.y;
                ++(d < 0 ? kept : cut);
            }
    EXPECT_GT(kept, 0u);
    EXPECT_GT(cut, 0u);
    EXPECT_EQ(diag.errors() + diag.warnings(), 0);
}

TEST(Trim, DefaultCutsTheInsideAwayAndAnEmptyRestIsSaid) {
    Diagnostics diag;
    ShapeRef s = build(sheet(2), Matrix(), diag, trimmed({{circle(0.5, 0.5, 0.4)}}));
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->area(), 4 - kPi * 0.64, 1e-5);
    // A loop around the whole patch, as exporters write it whose sense is the other one.
    auto around = lines({-1, 2, 2, -1, -1}, {-1, -1, 2, 2, -1});
    EXPECT_FALSE(build(sheet(2), Matrix(), diag, trimmed({{around}})));
    EXPECT_EQ(diag.warnings(), 1);
    EXPECT_NE(diag.all().back().hint.find("\"outside\""), std::string::npos);
    EXPECT_NEAR(build(sheet(2), Matrix(), diag, trimmed({{around}}, "outside"))->area(), 4, 1e-6);
}

TEST(Trim, FaultyCurvesAreSaid) {
    auto faults = [](const scene::Attributes& a) {
        Diagnostics diag;
        ShapeRef s = build(sheet(2), Matrix(), diag, a);
        EXPECT_TRUE(s);
        return std::make_pair(diag.errors(), diag.warnings());
    };
    auto bad = circle(0.5, 0.5, 0.4);
    bad.w[3] = -1;
    EXPECT_EQ(faults(trimmed({{bad}})).first, 1);
    bad = circle(0.5, 0.5, 0.4);
    bad.u[2] = NAN;
    EXPECT_EQ(faults(trimmed({{bad}})).first, 1);
    bad = circle(0.5, 0.5, 0.4);
    bad.knot[5] = 0;
    EXPECT_EQ(faults(trimmed({{bad}})).first, 1);
    EXPECT_EQ(faults(trimmed({{circle(0.5, 0.5, 0.4)}}, "left")).first, 1);
    EXPECT_EQ(faults(trimmed({{lines({.2f, .8f, .8f}, {.2f, .2f, .8f})}})).second, 1); // open: a line closes it
    EXPECT_EQ(faults(trimmed({{circle(0.5, 0.5, 0.4)}})), std::make_pair(0, 0));
}

TEST(NuPatch, AnyOrderAndAnyKnots) {
    std::mt19937 rng(7);
    auto random = [&] { return float(rng() / 4294967296.0); };
    for (int scene = 0; scene < 24; ++scene) {
        const int order[2] = {2 + scene % 9, 2 + scene * 5 % 12};
        std::vector<float> knots[2];
        int n[2];
        for (int k = 0; k < 2; ++k) {
            n[k] = order[k] + int(rng() % 5);
            float t = random();
            for (int i = 0; i < n[k] + order[k]; ++i) knots[k].push_back(t += i == n[k] || rng() % 2 ? 0.3f + random() : 0.f);
        }
        std::vector<float> Pw, f;
        for (int i = 0; i < n[0] * n[1]; ++i) {
            const float w = 0.5f + random();
            for (int c = 0; c < 3; ++c) Pw.push_back((random() * 4 - 2) * w);
            Pw.push_back(w);
            f.push_back(random());
        }
        auto p = std::make_shared<scene::Primitive>();
        p->kind = "NuPatch";
        p->ints = {n[0], order[0], n[1], order[1]};
        const double lo[2] = {knots[0][size_t(order[0]) - 1], knots[1][size_t(order[1]) - 1]},
                     hi[2] = {knots[0][size_t(n[0])], knots[1][size_t(n[1])]};
        if (!(lo[0] < hi[0] && lo[1] < hi[1])) continue;
        p->numbers = {float(lo[0]), float(hi[0]), float(lo[1]), float(hi[1])};
        p->params = {param("uknot", Class::Constant, Type::Float, knots[0]),
                     param("vknot", Class::Constant, Type::Float, knots[1]), param("Pw", Class::Vertex, Type::HPoint, Pw),
                     param("f", Class::Vertex, Type::Float, f)};
        Diagnostics diag;
        ShapeRef s = build(p, Matrix(), diag);
        ASSERT_TRUE(s);
        EXPECT_EQ(diag.errors() + diag.warnings(), 0);
        for (int k = 0; k < 20; ++k) {
            const double u = random(), v = random();
            double sum[5] = {};
            for (int j = 0; j < n[1]; ++j)
                for (int i = 0; i < n[0]; ++i) {
                    const double b = basis(knots[0], i, order[0], lo[0] + u * (hi[0] - lo[0]), size_t(n[0])) *
                                     basis(knots[1], j, order[1], lo[1] + v * (hi[1] - lo[1]), size_t(n[1]));
                    const size_t at = size_t(j * n[0] + i);
                    for (size_t c = 0; c < 4; ++c) sum[c] += b * Pw[4 * at + c];
                    sum[4] += b * f[at];
                }
            const SurfacePoint q = s->evaluate(0, u, v);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(q.P[c], sum[c] / sum[3], 2e-6) << "scene " << scene;
            float value;
            s->interpolate(s->findPrimvar("f"), q, &value, nullptr, nullptr);
            EXPECT_NEAR(value, sum[4], 1e-6);
        }
    }
    Diagnostics diag;
    auto p = sheet(2);
    p->ints = {40, limits::kNurbsOrder + 1, 2, 2};
    EXPECT_FALSE(build(p, Matrix(), diag));
    EXPECT_EQ(diag.errors(), 1);
}

TEST(NuPatch, UniformAndVaryingValuesLieBetweenKnots) {
    auto p = sheet(2);
    p->ints = {4, 2, 2, 2};
    p->numbers = {0, 4, 0, 1};
    std::vector<float> P;
    for (float y : {-1.f, 1.f})
        for (float x : {0.f, 1.f, 3.f, 4.f}) P.insert(P.end(), {x, y, 5});
    p->params = {param("uknot", Class::Constant, Type::Float, {0, 0, 1, 3, 4, 4}),
                 param("vknot", Class::Constant, Type::Float, {0, 0, 1, 1}), points(P),
                 param("f", Class::Uniform, Type::Float, {1, 2, 3}),
                 param("g", Class::Varying, Type::Float, {0, 10, 30, 40, 0, 10, 30, 40})};
    Diagnostics diag;
    ShapeRef s = build(p, Matrix(), diag);
    ASSERT_TRUE(s);
    for (auto [u, f] : {std::pair{0.2, 1.f}, {0.3, 2.f}, {0.7, 2.f}, {0.8, 3.f}}) {
        const SurfacePoint q = s->evaluate(0, u, 0.5);
        EXPECT_FLOAT_EQ(q.P.x, float(4 * u));
        float value, du;
        s->interpolate(s->findPrimvar("f"), q, &value, nullptr, nullptr);
        EXPECT_EQ(value, f);
        s->interpolate(s->findPrimvar("g"), q, &value, &du, nullptr);
        EXPECT_NEAR(value, 40 * u, 1e-5);
        EXPECT_NEAR(du, 40, 1e-4);
    }
}

TEST(NuPatch, AKnotThatTearsTheSurfaceLeavesAGap) {
    // Two flat pieces, order 2: the knot 1 is there twice, and between (1, .) and (2, .) there is nothing.
    auto p = sheet(2);
    p->ints = {4, 2, 2, 2};
    p->numbers = {0, 2, 0, 1};
    p->params = {param("uknot", Class::Constant, Type::Float, {0, 0, 1, 1, 2, 2}),
                 param("vknot", Class::Constant, Type::Float, {0, 0, 1, 1}),
                 points({0, 0, 5, 1, 0, 5, 2, 0, 5, 3, 0, 5, 0, 1, 5, 1, 1, 5, 2, 1, 5, 3, 1, 5})};
    Diagnostics diag;
    ShapeRef s = build(p, Matrix(), diag);
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->area(), 2, 1e-9);
    s->dice({}, diag);
    double area = 0;
    const TriMesh& m = s->mesh();
    for (uint32_t t = 0; t < m.triangles(); ++t) {
        const Vec3 a = m.P[m.index[3 * t]], b = m.P[m.index[3 * t + 1]], c = m.P[m.index[3 * t + 2]];
        area += 0.5 * length(cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a)));
    }
    EXPECT_NEAR(area, 2, 1e-6);
}

TEST(Trim, AreOfSoManyPiecesAtMost) {
    std::vector<float> u, v;
    for (size_t i = 0; i < limits::kTrimPieces + 3; ++i) u.push_back(i % 2 ? .25f : .75f), v.push_back(.5f);
    const scene::ParamList curves = trimList({{lines(std::move(u), std::move(v))}});
    std::string why;
    double gap;
    EXPECT_FALSE(TrimRegion::make(curves, kUnit, true, why, gap));
    EXPECT_NE(why.find(std::to_string(limits::kTrimPieces)), std::string::npos) << why;
}

} // namespace trim_test
