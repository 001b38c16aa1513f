// Primitive variables by class, their spaces and derivatives; texture coordinates.
#include "make.h"
#include <gtest/gtest.h>

namespace primvars_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using scene::Class;
using scene::Type;

TEST(Primvars, BilinearOnQuadrics) {
    Diagnostics diag;
    auto p = quadric("Sphere", {1, -1, 1, 360});
    p->params = {param("x", Class::Varying, Type::Float, {0, 1, 10, 11}), param("k", Class::Constant, Type::Color, {1, 2, 3})};
    ShapeRef s = build(p, Matrix(), diag);
    SurfacePoint at = s->evaluate(0, 0.25, 0.5);
    float v, du, dv;
    s->interpolate(s->findPrimvar("x"), at, &v, &du, &dv);
    EXPECT_FLOAT_EQ(v, 5.25f); // u + 10 v
    EXPECT_FLOAT_EQ(du, 1);
    EXPECT_FLOAT_EQ(dv, 10);
    float c[3];
    s->interpolate(s->findPrimvar("k"), at, c, nullptr, nullptr);
    EXPECT_FLOAT_EQ(c[2], 3);
}

TEST(Primvars, LinearOverPolygonsWithDerivativesByObjectXAndY) {
    Diagnostics diag;
    auto p = polygon({0, 0, 0, 0, 2, 0, 2, 2, 0, 2, 0, 0});
    p->params.push_back(param("f", Class::Varying, Type::Float, {1, 7, 11, 5})); // 1 + 2x + 3y
    p->params.push_back(param("w", Class::Vertex, Type::Vector, {1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}));
    ShapeRef s = build(p, scaleMatrix(2, 1, 1) * translateMatrix(0, 0, 9), diag);
    SurfacePoint at = s->evaluate(0, 0.5, 1.25);
    float v, du, dv, w[3];
    s->interpolate(s->findPrimvar("f"), at, &v, &du, &dv);
    EXPECT_NEAR(v, 5.75, 1e-5);
    EXPECT_NEAR(du, 2, 1e-5);
    EXPECT_NEAR(dv, 3, 1e-5);
    s->interpolate(s->findPrimvar("w"), at, w, nullptr, nullptr);
    EXPECT_FLOAT_EQ(w[0], 2); // vectors go to camera space
}

TEST(Primvars, FaceVaryingAndUniformOfPolyhedra) {
    Diagnostics diag;
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "PointsPolygons";
    p->ints = {3, 3};
    p->ints2 = {0, 1, 2, 0, 2, 3};
    p->params = {points({0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0}), param("id", Class::Uniform, Type::Float, {4, 5}),
                 param("fv", Class::FaceVarying, Type::Float, {0, 0, 0, 1, 1, 1})};
    ShapeRef s = build(p, Matrix(), diag);
    EXPECT_EQ(s->faces(), 2);
    float v;
    s->interpolate(s->findPrimvar("id"), s->evaluate(1, 0.9, 0.1), &v, nullptr, nullptr);
    EXPECT_FLOAT_EQ(v, 5);
    s->interpolate(s->findPrimvar("fv"), s->evaluate(1, 0.9, 0.1), &v, nullptr, nullptr);
    EXPECT_FLOAT_EQ(v, 1);
    s->interpolate(s->findPrimvar("fv"), s->evaluate(0, 0.1, 0.9), &v, nullptr, nullptr);
    EXPECT_FLOAT_EQ(v, 0);
}

TEST(Primvars, ExplicitNormalsAreTransformedAndUnit) {
    Diagnostics diag;
    auto p = polygon({0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0});
    std::vector<float> n;
    for (int i = 0; i < 4; ++i) n.insert(n.end(), {1, 0, -1});
    p->params.push_back(param("N", Class::Varying, Type::Point, n));
    SurfacePoint at = build(p, scaleMatrix(2, 1, 1), diag)->evaluate(0, 0.5, 0.5);
    // Inverse transpose: (0.5, 0, -1), normalised.
    EXPECT_NEAR(at.N.x, 0.5 / std::sqrt(1.25), 1e-6);
    EXPECT_NEAR(at.N.z, -1 / std::sqrt(1.25), 1e-6);
    EXPECT_NEAR(at.n.z, -1, 1e-6);
}

TEST(Primvars, TextureCoordinatesMapTheCorners) {
    Diagnostics diag;
    scene::Attributes a;
    float tc[8] = {0, 0, 2, 0, 0, 3, 2, 3};
    std::copy(tc, tc + 8, a.textureCoordinates);
    SurfacePoint p = build(quadric("Cylinder", {1, 0, 1, 360}), Matrix(), diag, a)->evaluate(0, 0.25, 0.5);
    EXPECT_FLOAT_EQ(p.s, 0.5f);
    EXPECT_FLOAT_EQ(p.t, 1.5f);
    EXPECT_FLOAT_EQ(p.dsdu, 2);
    EXPECT_FLOAT_EQ(p.dtdv, 3);
}

TEST(Primvars, WrongCountsAreReportedAndLeftOut) {
    Diagnostics diag;
    auto p = quadric("Disk", {0, 1, 360});
    p->params = {param("short", Class::Varying, Type::Float, {1, 2}), param("long", Class::Constant, Type::Float, {1, 2})};
    ShapeRef s = build(p, Matrix(), diag);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->findPrimvar("short"), -1);
    EXPECT_GE(s->findPrimvar("long"), 0);
    EXPECT_EQ(diag.errors(), 1);
    EXPECT_EQ(diag.warnings(), 1);
}

} // namespace primvars_test
