// Patches against closed forms: height fields, bases that reproduce straight lines, rational circles, mesh counts.
#include "make.h"
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

namespace patch_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;

namespace {
void setBasis(scene::Basis& b, std::vector<double> rows, int step) {
    for (size_t i = 0; i < 16; ++i) b.m[i / 4][i % 4] = rows[i];
    b.step = step;
}
} // namespace

TEST(Patch, BilinearCornersAndOrder) {
    Diagnostics diag;
    ShapeRef s = build(patch("bilinear", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 4}), Matrix(), diag);
    EXPECT_FLOAT_EQ(s->evaluate(0, 1, 0).P.x, 1);
    EXPECT_FLOAT_EQ(s->evaluate(0, 0, 1).P.y, 1);
    EXPECT_FLOAT_EQ(s->evaluate(0, 0.5, 0.5).P.z, 1); // 4 u v
    EXPECT_FLOAT_EQ(s->evaluate(0, 0.5, 0.5).Puv.z, 4);
}

TEST(Patch, PzIsAHeightFieldOverTheUnitSquare) {
    Diagnostics diag;
    auto p = patchMesh("bilinear", 3, "nowrap", 2, "nowrap", {});
    p->params = {param("Pz", scene::Class::Vertex, scene::Type::Float, {0, 1, 4, 10, 11, 14})};
    ShapeRef s = build(p, Matrix(), diag);
    SurfacePoint at = s->evaluate(0, 0.75, 0.5);
    EXPECT_FLOAT_EQ(at.P.x, 0.75f);
    EXPECT_FLOAT_EQ(at.P.y, 0.5f);
    EXPECT_FLOAT_EQ(at.P.z, 7.5f); // between 1 and 4, and halfway to + 10
    EXPECT_EQ(at.face, 1);
    EXPECT_EQ(diag.errors() + diag.warnings(), 0);
}

TEST(Patch, EveryBasisReproducesStraightLines) {
    // Control points on a plane, evenly spaced: b-spline and Catmull-Rom run from the 2nd to the 3rd of four points.
    struct B {
        const char* name;
        std::vector<double> m;
        int step;
        double x0, x1;
    };
    double s = 1.0 / 6;
    for (const B& b :
         {B{"bezier", {-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0}, 3, 0, 3},
          B{"b-spline", {-s, 3 * s, -3 * s, s, 3 * s, -6 * s, 3 * s, 0, -3 * s, 0, 3 * s, 0, s, 4 * s, s, 0}, 1, 1, 2},
          B{"catmull-rom", {-.5, 1.5, -1.5, .5, 1, -2.5, 2, -.5, -.5, 0, .5, 0, 0, 1, 0, 0}, 1, 1, 2}}) {
        Diagnostics diag;
        scene::Attributes a;
        setBasis(a.ubasis, b.m, b.step);
        setBasis(a.vbasis, b.m, b.step);
        std::vector<float> P;
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) P.insert(P.end(), {float(i), float(j), 0});
        ShapeRef shape = build(patch("bicubic", P), Matrix(), diag, a);
        ASSERT_TRUE(shape);
        SurfacePoint p = shape->evaluate(0, 0.25, 0.5);
        EXPECT_NEAR(p.P.x, b.x0 + 0.25 * (b.x1 - b.x0), 1e-6) << b.name;
        EXPECT_NEAR(p.P.y, b.x0 + 0.5 * (b.x1 - b.x0), 1e-6) << b.name;
        EXPECT_NEAR(p.dPdu.x, b.x1 - b.x0, 1e-5) << b.name;
    }
}

TEST(Patch, MeshIsContinuousAndClosesWherePeriodic) {
    Diagnostics diag;
    scene::Attributes a;
    double s = 1.0 / 6;
    setBasis(a.ubasis, {-s, 3 * s, -3 * s, s, 3 * s, -6 * s, 3 * s, 0, -3 * s, 0, 3 * s, 0, s, 4 * s, s, 0}, 1);
    setBasis(a.vbasis, {-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0}, 3);
    std::vector<float> P;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 8; ++i) P.insert(P.end(), {std::cos(float(i) * 0.785398f), std::sin(float(i) * 0.785398f), float(j)});
    auto prim = patchMesh("bicubic", 8, "periodic", 4, "nonperiodic", P);
    // Periodic in u: 8 patches by 1; 8 by 2 varying values.
    prim->params.push_back(param("f", scene::Class::Varying, scene::Type::Float, std::vector<float>(16, 2)));
    prim->params.push_back(param("g", scene::Class::Uniform, scene::Type::Float, {0, 1, 2, 3, 4, 5, 6, 7}));
    ShapeRef shape = build(prim, Matrix(), diag, a);
    ASSERT_TRUE(shape);
    EXPECT_EQ(shape->faces(), 8);
    EXPECT_EQ(diag.errors() + diag.warnings(), 0);
    EXPECT_NEAR(length(shape->evaluate(0, 0, 0.3).P - shape->evaluate(0, 1, 0.3).P), 0, 1e-6);
    SurfacePoint lo = shape->evaluate(0, 0.25 - 1e-7, 0.3), hi = shape->evaluate(0, 0.25 + 1e-7, 0.3);
    EXPECT_NEAR(length(lo.P - hi.P), 0, 1e-5);
    EXPECT_NEAR(length(lo.dPdu - hi.dPdu), 0, 1e-3);
    EXPECT_NEAR(length(lo.Puu - hi.Puu), 0, 1e-2); // uniform cubic b-splines are twice continuous
    float g;
    shape->interpolate(shape->findPrimvar("g"), shape->evaluate(0, 0.4, 0.5), &g, nullptr, nullptr);
    EXPECT_FLOAT_EQ(g, 3);
}

TEST(Patch, CollapsedEdgeHasANormal) {
    Diagnostics diag;
    ShapeRef s = build(patch("bilinear", {0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 1, 0}), Matrix(), diag);
    SurfacePoint p = s->evaluate(0, 0.5, 0);
    EXPECT_NEAR(std::fabs(p.n.z), 1, 1e-5);
    EXPECT_NEAR(dot(p.n, s->evaluate(0, 0.5, 0.5).n), 1, 1e-5);
}

TEST(NuPatch, RationalQuarterCircleIsRound) {
    Diagnostics diag;
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "NuPatch";
    p->ints = {3, 3, 2, 2};
    p->numbers = {0, 1, 0, 1};
    float w = std::sqrt(0.5f);
    p->params = {param("uknot", scene::Class::Constant, scene::Type::Float, {0, 0, 0, 1, 1, 1}),
                 param("vknot", scene::Class::Constant, scene::Type::Float, {0, 0, 1, 1}),
                 param("Pw", scene::Class::Vertex, scene::Type::HPoint,
                       {1, 0, 0, 1, w, w, 0, w, 0, 1, 0, 1, 1, 0, 2, 1, w, w, 2 * w, w, 0, 1, 2, 1})};
    ShapeRef s = build(p, Matrix(), diag);
    ASSERT_TRUE(s);
    for (double u : {0.0, 0.2, 0.5, 0.9, 1.0}) {
        SurfacePoint at = s->evaluate(0, u, 0.25);
        EXPECT_NEAR(std::hypot(at.P.x, at.P.y), 1, 1e-6);
        EXPECT_NEAR(at.P.z, 0.5, 1e-6);
        EXPECT_NEAR(std::fabs(at.n.x * at.P.x + at.n.y * at.P.y), 1, 1e-6);
    }
    EXPECT_NEAR(s->area(), kPi, 1e-6); // quarter of 2 pi r h, h = 2
}

// A hemisphere of nine control points (Geomview's themi.bez): those of weight 0 are directions, its own weight is
// (1 - 2u + 2u^2) (1 - 2v + 2v^2). The cosine and sine of an angle are (1 - 2u) and 2u (1 - u) over such a factor.
TEST(NuPatch, ControlPointsAtInfinity) {
    std::vector<float> Pw = {1, 0, 0, 1,  0, 0, 1,  0, -1, 0, 0, 1, 0, 1, 0, 0, 0, 0,
                             0, 0, 0, -1, 0, 0, -1, 0, 0,  1, 0, 0, 1, 0, 1, 0, 0, 1};
    const auto net = [&](Diagnostics& diag) {
        auto p = std::make_shared<scene::Primitive>();
        p->kind = "NuPatch";
        p->ints = {3, 3, 3, 3};
        p->numbers = {0, 1, 0, 1};
        p->params = {param("uknot", scene::Class::Constant, scene::Type::Float, {0, 0, 0, 1, 1, 1}),
                     param("vknot", scene::Class::Constant, scene::Type::Float, {0, 0, 0, 1, 1, 1}),
                     param("Pw", scene::Class::Vertex, scene::Type::HPoint, Pw)};
        return build(p, Matrix(), diag);
    };
    Diagnostics diag;
    const ShapeRef s = net(diag);
    ASSERT_TRUE(s);
    EXPECT_EQ(diag.all().size(), 0u);
    const auto over = [](double x, double y) { return x / (1 - 2 * y + 2 * y * y); };
    for (double u : {0.0, 0.2, 0.5, 0.9, 1.0})
        for (double v : {0.0, 0.3, 0.5, 1.0}) {
            const SurfacePoint at = s->evaluate(0, u, v);
            const double c = over(1 - 2 * u, u);
            EXPECT_NEAR(at.P.x, c * over(1 - 2 * v, v), 1e-6);
            EXPECT_NEAR(at.P.y, c * over(2 * v * (1 - v), v), 1e-6);
            EXPECT_NEAR(at.P.z, over(2 * u * (1 - u), u), 1e-6);
            if (u != 0.5) EXPECT_NEAR(std::fabs(dot(at.n, at.P)), 1, 1e-6) << u << " " << v;
        }
    EXPECT_NEAR(s->area(), 2 * kPi, 1e-4);
    Pw[3] = 0; // a corner: the patch itself goes to infinity
    EXPECT_FALSE(net(diag));
    EXPECT_EQ(diag.errors(), 1);
}

TEST(NuPatch, DerivativesAcrossKnots) {
    Diagnostics diag;
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "NuPatch";
    p->ints = {6, 4, 4, 4};
    p->numbers = {0, 3, 0, 1};
    std::vector<float> P;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 6; ++i) P.insert(P.end(), {float(i) + 0.2f * float(j), float(j), float((i * 7 + j * 3) % 5) * 0.3f});
    p->params = {param("uknot", scene::Class::Constant, scene::Type::Float, {0, 0, 0, 0, 0.5f, 2, 3, 3, 3, 3}),
                 param("vknot", scene::Class::Constant, scene::Type::Float, {0, 0, 0, 0, 1, 1, 1, 1}), points(P)};
    ShapeRef s = build(p, skewed(), diag);
    ASSERT_TRUE(s);
    for (double u : {0.1, 0.35, 0.8})
        for (double v : {0.3, 0.7}) {
            double h = 2e-3;
            SurfacePoint c = s->evaluate(0, u, v), a = s->evaluate(0, u + h, v), b = s->evaluate(0, u - h, v);
            EXPECT_LT(length((a.P - b.P) / float(2 * h) - c.dPdu), 1e-3 * (1 + length(c.dPdu) + length(c.Puu)));
            EXPECT_LT(length((a.dPdu - b.dPdu) / float(2 * h) - c.Puu), 7e-3 * (1 + length(c.dPdu) + length(c.Puu)));
        }
}

TEST(Dicing, FlatnessIsThePixelsThatFacetsStray) {
    // A quarter of a tube of radius 1, 100 pixels a unit: a cubic that strays from the circle by 0.03 pixels, so that n chords
    // stray by 100 (1 - cos(pi / 4n)).
    const double k = 0.5522847498;
    std::vector<float> P;
    for (int j = 0; j < 4; ++j)
        for (const auto& [x, y] : {std::pair{1., 0.}, {1., k}, {k, 1.}, {0., 1.}})
            P.insert(P.end(), {float(x), float(y), float(j)});
    size_t before = 0;
    for (const float flatness : {0.f, 0.5f, 4.f, 0.02f}) {
        scene::Attributes a;
        a.shadingRate = 4;
        setBasis(a.ubasis, {-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0}, 3);
        a.vbasis = a.ubasis;
        if (flatness > 0)
            a.values["GeometricApproximation:flatness"] =
                param("flatness", scene::Class::Uniform, scene::Type::Float, {flatness});
        Diagnostics diag;
        ShapeRef s = build(patch("bicubic", P), Matrix(), diag, a);
        DiceOptions o;
        o.camera.pixelsPerUnit = 100;
        diceShapes({s}, o, diag);
        ASSERT_FALSE(s->exact());
        const TriMesh& m = s->mesh();
        double stray = 0;
        for (size_t t = 0; t + 2 < m.index.size(); t += 3)
            for (int e = 0; e < 3; ++e) {
                const Vec3d p = (Vec3d(m.P[m.index[t + e]]) + Vec3d(m.P[m.index[t + (e + 1) % 3]])) * 0.5;
                stray = std::max(stray, 100 * std::fabs(1 - std::hypot(p.x, p.y)));
            }
        const double allowed = flatness > 0 ? flatness : 0.05 * 2; // else by ShadingRate: the edge of a micropolygon is 2 pixels
        EXPECT_LE(stray, allowed + 0.03) << flatness;
        if (flatness == 0.5f || flatness == 4) EXPECT_LT(m.index.size(), before) << flatness; // fewer facets, as that is enough
        if (flatness == 0.02f) EXPECT_GT(m.index.size(), 2 * before);
        before = m.index.size();
        EXPECT_EQ(diag.errors() + diag.warnings(), 0);
    }
}

} // namespace patch_test
