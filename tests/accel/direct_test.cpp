// Tiny scenes are looked through without a tree: no triangle is overlooked, and the answer is the tree's.
#include "../geometry/make.h"
#include "accel/accel.h"
#include "accel/direct.h"
#include "accel/directblock.h"
#include "geometry/dice.h"
#include <array>
#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace direct_test {

using namespace alpenglow;
using namespace alpenglow::accel;
using namespace alpenglow::geometry::test;

namespace {

using Rng = std::mt19937;
float uniform(Rng& r, float lo, float hi) { return lo + (hi - lo) * float(r() / 4294967296.0); }
Vec3 within(Rng& r, float size) { return {uniform(r, -size, size), uniform(r, -size, size), uniform(r, -size, size)}; }

TEST(DirectTriangles, NoneIsOverlooked) {
    Rng rng(5);
    size_t met = 0, asked = 0, candidates = 0;
    for (int scene = 0; scene < 400; ++scene) {
        float size = std::pow(10.f, uniform(rng, -3, 4)), away = scene % 3 == 0 ? 100 * size : 0,
              thin = scene % 5 == 0 ? 1e-4f : 1;
        Vec3 centre = within(rng, away);
        DirectTriangles triangles;
        size_t n = 1 + rng() % DirectTriangles::kMost;
        for (uint32_t i = 0; i < n; ++i) {
            Vec3 a = centre + within(rng, size), e = within(rng, size);
            triangles.add({a, a + e, a + e * 0.5f + within(rng, size * thin), i, 0});
        }
        for (int k = 0; k < 200; ++k) {
            Ray r;
            const DirectTriangles::Triangle &from = triangles[rng() % n], &to = triangles[rng() % n];
            // From anywhere or from a triangle, toward a corner, an edge or the inside of another.
            r.org = k % 2 ? centre + within(rng, 3 * size) : from.a + (from.b - from.a) * 0.3f + (from.c - from.a) * 0.3f;
            float s = k % 3 ? uniform(rng, 0, 1) : 0, t = k % 5 ? uniform(rng, 0, 1 - s) : 0;
            r.dir = (to.a + (to.b - to.a) * s + (to.c - to.a) * t - r.org) * (k % 7 ? 1.f : 1e-3f);
            if (!(length(r.dir) > 0)) continue;
            alignas(64) DirectTriangles::Near near;
            uint32_t found = triangles.candidates(r, near);
            for (size_t i = 0; i < n; ++i) {
                double at, b1, b2, outside;
                bool hit = intersectTriangle(r.org, r.dir, triangles[i].a, triangles[i].b, triangles[i].c, at, b1, b2, outside) &&
                           outside <= 0 && at > r.tnear && at < r.tfar;
                ++asked;
                met += hit;
                candidates += found >> i & 1;
                ASSERT_TRUE(!hit || (found >> i & 1)) << "scene " << scene << " ray " << k << " triangle " << i << " t " << at;
                ASSERT_TRUE(!hit || !(near[i] > at)) << "scene " << scene << " ray " << k << " triangle " << i << " t " << at;
            }
        }
    }
    EXPECT_GT(met, 20000u);
    EXPECT_LT(candidates, asked / 2); // else nothing would be gained; the rays were chosen to be hard
}

TEST(DirectTriangles, TheAnswerIsTheTrees) {
    Diagnostics diag;
    Rng rng(6);
    auto make = [&](bool tree) {
        std::vector<geometry::ShapeRef> shapes;
        Rng same(7);
        for (int i = 0; i < 5; ++i) {
            auto p = std::make_shared<scene::Primitive>();
            p->kind = "Polygon";
            Vec3 a = within(same, 1), b = within(same, 1), c = within(same, 1);
            p->params = {points({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z})};
            shapes.push_back(build(p, translateMatrix(0, 0, 5), diag));
        }
        auto ball = std::make_shared<scene::Primitive>();
        ball->kind = "Sphere";
        ball->numbers = {0.5, -0.5, 0.5, 360};
        shapes.push_back(build(ball, translateMatrix(0.2, 0, 5), diag));
        if (tree) { // far behind: many triangles that no ray below meets
            auto p = std::make_shared<scene::Primitive>();
            p->kind = "PointsPolygons";
            std::vector<float> P;
            for (int i = 0; i < 40; ++i) {
                p->ints.push_back(3);
                for (int k = 0; k < 3; ++k) {
                    p->ints2.push_back(3 * i + k);
                    P.insert(P.end(), {1e4f + float(i), float(k == 1), float(k == 2)});
                }
            }
            p->params = {points(P)};
            shapes.push_back(build(p, {}, diag));
        }
        for (const auto& s : shapes) EXPECT_NE(s, nullptr);
        return std::make_unique<Accel>(shapes, std::vector<uint32_t>{}, diag);
    };
    auto direct = make(false), tree = make(true);
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        Ray r;
        r.org = Vec3(0, 0, 5) + within(rng, 2);
        r.dir = normalize(Vec3(0, 0, 5) + within(rng, 1) - r.org);
        if (i % 4 == 0) r.tfar = uniform(rng, 0, 3);
        Hit a, b;
        ASSERT_EQ(direct->intersect(r, a), tree->intersect(r, b)) << i;
        ASSERT_EQ(direct->occluded(r), tree->occluded(r)) << i;
        if (!a.valid()) continue;
        ++met;
        ASSERT_EQ(a.shape, b.shape);
        ASSERT_EQ(a.t, b.t);
        ASSERT_EQ(a.b1, b.b1);
        ASSERT_EQ(a.b2, b.b2);
    }
    EXPECT_GT(met, 5000);
}

/// Triangles of any size and place, a ball among them, seen by some rays each.
std::unique_ptr<Accel> someShapes(Rng& rng, Vec3& centre, float& size, std::vector<std::array<Vec3, 3>>& corners) {
    Diagnostics diag;
    size = std::pow(10.f, uniform(rng, -2, 3));
    centre = Vec3(0, 0, 3 * size) + within(rng, rng() % 3 ? size : 50 * size);
    std::vector<geometry::ShapeRef> shapes;
    std::vector<uint32_t> visibility;
    corners.clear();
    for (int i = 0, n = 1 + int(rng() % 20); i < n; ++i) {
        auto p = std::make_shared<scene::Primitive>();
        p->kind = "Polygon";
        Vec3 a = centre + within(rng, size), b = centre + within(rng, size), c = centre + within(rng, size);
        if (i % 3 && !corners.empty()) b = corners.back()[1], c = corners.back()[2]; // a neighbour
        corners.push_back({a, b, c});
        p->params = {points({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z})};
        shapes.push_back(build(p, {}, diag));
        visibility.push_back(rng() % 4 ? kAll : kCamera);
    }
    auto ball = std::make_shared<scene::Primitive>();
    ball->kind = "Sphere";
    ball->numbers = {.4f * size, -.4f * size, .4f * size, 360};
    shapes.push_back(build(ball, translateMatrix(centre.x, centre.y, centre.z), diag));
    visibility.push_back(kAll);
    return std::make_unique<Accel>(shapes, visibility, diag);
}

TEST(DirectTriangles, BlocksOfRaysHaveTheBitsOfOne) {
    Rng rng(8);
    size_t met = 0, blocked = 0;
    for (int scene = 0; scene < 150; ++scene) {
        Vec3 centre;
        float size;
        std::vector<std::array<Vec3, 3>> corners;
        const auto accel = someShapes(rng, centre, size, corners);
        std::vector<Ray> rays(1 + rng() % 200);
        for (size_t k = 0; k < rays.size(); ++k) {
            Ray& r = rays[k];
            const auto& from = corners[rng() % corners.size()];
            const auto& to = corners[rng() % corners.size()];
            const float s = k % 3 ? uniform(rng, 0, 1) : 0, t = k % 5 ? uniform(rng, 0, 1 - s) : 0;
            r.org = k % 2 ? centre + within(rng, 2 * size) : from[0] + (from[1] - from[0]) * .3f + (from[2] - from[0]) * .3f;
            r.dir = to[0] + (to[1] - to[0]) * s + (to[2] - to[0]) * t - r.org; // tfar 1: to the triangle itself
            if (k % 4 == 0) r.tfar = uniform(rng, 0, 1.5f);
            if (k % 4 == 1) r.tfar = 1;
            if (k % 7 == 0) r.tnear = uniform(rng, 0, 1);
            if (k % 6 == 0) r.mask = kDiffuse;
            if (k % 9 == 0) r.dir = Vec3(k % 2 ? 1.f : -1.f, 0, 0);
            if (k % 11 == 0) r.excludeShape = uint32_t(rng() % corners.size()), r.excludePrim = 0, r.passed = .5;
            if (k % 13 == 0) r.org.y = INFINITY; // meets nothing
            if (k % 17 == 0) r.tfar = r.tnear;
        }
        std::vector<Hit> all(rays.size());
        std::vector<uint8_t> any(rays.size());
        accel->intersect(rays, all);
        accel->occluded(rays, any);
        for (size_t k = 0; k < rays.size(); ++k) {
            Hit one;
            ASSERT_EQ(accel->intersect(rays[k], one), all[k].valid()) << "scene " << scene << " ray " << k;
            ASSERT_EQ(accel->occluded(rays[k]), any[k] != 0) << "scene " << scene << " ray " << k;
            met += one.valid(), blocked += any[k] != 0;
            if (!one.valid()) continue;
            ASSERT_TRUE(one.shape == all[k].shape && one.prim == all[k].prim) << "scene " << scene << " ray " << k;
            ASSERT_TRUE(one.distance == all[k].distance && one.b1 == all[k].b1 && one.b2 == all[k].b2) << scene << " " << k;
        }
    }
    EXPECT_GT(met, 3000u);
    EXPECT_GT(blocked, 3000u);
}

TEST(DirectTriangles, EveryWidthDecidesTheSame) {
    Rng rng(9);
    DirectTriangles triangles;
    for (uint32_t i = 0; i < 17; ++i) triangles.add({within(rng, 1), within(rng, 1), within(rng, 1), i, 0});
    DirectScene scene;
    triangles.copyTo(scene);
    std::fill_n(scene.visible, 17, kAll);
    scene.balls = 1;
    scene.radius2[0] = .25, scene.centre[0][0] = scene.centre[1][0] = scene.centre[2][0] = .1;
    size_t undecided = 0;
    for (int turn = 0; turn < 400; ++turn) {
        DirectRays rays;
        for (size_t k = 0; k < size_t(DirectRays::kSize); ++k) {
            const Vec3 o = within(rng, 2), d = within(rng, 1);
            for (int q = 0; q < 3; ++q) rays.org[q][k] = o[q], rays.dir[q][k] = d[q];
            rays.tnear[k] = 0, rays.tfar[k] = 9, rays.mask[k] = kAll;
        }
        DirectHits first, first2;
        directSearch(4)->nearest(scene, rays, 0xffff, first);
        directSearch(4)->any(scene, rays, 0xffff, first2);
        undecided += size_t(std::popcount(first.undecided));
        for (int lanes : {8, 16}) {
            if (!directSearch(lanes)) continue;
            DirectHits h, h2;
            directSearch(lanes)->nearest(scene, rays, 0xffff, h);
            directSearch(lanes)->any(scene, rays, 0xffff, h2);
            EXPECT_EQ(h.undecided, first.undecided);
            EXPECT_EQ(h.ball[0], first.ball[0]);
            EXPECT_EQ(h2.blocked, first2.blocked);
            EXPECT_EQ(h2.undecided, first2.undecided);
            for (int k = 0; k < DirectRays::kSize; ++k) {
                EXPECT_EQ(h.triangle[k], first.triangle[k]);
                if (h.triangle[k] >= 0) EXPECT_TRUE(h.t[k] == first.t[k] && h.b1[k] == first.b1[k] && h.b2[k] == first.b2[k]);
            }
        }
    }
    EXPECT_LT(undecided, 400u); // of 6,400 rays; else nothing would be gained
}

} // namespace

} // namespace direct_test
