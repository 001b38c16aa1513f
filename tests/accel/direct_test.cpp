// Tiny scenes are looked through without a tree: no triangle is overlooked, and the answer is the tree's.
#include "../geometry/make.h"
#include "accel/accel.h"
#include "accel/direct.h"
#include "geometry/dice.h"
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
                bool hit = meetTriangle(r.org, r.dir, triangles[i].a, triangles[i].b, triangles[i].c, at, b1, b2, outside) &&
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

} // namespace

} // namespace direct_test
