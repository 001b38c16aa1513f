// Displaced shapes that have an edge in common meet there without cracks, each of them cut as finely as it looks large.
#include "../nightly.h"
#include "accel/accel.h"
#include "geometry/edge_curve.h"
#include "geometry/placed.h"
#include "make.h"
#include "scene/scene.h"
#include <cstdlib>
#include <gtest/gtest.h>
#include <map>
#include <random>

namespace seams_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;

namespace {

using Made = std::vector<std::shared_ptr<scene::Primitive>>;

std::shared_ptr<scene::Primitive> polygons(std::vector<int> counts, std::vector<int> vertex, std::vector<float> P) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "PointsPolygons";
    p->ints = std::move(counts);
    p->ints2 = std::move(vertex);
    p->params = {points(std::move(P))};
    return p;
}

/// Points of a cube's six faces, u fastest, as far apart in the picture as they like; `turn` turns each face's u and v
/// differently.
std::array<std::array<Vec3, 4>, 6> faces(int turn) {
    const auto corner = [](int k) { return Vec3(k & 1 ? 1.f : -1.f, k & 2 ? 1.25f : -1.f, k & 4 ? 1.1f : -1.3f); };
    static constexpr int at[6][4] = {{0, 1, 2, 3}, {4, 6, 5, 7}, {0, 4, 1, 5}, {2, 3, 6, 7}, {0, 2, 4, 6}, {1, 5, 3, 7}};
    static constexpr int order[4][4] = {{0, 1, 2, 3}, {1, 3, 0, 2}, {3, 2, 1, 0}, {2, 0, 3, 1}}; // quarter turns
    std::array<std::array<Vec3, 4>, 6> out;
    for (size_t f = 0; f < 6; ++f)
        for (size_t k = 0; k < 4; ++k) out[f][k] = corner(at[f][order[(f * size_t(turn)) % 4][k]]);
    return out;
}
void put(std::vector<float>& P, const Vec3& p) { P.insert(P.end(), {p.x, p.y, p.z}); }

/// A box of six primitives: bilinear patches, polygons, meshes of patches, or a mixture.
Made box(int kind) {
    Made out;
    int f = 0;
    for (const auto& q : faces(kind)) {
        std::vector<float> P;
        const int is = kind == 3 ? f % 3 : kind;
        if (is == 1) {
            for (int k : {0, 1, 3, 2}) put(P, q[size_t(k)]);
            out.push_back(f % 2 ? polygon(P) : polygons({4}, {0, 1, 2, 3}, P));
        } else {
            for (const Vec3& p : q) put(P, p);
            out.push_back(is == 0 ? patch("bilinear", P) : patchMesh("bilinear", 2, "nonperiodic", 2, "nonperiodic", P));
        }
        ++f;
    }
    return out;
}

/// A closed form of six bicubic Bezier patches whose edges are curved: control points by what lies on a bent cube.
Made pillow() {
    Made out;
    const auto bend = [](const Vec3& p) {
        const float l = length(p);
        return Vec3(p.x * (1.6f - 0.3f * l) + 0.2f * p.y * p.z, p.y * (1.5f - 0.25f * l) + 0.1f * p.x,
                    p.z * (1.4f - 0.2f * l) - 0.15f * p.x * p.y);
    };
    for (const auto& q : faces(1)) {
        std::vector<float> P;
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) {
                // The same arithmetic for both faces of an edge: thirds of its own ends, from the lesser one.
                const auto third = [](const Vec3& a, const Vec3& b, int k) {
                    if (k == 0 || k == 3) return k ? b : a;
                    const bool swap = std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z);
                    const Vec3 &lo = swap ? b : a, &hi = swap ? a : b;
                    const float w = float(swap ? 3 - k : k) / 3;
                    return Vec3(lo.x + (hi.x - lo.x) * w, lo.y + (hi.y - lo.y) * w, lo.z + (hi.z - lo.z) * w);
                };
                const Vec3 p = i == 0 || i == 3 ? third(q[i ? 1 : 0], q[i ? 3 : 2], j)
                                                : third(third(q[0], q[2], j), third(q[1], q[3], j), i);
                put(P, bend(p));
            }
        out.push_back(patch("bicubic", P));
    }
    return out;
}

/// A closed form of six meshes whose edges are curves: each face of a bent box has the points of a grid of `side` by `side`
/// faces. kind 0: quadrilaterals of catmull-clark; 1: triangles of catmull-clark, which are cut in parts; 2: triangles of loop;
/// 3: bilinear.
Made cage(int kind, int side) {
    Made out;
    for (const auto& q : faces(1)) {
        auto p = std::make_shared<scene::Primitive>();
        p->kind = "SubdivisionMesh";
        p->strings = {kind == 2 ? "loop" : kind == 3 ? "bilinear" : "catmull-clark", "interpolateboundary"};
        p->ints3 = {1, 0};
        scene::Param one;
        one.name = "intargs";
        one.numbers = {1};
        p->params = {one};
        std::vector<float> P;
        for (int j = 0; j <= side; ++j)
            for (int i = 0; i <= side; ++i) {
                // The same arithmetic on both faces of an edge: parts of its ends, bent by where they lie. Corners stay.
                const auto part = [&](const Vec3& a, const Vec3& b, int k) {
                    return Vec3((a.x * float(side - k) + b.x * float(k)) / float(side),
                                (a.y * float(side - k) + b.y * float(k)) / float(side),
                                (a.z * float(side - k) + b.z * float(k)) / float(side));
                };
                const Vec3 at = part(part(q[0], q[1], i), part(q[2], q[3], i), j);
                put(P, Vec3(at.x + 0.15f * at.y * at.z, at.y + 0.1f * at.z * at.z, at.z - 0.2f * at.x * at.x));
            }
        p->params.push_back(points(P));
        const auto add = [&](std::vector<int> face) {
            p->ints.push_back(int(face.size()));
            p->ints2.insert(p->ints2.end(), face.begin(), face.end());
        };
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) {
                const int a = j * (side + 1) + i, b = a + 1, c = b + side + 1, d = a + side + 1;
                if (kind == 0 || kind == 3) add({a, b, c, d});
                // Diagonals are such that each corner of the grid belongs to one face, which makes it sharp.
                else if ((i + j) % 2) add({a, b, c}), add({a, c, d});
                else add({a, b, d}), add({b, c, d});
            }
        out.push_back(p);
    }
    return out;
}

/// A box whose faces are cut in strips, each face in its own number and direction, so that an edge of one meets corners of
/// others. kind 0: polygons; 1: patches; 2: either.
Made strips(int kind) {
    Made out;
    int f = 0;
    for (const auto& q : faces(1)) {
        const int n = 1 + f % 4;
        const auto between = [&](const Vec3& a, const Vec3& b,
                                 int k) { // the same from both ends, and for a half of two and two of four
            const float v = float(n - k), w = float(k), all = float(n);
            return Vec3((a.x * v + b.x * w) / all, (a.y * v + b.y * w) / all, (a.z * v + b.z * w) / all);
        };
        for (int k = 0; k < n; ++k) {
            const Vec3 a = between(q[0], q[1], k), b = between(q[0], q[1], k + 1), c = between(q[2], q[3], k),
                       d = between(q[2], q[3], k + 1);
            std::vector<float> P;
            const bool patches = kind == 1 || (kind == 2 && (f + k) % 2);
            for (const Vec3& p : patches ? std::array{a, b, c, d} : std::array{a, b, d, c}) put(P, p);
            out.push_back(patches ? patch("bilinear", P) : polygon(P));
        }
        ++f;
    }
    return out;
}

struct Scene {
    Diagnostics diag;
    std::vector<ShapeRef> shapes;
    DiceOptions options;
    Scene(const Made& made, const Matrix& m, double pixels, bool displaced = true) {
        for (const auto& p : made) shapes.push_back(build(p, m, diag));
        options.camera = {true, pixels};
        options.displaces = [displaced](const Shape&) { return displaced; };
        options.displace = [](const Shape&, DiceGrid& g) {
            for (size_t i = 0; i < g.points.size(); ++i) {
                const Vec3 p = g.points[i].P;
                g.P[i] = g.P[i] + g.points[i].n * (0.08f * std::sin(7 * p.x + 3 * p.y) * std::sin(5 * p.z));
            }
        };
        diceShapes(shapes, options, diag);
    }
};

/// Sides of facets that no other facet, of whatever shape, has in the other direction or the same.
size_t openEdges(const std::vector<ShapeRef>& shapes) {
    using Place = std::tuple<float, float, float>;
    std::map<std::pair<Place, Place>, int> sides;
    for (const ShapeRef& s : shapes) {
        const TriMesh& m = s->mesh();
        const auto place = [&](size_t k) {
            const Vec3 p = m.P[m.index[k]] + Vec3(0.f);
            return Place(p.x, p.y, p.z);
        };
        for (size_t t = 0; t < m.index.size(); t += 3) {
            const Place p[3] = {place(t), place(t + 1), place(t + 2)};
            if (p[0] == p[1] || p[1] == p[2] || p[0] == p[2]) continue; // no area
            for (int k = 0; k < 3; ++k) ++sides[std::minmax(p[k], p[(k + 1) % 3])];
        }
    }
    size_t open = 0;
    for (const auto& [side, n] : sides) open += n % 2;
    return open;
}

struct Form {
    std::string name;
    Made made;
};
std::vector<Form> closedForms() {
    return {{"patches", box(0)},
            {"polygons", box(1)},
            {"meshes", box(2)},
            {"a mixture", box(3)},
            {"bicubic patches", pillow()},
            {"a can", {quadric("Cylinder", {1, -1, 0.8f, 360}), quadric("Disk", {-1, 1, 360}), quadric("Disk", {0.8f, 1, 360})}},
            {"a hat", {quadric("Cone", {1.5f, 1, 360}), quadric("Disk", {0, 1, 360})}},
            {"a bowl", {quadric("Paraboloid", {1, 0, 1.2f, 360}), quadric("Disk", {1.2f, 1, 360})}},
            {"half a ball", {quadric("Sphere", {1, 0, 1, 360}), quadric("Disk", {0, 1, 360})}},
            {"a ball", {quadric("Sphere", {1, -1, 1, 360})}},
            {"a waist",
             {quadric("Hyperboloid", {1, 0, 0, 0.5f, 0, 1, 360}), quadric("Disk", {0, 1, 360}), quadric("Disk", {1, 0.5f, 360})}},
            {"a ring", {quadric("Torus", {1, 0.4f, 0, 360, 360})}},
            {"strips of polygons", strips(0)},
            {"strips of patches", strips(1)},
            {"strips of either", strips(2)},
            {"subdivision meshes", cage(0, 4)},
            {"subdivision meshes of one face", cage(0, 1)},
            {"subdivision meshes of triangles", cage(1, 2)},
            {"loop meshes", cage(2, 2)},
            {"bilinear meshes", cage(3, 2)}};
}

} // namespace

TEST(Seams, ClosedFormsOfSeveralPrimitivesAreClosedToTheBit) {
    for (const Form& f : closedForms())
        for (double near : {2.2, 6.0, 40.0}) {
            Scene s(f.made, rotateMatrix(31, 1, 2, 3) * translateMatrix(0.3, -0.2, near), 60);
            EXPECT_EQ(openEdges(s.shapes), 0u) << f.name << " at " << near;
            EXPECT_EQ(s.diag.warnings() + s.diag.errors(), 0);
        }
}

TEST(Seams, WhereEdgesAreCutDependsOnThemOnly) {
    // The same edge as the side of a large and of a narrow patch, of a polygon, and backwards.
    const DiceCamera camera{true, 100};
    const auto cuts = [&](const EdgeCurve& e) { return EdgeCuts({&e, 1}, camera, 1, 0.05, true).places(); };
    const Vec3d a(-3, 0.1, 0.5), b(5, 0.3, 9);
    const auto forth = cuts(EdgeCurve::line(a, b)), back = cuts(EdgeCurve::line(b, a));
    ASSERT_EQ(forth.size(), back.size());
    for (size_t i = 0; i < forth.size(); ++i) {
        EXPECT_EQ(forth[i], 1 - back[back.size() - 1 - i]);
        EXPECT_EQ(EdgeCurve::line(a, b).at(forth[i]), EdgeCurve::line(b, a).at(1 - forth[i]));
    }
    // None longer than a micropolygon, and, being halves, none shorter than a half of what it need be nearby.
    for (size_t i = 0; i + 1 < forth.size(); ++i) {
        const Vec3d p = EdgeCurve::line(a, b).at(forth[i]), q = EdgeCurve::line(a, b).at(forth[i + 1]);
        EXPECT_LE(camera.pixels((p + q) * 0.5, q - p), 1.01);
        EXPECT_GE(camera.pixels((p + q) * 0.5, q - p), 0.3);
    }
}

TEST(Seams, BezierAndArcDerivatives) {
    const std::array<double, 4> points[4] = {{0, 1, 2, 1}, {2, 4, 3, 2}, {1, 0, 1, 0.5}, {4, 4, 2, 1}};
    for (const EdgeCurve& e : {EdgeCurve::bezier(points), EdgeCurve::bezier({points, 3}),
                               EdgeCurve::arc({1, 2, 3}, {2, 0, 0}, {0, 1, 1}, 1.7), EdgeCurve::line({1, 2, 3}, {0, 5, 1})})
        for (double c : {0.1, 0.5, 0.8}) {
            constexpr double h = 1e-4;
            Vec3d d, dd;
            const Vec3d p = e.along(c, &d, &dd), lo = e.along(c - h), hi = e.along(c + h);
            for (int k = 0; k < 3; ++k) { // differences are off by h^2 times the next derivatives
                EXPECT_NEAR(d[k], (hi[k] - lo[k]) / (2 * h), 1e-5);
                EXPECT_NEAR(dd[k], (hi[k] - 2 * p[k] + lo[k]) / (h * h), 1e-4);
            }
        }
}

TEST(Seams, NoRayLeavesThroughThem) {
    std::mt19937 random(5);
    const auto uniform = [&] { return double(random()) / 4294967296.0; };
    size_t rays = 0;
    for (const Form& f : closedForms()) {
        const Vec3d centre(0.3, -0.2, 4);
        Scene s(f.made, rotateMatrix(31, 1, 2, 3) * translateMatrix(centre.x, centre.y, centre.z), 40);
        accel::Accel tree(s.shapes, {}, s.diag);
        // Within the form, off the middle of what is hollow.
        const Vec3d inside = transformPoint(rotateMatrix(31, 1, 2, 3),
                                            f.name == "a ring" ? Vec3d(1, 0, 0) : Vec3d(0, 0, f.name == "a ball" ? 0 : 0.3)) +
                             centre;
        std::vector<Vec3> seam;
        for (const ShapeRef& shape : s.shapes)
            for (uint32_t i = 0; i < shape->mesh().vertices; ++i) seam.push_back(shape->mesh().P[i]);
        size_t lost = 0;
        for (int k = 0; k < (nightly() ? 90000 : 2000); ++k, ++rays) {
            accel::Ray r;
            r.org = Vec3(inside + Vec3d(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5) * 0.1);
            // At vertices, between two that may be neighbours, and anywhere.
            const size_t i = random() % (seam.size() - 1);
            const double w = uniform();
            const Vec3d at = k % 3 == 0   ? Vec3d(seam[i])
                             : k % 3 == 1 ? Vec3d(seam[i]) * w + Vec3d(seam[i + 1]) * (1 - w)
                                          : centre + Vec3d(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5) * 5;
            r.dir = Vec3(at - Vec3d(r.org));
            r.sides = accel::Sides::Both;
            lost += !tree.occluded(r);
        }
        EXPECT_EQ(lost, 0u) << f.name;
    }
    if (nightly()) EXPECT_GE(rays, 1000000u);
}

TEST(Seams, PatchesThatAreNotDisplacedMeetToo) {
    for (double near : {3.0, 30.0}) {
        Scene s(pillow(), translateMatrix(0, 0, near), 300, false);
        EXPECT_EQ(openEdges(s.shapes), 0u) << near;
    }
}

TEST(Seams, CanBeLeftOpen) {
    scene::Attributes a;
    a.values["stitch:enable"] = param("enable", scene::Class::Constant, scene::Type::Integer, {0});
    Scene s({}, Matrix(), 60);
    for (const auto& p : box(0)) s.shapes.push_back(build(p, translateMatrix(0, 0, 5), s.diag, a));
    diceShapes(s.shapes, s.options, s.diag);
    EXPECT_GT(openEdges(s.shapes), 0u); // faces of a box go apart
}

TEST(Seams, WhatMovesTogetherMeetsThroughoutTheShutter) {
    for (int kind : {0, 1, 2}) { // a moving place, moving points, both
        scene::Frame f;
        for (const auto& made : box(3)) {
            auto p = std::make_shared<scene::Primitive>(*made);
            p->attributes = std::make_shared<scene::Attributes>();
            p->toWorld = scene::Transform(translateMatrix(0, 0, 5));
            if (kind != 1) {
                p->toWorld.times = {0, 0.5f, 1};
                p->toWorld.keys = {translateMatrix(0, 0, 5), rotateMatrix(20, 0, 1, 0) * translateMatrix(0.2, 0, 5),
                                   rotateMatrix(40, 0, 1, 0) * translateMatrix(0.5, 0, 6)};
            }
            if (kind != 0) {
                auto last = std::make_shared<scene::Primitive>(*made);
                for (float& x : last->params[0].numbers) x *= 1.5f + 0.2f * x;
                p->motionTimes = {0, 1};
                p->motionKeys = {last};
            }
            f.primitives.push_back(p);
        }
        f.options.shutterClose = 1;
        Diagnostics diag;
        Scene s({}, Matrix(), 40);
        std::vector<ShapeRef> shapes = buildShapes(f, diag, {});
        ASSERT_EQ(shapes.size(), 6u);
        diceShapes(shapes, s.options, diag);
        EXPECT_EQ(diag.warnings() + diag.errors(), 0);
        // Meshes of the geometry at each key, which all of them are placed by the same motion.
        std::vector<std::vector<ShapeRef>> keys;
        for (const ShapeRef& shape : shapes) {
            const Placed* p = shape->placed();
            ASSERT_TRUE(p);
            const std::vector<ShapeRef> own = p->deforming() ? p->deforming()->keys() : std::vector<ShapeRef>{p->geometry()};
            keys.resize(own.size());
            for (size_t k = 0; k < own.size(); ++k) keys[k].push_back(own[k]);
        }
        EXPECT_EQ(keys.size(), kind == 0 ? 1u : 2u);
        for (const auto& key : keys) EXPECT_EQ(openEdges(key), 0u) << kind;
    }
}

TEST(Dicing, FacetsAreMicropolygonsAtAnyDistance) {
    // A field with the eye above it, near its edge: from 0.4 units to 400 away.
    for (bool patches : {true, false}) {
        std::vector<float> P{-200, 0, -20, 200, 0, -20, -200, 0, 400, 200, 0, 400};
        if (!patches) P = {-200, 0, -20, 200, 0, -20, 200, 0, 400, -200, 0, 400};
        Scene s({patches ? patch("bilinear", P) : polygon(P)}, translateMatrix(0, -0.4, 0), 60);
        for (const Diagnostic& d : s.diag.all()) // a slow machine, or a sanitizer, takes more than a second
            EXPECT_NE(d.message.find("dicing it took"), std::string::npos) << d.message;
        const TriMesh& m = s.shapes[0]->mesh();
        size_t tooLong = 0;
        for (uint32_t t = 0; t < m.triangles(); ++t)
            for (size_t k = 0; k < 3; ++k) {
                // Where the plane was: the displacement must not count.
                Vec3d a(m.P[m.index[3 * t + k]]), b(m.P[m.index[3 * t + (k + 1) % 3]]);
                a.y = b.y = -0.4;
                // A diagonal, and what a block's probes miss of its nearest corner.
                tooLong += s.options.camera.pixels((a + b) * 0.5, b - a) > 1.5 * 1.5;
            }
        EXPECT_LT(double(tooLong), 1e-3 * m.triangles()) << patches << " of " << m.triangles();
        EXPECT_LT(m.triangles(), 4'000'000u) << patches;
    }
}

TEST(Dicing, EndsWhereTheEyeLiesOnAFace) {
    // What is near the eye looks large however often it is cut. The box's first face lies at z = -1.3: at the eye, and beside it.
    for (int kind : {0, 1, 3})
        for (float x : {0.f, 0.3f}) {
            Scene s(box(kind), translateMatrix(x, 0.1f, 1.3f), 20);
            size_t triangles = 0;
            for (const ShapeRef& shape : s.shapes) triangles += shape->mesh().triangles();
            EXPECT_LT(triangles, 1'000'000u) << kind;
            EXPECT_EQ(openEdges(s.shapes), 0u) << kind << " " << x;
        }
    for (const std::vector<float>& P : {std::vector<float>{-60, 0, -60, -60, 0, 60, 60, 0, 60, 60, 0, -60},
                                        {0, 0, 0, 1e6f, 0, 0, 0, 0, 1e6f},
                                        {-1, 0, 0, 1, 0, 0, 0, 1, 0}}) {
        Scene s({polygon(P)}, Matrix(), 20);
        EXPECT_GT(s.shapes[0]->mesh().triangles(), 100u);
        EXPECT_LT(s.shapes[0]->mesh().triangles(), 1'000'000u);
    }
}

TEST(Dicing, HeightsOfADisplacedBallAndPlane) {
    // Vertices lie where the shader puts them; between them facets are off by what their chords are.
    scene::Attributes a;
    Scene s({}, Matrix(), 80);
    s.options.displace = [](const Shape&, DiceGrid& g) {
        for (size_t i = 0; i < g.points.size(); ++i) g.P[i] = g.P[i] + g.points[i].n * (0.25f);
    };
    const Vec3d centre(0, 0, 4);
    ShapeRef ball = build(quadric("Sphere", {1, -1, 1, 360}), translateMatrix(0, 0, 4), s.diag);
    diceShapes({ball}, s.options, s.diag);
    for (uint32_t i = 0; i < ball->mesh().vertices; ++i) EXPECT_NEAR(length(Vec3d(ball->mesh().P[i]) - centre), 1.25, 2e-6);
    for (uint32_t t = 0; t < ball->mesh().triangles(); ++t) {
        const SurfacePoint p = ball->evaluateHit(t, 1 / 3., 1 / 3.);
        // Two pixels on a ball 3 away: 2 / 80 * 4; its chord is off by its square over 8 r.
        EXPECT_NEAR(length(Vec3d(p.displacedP) - centre), 1.25, 0.1 * 0.1 / 8);
    }
}

TEST(DisplacementBound, CountsInItsOwnSpace) {
    struct Case {
        std::string space;
        Vec3 moved;   ///< in camera space
        double reach; ///< in the space
    };
    // Object space is stretched by 4 along x and 0.5 along y.
    const Matrix object = scaleMatrix(4, 0.5, 1) * translateMatrix(0, 0, 5);
    for (const Case& c : {Case{"object", {0.4f, 0, 0}, 0.1},
                          {"object", {0, 0.4f, 0}, 0.8},
                          {"camera", {0, 0.4f, 0}, 0.4},
                          {"current", {0.4f, 0, 0}, 0.4},
                          {"metres", {0, 0.4f, 0}, 4},
                          {"shader", {0.4f, 0, 0}, 0.2}})
        for (double radius : {c.reach * 1.01, c.reach * 0.5}) {
            scene::Attributes a;
            a.values["displacementbound:sphere"] = param("sphere", scene::Class::Constant, scene::Type::Float, {float(radius)});
            scene::Param space = param("coordinatesystem", scene::Class::Constant, scene::Type::String, {});
            space.strings = {c.space};
            a.values["displacementbound:coordinatesystem"] = space;
            Scene s({}, Matrix(), 20);
            s.options.spaceOf = [](const Shape& shape, const std::string& name, Matrix& m) {
                if (name == "metres") return m = rotateMatrix(90, 0, 0, 1) * scaleMatrix(0.1, 0.1, 0.1), true;
                if (name == "shader") return m = scaleMatrix(2, 7, 7), true;
                if (name == "object") return m = shape.toCamera(), true;
                return false;
            };
            s.options.displace = [&](const Shape&, DiceGrid& g) {
                for (size_t i = 0; i < g.P.size(); ++i) g.P[i] = g.P[i] + c.moved;
            };
            Diagnostics d;
            ShapeRef shape = build(quadric("Sphere", {1, -1, 1, 360}), object, d, a);
            diceShapes({shape}, s.options, d);
            ASSERT_EQ(d.warnings(), radius < c.reach) << c.space << " " << radius;
            if (radius < c.reach) EXPECT_NE(d.all()[0].hint.find("times 2.0"), std::string::npos) << d.all()[0].hint;
        }
}

} // namespace seams_test
