// What a stranger's file may hold: reported, never a crash. And the arithmetic below: roots, triangulation.
#include "geometry/solve.h"
#include "geometry/triangulate.h"
#include "make.h"
#include "scene/scene.h"
#include <cmath>
#include <gtest/gtest.h>

namespace hostile_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;

TEST(Hostile, DegeneratePrimitivesAreReportedAndNotDrawn) {
    float nan = NAN, inf = INFINITY;
    std::vector<std::shared_ptr<scene::Primitive>> bad = {
        quadric("Sphere", {0, -1, 1, 360}),
        quadric("Sphere", {nan, -1, 1, 360}),
        quadric("Sphere", {1, -1, 1}),
        quadric("Sphere", {1, 0, 0, 360}),
        quadric("Cylinder", {1, 2, 2, 360}),
        quadric("Cone", {1, 0, 360}),
        quadric("Torus", {1, 0, 0, 360, 360}),
        quadric("Torus", {1, inf, 0, 360, 360}),
        quadric("Hyperboloid", {0, 0, 0, 0, 0, 1, 360}),
        quadric("Hyperboloid", {1, 1, 1, 1, 1, 1, 360}),
        quadric("Paraboloid", {1, 0, 0, 360}),
        quadric("Disk", {0, 1, 0}),
        polygon({}),
        polygon({0, 0, 0, 1, 1, 1}),
        polygon({0, 0, 0, 1, 1, 1, 2, 2, 2}),
        polygon({0, 0, nan, 1, 0, 0, 0, 1, 0}),
        patch("cubic", bentNet()),
        patch("bicubic", {0, 0, 0}),
        patchMesh("bicubic", 3, "nonperiodic", 4, "nonperiodic", bentNet()),
        patchMesh("bilinear", -5, "nonperiodic", 2000000000, "periodic", bentNet()),
        patchMesh("bilinear", 1 << 24, "periodic", 1 << 24, "periodic", bentNet()),
    };
    auto pp = std::make_shared<scene::Primitive>();
    pp->kind = "PointsPolygons";
    pp->ints = {2000000000, 2000000000};
    pp->ints2 = {0, 1, 2};
    pp->params = {points({0, 0, 0, 1, 0, 0, 0, 1, 0})};
    bad.push_back(pp);
    auto index = std::make_shared<scene::Primitive>(*pp);
    index->ints = {3};
    index->ints2 = {0, 1, 7};
    bad.push_back(index);
    for (auto& p : bad) {
        Diagnostics diag;
        EXPECT_FALSE(build(p, Matrix(), diag)) << p->kind;
        EXPECT_GE(diag.errors() + diag.warnings(), 1) << p->kind;
    }
}

TEST(Hostile, SingularTransformsAndUnknownKinds) {
    Diagnostics diag;
    EXPECT_FALSE(build(quadric("Sphere", {1, -1, 1, 360}), scaleMatrix(1, 0, 1), diag));
    EXPECT_EQ(diag.warnings(), 1);
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(build(quadric("Volume", {}), Matrix(), diag));
    EXPECT_EQ(diag.warnings(), 2); // once a kind
}

// Exporters invert camera matrices in single precision; what that leaves in the last column is not said to be a perspective.
TEST(Hostile, NoiseOfSinglePrecisionIsNoPerspective) {
    for (double w : {0., 3.4e-10, 9.9e-9, -2e-8}) {
        Diagnostics diag;
        Matrix m;
        m.m[0][3] = w;
        m.m[3][2] = 112;
        EXPECT_TRUE(buildShape(quadric("Sphere", {1, -1, 1, 360}), nullptr, m, -1, diag));
        EXPECT_EQ(diag.all().size(), 0u) << w;
    }
    Diagnostics diag;
    Matrix m;
    m.m[2][3] = .01;
    buildShape(quadric("Sphere", {1, -1, 1, 360}), nullptr, m, -1, diag);
    ASSERT_EQ(diag.all().size(), 1u);
    EXPECT_NE(diag.all()[0].message.find("perspective"), std::string::npos);
}

TEST(Hostile, AbandonedInstanceIsReported) {
    scene::Frame f;
    f.instances.push_back({3, {}, nullptr, {}});
    Diagnostics diag;
    EXPECT_TRUE(buildShapes(f, diag).empty());
    EXPECT_EQ(diag.errors(), 1);
}

TEST(Instances, ComposeTransforms) {
    scene::Frame f;
    auto p = quadric("Sphere", {1, -1, 1, 360});
    p->toWorld = scene::Transform(translateMatrix(1, 0, 0));
    f.objects.push_back({"o", {p}});
    f.instances.push_back({0, scene::Transform(translateMatrix(0, 2, 0)), std::make_shared<scene::Attributes>(), {}});
    f.options.worldToCamera = scene::Transform(translateMatrix(0, 0, 5));
    Diagnostics diag;
    auto s = buildShapes(f, diag);
    ASSERT_EQ(s.size(), 1u);
    EXPECT_NEAR(length(s[0]->evaluate(0, 0, 0.5).P - Vec3(2, 2, 5)), 0, 1e-6);
}

// RISpec 3.2, 5.10: an instance's attributes count, but what was set inside the object holds in every instance.
TEST(Instances, AttributesSetInsideTheObjectHold) {
    auto before = std::make_shared<scene::Attributes>();
    before->color = Color(1, 0, 0);
    auto inside = std::make_shared<scene::Attributes>(*before);
    inside->opacity = Color(.5f, .5f, .5f);
    inside->values["user:x"].numbers = {1};
    auto call = std::make_shared<scene::ShaderCall>();
    call->name = "wood";
    call->toWorld = scene::Transform(translateMatrix(1, 0, 0));
    inside->displacement = call;
    auto of = std::make_shared<scene::Attributes>();
    of->color = Color(0, 1, 0);
    of->opacity = Color(.25f, .25f, .25f);
    of->lights = {0, 3};
    of->surface = std::make_shared<scene::ShaderCall>();
    scene::Frame f;
    auto plain = quadric("Sphere", {1, -1, 1, 360}), own = quadric("Sphere", {1, -1, 1, 360});
    plain->attributes = before;
    own->attributes = inside;
    own->attributesInside = true;
    own->attributesBefore = before;
    f.objects.push_back({"o", {plain, own, own}});
    f.instances.push_back({0, scene::Transform(translateMatrix(0, 2, 0)), of, {}});
    Diagnostics diag;
    auto s = buildShapes(f, diag);
    ASSERT_EQ(s.size(), 3u);
    EXPECT_EQ(&s[0]->attributes(), of.get()) << "nothing was set: the instance's";
    for (int k : {1, 2}) {
        const scene::Attributes& a = s[size_t(k)]->attributes();
        EXPECT_EQ(a.color, Color(0, 1, 0)) << "not set inside: the instance's";
        EXPECT_EQ(a.opacity, Color(.5f, .5f, .5f));
        EXPECT_EQ(a.lights, (std::vector<int>{0, 3}));
        EXPECT_EQ(a.surface, of->surface);
        ASSERT_TRUE(a.displacement);
        EXPECT_EQ(a.displacement->toWorld.first(), translateMatrix(1, 2, 0)) << "shader space goes with the instance";
        EXPECT_EQ(a.values.at("user:x").numbers.at(0), 1);
    }
    EXPECT_EQ(&s[1]->attributes(), &s[2]->attributes()) << "shared";
}

TEST(Solve, QuarticRoots) {
    // (t - 1)(t - 2)(t + 3)(t - 4)
    double c[5] = {-24, 34, -7, -4, 1}, t[4];
    ASSERT_EQ(polynomialRoots(c, 4, -10, 10, t), 4);
    EXPECT_NEAR(t[0], -3, 1e-12);
    EXPECT_NEAR(t[1], 1, 1e-12);
    EXPECT_NEAR(t[2], 2, 1e-12);
    EXPECT_NEAR(t[3], 4, 1e-12);
    EXPECT_EQ(polynomialRoots(c, 4, 1.5, 3, t), 1);
    double none[5] = {1, 0, 0, 0, 1};
    EXPECT_EQ(polynomialRoots(none, 4, -10, 10, t), 0);
}

TEST(Solve, QuadraticWithoutCancellation) {
    double t[2];
    ASSERT_EQ(solveQuadratic(1, -5e7, 1, t), 2); // roots 1e-8 and 1e8
    EXPECT_NEAR(t[0] * 1e8, 1, 1e-12);
    EXPECT_EQ(solveQuadratic(0, 0.5, -2, t), 1);
    EXPECT_EQ(t[0], 2);
    EXPECT_EQ(solveQuadratic(1, 0, 1, t), 0);
    EXPECT_EQ(solveQuadratic(NAN, 0, 1, t), 0);
}

namespace {
double areaOf(const std::vector<Vec3d>& p, const std::vector<uint32_t>& tri, const Vec3d& n) {
    double s = 0;
    for (size_t i = 0; i + 2 < tri.size(); i += 3)
        s += 0.5 * dot(cross(p[tri[i + 1]] - p[tri[i]], p[tri[i + 2]] - p[tri[i]]), normalize(n));
    return s;
}
} // namespace

TEST(Triangulate, ConcaveAndHolesKeepTheirArea) {
    // A 10 by 10 square with two holes of 2 by 2 (either winding) and a notch of 1 by 5 cut from the top.
    std::vector<Vec3d> p = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {5.5, 10, 0}, {5.5, 5, 0}, {4.5, 5, 0}, {4.5, 10, 0}, {0, 10, 0},
                            {1, 1, 0}, {3, 1, 0},  {3, 3, 0},   {1, 3, 0},    {7, 1, 0},   {7, 3, 0},   {9, 3, 0},    {9, 1, 0}};
    for (auto& q : p) q.z = q.x * 0.5 + q.y * 0.25; // any plane
    std::vector<int> loops = {8, 4, 4};
    std::vector<uint32_t> tri;
    Vec3d n;
    EXPECT_EQ(triangulate(p, loops, tri, n), TriangulationResult::Good);
    EXPECT_EQ(tri.size() / 3, 16u + 2 * 2 - 2);
    double stretch = std::sqrt(1 + 0.25 + 0.0625);
    EXPECT_NEAR(areaOf(p, tri, n), (100 - 8 - 5) * stretch, 1e-9);
    for (size_t i = 0; i < tri.size(); i += 3) EXPECT_GE(dot(cross(p[tri[i + 1]] - p[tri[i]], p[tri[i + 2]] - p[tri[i]]), n), 0);
}

TEST(Triangulate, FlatCornersKeepTheirPlace) {
    // A square with a corner in the middle of each side: neighbours may share those, so every one must be a triangle's corner.
    std::vector<Vec3d> p = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    std::vector<int> loop = {8};
    std::vector<uint32_t> tri;
    Vec3d n;
    EXPECT_EQ(triangulate(p, loop, tri, n), TriangulationResult::Good);
    EXPECT_EQ(tri.size() / 3, 6u);
    EXPECT_NEAR(areaOf(p, tri, n), 4, 1e-12);
    for (uint32_t k = 0; k < 8; ++k) EXPECT_NE(std::find(tri.begin(), tri.end(), k), tri.end()) << k;
}

TEST(Triangulate, StarAndCrossingLoopsEnd) {
    std::vector<Vec3d> star, cross;
    for (int i = 0; i < 200; ++i) {
        double r = i % 2 ? 1 : 3, a = i * kPi / 100;
        star.push_back({r * std::cos(a), r * std::sin(a), 0});
        cross.push_back({std::cos(a * 7.3) * 2, std::sin(a * 13.1), 0});
    }
    std::vector<uint32_t> tri;
    Vec3d n;
    std::vector<int> loop = {200};
    EXPECT_EQ(triangulate(star, loop, tri, n), TriangulationResult::Good);
    EXPECT_NEAR(areaOf(star, tri, n), 100 * 1 * 3 * std::sin(kPi / 100), 1e-9); // 200 triangles of r1 r2 sin / 2
    tri.clear();
    triangulate(cross, loop, tri, n);
    for (uint32_t i : tri) EXPECT_LT(i, 200u);
}

TEST(Dice, MeshStaysNearTheSurfaceAndCountsAreCapped) {
    Diagnostics diag;
    ShapeRef s = build(patch("bicubic", bentNet()), translateMatrix(0, 0, 3), diag);
    DiceOptions opt;
    opt.camera = {true, 500};
    s->dice(opt, diag);
    ASSERT_FALSE(s->exact());
    // A facet point strays by at most a tenth of a pixel: 0.1 / 500 * distance 3.
    for (uint32_t t = 0; t < s->mesh().triangles(); ++t) EXPECT_LT(s->evaluateHit(t, 0.3, 0.4).pError, 0.1 * 3 / 500 * 1.2);
    Diagnostics close;
    ShapeRef big = build(patch("bicubic", bentNet()), scaleMatrix(1e5, 1e5, 1e5), close);
    opt.camera = {true, 1e9};
    big->dice(opt, close);
    EXPECT_LE(big->mesh().triangles(), 8'100'000u);
    EXPECT_GE(close.all().size(), 1u);
}

TEST(Dice, DisplacementMovesTheMeshAndReportsItsBound) {
    Diagnostics diag;
    scene::Attributes a;
    a.displacement = std::make_shared<scene::ShaderCall>();
    a.values["displacementbound:sphere"] = param("sphere", scene::Class::Uniform, scene::Type::Float, {0.1f});
    DiceOptions opt;
    opt.camera = {true, 50};
    opt.displace = [](const Shape&, DiceGrid& g) {
        for (size_t i = 0; i < g.P.size(); ++i) g.P[i] += g.points[i].n * 0.25f;
    };
    for (auto& prim : {quadric("Sphere", {1, -1, 1, 360}), polygon({0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0})}) {
        Diagnostics own;
        ShapeRef s = build(prim, translateMatrix(0, 0, 5), own, a);
        s->dice(opt, own);
        ASSERT_FALSE(s->exact());
        EXPECT_EQ(own.warnings(), 1); // beyond the bound of 0.1
        SurfacePoint p = s->evaluateHit(s->mesh().triangles() / 2, 0, 0);
        EXPECT_TRUE(p.displaced);
        EXPECT_NEAR(length(p.displacedP - p.P), 0.25, 1e-5) << prim->kind;
        EXPECT_GT(dot(p.displacedN, p.n), 0.9) << prim->kind;
    }
}

// Exporters write them by the thousand: one message of each kind, with the number.
TEST(Hostile, PolygonsWithoutAreaAreCounted) {
    const std::vector<float> none = {0, 0, 0, 1, 1, 1, 2, 2, 2};
    for (const auto& [polygons, said] :
         {std::pair{1, "Polygon has no area; it is not drawn"}, {3, "Polygon has no area; it is not drawn (this and 2 more)"}}) {
        scene::Frame f;
        for (int i = 0; i < polygons; ++i) {
            auto p = polygon(none);
            p->place = {"a.rib", 10 + i, 1};
            p->attributes = std::make_shared<scene::Attributes>();
            f.primitives.push_back(p);
        }
        Diagnostics d;
        EXPECT_TRUE(buildShapes(f, d).empty());
        ASSERT_EQ(d.all().size(), 1u);
        EXPECT_EQ(d.all()[0].message, said);
        EXPECT_EQ(d.all()[0].place.line, 10);
        EXPECT_EQ(d.warnings(), 1);
    }
}

} // namespace hostile_test
