// Exact shapes of many primitives: the same as so many shapes.
#include "../geometry/make.h"
#include "accel/accel.h"
#include "geometry/solve.h"
#include <atomic>
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <thread>

namespace exact_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using alpenglow::accel::Accel;
using alpenglow::accel::Hit;
using alpenglow::accel::Ray;

namespace {

double uniform(std::mt19937& r) { return r() / 4294967296.0; }
Vec3d within(std::mt19937& r, double size) { return Vec3d(uniform(r) - 0.5, uniform(r) - 0.5, uniform(r) - 0.5) * (2 * size); }

struct OneBall {
    Vec3d centre;
    double radius;
};

/// Balls, from the first of a list to the last.
class Balls final : public Shape {
public:
    Balls(ShapeSource s, std::vector<OneBall> balls) : Shape(std::move(s)), balls_(std::move(balls)) {}
    uint32_t exactPrims() const override { return uint32_t(balls_.size()); }
    Bounds exactBounds(uint32_t k) const override {
        Bounds b;
        const Vec3d r(balls_[k].radius * 1.0001 + 1e-4);
        b.add(Vec3(balls_[k].centre - r));
        b.add(Vec3(balls_[k].centre + r));
        return b;
    }
    Bounds bounds() const override {
        Bounds b;
        for (uint32_t k = 0; k < exactPrims(); ++k) b.add(exactBounds(k));
        return b;
    }
    using Shape::exactHits;
    int exactHits(uint32_t k, const Vec3d& o, const Vec3d& d, double lo, double hi, Wanted, ExactHit out[4]) const override {
        const Vec3d to = o - balls_[k].centre;
        double t[2];
        int n = solveQuadratic(dot(d, d), dot(to, d), dot(to, to) - balls_[k].radius * balls_[k].radius, t), m = 0;
        for (int i = 0; i < n; ++i)
            if (t[i] > lo && t[i] <= hi) out[m++] = {t[i], double(k), t[i]};
        return m;
    }
    SurfacePoint evaluate(int, double, double) const override { return {}; }
    double area() const override { return 0; }
    SurfacePoint sampleArea(double, double) const override { return {}; }
    double sampleDensity(const SurfacePoint&) const override { return 0; }

protected:
    size_t classCount(scene::Class) const override { return 1; }
    int weights(scene::Class, const SurfacePoint&, Weight[16]) const override { return 0; }
    SurfacePoint evaluateLocal(uint32_t, double, double) const override { return {}; }

private:
    std::vector<OneBall> balls_;
};

ShapeRef shapeOf(std::vector<OneBall> balls) {
    ShapeSource s;
    s.primitive = quadric("Points", {});
    s.attributes = std::make_shared<scene::Attributes>();
    return std::make_shared<Balls>(s, std::move(balls));
}

} // namespace

TEST(ExactPrims, AreMetLikeSoManyShapes) {
    for (size_t count : {1, 2, 3, 700}) {
        std::mt19937 rng(5);
        std::vector<OneBall> balls(count);
        for (OneBall& b : balls) b = {within(rng, 10), 0.05 + uniform(rng)};
        for (size_t i = 0; i + 1 < count; i += 9) balls[i + 1] = balls[i]; // at one place
        std::vector<ShapeRef> each;
        for (const OneBall& b : balls) each.push_back(shapeOf({b}));
        Diagnostics diag;
        // A polygon before and behind them: numbers of triangles and of balls are apart.
        const ShapeRef wall = build(polygon({-9, -9, 4, -9, 9, 4, 9, 9, 4, 9, -9, 4}), Matrix(), diag);
        std::vector<ShapeRef> one{wall, shapeOf(balls), wall};
        each.insert(each.begin(), wall);
        each.push_back(wall);
        Accel a(one, {}, diag), b(each, {}, diag);
        size_t met = 0;
        for (int i = 0; i < 3000; ++i) {
            Ray r;
            r.org = Vec3(within(rng, 14));
            r.dir = Vec3(within(rng, 10)) - r.org;
            Ray s = r;
            // All that the ray goes through, one behind the other: in the same order, nothing twice.
            for (int k = 0; k < 200; ++k) {
                Hit x, y;
                ASSERT_EQ(a.occluded(r), b.occluded(s));
                const bool hit = a.intersect(r, x);
                ASSERT_EQ(hit, b.intersect(s, y)) << count << " ray " << i << " hit " << k;
                if (!hit) break;
                ++met;
                ASSERT_EQ(x.distance, y.distance);
                const uint32_t behind = uint32_t(each.size()) - 1;
                ASSERT_EQ(y.shape, x.shape == 0   ? 0
                                   : x.shape == 2 ? behind
                                                  : 1 + x.prim)
                    << count << " ray " << i << " hit " << k;
                if (x.shape == 1) ASSERT_EQ(x.b1, double(x.prim));
                for (auto [ray, at] : {std::pair(&r, &x), std::pair(&s, &y)}) {
                    ray->excludeShape = at->shape;
                    ray->excludePrim = at->prim;
                    ray->passed = at->distance;
                }
                ASSERT_LT(k, 199);
            }
        }
        EXPECT_GT(met, 2500u);
    }
}

// A flag that is set while rays meet a hundred thousand balls in one place, several seconds of work, ends it at once.
TEST(ExactPrims, AFlagStopsTheSearch) {
    Diagnostics diag;
    Accel all({shapeOf(std::vector<OneBall>(100'000, {Vec3d(0, 0, 5), 1}))}, {}, diag);
    Ray r;
    r.dir = Vec3(0, 0, 1);
    r.tnear = 4.5f; // within all of them, whose surfaces it does not reach: none makes another needless
    r.tfar = 5.5f;
    const std::vector<Ray> rays(4000, r);
    std::vector<Hit> hits(rays.size());
    std::vector<uint8_t> met(rays.size());
    for (const bool any : {false, true}) {
        StopFlag stop;
        std::atomic<bool> begun = false;
        std::chrono::steady_clock::time_point set, ended;
        std::thread search([&] {
            begun = true;
            if (any) all.occluded(rays, met, &stop);
            else all.intersect(rays, hits, &stop);
            ended = std::chrono::steady_clock::now();
        });
        while (!begun) std::this_thread::yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        set = std::chrono::steady_clock::now();
        stop = 1;
        search.join();
        EXPECT_GT(ended, set);
        EXPECT_LT(ended - set, std::chrono::milliseconds(500));
        EXPECT_FALSE(hits.back().valid());
    }
}

} // namespace exact_test
