// T12: leaks, self-hits, agreement with brute force, ties, visibility, Sides; at sizes that run in seconds.
#include "../geometry/make.h"
#include "accel/accel.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <thread>

namespace accel_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using alpenglow::accel::Accel;
using alpenglow::accel::Hit;
using alpenglow::accel::Ray;

namespace {

using Rng = std::mt19937;
double uniform(Rng& r) { return r() / 4294967296.0; }
Vec3 direction(Rng& r) {
    double z = 2 * uniform(r) - 1, a = 2 * kPi * uniform(r), s = std::sqrt(1 - z * z);
    return Vec3(float(s * std::cos(a)), float(s * std::sin(a)), float(z));
}

std::shared_ptr<scene::Primitive> cube() {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "PointsPolygons";
    p->ints.assign(6, 4);
    p->ints2 = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    std::vector<float> P;
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) P.push_back((i >> k & 1) ? 1.f : -1.f);
    p->params = {points(P)};
    return p;
}

// A tube closed at both ends by points, as a periodic bicubic mesh.
std::shared_ptr<scene::Primitive> closedMesh() {
    int nu = 12, nv = 7;
    std::vector<float> P;
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            double a = 2 * kPi * i / nu, r = j == 0 || j == nv - 1 ? 0 : 1.2, z = -1 + 2.0 * j / (nv - 1);
            P.insert(P.end(), {float(r * std::cos(a)), float(r * std::sin(a)), float(z)});
        }
    return patchMesh("bicubic", nu, "periodic", nv, "nonperiodic", P);
}

struct Scene {
    Diagnostics diag;
    std::unique_ptr<Accel> accel;
    Scene(const std::vector<std::shared_ptr<scene::Primitive>>& prims, const Matrix& m, const scene::Attributes& a = {},
          const std::vector<uint32_t>& mask = {}) {
        std::vector<ShapeRef> shapes;
        for (const auto& p : prims)
            if (auto s = build(p, m, diag, a)) shapes.push_back(s);
        DiceOptions opt;
        opt.camera = {true, 200};
        diceShapes(shapes, opt, diag);
        accel = std::make_unique<Accel>(shapes, mask, diag);
    }
};

std::vector<std::vector<std::shared_ptr<scene::Primitive>>> closedSets() {
    return {
        {quadric("Sphere", {1, -1, 1, 360})},
        {quadric("Cylinder", {0.7f, -0.6f, 0.8f, 360}), quadric("Disk", {-0.6f, 0.7f, 360}), quadric("Disk", {0.8f, 0.7f, 360})},
        {quadric("Sphere", {1, -1, 0.3f, 360}), quadric("Disk", {0.3f, std::sqrt(1 - 0.09f), 360})},
        {quadric("Sphere", {1, -1, 1, 130}), quadric("Sphere", {1, -1, 1, -230})},
        {quadric("Hyperboloid", {0.4f, -0.4f, -0.4f, 0.4f, 0.4f, 0.4f, 360}), quadric("Disk", {-0.4f, std::sqrt(0.32f), 360}),
         quadric("Disk", {0.4f, std::sqrt(0.32f), 360})},
        {quadric("Paraboloid", {0.8f, 0, 0.9f, 360}), quadric("Disk", {0.9f, 0.8f, 360})},
        {cube()},
        {closedMesh()},
    };
}

} // namespace

TEST(Leaks, NoRayLeavesAClosedShape) {
    Matrix m = skewed();
    size_t which = 0;
    for (auto& set : closedSets()) {
        Scene s(set, m);
        Rng rng(7);
        // An inner point of every set: the paraboloid's lies above its apex.
        Vec3d o = transformPoint(m, Vec3d(0.02, 0.01, which == 5 ? 0.5 : 0.03));
        int leaks = 0;
        for (int i = 0; i < 200'000; ++i) {
            Ray r;
            r.org = Vec3(o);
            r.dir = direction(rng);
            Hit h;
            leaks += !s.accel->intersect(r, h);
        }
        EXPECT_EQ(leaks, 0) << "set " << which;
        ++which;
    }
}

TEST(Leaks, TorusIsMetFourTimesOrTwice) {
    Scene s({quadric("Torus", {1, 0.25f, 0, 360, 360})}, skewed());
    const Shape& torus = *s.accel->shapes()[0];
    Rng rng(3);
    Vec3d inside = transformPoint(skewed(), Vec3d(1.05, 0, 0.02));
    for (int i = 0; i < 100'000; ++i) {
        // A line through a point inside the tube: an odd number of hits each way.
        ExactHit h[4];
        Vec3 d = direction(rng);
        int n = torus.exactHits(inside, Vec3d(d), h), ahead = 0;
        for (int k = 0; k < n; ++k) {
            ahead += h[k].t > 0;
            Vec3d hit = inside + Vec3d(d) * h[k].t;
            EXPECT_LT(length(hit - Vec3d(torus.evaluate(0, h[k].u, h[k].v).P)), 4e-6);
        }
        ASSERT_EQ(ahead % 2, 1) << i;
        ASSERT_EQ(n % 2, 0) << i;
    }
}

TEST(Hits, PointsLieOnTheRayAndOnTheSurface) {
    for (auto& set : closedSets()) {
        Scene s(set, skewed());
        Rng rng(5);
        for (int i = 0; i < 2000; ++i) {
            Ray r;
            r.dir = normalize(Vec3(0.3f, -1, 7) + direction(rng));
            Hit h;
            if (!s.accel->intersect(r, h)) continue;
            SurfacePoint p = s.accel->point(h);
            Vec3d on = Vec3d(r.dir) * double(h.t);
            EXPECT_LT(length(on - Vec3d(p.P)), p.pError * 2 + 3e-6) << set[0]->kind;
        }
    }
}

TEST(SelfHit, SpawnedRaysDoNotMeetTheirOwnPlane) {
    for (double scale : {1e-3, 1.0, 1e3, 1e6})
        for (double offset : {0.0, 1e6}) {
            Matrix m = rotateMatrix(37, 1, 1, 0.2) * scaleMatrix(scale, scale, scale) *
                       translateMatrix(offset, -offset * 0.5, offset + 3 * scale);
            Scene s({polygon({-1, -1, 0, -1, 1, 0, 1, 1, 0, 1, -1, 0})}, m);
            Rng rng(11);
            int again = 0;
            for (int i = 0; i < 20'000; ++i) {
                SurfacePoint p = s.accel->shapes()[0]->sampleArea(uniform(rng), uniform(rng));
                Ray r;
                r.dir = direction(rng);
                r.org = offsetOrigin(p, r.dir);
                Hit h;
                again += s.accel->intersect(r, h);
                again += s.accel->occluded(r);
            }
            EXPECT_EQ(again, 0) << "scale " << scale << " offset " << offset;
        }
}

TEST(SelfHit, RaysLeavingConvexShapesOutwardMeetNothing) {
    for (auto& set : {closedSets()[0], closedSets()[1], closedSets()[6]})
        for (double scale : {1e-3, 1.0, 1e6}) {
            Matrix m = rotateMatrix(20, 0, 1, 1) * scaleMatrix(scale, scale, scale) * translateMatrix(scale, 0, 4 * scale);
            Scene s(set, m);
            Rng rng(13);
            int again = 0;
            Vec3d middle = transformPoint(m, Vec3d(0, 0, 0.1));
            for (int i = 0; i < 20'000; ++i) {
                Ray r;
                r.org = Vec3(middle);
                r.dir = direction(rng);
                Hit h;
                ASSERT_TRUE(s.accel->intersect(r, h));
                SurfacePoint p = s.accel->point(h);
                Vec3 out = dot(p.n, r.dir) > 0 ? p.n : -p.n, d = direction(rng);
                r.dir = dot(d, out) > 0 ? d : -d;
                r.org = offsetOrigin(p, r.dir);
                again += s.accel->intersect(r, h);
            }
            EXPECT_EQ(again, 0) << set[0]->kind << " scale " << scale;
        }
}

TEST(Agreement, TheTreeAndTheLoopOverEverythingGiveTheSameHit) {
    std::vector<std::shared_ptr<scene::Primitive>> all;
    for (auto& set : closedSets()) all.insert(all.end(), set.begin(), set.end());
    all.push_back(quadric("Torus", {1, 0.3f, 30, 300, 250}));
    all.push_back(quadric("Cone", {1, 1, 300}));
    Scene s(all, skewed());
    const auto& shapes = s.accel->shapes();
    Rng rng(17);
    int hits = 0;
    for (int i = 0; i < 1500; ++i) {
        Ray r;
        r.dir = normalize(Vec3(0.3f, -1, 7) + direction(rng) * 1.5f);
        double best = INFINITY;
        uint32_t shape = accel::kNone, prim = 0;
        for (uint32_t k = 0; k < shapes.size(); ++k) {
            if (shapes[k]->exact()) {
                ExactHit h[4];
                int n = shapes[k]->exactHits(Vec3d(r.org), Vec3d(r.dir), h);
                for (int q = 0; q < n; ++q)
                    if (h[q].t > 0 && h[q].t < best) best = h[q].t, shape = k, prim = 0;
                continue;
            }
            const TriMesh& m = shapes[k]->mesh();
            for (uint32_t t = 0; t < m.triangles(); ++t) {
                double at, b1, b2, outside;
                const uint32_t* v = &m.index[3 * size_t(t)];
                if (!accel::intersectTriangle(r.org, r.dir, m.P[v[0]], m.P[v[1]], m.P[v[2]], at, b1, b2, outside)) continue;
                if (outside == 0 && at > 0 && at < best) best = at, shape = k, prim = t;
            }
        }
        Hit h;
        bool hit = s.accel->intersect(r, h);
        ASSERT_EQ(hit, shape != accel::kNone);
        EXPECT_EQ(s.accel->occluded(r), hit);
        if (!hit) continue;
        ++hits;
        EXPECT_EQ(h.shape, shape);
        EXPECT_EQ(h.prim, prim);
        EXPECT_EQ(h.t, float(best));
    }
    EXPECT_GT(hits, 100);
}

TEST(Ties, GoToTheLowerShapeWhateverTheBuild) {
    // Three equal polygons in one place: always the first that counts.
    auto p = polygon({-1, -1, 0, -1, 1, 0, 1, 1, 0, 1, -1, 0});
    Scene s({p, p, p}, translateMatrix(0, 0, 3), {}, {accel::kDiffuse, accel::kAll, accel::kAll});
    Rng rng(19);
    for (int i = 0; i < 2000; ++i) {
        Ray r;
        r.dir = Vec3(float(uniform(rng) * 0.5 - 0.25), float(uniform(rng) * 0.5 - 0.25), 1);
        Hit h;
        ASSERT_TRUE(s.accel->intersect(r, h));
        EXPECT_EQ(h.shape, 0u);
        r.mask = accel::kCamera;
        ASSERT_TRUE(s.accel->intersect(r, h));
        EXPECT_EQ(h.shape, 1u);
        r.excludeShape = 1;
        ASSERT_TRUE(s.accel->intersect(r, h));
        EXPECT_EQ(h.shape, 2u);
    }
}

TEST(Threads, SameBitsForAnyOrder) {
    std::vector<std::shared_ptr<scene::Primitive>> all;
    for (auto& set : closedSets()) all.insert(all.end(), set.begin(), set.end());
    Scene a(all, skewed()), b(all, skewed());
    std::vector<Ray> rays(20000);
    Rng rng(23);
    for (Ray& r : rays) r.dir = normalize(Vec3(0.3f, -1, 7) + direction(rng));
    std::vector<Hit> one(rays.size()), two(rays.size());
    a.accel->intersect(std::span<const Ray>(rays), one);
    size_t half = rays.size() / 2;
    std::thread t([&] {
        for (size_t i = rays.size(); i-- > half;) b.accel->intersect(rays[i], two[i]);
    });
    for (size_t i = half; i-- > 0;) b.accel->intersect(rays[i], two[i]);
    t.join();
    for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(one[i].shape, two[i].shape);
        ASSERT_EQ(one[i].prim, two[i].prim);
        ASSERT_EQ(one[i].t, two[i].t);
        ASSERT_EQ(one[i].b1, two[i].b1);
        ASSERT_EQ(one[i].b2, two[i].b2);
    }
}

TEST(Sides, OneSidedShapesAreInvisibleFromBehind) {
    scene::Attributes a;
    a.sides = 1;
    Scene s({quadric("Sphere", {1, -1, 1, 360})}, translateMatrix(0, 0, 5), a);
    Ray r;
    r.dir = Vec3(0, 0, 1);
    Hit h;
    ASSERT_TRUE(s.accel->intersect(r, h));
    EXPECT_NEAR(h.t, 4, 1e-5);
    r.org = Vec3(0, 0, 5); // from inside every normal faces away
    EXPECT_FALSE(s.accel->intersect(r, h));
    EXPECT_FALSE(s.accel->occluded(r));
    r.sides = accel::Sides::Both;
    EXPECT_TRUE(s.accel->intersect(r, h));
    a.inside = true; // normals inward: seen from outside, only the far half is there
    Scene in({quadric("Sphere", {1, -1, 1, 360})}, translateMatrix(0, 0, 5), a);
    r = Ray();
    r.dir = Vec3(0, 0, 1);
    ASSERT_TRUE(in.accel->intersect(r, h));
    EXPECT_NEAR(h.t, 6, 1e-5);
}

TEST(Hostile, OddRaysMissAndEmptyScenesWork) {
    Scene s({quadric("Sphere", {1, -1, 1, 360})}, translateMatrix(0, 0, 5));
    Hit h;
    for (float bad : {NAN, INFINITY, -INFINITY}) {
        Ray r;
        r.dir = Vec3(0, bad, 1);
        EXPECT_FALSE(s.accel->intersect(r, h));
        EXPECT_FALSE(s.accel->occluded(r));
    }
    Ray zero;
    EXPECT_FALSE(s.accel->intersect(zero, h));
    Scene none({}, Matrix());
    Ray r;
    r.dir = Vec3(0, 0, 1);
    EXPECT_FALSE(none.accel->intersect(r, h));
    EXPECT_EQ(none.diag.errors(), 0);
}

} // namespace accel_test
