// Blobbies against closed forms: the ball, the capsule, fields by quadrature and by differences, volumes and areas by chords and
// samples.
#include "../nightly.h"
#include "base/limits.h"
#include "geometry/blob_field.h"
#include "make.h"
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

namespace blobby_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;

namespace {

std::vector<float> matrixNumbers(const Matrix& m) {
    std::vector<float> f;
    for (auto& row : m.m)
        for (double x : row) f.push_back(float(x));
    return f;
}
std::shared_ptr<scene::Primitive> blobby(int leaves, std::vector<int> code, std::vector<std::vector<float>> floats,
                                         std::vector<std::string> strings = {}) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Blobby";
    p->ints = {leaves};
    p->ints2 = std::move(code);
    for (auto& f : floats) p->numbers.insert(p->numbers.end(), f.begin(), f.end());
    p->strings = std::move(strings);
    return p;
}
std::vector<float> ball(double x, double y, double z, double radius) { // of the field; the surface of a lone one has half of it
    return matrixNumbers(scaleMatrix(radius, radius, radius) * translateMatrix(x, y, z));
}

std::mt19937 rng(5);
double random01() { return double(rng()) / 4294967296.0; }
Vec3d within(double s) { return {(2 * random01() - 1) * s, (2 * random01() - 1) * s, (2 * random01() - 1) * s}; }

/// All hits of a line, by every box: sorted, those that two boxes found once.
std::vector<double> hits(const Shape& s, const Vec3d& o, const Vec3d& d) {
    std::vector<double> t;
    for (uint32_t k = 0; k < s.exactPrims(); ++k) {
        ExactHit h[4];
        for (int n = s.exactHits(k, o, d, -INFINITY, INFINITY, Shape::Wanted::All, h), i = 0; i < n; ++i) t.push_back(h[i].t);
    }
    std::sort(t.begin(), t.end());
    t.erase(std::unique(t.begin(), t.end(), [](double a, double b) { return b - a < 1e-10; }), t.end());
    return t;
}

/// Volume by chords along z through a grid of lines, camera space.
double volume(const Shape& s, int n) {
    const Bounds b = s.bounds();
    const double hx = (double(b.hi.x) - b.lo.x) / n, hy = (double(b.hi.y) - b.lo.y) / n;
    double sum = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const auto t = hits(s, {b.lo.x + hx * (i + 0.5), b.lo.y + hy * (j + 0.5), double(b.lo.z) - 1}, {0, 0, 1});
            EXPECT_EQ(t.size() % 2, 0u);
            for (size_t k = 0; k + 1 < t.size(); k += 2) sum += t[k + 1] - t[k];
        }
    return sum * hx * hy;
}

} // namespace

TEST(Blobby, ALoneBallIsABallOfHalfItsRadius) {
    Diagnostics diag;
    ShapeRef s = build(blobby(1, {1001, 0}, {ball(1, 2, 3, 4)}), translateMatrix(0, 0, 10), diag);
    ASSERT_TRUE(s);
    ASSERT_TRUE(s->exact());
    const Vec3d c(1, 2, 13);
    for (int i = 0; i < 300; ++i) {
        const Vec3d o = c + within(8), to = c + within(2.2), d = to - o, e = o - c;
        // The ball's own roots.
        const double a = dot(d, d), b = dot(e, d), q = dot(e, e) - 4, disc = b * b - a * q;
        if (std::fabs(disc) < 1e-7 * a) continue;
        const auto t = hits(*s, o, d);
        ASSERT_EQ(t.size(), disc > 0 ? 2u : 0u);
        if (disc < 0) continue;
        EXPECT_NEAR(t[0], (-b - std::sqrt(disc)) / a, 1e-11);
        EXPECT_NEAR(t[1], (-b + std::sqrt(disc)) / a, 1e-11);
    }
    EXPECT_NEAR(s->area(), 16 * kPi, 16 * kPi * 2e-3); // 800 lines a face of a box
    EXPECT_NEAR(volume(*s, 60), 32 * kPi / 3, 32 * kPi / 3 * 2e-3);
    EXPECT_EQ(diag.errors() + diag.warnings(), 0);
}

TEST(Blobby, PointsHaveTheBallsNormalsAndPartials) {
    Diagnostics diag;
    for (const Matrix& m : {Matrix(), skewed(), scaleMatrix(1, 1, -1)}) {
        ShapeRef s = build(blobby(1, {1001, 0}, {ball(0, 0, 0, 2)}), m, diag);
        ASSERT_TRUE(s);
        const Matrix back = inverse(m);
        for (int i = 0; i < 100; ++i) {
            const Vec3d to = normalize(within(1)), o = transformPoint(m, to * 3.0), d = transformPoint(m, Vec3d(0.0)) - o;
            for (uint32_t k = 0; k < s->exactPrims(); ++k) {
                ExactHit h[4];
                if (s->exactHits(k, o, d, 0, 1, Shape::Wanted::Nearest, h) == 0) continue;
                const SurfacePoint p = s->evaluateHit(k, h[0].u, h[0].v);
                EXPECT_LT(length(Vec3d(p.P) - (o + d * h[0].t)), double(p.pError));
                const Vec3d q = transformPoint(back, Vec3d(p.P));
                EXPECT_NEAR(length(q), 1, 1e-6);
                // The normal leaves the ball, whatever the transform; perpendicular to both partials, as the slopes of N are to
                // N.
                const Vec3d n(p.n);
                EXPECT_GT(dot(n, -d), 0);
                EXPECT_NEAR(length(n), 1, 1e-6);
                EXPECT_NEAR(dot(n, normalize(Vec3d(p.dPdu))), 0, 1e-6);
                EXPECT_NEAR(dot(n, normalize(Vec3d(p.dPdv))), 0, 1e-6);
                EXPECT_NEAR(dot(n, normalize(Vec3d(p.Ng))), 1, 1e-6);
                // Second fundamental form two ways: n . P_uu = -dN/du . P_u, and so on.
                const double scale = length(p.Puu) + length(p.Pvv) + 1;
                EXPECT_NEAR(dot(n, Vec3d(p.Puu)), -dot(Vec3d(p.dNdu), Vec3d(p.dPdu)), 1e-5 * scale);
                EXPECT_NEAR(dot(n, Vec3d(p.Puv)), -dot(Vec3d(p.dNdu), Vec3d(p.dPdv)), 1e-5 * scale);
                EXPECT_NEAR(dot(n, Vec3d(p.Puv)), -dot(Vec3d(p.dNdv), Vec3d(p.dPdu)), 1e-5 * scale);
                EXPECT_NEAR(dot(n, Vec3d(p.Pvv)), -dot(Vec3d(p.dNdv), Vec3d(p.dPdv)), 1e-5 * scale);
            }
        }
    }
}

TEST(Blobby, TwoFarApartAreTwoBalls) {
    Diagnostics diag;
    ShapeRef s = build(blobby(2, {1001, 0, 1001, 16, 0, 2, 0, 1}, {ball(0, 0, 0, 1), ball(5, 0, 0, 2)}), Matrix(), diag);
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->area(), 4 * kPi * (0.25 + 1), 4 * kPi * 1.25 * 5e-3);
    EXPECT_EQ(hits(*s, {-3, 0, 0}, {1, 0, 0}).size(), 4u);
    EXPECT_NEAR(volume(*s, 80), 4 * kPi / 3 * (0.125 + 1), 4 * kPi / 3 * 1.125 * 5e-3);
}

TEST(Blobby, SegmentsAreIntegralsOfTheBump) {
    // Field, gradient and second derivatives by quadrature and differences; and end to end they add up to the longer one.
    BlobLeaf l;
    l.kind = BlobLeaf::Kind::Segment;
    l.from = Vec3d(0.2, -0.1, 0.3);
    l.along = normalize(Vec3d(1, 2, -1));
    l.length = 1.3;
    for (int i = 0; i < 200; ++i) {
        const Vec3d p = l.from + l.along * (random01() * 3 - 0.8) + within(0.5);
        double f = 0;
        constexpr int kSteps = 20000;
        for (int k = 0; k < kSteps; ++k) {
            const Vec3d d = p - (l.from + l.along * (l.length * (k + 0.5) / kSteps));
            const double b = std::max(0.0, 1 - dot(d, d));
            f += b * b * b * l.length / kSteps;
        }
        Vec3d g;
        double h[6];
        EXPECT_NEAR(blobLeafField(l, p, &g, h), f * 35 / 32, 1e-7);
        const double e = 1e-5;
        for (int k = 0; k < 3; ++k) {
            Vec3d a = p, b = p, ga, gb;
            a[k] += e, b[k] -= e;
            EXPECT_NEAR(g[k], (blobLeafField(l, a, &ga, nullptr) - blobLeafField(l, b, &gb, nullptr)) / (2 * e), 1e-7);
            EXPECT_NEAR(h[k], ((ga - gb) / (2 * e))[k], 1e-4);
            EXPECT_NEAR(k == 0 ? h[3] : k == 1 ? h[5] : h[4], ((ga - gb) / (2 * e))[k == 0 ? 1 : k == 1 ? 2 : 0], 1e-4);
        }
        BlobLeaf first = l, second = l;
        first.length = 0.5;
        second.from = l.from + l.along * 0.5;
        second.length = 0.8;
        EXPECT_NEAR(blobLeafField(first, p, nullptr, nullptr) + blobLeafField(second, p, nullptr, nullptr),
                    blobLeafField(l, p, nullptr, nullptr), 1e-13);
    }
}

TEST(Blobby, ALongSegmentIsATube) {
    // Far from its ends the field is (1 - h^2)^(7/2): the tube's radius is the root of that.
    Diagnostics diag;
    auto numbers = matrixNumbers(Matrix());
    numbers.insert(numbers.begin(), {0, 0, -4, 0, 0, 4, 0.5f});
    ShapeRef s = build(blobby(1, {1002, 0}, {numbers}), Matrix(), diag);
    ASSERT_TRUE(s);
    const double radius = 0.5 * std::sqrt(1 - std::pow(0.421875, 2.0 / 7));
    for (double z : {-3.0, -0.7, 0.0, 3.2}) {
        const auto t = hits(*s, {-2, 0.03, z}, {1, 0, 0});
        ASSERT_EQ(t.size(), 2u);
        EXPECT_NEAR(t[1] - t[0], 2 * std::sqrt(radius * radius - 0.03 * 0.03), 1e-10);
    }
    // On the axis it ends where the integral of the bump is the threshold: about half a radius of 0.5 beyond, found by bisection.
    double lo = 0, hi = 1;
    for (int i = 0; i < 60; ++i) {
        const double x = 0.5 * (lo + hi), G = x - x * x * x + 0.6 * std::pow(x, 5) - std::pow(x, 7) / 7;
        (35.0 / 32 * (16.0 / 35 - G) > 0.421875 ? lo : hi) = x; // beyond the end only the far half of the bump is on the segment
    }
    const auto t = hits(*s, {0, 0, -9}, {0, 0, 1});
    ASSERT_EQ(t.size(), 2u);
    EXPECT_NEAR(t[1] - t[0], 8 + 2 * 0.5 * lo, 1e-9);
}

// Every point of such a line is a point of the surface, as far as numbers tell: no number of pieces decides about it. It took
// hours.
TEST(Blobby, ALineInTheSurfaceOfATubeEnds) {
    Diagnostics diag;
    auto floats = std::vector<float>{-2, 0, 0, 2, 0, 0, 1};
    const auto unit = matrixNumbers(Matrix());
    floats.insert(floats.end(), unit.begin(), unit.end());
    ShapeRef s = build(blobby(1, {1002, 0}, {floats}), Matrix(), diag);
    ASSERT_TRUE(s);
    const auto across = hits(*s, {0, -3, 0}, {0, 1, 0});
    ASSERT_EQ(across.size(), 2u);
    for (double off : {0.0, 1e-16, -1e-15, 1e-13, -1e-12, 1e-11}) {
        const auto t = hits(*s, {-9, across[1] - 3 + off, 0}, {1, 0, 0});
        for (double x : t) EXPECT_TRUE(x > 6 && x < 12) << "within the tube";
    }
    EXPECT_EQ(hits(*s, {-9, across[1] - 3 - 1e-6, 0}, {1, 0, 0}).size(), 2u);
    EXPECT_EQ(hits(*s, {-9, across[1] - 3 + 1e-6, 0}, {1, 0, 0}).size(), 0u);
}

TEST(Blobby, OperatorsAreWhatTheyAreCalled) {
    // Along the x axis through two balls one unit apart the field is known: its roots by scanning it finely.
    const auto bump = [](double d) {
        const double k = std::max(0.0, 1 - d * d);
        return k * k * k;
    };
    struct Case {
        std::vector<int> code;
        std::function<double(double, double)> f;
    };
    const std::vector<int> leaves{1001, 0, 1001, 16, 1000, 32};
    for (const Case& c :
         {Case{{0, 2, 0, 1}, [](double a, double b) { return a + b; }},
          Case{{1, 3, 0, 1, 2}, [](double a, double b) { return 3 * a * b; }},
          Case{{2, 2, 0, 1}, [](double a, double b) { return std::max(a, b); }},
          Case{{3, 2, 0, 1}, [](double a, double b) { return std::min(a, b); }},
          Case{{4, 0, 1}, [](double a, double b) { return a - b; }}, Case{{5, 0, 2}, [](double a, double) { return a / 3; }},
          Case{{6, 0, 0, 2, 3, 2}, [](double a, double) { return 3 - a; }}, Case{{7, 1}, [](double, double b) { return b; }}}) {
        auto code = leaves;
        code.insert(code.end(), c.code.begin(), c.code.end());
        Diagnostics diag;
        ShapeRef s = build(blobby(3, code, {ball(0, 0, 0, 1), ball(0.875, 0, 0, 1), {3}}), Matrix(), diag);
        const auto f = [&](double x) { return c.f(bump(x), bump(x - 0.875)) - 0.421875; };
        std::vector<double> roots;
        for (int k = 0; k < 40000; ++k) {
            double a = -2.00003 + k * 1e-4, b = -2.00003 + (k + 1) * 1e-4; // no point of the grid is a root
            if ((f(a) < 0) == (f(b) < 0)) continue;
            for (int i = 0; i < 60; ++i) {
                const double m = 0.5 * (a + b);
                ((f(m) < 0) == (f(a) < 0) ? a : b) = m;
            }
            roots.push_back(a);
        }
        if (roots.empty()) {
            EXPECT_FALSE(s && !hits(*s, {-2, 0, 0}, {1, 0, 0}).empty());
            continue;
        }
        ASSERT_TRUE(s);
        const auto t = hits(*s, {-2, 0, 0}, {1, 0, 0});
        ASSERT_EQ(t.size(), roots.size()) << c.code[0];
        for (size_t i = 0; i < t.size(); ++i) EXPECT_NEAR(t[i] - 2, roots[i], 1e-10) << c.code[0];
    }
}

TEST(Blobby, NoThinPartIsLost) {
    // A thousand balls of all sizes and a sheet a thousandth thick, and rays at them: every root that a fine scan of the whole
    // field sees is found, and none that it does not see.
    std::vector<int> code;
    std::vector<std::vector<float>> floats;
    std::vector<int> sum{0, 301};
    for (int i = 0; i < 300; ++i) {
        code.insert(code.end(), {1001, 16 * i});
        floats.push_back(ball(3 * random01(), 3 * random01(), 3 * random01(), std::pow(10, -2 * random01()) * 0.6));
        sum.push_back(i);
    }
    code.insert(code.end(), {1001, 16 * 300});
    floats.push_back(matrixNumbers(scaleMatrix(2, 2, 0.001) * rotateMatrix(30, 1, 1, 0) * translateMatrix(1.5, 1.5, 1.5)));
    sum.push_back(300);
    code.insert(code.end(), sum.begin(), sum.end());
    Diagnostics diag;
    auto p = blobby(301, code, floats);
    ShapeRef s = build(p, Matrix(), diag);
    ASSERT_TRUE(s);
    BlobField field;
    ASSERT_TRUE(field.read(301, p->ints2, p->numbers, {}, Matrix(), {}, diag));
    for (int i = 0; i < (nightly() ? 20 : 8); ++i) {
        const Vec3d o(4 * random01() - 0.5, 4 * random01() - 0.5, -1), to(4 * random01() - 0.5, 4 * random01() - 0.5, 4);
        const auto t = hits(*s, o, to - o);
        size_t seen = 0;
        double nearest = 1, before = field.value(field.whole(), o) - kBlobThreshold;
        for (int k = 1; k <= 15000; ++k) {
            const double f = field.value(field.whole(), o + (to - o) * (k / 15000.0)) - kBlobThreshold;
            seen += (f < 0) != (before < 0);
            before = f;
            nearest = std::min(nearest, std::fabs(f));
        }
        EXPECT_GE(t.size(), seen) << i;
        EXPECT_EQ(t.size() % 2, 0u) << i;
        for (double x : t)
            EXPECT_NEAR(field.value(field.whole(), o + (to - o) * x), kBlobThreshold, 1e-7) << i; // of a sheet this thin
    }
}

TEST(Blobby, SamplesIntegrateTheSurface) {
    Diagnostics diag;
    ShapeRef s = build(blobby(1, {1001, 0}, {matrixNumbers(scaleMatrix(2, 2, 2))}), scaleMatrix(1, 2, 1), diag);
    ASSERT_TRUE(s);
    // Area, and the integral of y^2, of the ellipsoid with half axes 1, 2, 1.
    double area = 0, second = 0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) { // rings about y = 2 cos t
        const double t = kPi * (i + 0.5) / kSteps,
                     ring = 2 * kPi * std::sin(t) * std::hypot(std::cos(t), 2 * std::sin(t)) * kPi / kSteps;
        area += ring;
        second += ring * 4 * std::cos(t) * std::cos(t);
    }
    double one = 0, two = 0, one2 = 0, two2 = 0;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
        const SurfacePoint p = s->sampleArea(random01(), random01());
        const double d = s->sampleDensity(p), w = d > 0 ? 1 / d : 0, y = double(p.P.y) * p.P.y * w;
        one += w, one2 += w * w, two += y, two2 += y * y;
    }
    const auto deviation = [&](double sum, double squares) {
        return std::sqrt((squares / kSamples - sum * sum / kSamples / kSamples) / kSamples);
    };
    EXPECT_NEAR(one / kSamples, area, 4 * deviation(one, one2));
    EXPECT_NEAR(two / kSamples, second, 4 * deviation(two, two2));
    EXPECT_NEAR(s->area(), area, 5e-3 * area);
    EXPECT_LT(deviation(one, one2), 0.02 * area);
}

TEST(Blobby, VariablesBlendByTheField) {
    Diagnostics diag;
    auto p = blobby(2, {1001, 0, 1001, 16, 0, 2, 0, 1}, {ball(-0.3, 0, 0, 1), ball(0.3, 0, 0, 1)});
    p->params = {param("f", scene::Class::Vertex, scene::Type::Float, {0, 1})};
    ShapeRef s = build(p, Matrix(), diag);
    ASSERT_TRUE(s);
    for (uint32_t k = 0, seen = 0; k < s->exactPrims() && seen < 50; ++k) {
        ExactHit h[4];
        const Bounds b = s->exactBounds(k);
        const Vec3d c = (Vec3d(b.lo) + Vec3d(b.hi)) * 0.5;
        if (s->exactHits(k, c - Vec3d(0.1, 1, 0.2), {0.1, 1, 0.2}, 0, 9, Shape::Wanted::Nearest, h) == 0) continue;
        ++seen;
        const SurfacePoint q = s->evaluateHit(k, h[0].u, h[0].v);
        const auto f = [](const Vec3d& x) {
            const auto bump = [&](double cx) {
                const Vec3d e(x.x - cx, x.y, x.z);
                const double w = std::max(0.0, 1 - dot(e, e));
                return w * w * w;
            };
            return bump(0.3) / (bump(0.3) + bump(-0.3));
        };
        float v, du, dv;
        s->interpolate(s->findPrimvar("f"), q, &v, &du, &dv);
        EXPECT_NEAR(v, f(Vec3d(q.P)), 1e-5);
        const Vec3d pu(q.dPdu), pv(q.dPdv), x(q.P);
        EXPECT_NEAR(du, (f(x + pu * 1e-5) - f(x - pu * 1e-5)) / 2e-5, 1e-3 * (1 + length(pu)));
        EXPECT_NEAR(dv, (f(x + pv * 1e-5) - f(x - pv * 1e-5)) / 2e-5, 1e-3 * (1 + length(pv)));
    }
}

// A variable of type mpoint, which is read as the four rows of its matrix. Where the reference pose is the pose, every blob takes
// a point to itself, so their mix is the point, in camera space; and one blob alone takes it by the inverse of its matrix and the
// other matrix.
TEST(Blobby, ReferencePosesPlaceThePoints) {
    const Matrix here = rotateMatrix(30, 1, 2, 0.5) * scaleMatrix(0.8, 1, 1.2) * translateMatrix(-0.3, 0.1, 0);
    const Matrix there = rotateMatrix(-70, 0, 1, 1) * scaleMatrix(2, 1, 3) * translateMatrix(4, 5, 6);
    const Matrix toCamera = rotateMatrix(20, 0, 1, 0) * translateMatrix(1, 2, 9);
    std::vector<float> tube{-0.5, 0, 0, 0.5, 0, 0, 0.4f};
    const auto second = ball(0.4, 0, 0.2, 0.9);
    tube.insert(tube.end(), second.begin(), second.end());
    struct Case {
        std::vector<int> code;
        std::vector<std::vector<float>> floats;
        std::vector<Matrix> poses;
        Matrix moves;
    };
    const Matrix own = scaleMatrix(0.9, 0.9, 0.9) * translateMatrix(0.4, 0, 0.2);
    const Case cases[] = {{{1001, 0, 1001, 16, 0, 2, 0, 1}, {matrixNumbers(here), second}, {here, own}, Matrix()},
                          {{1001, 0, 1002, 16, 0, 2, 0, 1}, {matrixNumbers(here), tube}, {here, own}, Matrix()},
                          {{1001, 0}, {matrixNumbers(here)}, {there}, inverse(here) * there},
                          {{1002, 0}, {tube}, {there}, inverse(own) * there}};
    for (const Case& c : cases) {
        Diagnostics diag;
        auto p = blobby(int(c.poses.size()), c.code, c.floats);
        std::vector<float> rows;
        for (const Matrix& m : c.poses)
            for (float f : matrixNumbers(m)) rows.push_back(f);
        p->params = {param("Pref", scene::Class::Vertex, scene::Type::HPoint, rows)};
        p->params[0].arrayLength = 4;
        ShapeRef s = build(p, toCamera, diag);
        ASSERT_TRUE(s);
        const int var = s->findPrimvar("Pref");
        ASSERT_EQ(s->primvars()[size_t(var)].outWidth(), 3);
        const Matrix all = inverse(toCamera) * c.moves * toCamera;
        for (int i = 0; i < 20; ++i) {
            const SurfacePoint q = s->sampleArea(random01(), random01());
            if (!(s->sampleDensity(q) > 0)) continue;
            float v[3], du[3], dv[3];
            s->interpolate(var, q, v, du, dv);
            const Vec3d want = transformPoint(all, Vec3d(q.P)), wu = transformVector(all, Vec3d(q.dPdu)),
                        wv = transformVector(all, Vec3d(q.dPdv));
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(v[k], want[k], 1e-4);
                EXPECT_NEAR(du[k], wu[k], 1e-4 * (1 + length(wu)));
                EXPECT_NEAR(dv[k], wv[k], 1e-4 * (1 + length(wv)));
            }
        }
    }
}

TEST(Blobby, WhatIsTakenAwayColoursNothing) {
    Diagnostics diag;
    auto p = blobby(2, {1001, 0, 1001, 16, 4, 0, 1}, {ball(0, 0, 0, 1), ball(0.6, 0, 0, 1)});
    p->params = {param("f", scene::Class::Vertex, scene::Type::Float, {0, 1})};
    ShapeRef s = build(p, Matrix(), diag);
    ASSERT_TRUE(s);
    for (int i = 0; i < 40; ++i) {
        const SurfacePoint q = s->sampleArea(random01(), random01());
        if (!(s->sampleDensity(q) > 0)) continue;
        float v;
        s->interpolate(s->findPrimvar("f"), q, &v, nullptr, nullptr);
        EXPECT_EQ(v, 0);
    }
}

TEST(Blobby, FaultyCodeIsSaid) {
    const auto b = ball(0, 0, 0, 1);
    const auto errors = [&](const std::shared_ptr<scene::Primitive>& p) {
        Diagnostics diag;
        EXPECT_FALSE(build(p, Matrix(), diag));
        return diag.errors();
    };
    EXPECT_EQ(errors(blobby(1, {1001}, {b})), 1);
    EXPECT_EQ(errors(blobby(1, {1001, 1}, {b})), 1);
    EXPECT_EQ(errors(blobby(1, {1001, -1}, {b})), 1);
    EXPECT_EQ(errors(blobby(1, {1001, 0, 0, 2, 0, 1}, {b})), 1);
    EXPECT_EQ(errors(blobby(1, {1001, 0, 0, 2000000000, 0}, {b})), 1);
    EXPECT_EQ(errors(blobby(1, {1001, 0, 9, 0}, {b})), 1);
    EXPECT_EQ(errors(blobby(1, {1004, 0, 0, 0, 0, 0}, {b})), 1);
    EXPECT_EQ(errors(blobby(0, {}, {})), 1);
    Diagnostics diag;
    EXPECT_FALSE(
        build(blobby(1, {1001, 0}, {std::vector<float>(16, 0)}), Matrix(), diag)); // no inverse: no field, nothing to draw
    EXPECT_EQ(diag.warnings(), 2);
    Diagnostics missing; // a depth map that is not there: reported, and the rest is drawn
    EXPECT_TRUE(build(blobby(2, {1001, 0, 1003, 0, 16, 0, 2, 0, 1}, {b, {1, 1, 1, 1}}, {"/none.z"}), Matrix(), missing));
    EXPECT_EQ(missing.errors(), 1);
}

TEST(Blobby, CodeAndBoxesHaveTheirLimits) {
    Diagnostics diag;
    auto p = blobby(1, std::vector<int>(size_t(limits::kBlobInstructions) + 1, 1001), {ball(0, 0, 5, 1)});
    EXPECT_EQ(build(p, Matrix{}, diag), nullptr);
    EXPECT_GE(diag.errors(), 1);
    // A needle a million times as long as it is thick, tilted, asks for boxes all along.
    Diagnostics quiet;
    auto needle = blobby(1, {1002, 0}, {{-100, -100, 3, 100, 100, 50, 1e-4f}});
    for (float f : matrixNumbers(Matrix{})) needle->numbers.push_back(f);
    const auto s = build(needle, Matrix{}, quiet);
    ASSERT_NE(s, nullptr);
    EXPECT_GT(s->exactPrims(), 1u);
    EXPECT_LE(s->exactPrims(), limits::kBlobBoxes);
}

// Pixar's application note 31 says 21 of the 22 leaves of its hand, and shows it: the code counts. The last leaf has the values
// of the one before.
TEST(Blobby, AWrongCountOfLeavesIsAWarning) {
    const std::vector<float> left = ball(-3, 0, 5, 1), right = ball(3, 0, 5, 1);
    for (const int count : {1, 2, 3}) {
        auto p = blobby(count, {1001, 0, 1001, 16, 0, 2, 0, 1}, {left, right});
        std::vector<float> colours;
        for (int i = 0; i < count; ++i) colours.insert(colours.end(), {float(i), 0, 0});
        p->params.push_back(param("Cs", scene::Class::Vertex, scene::Type::Color, colours));
        Diagnostics d;
        const auto s = build(p, Matrix(), d);
        ASSERT_NE(s, nullptr);
        EXPECT_EQ(d.errors(), 0);
        EXPECT_EQ(d.warnings(), count == 2 ? 0 : 1);
        const Bounds b = s->bounds();
        EXPECT_LT(b.lo.x, -3);
        EXPECT_GT(b.hi.x, 3);
        for (uint32_t i = 0; i < s->exactPrims(); ++i) EXPECT_FALSE(s->exactBounds(i).empty());
    }
}

} // namespace blobby_test
