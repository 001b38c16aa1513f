// Partials and normals of every primitive against central differences of its own positions (T12, 1e-3), positions against
// docs/design/ri.md, areas against closed forms, orientation against RISpec 3.2, 4.2.
#include "make.h"
#include <cmath>
#include <gtest/gtest.h>

namespace derivatives_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;

namespace {

struct Case {
    std::string name;
    std::shared_ptr<scene::Primitive> prim;
};

std::vector<Case> parametricCases() {
    return {
        {"sphere", quadric("Sphere", {2, -1.5f, 1.2f, 290})},
        {"sphere negative sweep", quadric("Sphere", {2, -2, 2, -200})},
        {"sphere swapped", quadric("Sphere", {1, 0.8f, -0.3f, 360})},
        {"sphere negative radius", quadric("Sphere", {-1, -0.8f, 0.3f, 360})},
        {"cone", quadric("Cone", {2, 0.7f, 360})},
        {"cylinder", quadric("Cylinder", {0.6f, -1, 2, 250})},
        {"hyperboloid", quadric("Hyperboloid", {0.4f, -0.4f, -0.4f, 0.4f, 0.4f, 0.4f, 360})},
        {"paraboloid", quadric("Paraboloid", {0.5f, 0.1f, 0.9f, 360})},
        {"disk", quadric("Disk", {0.3f, 1.5f, 270})},
        {"torus", quadric("Torus", {1, 0.3f, 0, 360, 360})},
        {"torus part", quadric("Torus", {0.75f, 0.45f, 90, 180, 360})},
        {"bilinear", patch("bilinear", {0, 0, 0, 1, 0, 0.3f, 0, 1, -0.2f, 1.2f, 1, 0.5f})},
        {"bicubic", patch("bicubic", bentNet())},
    };
}

Vec3d central(const Vec3& hi, const Vec3& lo, double h) { return (Vec3d(hi) - Vec3d(lo)) / (2 * h); }

void near(const Vec3d& a, const Vec3d& b, double scale, const std::string& what) {
    EXPECT_LT(length(a - b), 1e-3 * scale) << what << ": " << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y
                                           << " " << b.z;
}

} // namespace

TEST(Derivatives, PartialsAndNormalsOfParametricSurfaces) {
    Diagnostics diag;
    for (const Matrix& m : {Matrix(), skewed(), skewed() * scaleMatrix(1, 1, -1)})
        for (const Case& c : parametricCases()) {
            ShapeRef s = build(c.prim, m, diag);
            ASSERT_TRUE(s) << c.name;
            for (double u : {0.13, 0.5, 0.81})
                for (double v : {0.2, 0.47, 0.9}) {
                    double h = 2e-3;
                    SurfacePoint p = s->evaluate(0, u, v), a = s->evaluate(0, u + h, v), b = s->evaluate(0, u - h, v),
                                 d = s->evaluate(0, u, v + h), e = s->evaluate(0, u, v - h);
                    double scale = 1 + length(p.dPdu) + length(p.dPdv) + length(p.Puu) + length(p.Pvv);
                    near(Vec3d(p.dPdu), central(a.P, b.P, h), scale, c.name + " dPdu");
                    near(Vec3d(p.dPdv), central(d.P, e.P, h), scale, c.name + " dPdv");
                    near(Vec3d(p.Puu), central(a.dPdu, b.dPdu, h), scale * 7, c.name + " Puu");
                    near(Vec3d(p.Puv), central(a.dPdv, b.dPdv, h), scale * 7, c.name + " Puv");
                    near(Vec3d(p.Pvv), central(d.dPdv, e.dPdv, h), scale * 7, c.name + " Pvv");
                    double ns = 1 + length(p.dNdu) + length(p.dNdv);
                    near(Vec3d(p.dNdu), central(a.N, b.N, h), ns * 5, c.name + " dNdu");
                    near(Vec3d(p.dNdv), central(d.N, e.N, h), ns * 5, c.name + " dNdv");
                    Vec3d g = cross(Vec3d(p.dPdu), Vec3d(p.dPdv)) * double(p.orientation);
                    near(Vec3d(p.n), normalize(g), 1, c.name + " n");
                    near(Vec3d(p.Ng), g, length(g), c.name + " Ng");
                }
        }
    EXPECT_EQ(diag.errors(), 0);
}

TEST(Derivatives, QuadricPositionsAreThoseOfTheReference) {
    Diagnostics diag;
    auto at = [&](const std::shared_ptr<scene::Primitive>& p, double u, double v) {
        return build(p, Matrix(), diag)->evaluate(0, u, v).P;
    };
    auto expect = [](Vec3 p, double x, double y, double z) {
        EXPECT_NEAR(p.x, x, 1e-6);
        EXPECT_NEAR(p.y, y, 1e-6);
        EXPECT_NEAR(p.z, z, 1e-6);
    };
    double q = std::sqrt(0.5);
    expect(at(quadric("Sphere", {2, -2, 2, 360}), 0.25, 0.75), 0, 2 * q, 2 * q); // theta 90, phi 45 degrees
    expect(at(quadric("Sphere", {2, 0, 1, 180}), 0.5, 1), 0, std::sqrt(3.0), 1); // phimax = asin(1/2)
    expect(at(quadric("Cone", {2, 1, 360}), 0.5, 0.25), -0.75, 0, 0.5);
    expect(at(quadric("Cylinder", {1, -1, 3, 90}), 1, 0.5), 0, 1, 1);
    expect(at(quadric("Hyperboloid", {1, 0, 0, 0, 1, 2, 360}), 0.25, 0.5), -0.5, 0.5, 1);
    expect(at(quadric("Paraboloid", {2, 0, 4, 360}), 0, 0.25), 1, 0, 1);
    expect(at(quadric("Disk", {3, 2, 360}), 0.75, 0.5), 0, -1, 3);
    expect(at(quadric("Torus", {2, 0.5f, 0, 360, 360}), 0.5, 0.25), -2, 0, 0.5);
}

TEST(Area, ClosedForms) {
    Diagnostics diag;
    auto area = [&](const std::shared_ptr<scene::Primitive>& p) { return build(p, translateMatrix(1, 2, 3), diag)->area(); };
    EXPECT_NEAR(area(quadric("Sphere", {2, -2, 2, 360})), 16 * kPi, 1e-6);
    EXPECT_NEAR(area(quadric("Sphere", {2, -1, 1, 180})), 4 * kPi, 1e-6); // zone: 2 pi r h, half a turn
    EXPECT_NEAR(area(quadric("Cylinder", {0.5f, -1, 1, 360})), 2 * kPi, 1e-6);
    EXPECT_NEAR(area(quadric("Cone", {3, 4, 360})), 20 * kPi, 1e-6); // pi r l, l = 5
    EXPECT_NEAR(area(quadric("Disk", {0, 2, 90})), kPi, 1e-6);
    EXPECT_NEAR(area(quadric("Torus", {2, 0.5f, 0, 360, 360})), 4 * kPi * kPi, 1e-6);
    // Paraboloid r = 1 at z = 1: pi/6 (5^1.5 - 1); its parametrisation has a root at the apex.
    EXPECT_NEAR(area(quadric("Paraboloid", {1, 0, 1, 360})), kPi / 6 * (std::pow(5, 1.5) - 1), 1e-2);
    EXPECT_NEAR(area(patch("bilinear", {0, 0, 0, 2, 0, 0, 0, 3, 0, 2, 3, 0})), 6, 1e-9);
    EXPECT_NEAR(area(polygon({0, 0, 0, 0, 2, 0, 3, 2, 0, 3, 0, 0})), 6, 1e-9);
}

TEST(Area, SampledPointsHaveTheStatedDensity) {
    // Mean of 1 / density over the samples is the area.
    Diagnostics diag;
    for (auto& p : {quadric("Sphere", {1, -1, 1, 360}), quadric("Torus", {1, 0.3f, 0, 360, 360}), patch("bicubic", bentNet()),
                    polygon({0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0})}) {
        ShapeRef s = build(p, skewed(), diag);
        double sum = 0;
        int n = 64;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) sum += 1 / s->sampleDensity(s->sampleArea((i + 0.5) / n, (j + 0.5) / n));
        EXPECT_NEAR(sum / (n * n), s->area(), 2e-3 * s->area()) << p->kind;
    }
}

TEST(Orientation, NormalsFollowTheRules) {
    Diagnostics diag;
    auto outward = [&](const Matrix& m, const scene::Attributes& a, const std::shared_ptr<scene::Primitive>& prim) {
        ShapeRef s = build(prim, m, diag, a);
        SurfacePoint p = s->evaluate(0, 0.3, 0.6);
        Vec3d centre = transformPoint(m, Vec3d(0.0));
        return dot(Vec3d(p.n), Vec3d(p.P) - centre) > 0 ? 1 : -1;
    };
    auto sphere = quadric("Sphere", {1, -1, 1, 360});
    Matrix plain = translateMatrix(0, 0, 5), mirror = scaleMatrix(-1, 1, 1) * plain;
    scene::Attributes outside, inside, lh, rh;
    inside.inside = true;
    lh.absoluteHandedness = rh.absoluteHandedness = true;
    rh.rightHanded = true;
    EXPECT_EQ(outward(plain, outside, sphere), 1);
    EXPECT_EQ(outward(mirror, outside, sphere), 1); // flips with the handedness, so the outside stays outside
    EXPECT_EQ(outward(plain, inside, sphere), -1);
    EXPECT_EQ(outward(mirror, inside, sphere), -1);
    EXPECT_EQ(outward(plain, lh, sphere), 1); // dPdu ^ dPdv as it is in left-handed camera space
    EXPECT_EQ(outward(plain, rh, sphere), -1);
    EXPECT_EQ(outward(mirror, lh, sphere), -1);
    EXPECT_EQ(outward(mirror, rh, sphere), 1);
}

TEST(Orientation, PolygonNormalFollowsTheWinding) {
    // Left-handed camera space: a face wound clockwise as the viewer sees it faces the viewer (-z).
    Diagnostics diag;
    ShapeRef s = build(polygon({0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0}), translateMatrix(0, 0, 5), diag);
    SurfacePoint p = s->evaluate(0, 0.5, 0.25);
    EXPECT_NEAR(p.n.z, -1, 1e-6);
    EXPECT_EQ(p.orientation, -1); // dPdu ^ dPdv of object x and y is +z
    EXPECT_NEAR(dot(normalize(p.Ng), p.n), 1, 1e-6);
    EXPECT_FLOAT_EQ(p.u, 0.5f);
    EXPECT_FLOAT_EQ(p.v, 0.25f);
    EXPECT_FLOAT_EQ(p.s, 0.5f);
    ShapeRef back = build(polygon({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), translateMatrix(0, 0, 5), diag);
    EXPECT_NEAR(back->evaluate(0, 0.5, 0.25).n.z, 1, 1e-6);
}

TEST(Polygon, PartialsFollowObjectXAndYOrTheFallbackFrame) {
    Diagnostics diag;
    // z = 2x - y: dPdu = (1, 0, 2), dPdv = (0, 1, -1).
    ShapeRef s = build(polygon({0, 0, 0, 1, 0, 2, 1, 1, 1, 0, 1, -1}), Matrix(), diag);
    SurfacePoint p = s->evaluate(0, 0.5, 0.5);
    EXPECT_NEAR(p.dPdu.z, 2, 1e-6);
    EXPECT_NEAR(p.dPdv.z, -1, 1e-6);
    // Edge-on: the plane x = 1; u along y, v along z, orthonormal.
    ShapeRef e = build(polygon({1, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1}), Matrix(), diag);
    SurfacePoint q = e->evaluate(0, 0.25, 0.75);
    EXPECT_NEAR(length(q.P - Vec3(1, 0.25f, 0.75f)), 0, 1e-6);
    EXPECT_NEAR(dot(q.dPdu, q.dPdv), 0, 1e-6);
    EXPECT_NEAR(length(q.dPdu), 1, 1e-6);
    EXPECT_NEAR(length(q.dPdv), 1, 1e-6);
    EXPECT_NEAR(dot(normalize(q.Ng), q.n), 1, 1e-6);
}

} // namespace derivatives_test
