// What camera rays cannot come to is not diced, and what they can is as it was, to the bit.
#include "geometry/picture_sides.h"
#include "make.h"
#include "scene/anycamera.h"
#include "scene/scene.h"
#include "scene/solids.h"
#include <array>
#include <gtest/gtest.h>
#include <set>

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;

namespace {

/// 100 by 100 pixels, 90 degrees: the sides are |x| = z and |y| = z, a pixel is z / 50 wide.
scene::Options square() {
    scene::Options o;
    o.xres = o.yres = 100;
    o.projection = "perspective";
    o.fov = 90;
    o.filter = {"box", 1, 1};
    return o;
}

Bounds box(Vec3 lo, Vec3 hi) {
    Bounds b;
    b.add(lo), b.add(hi);
    return b;
}

struct Lots {
    scene::Options frame = square();
    DiceOptions all, seen;
    std::optional<PictureSides> sides;
    explicit Lots(scene::Options o = square()) : frame(std::move(o)), sides(PictureSides::from(frame)) {
        all.camera = seen.camera = DiceCamera::from(frame);
        seen.picture = sides ? &*sides : nullptr;
    }
    void displace(std::function<void(const Shape&, DiceGrid&)> by) {
        all.displace = seen.displace = std::move(by), all.displaces = seen.displaces = [](const Shape&) { return true; };
    }
};

using Triangle = std::array<std::array<float, 3>, 3>;
std::set<Triangle> trianglesOf(const TriMesh& m) {
    std::set<Triangle> out;
    for (size_t t = 0; t < m.triangles(); ++t) {
        Triangle k{};
        for (size_t c = 0; c < 3; ++c) {
            const Vec3& p = m.P[m.index[3 * t + c]];
            k[c] = {p.x, p.y, p.z};
        }
        out.insert(k);
    }
    return out;
}
/// Some corner of it lies in the picture.
bool inPicture(const Triangle& t) {
    return std::any_of(t.begin(), t.end(),
                       [](const auto& p) { return p[2] > 0 && std::fabs(p[0]) <= p[2] && std::fabs(p[1]) <= p[2]; });
}

/// radius < 0: nothing is said. Facets are measured by their length, whoever sees them.
scene::Attributes bounded(float radius) {
    scene::Attributes a;
    a.values["dice:rasterorient"] = param("rasterorient", scene::Class::Constant, scene::Type::Float, {0});
    if (radius >= 0) a.values["displacementbound:sphere"] = param("sphere", scene::Class::Constant, scene::Type::Float, {radius});
    return a;
}

void ripple(const Shape&, DiceGrid& g) {
    for (size_t i = 0; i < g.P.size(); ++i) g.P[i] = g.P[i] + g.points[i].N * (0.1f * std::sin(9 * g.points[i].u));
}

/// A grid of faces over x -6..6 at y -1, z -6..6, bent.
std::vector<float> land(int n) {
    std::vector<float> P;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const float x = -6 + 12.f * float(i) / float(n - 1), z = -6 + 12.f * float(j) / float(n - 1);
            P.insert(P.end(), {x, -1 + 0.1f * std::sin(x * 2) * std::cos(z * 3), z});
        }
    return P;
}
std::shared_ptr<scene::Primitive> faces(const std::string& kind, int n) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = kind;
    if (kind == "SubdivisionMesh") p->strings = {"catmull-clark"};
    for (int j = 0; j + 1 < n; ++j)
        for (int i = 0; i + 1 < n; ++i) {
            p->ints.push_back(4);
            for (int k : {j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i}) p->ints2.push_back(k);
        }
    p->params = {points(land(n))};
    return p;
}

} // namespace

TEST(PictureSides, OfAPictureOfNinetyDegreesAreWhereDepthIs) {
    const PictureSides s = *PictureSides::from(square());
    // Half a pixel of the filter and eight more belong to it: at z = 10 the room ends at x = 10 + 8.5 / 5 = 11.7.
    for (const float side : {-1.f, 1.f}) {
        const auto at = [&](float x, float y, float z) { return box(Vec3(x, y, z), Vec3(x, y, z)); };
        EXPECT_FALSE(s.outside(at(side * 11.69f, 0, 10), 0));
        EXPECT_TRUE(s.outside(at(side * 11.71f, 0, 10), 0));
        EXPECT_FALSE(s.outside(at(side * 11.89f, 0, 10), 1)) << "a pixel more";
        EXPECT_TRUE(s.outside(at(side * 11.91f, 0, 10), 1));
        EXPECT_FALSE(s.outside(at(0, side * 11.69f, 10), 0));
        EXPECT_TRUE(s.outside(at(0, side * 11.71f, 10), 0));
    }
    EXPECT_TRUE(s.outside(box(Vec3(-1, -1, -5), Vec3(1, 1, -1)), 0)) << "behind the eye";
    EXPECT_FALSE(s.outside(box(Vec3(-20, -1, -5), Vec3(20, 1, 5)), 0)) << "around it";
    EXPECT_FALSE(s.outside(Bounds(), 0));
    EXPECT_FALSE(s.outside(box(Vec3(NAN, 100, 1), Vec3(NAN, 100, 1)), 0));
}

TEST(PictureSides, NearPlaneLensWindowAndFilterMoveThem) {
    scene::Options o = square();
    o.clipNear = 3;
    EXPECT_TRUE(PictureSides::from(o)->outside(box(Vec3(0, 0, 1), Vec3(0, 0, 2.9f)), 0));
    EXPECT_FALSE(PictureSides::from(o)->outside(box(Vec3(0, 0, 1), Vec3(0, 0, 3)), 0));
    o = square();
    o.fstop = 1, o.focalLength = 4, o.focalDistance = 10; // a lens of radius 2: at z = 20 it blurs by 2 |1 - 20 / 10| = 2
    EXPECT_FALSE(PictureSides::from(o)->outside(box(Vec3(25.3f, 0, 20), Vec3(25.3f, 0, 20)), 0)) << "20 * 1.17 + 2 = 25.4";
    EXPECT_TRUE(PictureSides::from(o)->outside(box(Vec3(25.5f, 0, 20), Vec3(25.5f, 0, 20)), 0));
    o = square();
    o.screenWindow = std::vector<float>{0, 2, 0, 2}; // the eye looks past the picture; a pixel is .02 z wide
    EXPECT_TRUE(PictureSides::from(o)->outside(box(Vec3(-2, 5, 10), Vec3(-1.71f, 5, 10)), 0));
    EXPECT_FALSE(PictureSides::from(o)->outside(box(Vec3(-2, 5, 10), Vec3(-1.69f, 5, 10)), 0));
    o = square();
    o.filter.xwidth = 21; // ten pixels more than above
    EXPECT_FALSE(PictureSides::from(o)->outside(box(Vec3(13.6f, 0, 10), Vec3(13.6f, 0, 10)), 0));
    o = square();
    o.projection = "orthographic";
    EXPECT_TRUE(PictureSides::from(o)->outside(box(Vec3(1.18f, 0, 10), Vec3(2, 0, 90)), 0));
    EXPECT_FALSE(PictureSides::from(o)->outside(box(Vec3(1.16f, 0, 10), Vec3(2, 0, 90)), 0));
    o = square();
    o.worldToCamera.times = {0, 1};
    o.worldToCamera.keys = {Matrix(), translateMatrix(1, 0, 0)};
    EXPECT_FALSE(PictureSides::from(o).has_value()) << "the camera moves";
    o = square();
    o.values[scene::kAnyCamera] = {};
    EXPECT_FALSE(PictureSides::from(o).has_value()) << "others look";
}

TEST(PictureSides, WhatLiesWithinIsDicedAsBeforeAndTheRestIsNot) {
    for (const bool displaced : {false, true})
        for (int kind = 0; kind < 4; ++kind) {
            if (kind == 2 && !displaced) continue; // flat polygons are not diced
            Diagnostics d;
            const auto make = [&]() -> ShapeRef {
                const scene::Attributes a = bounded(0.11f);
                if (kind == 0)
                    return build(patchMesh("bilinear", 13, "nonperiodic", 13, "nonperiodic", land(13)), Matrix(), d, a);
                if (kind == 1) return build(patch("bilinear", land(2)), Matrix(), d, a);
                return build(faces(kind == 2 ? "PointsPolygons" : "SubdivisionMesh", 13), Matrix(), d, a);
            };
            Lots o;
            if (displaced) o.displace(ripple);
            ShapeRef all = make(), seen = make();
            all->dice(o.all, d);
            seen->dice(o.seen, d);
            ASSERT_EQ(d.all().size(), 0u) << toString(d.all()[0]);
            const std::set<Triangle> a = trianglesOf(all->mesh()), b = trianglesOf(seen->mesh());
            size_t missing = 0, foreign = 0;
            for (const Triangle& t : a) missing += inPicture(t) && !b.count(t);
            for (const Triangle& t : b) foreign += inPicture(t) && !a.count(t);
            EXPECT_EQ(missing, 0u) << kind << displaced;
            EXPECT_EQ(foreign, 0u) << kind << displaced;
            // A flat patch has two triangles, whatever is outside; of the others the picture shows less than half.
            if (kind != 1 || displaced) EXPECT_LT(b.size(), 0.6 * double(a.size())) << kind << displaced;
        }
}

TEST(PictureSides, AWholeShapeBesideOrBehindHasNoTriangles) {
    for (const Matrix& m : {translateMatrix(40, 0, 10), translateMatrix(0, 0, -10)})
        for (const bool displaced : {false, true}) {
            Diagnostics d;
            Lots o;
            if (displaced) o.displace(ripple);
            std::vector<ShapeRef> shapes = {build(patch("bicubic", bentNet()), m, d, bounded(0.11f))};
            if (displaced) shapes.push_back(build(quadric("Sphere", {1, -1, 1, 360}), m, d, bounded(0.11f)));
            if (displaced) shapes.push_back(build(polygon({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), m, d, bounded(0.11f)));
            for (const ShapeRef& s : shapes) {
                s->dice(o.seen, d);
                EXPECT_EQ(s->mesh().triangles(), 0u) << s->kind();
                EXPECT_FALSE(s->exact()) << s->kind();
                EXPECT_FALSE(s->bounds().empty()) << s->kind();
            }
            EXPECT_EQ(d.all().size(), 0u);
        }
}

TEST(PictureSides, WhatDisplacementBringsInIsThere) {
    // At z = 10 the picture and its margin end at 11.7, with four facets 12.5; this lies at 14 and goes 3 to the left.
    const Matrix m = translateMatrix(14, 0, 10);
    const auto left = [](const Shape&, DiceGrid& g) {
        for (Vec3& p : g.P) p.x -= 3;
    };
    for (const float bound : {-1.f, .5f, 3.5f}) { // none is said; it lies; it is true
        Diagnostics d;
        Lots o;
        o.displace(left);
        ShapeRef all = build(patch("bilinear", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}), m, d, bounded(bound)),
                 seen = build(patch("bilinear", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}), m, d, bounded(bound));
        all->dice(o.all, d);
        seen->dice(o.seen, d);
        if (bound == .5f) EXPECT_EQ(seen->mesh().triangles(), 0u) << "nothing of it was seen that could tell";
        else EXPECT_EQ(trianglesOf(seen->mesh()), trianglesOf(all->mesh())) << bound;
    }
    // Of what is seen in part the bound shows as wrong, and then all of it is there.
    Diagnostics d;
    Lots o;
    o.displace(left);
    const std::vector<float> wide{-20, 0, 0, 20, 0, 0, -20, 1, 0, 20, 1, 0};
    ShapeRef all = build(patch("bilinear", wide), translateMatrix(0, 0, 10), d, bounded(1)),
             seen = build(patch("bilinear", wide), translateMatrix(0, 0, 10), d, bounded(1));
    all->dice(o.all, d);
    const size_t said = d.all().size();
    seen->dice(o.seen, d);
    EXPECT_EQ(trianglesOf(seen->mesh()), trianglesOf(all->mesh()));
    EXPECT_EQ(said, 1u);
    EXPECT_EQ(d.all().size(), 2 * said) << "once a shape";
}

TEST(PictureSides, EmittersSolidsAndWhatMovesStayWhole) {
    Diagnostics d;
    Lots o;
    const Matrix m = translateMatrix(40, 0, 10);
    scene::Attributes emits, solid;
    emits.areaLight = 0;
    solid.solid = {{1, scene::SolidOperation::Part, 0}};
    for (const scene::Attributes& a : {emits, solid}) {
        ShapeRef s = build(patch("bicubic", bentNet()), m, d, a);
        s->dice(o.seen, d);
        EXPECT_GT(s->mesh().triangles(), 0u);
    }
    ShapeRef a = build(patch("bicubic", bentNet()), m, d), b = build(patch("bicubic", bentNet()), Matrix(), d);
    const ShapeRef keys[] = {a, b};
    o.seen.keys = keys;
    a->dice(o.seen, d);
    EXPECT_GT(a->mesh().triangles(), 0u);
}

// A floor that the eye looks along: a step away from it counts by a quarter of its length, one across it by all of it.
TEST(PictureSides, DisplacedShapesAreDicedAsTheEyeSeesThem) {
    Lots lots;
    lots.displace(ripple);
    const auto facets = [&](const DiceOptions& o, float rasterorient) {
        scene::Attributes a = bounded(0.1f);
        a.values["dice:rasterorient"] = param("rasterorient", scene::Class::Constant, scene::Type::Float, {rasterorient});
        Diagnostics d;
        const ShapeRef s = build(patch("bilinear", {-8, -1, 40, 8, -1, 40, -8, -1, 60, 8, -1, 60}), Matrix(), d, a);
        s->dice(o, d);
        return double(s->mesh().triangles());
    };
    // Pixels are a fiftieth of the distance: 40 to 60 units away 16 across are 13 to 20 of them, 20 along the sight 17 to 25.
    const double whole = facets(lots.seen, 0);
    EXPECT_GT(whole, 2 * 13 * 17);
    EXPECT_NEAR(facets(lots.seen, 1), whole / 4, whole / 12); // whole numbers of facets
    EXPECT_EQ(facets(lots.all, 1), whole) << "rays may come from elsewhere";
}
