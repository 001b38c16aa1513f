// The tree over large scenes: it overlooks nothing, rays through corners and edges do not slip between triangles, and what it
// answers depends neither on the processor's instructions nor on which rays are followed together.
#include "../geometry/make.h"
#include "accel/accel.h"
#include "accel/bvh.h"
#include "accel/impl.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tree_test {

using namespace alpenglow;
using namespace alpenglow::accel;
using namespace alpenglow::geometry::test;
using geometry::ShapeRef;

namespace {

using Rng = std::mt19937;
float uniform(Rng& r, float lo, float hi) { return lo + (hi - lo) * float(r() >> 8) * 0x1p-24f; }
Vec3 within(Rng& r, float size) { return {uniform(r, -size, size), uniform(r, -size, size), uniform(r, -size, size)}; }

std::shared_ptr<scene::Primitive> trianglesOf(const std::vector<Vec3>& corners, const std::vector<int>& index) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "PointsPolygons";
    p->ints.assign(index.size() / 3, 3);
    p->ints2 = index;
    std::vector<float> P;
    for (const Vec3& v : corners) P.insert(P.end(), {v.x, v.y, v.z});
    p->params = {points(P)};
    return p;
}

/// Triangles without order around `centre`: small, large, thin, flat along an axis.
std::shared_ptr<scene::Primitive> soup(Rng& rng, int n, const Vec3& centre, float size) {
    std::vector<Vec3> corners;
    std::vector<int> index;
    for (int i = 0; i < n; ++i) {
        const Vec3 a = centre + within(rng, size), e = within(rng, size * (i % 3 ? 0.1f : 1));
        Vec3 b = a + e, c = a + e * 0.5f + within(rng, size * (i % 5 ? 0.1f : 1e-4f));
        if (i % 7 == 0) b.y = c.y = a.y;
        for (const Vec3& v : {a, b, c}) {
            index.push_back(int(corners.size()));
            corners.push_back(v);
        }
    }
    return trianglesOf(corners, index);
}

/// A closed ball of rows * around * 2 triangles, bent by waves.
std::shared_ptr<scene::Primitive> ball(int rows, int around) {
    std::vector<Vec3> corners{{0, 0, -1}, {0, 0, 1}};
    std::vector<int> index;
    const auto at = [&](int j, int i) { return j == 0 ? 0 : j == rows ? 1 : 2 + (j - 1) * around + i % around; };
    for (int j = 1; j < rows; ++j)
        for (int i = 0; i < around; ++i) {
            const double a = kPi * j / rows, b = 2 * kPi * i / around, r = 1 + 0.1 * std::sin(7 * b) * std::sin(a);
            corners.push_back(
                Vec3(float(r * std::sin(a) * std::cos(b)), float(r * std::sin(a) * std::sin(b)), float(-std::cos(a))));
        }
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < around; ++i) {
            if (j > 0) index.insert(index.end(), {at(j, i), at(j, i + 1), at(j + 1, i)});
            if (j + 1 < rows) index.insert(index.end(), {at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)});
        }
    return trianglesOf(corners, index);
}

} // namespace

// Where nothing lies within the sides of a window no ray through it meets anything; and that is found where there is room.
TEST(Bvh, WindowsThatSeeNothing) {
    Rng rng(12);
    size_t empty = 0, open = 0;
    for (const int triangles : {12, 500}) { // looked at one by one, and in a tree
        Diagnostics diag;
        std::vector<ShapeRef> shapes{build(soup(rng, triangles, {0, 0, 5}, 1), Matrix(), diag),
                                     build(quadric("Sphere", {.3f, -.3f, .3f, 360}), translateMatrix(1, 1, 6), diag)};
        Accel accel(shapes, {}, diag);
        for (int window = 0; window < 400; ++window) {
            const float x = uniform(rng, -.6f, .6f), y = uniform(rng, -.6f, .6f), w = uniform(rng, .001f, .1f);
            const Plane sides[] = {{Vec3(0, 0, 1), 0},
                                   {Vec3(1, 0, w - x), 0},
                                   {Vec3(-1, 0, w + x), 0},
                                   {Vec3(0, 1, w - y), 0},
                                   {Vec3(0, -1, w + y), 0}};
            const bool reaches = accel.reachesInto(sides);
            bool hit = false;
            for (int k = 0; k < 64; ++k) {
                Ray r;
                r.dir = {x + w * uniform(rng, -1, 1), y + w * uniform(rng, -1, 1), 1};
                Hit h;
                hit |= accel.intersect(r, h);
            }
            ASSERT_TRUE(reaches || !hit) << triangles << " " << window;
            empty += !reaches;
            open += reaches;
        }
    }
    EXPECT_GT(empty, 100u);
    EXPECT_GT(open, 100u);
}

// Rays that go about the same way, as from an eye through a window, or side by side: the hits are those that each has alone, with
// the instructions of every processor. Every fifth bundle is too wide for that, and a few rays have no length or no end.
TEST(Bvh, RaysTogetherMeetWhatTheyMeetAlone) {
    Rng rng(11);
    size_t met = 0;
    for (int scene = 0; scene < 12; ++scene) {
        const float size = std::pow(10.f, uniform(rng, -2, 3));
        Diagnostics diag;
        std::vector<ShapeRef> shapes{build(soup(rng, 400, {}, size), Matrix(), diag), build(ball(20, 30), Matrix(), diag)};
        for (int k = 0; k < 5; ++k)
            shapes.push_back(build(quadric("Sphere", {size * 0.1f, -size, size, 360}), translateMatrix(0, 0, size * k), diag));
        Accel::Impl inside;
        inside.shapes = shapes;
        inside.visibility.assign(shapes.size(), kAll);
        inside.visibility[2] = kDiffuse;
        inside.tree.build(shapes);
        std::vector<Ray> rays;
        for (int bundle = 0; bundle < 40; ++bundle) {
            const Vec3 eye = within(rng, 3 * size), aim = within(rng, size);
            for (int k = 0; k < 16; ++k) {
                const Vec3 off = within(rng, size * (bundle % 5 ? 0.03f : 2));
                Ray r;
                r.org = bundle % 2 ? eye : eye + off;
                r.dir = bundle % 2 ? aim + off - eye : aim - eye;
                r.mask = kCamera;
                if (k == 3) r.tnear = 0.9f, r.tfar = 1.1f;
                if (k == 5 && bundle % 7 == 0) r.dir = Vec3(0.f);
                if (k == 6 && bundle % 7 == 0) r.tfar = -1;
                rays.push_back(r);
            }
        }
        rays.resize(rays.size() - 5); // the last ones are fewer
        std::vector<Hit> alone(rays.size());
        inside.walkNearest(rays, alone);
        for (const bool plain : {false, true}) {
            std::vector<Hit> together(rays.size());
            inside.walkNearestTogether(rays, together, plain);
            for (size_t i = 0; i < rays.size(); ++i) {
                ASSERT_EQ(together[i].shape, alone[i].shape) << "scene " << scene << " ray " << i;
                if (!alone[i].valid()) continue;
                met += plain;
                ASSERT_EQ(together[i].prim, alone[i].prim);
                ASSERT_EQ(together[i].distance, alone[i].distance);
                ASSERT_EQ(together[i].b1, alone[i].b1);
                ASSERT_EQ(together[i].b2, alone[i].b2);
            }
        }
    }
    EXPECT_GT(met, 2000u);
}

TEST(Bvh, NothingIsOverlooked) {
    Rng rng(3);
    size_t met = 0;
    for (int scene = 0; scene < 24; ++scene) {
        const float size = std::pow(10.f, uniform(rng, -3, 4)), away = scene % 3 == 0 ? 300 * size : 0;
        const Vec3 centre = within(rng, away);
        Diagnostics diag;
        std::vector<ShapeRef> shapes;
        for (int k = 0; k < 3; ++k)
            if (ShapeRef s = build(soup(rng, 1 + int(rng() % 300), centre, size), Matrix(), diag)) shapes.push_back(s);
        for (int k = 0; k < 5; ++k)
            if (ShapeRef s = build(quadric("Sphere", {size * 0.1f, -size, size, 360}),
                                   translateMatrix(centre.x, centre.y, centre.z + size * k), diag))
                shapes.push_back(s);
        Accel accel(shapes, {}, diag);
        Accel::Impl inside; // the same, to be asked in other ways
        inside.shapes = shapes;
        inside.visibility.assign(shapes.size(), kAll);
        inside.tree.build(shapes);
        std::vector<Ray> rays;
        for (int k = 0; k < 400; ++k) {
            const geometry::TriMesh& to = shapes[rng() % 3]->mesh();
            const uint32_t* t = &to.index[3 * (uint32_t(rng()) % to.triangles())];
            // Toward a corner, an edge or the inside of a triangle; from anywhere, or along an axis.
            const float s = k % 3 ? uniform(rng, 0, 1) : 0, u = k % 5 ? uniform(rng, 0, 1 - s) : 0;
            const Vec3 aim = to.P[t[0]] + (to.P[t[1]] - to.P[t[0]]) * s + (to.P[t[2]] - to.P[t[0]]) * u;
            Ray r;
            r.org = k % 11 == 0   ? aim - Vec3(0, 0, 3 * size)
                    : k % 13 == 0 ? aim + Vec3(size, 0, 0)
                                  : centre + within(rng, 3 * size);
            r.dir = (aim - r.org) * (k % 7 ? 1.f : 1e-3f);
            if (k % 4 == 0) r.tnear = uniform(rng, 0, 1), r.tfar = 1 + uniform(rng, 0, 5);
            if (length(r.dir) > 0) rays.push_back(r);
        }
        std::vector<Hit> hits(rays.size()), plain(rays.size());
        std::vector<uint8_t> any(rays.size());
        accel.intersect(rays, hits);
        accel.occluded(rays, any);
        inside.walkNearest(rays, plain, true);
        for (size_t i = 0; i < rays.size(); ++i) {
            Query q{&rays[i], {INFINITY, kNone, kNone, 0, 0}, false}; // everything, by the same rule
            for (uint32_t k = 0; k < shapes.size(); ++k) {
                if (shapes[k]->exact()) {
                    inside.intersectExact(q, k, 0);
                    continue;
                }
                const geometry::TriMesh& m = shapes[k]->mesh();
                for (uint32_t t = 0; t < m.triangles(); ++t)
                    inside.meetOne(q, k, t, m.P[m.index[3 * t]], m.P[m.index[3 * t + 1]], m.P[m.index[3 * t + 2]]);
            }
            ASSERT_EQ(hits[i].shape, q.best.shape) << "scene " << scene << " ray " << i;
            ASSERT_EQ(bool(any[i]), q.best.shape != kNone) << "scene " << scene << " ray " << i;
            ASSERT_EQ(plain[i].shape, hits[i].shape);
            if (!hits[i].valid()) continue;
            ++met;
            ASSERT_EQ(hits[i].prim, q.best.prim) << "scene " << scene << " ray " << i;
            ASSERT_EQ(hits[i].distance, q.best.t);
            ASSERT_EQ(plain[i].prim, hits[i].prim);
            ASSERT_EQ(plain[i].distance, hits[i].distance);
            Hit alone;
            ASSERT_TRUE(accel.intersect(rays[i], alone));
            ASSERT_EQ(alone.prim, hits[i].prim);
            ASSERT_EQ(alone.distance, hits[i].distance);
        }
    }
    EXPECT_GT(met, 4000u);
}

// The parts that a tree is opened into hold each triangle once, within their boxes.
TEST(Bvh, PartsHoldAllOfIt) {
    Rng rng(8);
    Diagnostics diag;
    const ShapeRef shape = build(soup(rng, 3000, {3, -2, 8}, 4), Matrix(), diag);
    ASSERT_TRUE(shape);
    Bvh tree;
    tree.build({&shape, 1});
    for (const size_t most : {size_t(1), size_t(8), size_t(60), size_t(100000)}) {
        const auto parts = tree.opened(most);
        EXPECT_LE(parts.size(), most);
        EXPECT_GT(parts.size() * Bvh::kWidth, std::min<size_t>(most, 500));
        std::vector<int> held(shape->mesh().triangles());
        for (const auto& [start, box] : parts) {
            std::vector<Bvh::Child> left{start};
            while (!left.empty()) {
                const Bvh::Child c = left.back();
                left.pop_back();
                if (!(c & Bvh::kLeaf)) {
                    for (const Bvh::Child k : tree.nodes()[c].child)
                        if (k != Bvh::kNothing) left.push_back(k);
                    continue;
                }
                const Bvh::Leaf& leaf = tree.leaves()[c & Bvh::kIndex];
                for (uint32_t t = 0; t < leaf.size(); ++t) {
                    ++held[leaf.id[t]];
                    for (int k = 0; k < 3; ++k)
                        for (int a = 0; a < 3; ++a) {
                            const float x = leaf.point(leaf.vertex(t, k))[a];
                            ASSERT_TRUE(x >= box.lo[a] && x <= box.hi[a]) << most << " " << leaf.id[t];
                        }
                }
            }
        }
        EXPECT_EQ(std::count(held.begin(), held.end(), 1), long(held.size())) << most;
    }
}

namespace {

/// A bent net of 8 by 8 points, as dicing cuts it.
ShapeRef dicedNet(Diagnostics& diag, float far = 0) {
    std::vector<float> P;
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i)
            P.insert(P.end(), {float(i) - 3.5f, std::sin(float(i)) * std::cos(2.f * float(j)), float(j) + 6});
    if (far > 0) P[3 * 63] = far;
    ShapeRef s = build(patchMesh("bilinear", 8, "nonperiodic", 8, "nonperiodic", P), Matrix(), diag);
    geometry::DiceOptions o;
    o.camera.pixelsPerUnit = far > 0 ? 100 / double(far) : 25;
    o.displaces = [](const geometry::Shape&) { return true; }; // facets of a pixel
    o.displace = [](const geometry::Shape&, geometry::DiceGrid& g) {
        for (size_t i = 0; i < g.P.size(); ++i) g.P[i].y += 0.05f * std::sin(7 * g.P[i].x + 5 * g.P[i].z);
    };
    s->dice(o, diag);
    return s;
}

/// By triangle, in how many leaves it is; leaves: how many there are.
std::vector<int> heldBy(const Bvh& tree, uint32_t triangles, size_t& leaves) {
    std::vector<int> held(triangles);
    std::vector<Bvh::Child> left{0};
    for (leaves = 0; !left.empty();) {
        const Bvh::Child c = left.back();
        left.pop_back();
        if (!(c & Bvh::kLeaf)) {
            for (const Bvh::Child k : tree.nodes()[c].child)
                if (k != Bvh::kNothing) left.push_back(k);
            continue;
        }
        ++leaves;
        const Bvh::Leaf& leaf = tree.leaves()[c & Bvh::kIndex];
        for (uint32_t t = 0; t < leaf.size(); ++t) ++held[leaf.id[t]];
    }
    return held;
}

} // namespace

// Rows of quads become full leaves: six triangles with eight corners.
TEST(Bvh, QuickOverAGridIsMadeOfItsLeaves) {
    Diagnostics diag;
    const ShapeRef net = dicedNet(diag);
    const uint32_t n = net->mesh().triangles();
    ASSERT_GT(n, 40'000u);
    Bvh quick;
    quick.build({&net, 1}, {}, {}, {}, Building::Quick);
    size_t leaves = 0;
    const std::vector<int> held = heldBy(quick, n, leaves);
    EXPECT_EQ(std::count(held.begin(), held.end(), 1), long(n));
    EXPECT_LT(double(leaves), double(n) / 4.5); // the borders of blocks and ends of rows have fewer
    Bvh best;
    best.build({&net, 1});
    size_t others = 0;
    heldBy(best, n, others);
    EXPECT_LT(leaves, others);
    // Neighbours of what reaches too far are there.
    const ShapeRef wide = dicedNet(diag, 1e31f);
    Bvh quickWide;
    quickWide.build({&wide, 1}, {}, {}, {}, Building::Quick);
    const std::vector<int> some = heldBy(quickWide, wide->mesh().triangles(), leaves);
    long far = 0;
    for (uint32_t t = 0; t < wide->mesh().triangles(); ++t) {
        bool reaches = false;
        for (uint32_t k = 0; k < 3; ++k) reaches |= Bvh::reaches(wide->mesh().P[wide->mesh().index[3 * t + k]]);
        ASSERT_EQ(some[t], reaches ? 0 : 1) << t;
        far += reaches;
    }
    EXPECT_GT(far, 0);
    EXPECT_EQ(quickWide.beyond(), size_t(far));
}

TEST(Bvh, QuickMeetsTheSame) {
    Rng rng(11);
    Diagnostics diag;
    const ShapeRef net = dicedNet(diag);
    const std::vector<ShapeRef> shapes{net, build(soup(rng, 300, {0, 0, 9}, 2), Matrix(), diag),
                                       build(quadric("Sphere", {1, -1, 1, 360}), translateMatrix(0, 1, 9), diag)};
    const Accel best(shapes, {}, diag), quick(shapes, {}, diag, true);
    std::vector<Ray> rays;
    for (int k = 0; k < 20'000; ++k) {
        Ray r;
        r.org = k % 2 ? Vec3(0.f) : within(rng, 12);
        r.dir = Vec3(0, 0, 9) + within(rng, 5) - r.org;
        rays.push_back(r);
    }
    std::vector<Hit> a(rays.size()), b(rays.size());
    std::vector<uint8_t> c(rays.size()), d(rays.size());
    best.intersect(rays, a), quick.intersect(rays, b);
    best.occluded(rays, c), quick.occluded(rays, d);
    size_t met = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(a[i].shape, b[i].shape) << i;
        ASSERT_EQ(c[i], d[i]) << i;
        if (!a[i].valid()) continue;
        ++met;
        ASSERT_EQ(a[i].prim, b[i].prim) << i;
        ASSERT_EQ(a[i].distance, b[i].distance) << i;
        ASSERT_EQ(a[i].b1, b[i].b1) << i;
    }
    EXPECT_GT(met, 4'000u);
}

// Whether anything is met, of rays that end or begin about where the only triangle is: as the triangle itself has it.
TEST(Bvh, AnyHitAtTheEndsOfRays) {
    Rng rng(5);
    for (int k = 0; k < 3000; ++k) {
        const float size = std::pow(10.f, uniform(rng, -3, 4));
        const std::vector<Vec3> corners = {within(rng, size), within(rng, size), within(rng, size)};
        Diagnostics diag;
        const ShapeRef shape = build(trianglesOf(corners, {0, 1, 2}), Matrix(), diag);
        if (!shape) continue;
        Accel::Impl inside; // an Accel looks at one triangle without a tree
        inside.shapes = {shape};
        inside.visibility.assign(1, kAll);
        inside.tree.build(inside.shapes);
        const float s = uniform(rng, 0, 1), u = k % 3 ? uniform(rng, 0, 1 - s) : 0; // on an edge, too
        const Vec3 aim = corners[0] + (corners[1] - corners[0]) * s + (corners[2] - corners[0]) * u;
        Ray r;
        r.org = within(rng, 3 * size);
        r.dir = aim - r.org;
        if (!(length(r.dir) > 0)) continue;
        std::vector<Ray> rays;
        for (const float end : {.5f, .999f, 1 - 0x1p-22f, 1 - 0x1p-24f, 1.f, 1 + 0x1p-23f, 1 + 0x1p-21f, 1.001f, 2.f}) {
            rays.push_back(r);
            rays.back().tfar = end;
            rays.push_back(r);
            rays.back().tnear = end;
        }
        std::vector<uint8_t> any(rays.size());
        inside.walkAny(rays, any);
        for (size_t i = 0; i < rays.size(); ++i) {
            Query q{&rays[i], {INFINITY, kNone, kNone, 0, 0}, false};
            const geometry::TriMesh& m = shape->mesh();
            const bool want = inside.meetOne(q, 0, 0, m.P[m.index[0]], m.P[m.index[1]], m.P[m.index[2]]);
            ASSERT_EQ(bool(any[i]), want) << k << " " << i;
        }
    }
}

// Triangles at the end of all floats have no boxes that rays could pass by. They are left out, all else is met as without them.
TEST(Bvh, TrianglesThatReachTooFarAreLeftOut) {
    for (const int n : {5, 3000}) { // without a tree, and with one
        Rng rng(4);
        Diagnostics quiet, diag;
        const auto near = soup(rng, n, Vec3(0.f), 10);
        std::vector<Vec3> corners;
        std::vector<int> index;
        for (int i = 0; i < 3 * n; ++i) {
            corners.push_back(i % 3 == 1 ? within(rng, 1) * 3e38f : within(rng, 10));
            index.push_back(i);
        }
        corners[1] = Vec3(1, 2, 3);
        const ShapeRef a = build(near, Matrix(), quiet), b = build(trianglesOf(corners, index), Matrix(), quiet);
        ASSERT_TRUE(a && b) << (quiet.all().empty() ? "" : quiet.all()[0].message);
        const auto kept = build(trianglesOf({corners[0], corners[1], corners[2]}, {0, 1, 2}), Matrix(), quiet);
        Accel all({a, b}, {}, diag), without({a, kept}, {}, quiet);
        EXPECT_TRUE(quiet.all().empty());
        ASSERT_EQ(diag.all().size(), 1u);
        EXPECT_NE(diag.all()[0].message.find(std::to_string(n - 1) + " triangles"), std::string::npos) << diag.all()[0].message;
        int met = 0;
        for (int k = 0; k < 2000; ++k) {
            Ray r;
            r.org = within(rng, 30);
            r.dir = within(rng, 10) - r.org;
            Hit x, y;
            ASSERT_EQ(all.intersect(r, x), without.intersect(r, y));
            met += x.valid();
            if (!x.valid()) continue;
            ASSERT_EQ(x.shape, y.shape);
            ASSERT_EQ(x.prim, y.prim);
            ASSERT_EQ(x.distance, y.distance);
        }
        EXPECT_GT(met, n > 5 ? 500 : 5);
    }
}

TEST(Bvh, RaysAtCornersAndEdgesDoNotSlipThrough) {
    for (double scale : {1e-3, 1.0, 1e5}) {
        Diagnostics diag;
        const Matrix m =
            rotateMatrix(31, 1, 2, 3) * scaleMatrix(scale, scale, scale) * translateMatrix(20 * scale, -3 * scale, 50 * scale);
        ShapeRef s = build(ball(120, 240), m, diag);
        ASSERT_TRUE(s);
        Accel accel({s}, {}, diag);
        const geometry::TriMesh& mesh = s->mesh();
        Rng rng(9);
        std::vector<Ray> rays;
        const Vec3 middle = Vec3(transformPoint(m, Vec3d(0.1, 0.02, -0.03)));
        for (uint32_t t = 0; t < mesh.triangles(); ++t)
            for (int k = 0; k < 3; ++k) {
                const Vec3 a = mesh.P[mesh.index[3 * size_t(t) + size_t(k)]],
                           b = mesh.P[mesh.index[3 * size_t(t) + size_t((k + 1) % 3)]];
                Ray r;
                r.org = middle + within(rng, float(0.3 * scale));
                r.dir = a + (b - a) * (k == 0 ? 0.f : uniform(rng, 0, 1)) - r.org;
                rays.push_back(r);
            }
        std::vector<Hit> hits(rays.size());
        accel.intersect(rays, hits);
        size_t leaks = 0;
        for (const Hit& h : hits) leaks += !h.valid();
        EXPECT_EQ(leaks, 0u) << "scale " << scale;
    }
}

TEST(Bvh, AlikeShapesInOnePlaceEndInLeaves) {
    // A thousand equal triangles and spheres: nothing divides them, and the first counts.
    Diagnostics diag;
    std::vector<ShapeRef> shapes;
    for (int k = 0; k < 1000; ++k) {
        shapes.push_back(build(polygon({-1, -1, 0, -1, 1, 0, 1, 1, 0}), translateMatrix(0, 0, 3), diag));
        shapes.push_back(build(quadric("Sphere", {1, -1, 1, 360}), translateMatrix(0, 0, 8), diag));
    }
    Accel accel(shapes, {}, diag);
    Ray r;
    r.dir = Vec3(-0.1f, 0.1f, 1);
    Hit h;
    ASSERT_TRUE(accel.intersect(r, h));
    EXPECT_EQ(h.shape, 0u);
    r.dir = Vec3(0.05f, -0.05f, 1);
    ASSERT_TRUE(accel.intersect(r, h));
    EXPECT_EQ(h.shape, 1u);
}

} // namespace tree_test
