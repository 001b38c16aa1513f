// Points of large meshes: what is asked for is what comes with everything, in runs and one by one, and what it is of the same
// triangle alone; places on emitters lie where their areas say.
#include "make.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace needs_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using scene::Class;
using scene::Type;

namespace {

using Corners = std::array<std::pair<int, int>, 3>; // of a triangle, in its cell
const Corners kLower{{{0, 0}, {1, 0}, {0, 1}}}, kUpper{{{1, 0}, {1, 1}, {0, 1}}};

constexpr int kSide = 20; // 800 triangles: more than are remembered

struct Values {
    std::vector<float> P, N, st;
};

Values valuesAt(int i, int j) {
    const float x = float(i) / kSide, y = float(j) / kSide;
    return {{x, y * 1.5f, 0.2f * std::sin(5 * x) * y}, {std::sin(3 * x), 0.3f * y, 1.2f}, {x * x, y + 0.1f * x}};
}

/// A bent sheet; N and st by vertex, or by corner of a face.
std::shared_ptr<scene::Primitive> sheet(bool byCorner) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "PointsPolygons";
    std::vector<float> P, N, st;
    const auto append = [](std::vector<float>& to, const std::vector<float>& v) { to.insert(to.end(), v.begin(), v.end()); };
    for (int j = 0; j <= kSide; ++j)
        for (int i = 0; i <= kSide; ++i) {
            const Values v = valuesAt(i, j);
            append(P, v.P);
            if (!byCorner) append(N, v.N), append(st, v.st);
        }
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i)
            for (const Corners& corners : {kLower, kUpper}) {
                p->ints.push_back(3);
                for (const auto& [a, b] : corners) {
                    p->ints2.push_back((j + b) * (kSide + 1) + i + a);
                    if (byCorner) append(N, valuesAt(i + a, j + b).N), append(st, valuesAt(i + a, j + b).st);
                }
            }
    const Class c = byCorner ? Class::FaceVarying : Class::Varying;
    p->params = {points(P), param("N", c, Type::Normal, N), param("st", c, Type::Float, st)};
    p->params.back().arrayLength = 2;
    return p;
}

/// One triangle of it, as a primitive of its own.
std::shared_ptr<scene::Primitive> alone(uint32_t t) {
    const int cell = int(t) / 2, i = cell % kSide, j = cell / kSide;
    const Corners& corners = t % 2 ? kUpper : kLower;
    std::vector<float> P, N, st;
    for (const auto& [a, b] : corners) {
        const Values v = valuesAt(i + a, j + b);
        P.insert(P.end(), v.P.begin(), v.P.end());
        N.insert(N.end(), v.N.begin(), v.N.end());
        st.insert(st.end(), v.st.begin(), v.st.end());
    }
    auto p = polygon(P);
    p->params.push_back(param("N", Class::Varying, Type::Normal, N));
    p->params.push_back(param("st", Class::Varying, Type::Float, st));
    p->params.back().arrayLength = 2;
    return p;
}

void near(const Vec3& a, const Vec3& b, const char* what, uint32_t t) {
    EXPECT_LT(length(a - b), 2e-5f * (1 + length(b))) << what << " of triangle " << t;
}

} // namespace

TEST(PointNeeds, WhatIsAskedForIsWhatComesWithEverything) {
    for (bool byCorner : {false, true}) {
        Diagnostics diag;
        ShapeRef s = build(sheet(byCorner), skewed(), diag);
        ASSERT_TRUE(s);
        std::mt19937 rng(4);
        std::vector<HitRef> run(97);
        std::vector<SurfacePoint> out(run.size());
        for (uint32_t needs = 0; needs <= kNeedAll; ++needs) {
            for (size_t k = 0; k < run.size(); ++k) {
                const double a = double(rng() % 1000) / 1000, b = double(rng() % 1000) / 1000 * (1 - a);
                run[k] = {uint32_t(rng()) % s->mesh().triangles(), a, b, &out[k]};
            }
            s->points(run, needs);
            for (const HitRef& h : run) {
                const SurfacePoint p = s->evaluateHit(h.prim, h.b1, h.b2), &q = *h.out;
                ASSERT_EQ(q.P, p.P);
                ASSERT_EQ(q.n, p.n);
                ASSERT_EQ(q.pError, p.pError);
                ASSERT_EQ(q.face, p.face);
                ASSERT_EQ(q.prim, p.prim);
                if (needs & kNeedN) ASSERT_EQ(q.N, p.N);
                if (needs & kNeedPartials) ASSERT_TRUE(q.dPdu == p.dPdu && q.dPdv == p.dPdv && q.orientation == p.orientation);
                if (needs & kNeedNg) ASSERT_EQ(q.Ng, p.Ng);
                if (needs & kNeedNormalSlopes) ASSERT_TRUE(q.dNdu == p.dNdu && q.dNdv == p.dNdv);
                if (needs & kNeedUV) ASSERT_TRUE(q.u == p.u && q.v == p.v);
                if (needs & kNeedST) ASSERT_TRUE(q.s == p.s && q.t == p.t);
                if (needs & kNeedSTSlopes)
                    ASSERT_TRUE(q.dsdu == p.dsdu && q.dsdv == p.dsdv && q.dtdu == p.dtdu && q.dtdv == p.dtdv);
            }
        }
    }
}

TEST(PointNeeds, LargeMeshesAreWhatTheirTrianglesAreAlone) {
    for (bool byCorner : {false, true}) {
        Diagnostics diag;
        ShapeRef s = build(sheet(byCorner), skewed(), diag);
        for (uint32_t t = 0; t < s->mesh().triangles(); t += 7) {
            ShapeRef one = build(alone(t), skewed(), diag);
            ASSERT_TRUE(one);
            const SurfacePoint p = s->evaluateHit(t, 0.3, 0.45), q = one->evaluateHit(0, 0.3, 0.45);
            near(p.P, q.P, "P", t);
            near(p.n, q.n, "n", t);
            near(p.N, q.N, "N", t);
            near(p.Ng, q.Ng, "Ng", t);
            near(p.dPdu, q.dPdu, "dPdu", t);
            near(p.dPdv, q.dPdv, "dPdv", t);
            near(p.dNdu, q.dNdu, "dNdu", t);
            near(p.dNdv, q.dNdv, "dNdv", t);
            near({p.u, p.v, p.s}, {q.u, q.v, q.s}, "u, v, s", t);
            near({p.t, p.dsdu, p.dsdv}, {q.t, q.dsdu, q.dsdv}, "t, slopes of s", t);
            near({p.dtdu, p.dtdv, 0}, {q.dtdu, q.dtdv, 0}, "slopes of t", t);
            EXPECT_EQ(p.face, int(t));
        }
    }
}

TEST(PointNeeds, PlacesOnEmittersLieByArea) {
    Diagnostics diag;
    ShapeRef s = build(sheet(false), skewed(), diag);
    const TriMesh& m = s->mesh();
    std::vector<double> sums;
    double sum = 0;
    for (uint32_t t = 0; t < m.triangles(); ++t) {
        const Vec3d a(m.P[m.index[3 * t]]), b(m.P[m.index[3 * t + 1]]), c(m.P[m.index[3 * t + 2]]);
        sums.push_back(sum += 0.5 * length(cross(b - a, c - a)));
    }
    EXPECT_NEAR(s->area(), sum, 1e-9 * sum);
    for (int k = 0; k < 5000; ++k) {
        const double x = (k + 0.5) / 5000;
        const SurfacePoint p = s->sampleArea(x, 0.37);
        const double lo = p.prim ? sums[p.prim - 1] : 0;
        EXPECT_GE(x * sum, lo * (1 - 1e-12));
        EXPECT_LE(x * sum, sums[p.prim] * (1 + 1e-12));
    }
    EXPECT_EQ(s->sampleArea(0, 0.5).prim, 0u);
    EXPECT_EQ(s->sampleArea(1 - 1e-16, 0.5).prim, m.triangles() - 1);
}

TEST(PointNeeds, OfSpheresAreWhereTheLineMeetsThem) {
    // Whole spheres, turned and mirrored, near and far; an ellipsoid; a part of a sphere.
    const Matrix turn = rotateMatrix(37, 1, 2, .5) * translateMatrix(.4, -.3, 6);
    Matrix rounded = turn; // as exporters write it
    for (auto& row : rounded.m)
        for (double& x : row) x = double(float(x));
    const std::pair<std::vector<float>, Matrix> cases[] = {{{1.25f, -1.25f, 1.25f, 360}, rounded},
                                                           {{1.5f, -1.5f, 1.5f, 360}, scaleMatrix(2, 2, 2) * turn},
                                                           {{-.7f, -.7f, .7f, 360}, scaleMatrix(1, 1, -1) * turn},
                                                           {{1, -1, 1, -360}, turn * translateMatrix(1e5, 0, 2e5)},
                                                           {{1, -1, 1, 360}, scaleMatrix(1, 1, 1.5) * turn},
                                                           {{1, -.5f, 1, 300}, turn}};
    std::mt19937 rng(9);
    const auto one = [&](double from, double to) { return from + (to - from) * std::generate_canonical<double, 40>(rng); };
    for (const auto& [numbers, m] : cases) {
        Diagnostics diag;
        const ShapeRef s = build(quadric("Sphere", numbers), m, diag);
        ASSERT_TRUE(s);
        const Vec3d centre = transformPoint(m, Vec3d(0, 0, 0));
        int met = 0;
        for (int k = 0; k < 300; ++k) {
            const Vec3d org = centre + Vec3d(one(-6, 6), one(-6, 6), one(-6, 6)),
                        dir = centre + Vec3d(one(-1, 1), one(-1, 1), one(-1, 1)) - org;
            ExactHit h[4];
            for (int i = s->exactHits(org, dir, h) - 1; i >= 0; --i, ++met) {
                const SurfacePoint all = s->evaluateHit(0, h[i].u, h[i].v);
                SurfacePoint few;
                s->evaluateHit(0, h[i].u, h[i].v, few, kNeedN | kNeedNg);
                const float size = float(length(centre)) + 1, most = 4e-7f * size;
                ASSERT_LT(length(few.P - Vec3(org + dir * h[i].t)), most);
                ASSERT_EQ(few.P, all.P);
                ASSERT_EQ(few.n, all.n);
                ASSERT_EQ(few.N, all.N);
                ASSERT_LT(length(few.Ng - all.Ng), 2e-5f * length(all.Ng));
                // The same place by its u and v, which the primitive defines.
                const SurfacePoint p = s->evaluate(0, double(all.u), double(all.v));
                ASSERT_LT(length(p.P - few.P), 4e-6f + most);
                ASSERT_GT(dot(p.n, few.n), .99999f);
                ASSERT_LT(length(Vec3(s->hitNormal(0, h[i].u, h[i].v)) / float(length(s->hitNormal(0, h[i].u, h[i].v))) - few.n),
                          1e-5f);
            }
        }
        EXPECT_GT(met, 100);
    }
}

} // namespace needs_test
