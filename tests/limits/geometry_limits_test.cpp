// What one primitive and one frame may cost.
#include "base/limits.h"
#include "geometry/make.h"
#include "geometry/triangulate.h"
#include "scene/scene.h"
#include <cmath>
#include <gtest/gtest.h>

namespace geometry_limits_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;

namespace {

/// Diced with a displacement shader that moves every point by (0, 0, by).
ShapeRef displaced(const std::shared_ptr<scene::Primitive>& p, double pixelsPerUnit, float by, Diagnostics& d) {
    scene::Attributes a;
    a.displacement = std::make_shared<scene::ShaderCall>();
    ShapeRef s = build(p, Matrix(), d, a);
    EXPECT_TRUE(s);
    if (!s) return s;
    DiceOptions o;
    o.camera.pixelsPerUnit = pixelsPerUnit;
    o.displace = [by](const Shape&, DiceGrid& g) {
        for (Vec3& x : g.P) x.z += by;
    };
    diceShapes({s}, o, d);
    return s;
}

std::vector<float> square(float w, float h) { return {0, 0, 0, w, 0, 0, 0, h, 0, w, h, 0}; }

int limitsSaid(const Diagnostics& d) {
    int n = 0;
    for (const Diagnostic& m : d.all()) n += m.code == Rie::Limit;
    return n;
}

} // namespace

TEST(GeometryLimits, StepsAlongOneEdge) {
    // A strip a million pixels long and one pixel wide: kDiceEdge steps, no more.
    Diagnostics d;
    ShapeRef s = displaced(patch("bilinear", square(1e6f, 1)), 1, 0, d);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->mesh().triangles(), 2u * unsigned(limits::kDiceEdge));
}

TEST(GeometryLimits, WhatIsDearToDiceIsNamed) {
    scene::Attributes a;
    a.displacement = std::make_shared<scene::ShaderCall>();
    a.shadingRate = 4;
    Diagnostics d;
    const ShapeRef small = build(patch("bilinear", square(10, 10)), Matrix(), d, a),
                   large = build(patch("bilinear", square(200, 200)), Matrix(), d, a);
    DiceOptions o;
    o.camera.pixelsPerUnit = 1;
    o.displace = [](const Shape&, DiceGrid&) {};
    diceShapes({small, large}, o, d);
    EXPECT_TRUE(d.all().empty());
    // About 100 by 100 micropolygons: 10,000 points of 20 bytes, 20,000 triangles of 12 bytes.
    o.noteBytes = 400'000;
    diceShapes({small, large}, o, d);
    ASSERT_EQ(d.all().size(), 1u);
    EXPECT_EQ(d.all()[0].severity, Severity::Info);
    EXPECT_NE(d.all()[0].message.find("facets at ShadingRate 4"), std::string::npos) << d.all()[0].message;
    EXPECT_NE(d.all()[0].hint.find("ShadingRate"), std::string::npos);
    o.noteBytes = 500'000;
    diceShapes({small, large}, o, d);
    EXPECT_EQ(d.all().size(), 1u);
}

TEST(GeometryLimits, MicropolygonsOfOnePrimitive) {
    // 2100 pixels squared are 4.4 million micropolygons.
    static_assert(limits::kDiceQuads < 2100u * 2100u);
    Diagnostics d;
    ShapeRef s = displaced(patch("bilinear", square(2100, 2100)), 1, 0, d);
    ASSERT_TRUE(s);
    EXPECT_LE(s->mesh().triangles(), 2 * limits::kDiceQuads);
    EXPECT_GE(s->mesh().triangles(), limits::kDiceQuads / 2);
    EXPECT_EQ(limitsSaid(d), 1);
}

// The weight of a patch vanishes along a line: it reaches as far as can be, and is cut no finer than others.
TEST(GeometryLimits, MicropolygonsWhereAWeightVanishes) {
    Diagnostics d;
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "NuPatch";
    p->ints = {2, 2, 2, 2};
    p->numbers = {0, 1, 0, 1};
    p->params = {param("uknot", scene::Class::Uniform, scene::Type::Float, {0, 0, 1, 1}),
                 param("vknot", scene::Class::Uniform, scene::Type::Float, {0, 0, 1, 1}),
                 param("Pw", scene::Class::Vertex, scene::Type::HPoint, {-1, -1, 0, 1, 1, -1, 0, -1, -1, 1, 0, 1, 1, 1, 0, -1})};
    ShapeRef s = displaced(p, 50, 0, d);
    ASSERT_TRUE(s);
    EXPECT_LE(s->mesh().triangles(), 3 * limits::kDiceQuads); // sides may have twice as many
}

// A corner lies so far away that a face is longer than its least scale brings down.
TEST(GeometryLimits, MicropolygonsOfAFaceOfEndlessLength) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "SubdivisionMesh";
    p->strings = {"catmull-clark"};
    p->ints = {4, 4, 4, 4, 4, 4};
    p->ints2 = {0, 1, 3, 2, 2, 3, 5, 4, 4, 5, 7, 6, 6, 7, 1, 0, 1, 7, 5, 3, 6, 0, 2, 4};
    p->params = {points({-.5f, -.5f, .5f,  .5f, -.5f, .5f,  -.5f, .5f,  .5f,  .5f, .5f,  .5f,
                         -.5f, .5f,  -.5f, .5f, .5f,  -.5f, -.5f, -.5f, -.5f, .5f, -.5f, -1e30f})};
    Diagnostics d;
    const ShapeRef s = build(p, Matrix(), d);
    ASSERT_TRUE(s);
    DiceOptions o;
    o.camera.pixelsPerUnit = 1e20;
    diceShapes({s}, o, d);
    EXPECT_LE(s->mesh().triangles(), 2 * limits::kDiceQuads);
    EXPECT_EQ(limitsSaid(d), 1);
}

TEST(GeometryLimits, DisplacementTooFar) {
    Diagnostics d;
    ShapeRef s = displaced(patch("bilinear", square(1, 1)), 4, limits::kDisplacementBound * 1.5f, d);
    ASSERT_TRUE(s);
    EXPECT_EQ(limitsSaid(d), 1);
    EXPECT_EQ(s->bounds().hi.z, 0); // stays where it was
    Diagnostics fine;
    ShapeRef moved = displaced(patch("bilinear", square(1, 1)), 4, limits::kDisplacementBound * 0.5f, fine);
    ASSERT_TRUE(moved);
    EXPECT_EQ(limitsSaid(fine), 0);
    EXPECT_EQ(moved->bounds().hi.z, limits::kDisplacementBound * 0.5f);
}

TEST(GeometryLimits, ControlPoints) {
    const int side = int(std::sqrt(double(limits::kControlPoints)));
    for (auto [nu, nv] : {std::pair{side + 1, side + 1}, {2, 2'000'000'000}, {2'000'000'000, 2'000'000'000}}) {
        Diagnostics d;
        EXPECT_FALSE(build(patchMesh("bilinear", nu, "nonperiodic", nv, "nonperiodic", square(1, 1)), Matrix(), d));
        EXPECT_GE(d.errors(), 1) << nu;
    }
    Diagnostics d;
    build(patchMesh("bilinear", side + 1, "nonperiodic", side + 1, "nonperiodic", square(1, 1)), Matrix(), d);
    EXPECT_EQ(limitsSaid(d), 1);
}

TEST(GeometryLimits, Shapes) {
    static_assert(limits::kShapes >= 1'000'000); // the same code with a smaller number
    scene::Frame f;
    auto p = quadric("Sphere", {1, -1, 1, 360});
    p->attributes = std::make_shared<scene::Attributes>();
    f.objects.push_back({"o", {p, p, p}});
    for (int i = 0; i < 40; ++i) f.instances.push_back({0, {}, std::make_shared<scene::Attributes>(), {}});
    for (size_t most : {size_t(99), size_t(100)}) { // at the end of an instance, and within one
        Diagnostics d;
        EXPECT_EQ(buildShapes(f, d, {.most = most}).size(), most);
        EXPECT_EQ(limitsSaid(d), 1);
    }
    Diagnostics enough;
    EXPECT_EQ(buildShapes(f, enough, {.most = 120}).size(), 120u);
    EXPECT_EQ(limitsSaid(enough), 0);
}

TEST(GeometryLimits, ConcavePolygonsEndInTime) {
    // A comb: to cut a tooth off, its triangle is tested against all corners between the teeth that are left, so the tests are
    // about the square of the teeth. The same code with a smaller number, after which the rest is guessed.
    static_assert(limits::kTriangulationTests >= 1'000'000);
    const int teeth = 300;
    std::vector<Vec3d> p;
    for (int i = 0; i < teeth; ++i) {
        p.push_back({double(i), 0.0, 0.0});
        p.push_back({i + 0.5, 1.0 + 0.01 * double(i) * (teeth - i), 0.0}); // the valleys form an arch
    }
    p.push_back({double(teeth), 0.0, 0.0});
    p.push_back({double(teeth), 1e6, 0.0});
    p.push_back({-1.0, 1e6, 0.0});
    const int loop = int(p.size());
    for (size_t most : {limits::kTriangulationTests, size_t(1000)}) {
        std::vector<uint32_t> out;
        Vec3d normal;
        EXPECT_EQ(triangulate(p, std::span(&loop, 1), out, normal, most),
                  most == 1000 ? TriangulationResult::Forced : TriangulationResult::Good);
        EXPECT_EQ(out.size(), 3 * (p.size() - 2));
        for (uint32_t i : out) ASSERT_LT(i, p.size());
    }
}

namespace {

std::shared_ptr<scene::Primitive> subdivision(int n, const std::string& kind, const std::vector<std::string>& tags) {
    // n x n quadrilaterals over the unit square.
    auto p = std::make_shared<scene::Primitive>();
    p->kind = kind;
    p->strings = {"catmull-clark"};
    p->strings.insert(p->strings.end(), tags.begin(), tags.end());
    std::vector<float> P;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) P.insert(P.end(), {float(i) / float(n), float(j) / float(n), 0});
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i;
            p->ints.push_back(4);
            p->ints2.insert(p->ints2.end(), {a, a + 1, a + n + 2, a + n + 1});
        }
    p->params = {points(P)};
    return p;
}

} // namespace

// One point at 1e38, or at 2^31: what reaches so far is cut no finer than a picture could show it, and a scene that is far and
// large looks as it does from near.
TEST(GeometryLimits, APointThatIsFarAway) {
    DiceOptions o;
    o.camera.perspective = true;
    o.camera.pixelsPerUnit = 500;
    const auto facets = [&](const std::shared_ptr<scene::Primitive>& p, double scale) {
        Diagnostics d;
        scene::Attributes a;
        a.ubasis = a.vbasis = {
            {{-1 / 6., .5, -.5, 1 / 6.}, {.5, -1, .5, 0}, {-.5, 0, .5, 0}, {1 / 6., 4 / 6., 1 / 6., 0}}, 1, "b-spline"};
        const ShapeRef s = build(p, scaleMatrix(scale, scale, scale) * translateMatrix(0, 0, 5 * scale), d, a);
        EXPECT_TRUE(s);
        if (!s) return size_t(0);
        diceShapes({s}, o, d);
        return size_t(s->mesh().triangles());
    };
    std::vector<float> net;
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 9; ++i) net.insert(net.end(), {.2f * float(i) - .8f, .15f * float(j) - .5f, .05f * float(i * j % 5)});
    const auto curtain = [&](float far) {
        std::vector<float> P = net;
        P[3 * 9] = far;
        return patchMesh("bicubic", 9, "nonperiodic", 8, "nonperiodic", P);
    };
    const size_t near = facets(curtain(-.8f), 1);
    EXPECT_GT(near, 1000u);
    EXPECT_EQ(facets(curtain(-.8f), 0x1p30), near);
    EXPECT_EQ(facets(curtain(-.8f), std::exp2(std::floor(std::log2(limits::kDiceDistance / 16)))), near);
    EXPECT_LT(facets(curtain(1e38f), 1), 200'000u);
    const auto cage = [&](float far) {
        auto p = subdivision(8, "SubdivisionMesh", {});
        p->params[0].numbers[3 * 40 + 2] = far;
        return p;
    };
    EXPECT_GT(facets(cage(.1f), 1), 100u);
    EXPECT_LE(facets(cage(0x1p31f), 1), 3u * 64 * 64 * 64); // 64 faces
}

TEST(GeometryLimits, EditsOfSubdivisionSurfaces) {
    // Ten levels of 16 faces would be 16 million: kEditedFaces corners stop it, the surface is drawn.
    static_assert(16ull * 4 << 20 > limits::kEditedFaces);
    Diagnostics d;
    auto p = subdivision(4, "HierarchicalSubdivisionMesh", {"interpolateboundary", "vertexedit"});
    p->ints3 = {0, 0, 0, 13, 3, 3};
    p->params.push_back(param("intargs", scene::Class::Constant, scene::Type::Integer, {12, 5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2}));
    p->params.push_back(param("floatargs", scene::Class::Constant, scene::Type::Float, {0, 0, 1}));
    scene::Param strings = param("stringargs", scene::Class::Constant, scene::Type::String, {});
    strings.strings = {"add", "P", "value"};
    p->params.push_back(strings);
    ShapeRef s = build(p, Matrix(), d);
    ASSERT_TRUE(s);
    EXPECT_EQ(limitsSaid(d), 1);
    EXPECT_LE(size_t(s->faces()), limits::kEditedFaces);
}

TEST(GeometryLimits, PatternsOfSubdivisionSurfaces) {
    // Creases of many degrees give nearly every face a neighbourhood of its own, some of 1 MiB: kLimitPatternBytes ends that, and
    // says so.
    Diagnostics d;
    auto p = subdivision(40, "SubdivisionMesh", {"interpolateboundary"});
    p->ints3 = {0, 0};
    std::vector<float> ends, sharp;
    for (int k = 0; k < 700; ++k) {
        const int a = (k / 18 + 1) * 41 + 2 * (k % 18) + 2;
        p->strings.push_back("crease");
        p->ints3.insert(p->ints3.end(), {2, 1});
        ends.insert(ends.end(), {float(a), float(a + 1)});
        sharp.push_back(7 + float(k) / 300);
    }
    p->params.push_back(param("intargs", scene::Class::Constant, scene::Type::Integer, ends));
    p->params.push_back(param("floatargs", scene::Class::Constant, scene::Type::Float, sharp));
    ShapeRef s = build(p, Matrix(), d);
    ASSERT_TRUE(s);
    EXPECT_EQ(limitsSaid(d), 1);
    EXPECT_GT(limits::kLimitPatternBytes, size_t(1) << 20);
}

} // namespace geometry_limits_test
