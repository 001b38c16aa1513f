// Solids: volumes against closed forms, boundaries against intervals worked out by hand, faces in common, the side that they look
// to.
#include "../geometry/make.h"
#include "../statistics/nightly.h"
#include "accel/accel.h"
#include "geometry/placed.h"
#include "scene/solids.h"
#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace solids_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using alpenglow::accel::Accel;
using alpenglow::accel::Hit;
using alpenglow::accel::Ray;
using scene::SolidOperation;

namespace {

using Rng = std::mt19937;
double uniform(Rng& r) { return r() / 4294967296.0; }

constexpr float kPart = float(SolidOperation::Part), kUnion = float(SolidOperation::Union),
                kIntersection = float(SolidOperation::Intersection), kDifference = float(SolidOperation::Difference);

scene::Attributes at(std::vector<float> path, int sides = 2) {
    scene::Attributes a;
    for (size_t i = 0; i < path.size(); i += 3)
        a.solid.push_back({uint32_t(path[i]), SolidOperation(int(path[i + 1])), int(path[i + 2])});
    a.sides = sides;
    return a;
}
std::shared_ptr<scene::Primitive> box(Vec3d lo, Vec3d hi) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "PointsPolygons";
    p->ints.assign(6, 4);
    p->ints2 = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    std::vector<float> P;
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) P.push_back(float((i >> k & 1) ? hi[k] : lo[k]));
    p->params = {points(P)};
    return p;
}
struct Scene {
    Diagnostics diag;
    std::vector<ShapeRef> shapes;
    std::unique_ptr<Accel> accel;
    void add(const std::shared_ptr<scene::Primitive>& p, const Matrix& m, const scene::Attributes& a) {
        shapes.push_back(build(p, m, diag, a));
    }
    void ready() {
        accel = std::make_unique<Accel>(shapes, std::vector<uint32_t>(), diag);
        accel->makeSolids(diag);
    }
    std::vector<Hit> all(Ray r) const {
        std::vector<Hit> hits;
        Hit h;
        while (hits.size() < 100 && accel->intersect(r, h)) {
            hits.push_back(h);
            r.excludeShape = h.shape, r.excludePrim = h.prim, r.passed = h.distance;
        }
        return hits;
    }
    /// Of what lies within -3..3 in x and y, seen along z: means of chords.
    double volume(int side = 500) const {
        double sum = 0;
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) {
                Ray r;
                r.org = Vec3(float(-3 + 6 * (i + 0.5037) / side), float(-3 + 6 * (j + 0.4971) / side), -10);
                r.dir = Vec3(0, 0, 1);
                const std::vector<Hit> hits = all(r);
                EXPECT_EQ(hits.size() % 2, 0u);
                for (size_t k = 0; k + 1 < hits.size(); k += 2) sum += hits[k + 1].distance - hits[k].distance;
                EXPECT_EQ(accel->occluded(r), !hits.empty());
            }
        return sum * 36 / (double(side) * side);
    }
};
std::shared_ptr<scene::Primitive> ball(float r) { return quadric("Sphere", {r, -r, r, 360}); }

} // namespace

TEST(Solids, VolumesOfTwoBalls) {
    const double r = 1, d = 0.8, whole = 4 * kPi / 3, lens = kPi * (4 * r + d) * (2 * r - d) * (2 * r - d) / 12;
    const std::pair<float, double> expected[] = {{kUnion, 2 * whole - lens}, {kIntersection, lens}, {kDifference, whole - lens}};
    for (const auto& [operation, volume] : expected) {
        Scene s;
        s.add(ball(1), translateMatrix(-0.4, 0, 0), at({1, operation, 0, 2, kPart, 0}));
        s.add(ball(1), translateMatrix(0.4, 0, 0), at({1, operation, 0, 3, kPart, 1}));
        s.ready();
        // A grid of 500 by 500: the rim is cut to about (6/500)^1.5 of its length.
        EXPECT_NEAR(s.volume(), volume, 2e-3) << operation;
    }
}

TEST(Solids, ACylinderThroughABall) {
    // What is left of a ball with a hole of radius b: 4 pi / 3 (r^2 - b^2)^(3/2), whatever the drill's length.
    Scene s;
    const float b = 0.5f;
    s.add(ball(1), Matrix(), at({1, kDifference, 0, 2, kPart, 0}));
    const Matrix turned = rotateMatrix(35, 1, 0.3, 0);
    s.add(quadric("Cylinder", {b, -2, 2, 360}), turned, at({1, kDifference, 0, 3, kPart, 1}));
    s.add(quadric("Disk", {-2, b, 360}), turned, at({1, kDifference, 0, 3, kPart, 1}));
    s.add(quadric("Disk", {2, b, 360}), turned, at({1, kDifference, 0, 3, kPart, 1}));
    s.ready();
    EXPECT_NEAR(s.volume(), 4 * kPi / 3 * std::pow(1 - b * b, 1.5), 2e-3);
}

TEST(Solids, NestedOnesHaveTheBoundariesOfTheirIntervals) {
    // (A + B) - (C * (D - E)), balls of which a line has one interval each.
    Rng rng(4);
    Vec3d centre[5];
    double radius[5];
    Scene s;
    const std::vector<float> path[5] = {{1, kDifference, 0, 2, kUnion, 0, 3, kPart, 0},
                                        {1, kDifference, 0, 2, kUnion, 0, 4, kPart, 1},
                                        {1, kDifference, 0, 5, kIntersection, 1, 6, kPart, 0},
                                        {1, kDifference, 0, 5, kIntersection, 1, 7, kDifference, 1, 8, kPart, 0},
                                        {1, kDifference, 0, 5, kIntersection, 1, 7, kDifference, 1, 9, kPart, 1}};
    for (int k : {3, 0, 4, 2, 1}) { // in any order
        centre[k] = Vec3d(Vec3(float(uniform(rng) - 0.5), float(uniform(rng) - 0.5), float(uniform(rng) - 0.5)));
        radius[k] = double(0.5f + 0.5f * float(uniform(rng)));
        s.add(ball(float(radius[k])), translateMatrix(centre[k].x, centre[k].y, centre[k].z), at(path[k], 1));
    }
    s.ready();
    const int part[5] = {3, 0, 4, 2, 1}; // by shape
    size_t met = 0;
    for (int i = 0; i < 20000; ++i) {
        Ray r;
        r.org = Vec3(float(6 * uniform(rng) - 3), float(6 * uniform(rng) - 3), -4);
        r.dir = Vec3(float(2 * uniform(rng) - 1), float(2 * uniform(rng) - 1), 0) - r.org;
        r.sides = accel::Sides::Both;
        const Vec3d o(r.org), d(r.dir);
        struct Crossing {
            double t;
            int part;
        };
        std::vector<Crossing> crossings;
        for (int k = 0; k < 5; ++k) {
            const Vec3d w = o - centre[k];
            const double a = dot(d, d), h = dot(w, d), c = dot(w, w) - radius[k] * radius[k], q = h * h - a * c;
            if (q <= 0) continue;
            crossings.push_back({(-h - std::sqrt(q)) / a, k});
            crossings.push_back({(-h + std::sqrt(q)) / a, k});
        }
        std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
        bool in[5] = {}, was = false, near = false;
        std::vector<Crossing> expected;
        for (size_t k = 0; k < crossings.size(); ++k) {
            near |= k && crossings[k].t - crossings[k - 1].t < 1e-4;
            in[crossings[k].part] = !in[crossings[k].part];
            const bool now = (in[0] || in[1]) && !(in[2] && in[3] && !in[4]);
            if (now != was) expected.push_back(crossings[k]);
            was = now;
        }
        if (near) continue;
        const std::vector<Hit> hits = s.all(r);
        ASSERT_EQ(hits.size(), expected.size()) << i;
        for (size_t k = 0; k < hits.size(); ++k) {
            ++met;
            EXPECT_NEAR(hits[k].distance, expected[k].t, 1e-9);
            EXPECT_EQ(part[hits[k].shape], expected[k].part);
            // The outside of the whole: against the ray where it comes in.
            const SurfacePoint p = s.accel->point(hits[k]);
            EXPECT_EQ(dot(p.n, r.dir) < 0, k % 2 == 0) << i;
        }
    }
    EXPECT_GT(met, 20000u);
}

TEST(Solids, FacesInCommonLeaveNoFilm) {
    // A box less a box that ends in its upper face: the hole is open. Two boxes side by side: nothing between them.
    Scene s;
    const Matrix m = rotateMatrix(20, 1, 2, 0.5) * translateMatrix(0.3, 0, 7);
    s.add(box({-1, -1, -1}, {1, 1, 1}), m, at({1, kDifference, 0, 2, kPart, 0}));
    s.add(box({-0.5, -0.5, 0}, {0.5, 0.5, 1}), m, at({1, kDifference, 0, 3, kPart, 1}));
    s.add(box({-1, 5, -1}, {0, 6, 1}), m, at({4, kUnion, 0, 5, kPart, 0}));
    s.add(box({0, 5, -1}, {1, 6, 1}), m, at({4, kUnion, 0, 6, kPart, 1}));
    s.ready();
    Rng rng(6);
    for (int i = 0; i < 3000; ++i) {
        const double x = 0.8 * uniform(rng) - 0.4, y = 0.8 * uniform(rng) - 0.4;
        Ray r;
        r.org = Vec3(transformPoint(m, Vec3d(x, y, 3)));
        r.dir = Vec3(transformVector(m, Vec3d(0.01, 0.02, -1)));
        auto hits = s.all(r);
        ASSERT_EQ(hits.size(), 2u);
        EXPECT_NEAR(hits[0].distance, 3, 1e-5); // the floor of the hole, at z = 0
        EXPECT_EQ(hits[0].shape, 1u);
        r.org = Vec3(transformPoint(m, Vec3d(-4, 5.5 + x, y)));
        r.dir = Vec3(transformVector(m, Vec3d(1, 0.01, 0.02)));
        hits = s.all(r);
        ASSERT_EQ(hits.size(), 2u);
        EXPECT_NEAR(hits[0].distance, 3, 1e-5);
        EXPECT_NEAR(hits[1].distance, 5, 1e-5);
    }
}

TEST(Solids, PointsOfTheirSurfacesAreKeptOrNot) {
    Scene s;
    s.add(ball(1), translateMatrix(-0.4, 0, 5), at({1, kIntersection, 0, 2, kPart, 0}));
    s.add(ball(1), translateMatrix(0.4, 0, 5), at({1, kIntersection, 0, 3, kPart, 1}));
    s.ready();
    Rng rng(7);
    for (int i = 0; i < 2000; ++i) {
        const SurfacePoint p = s.shapes[0]->sampleArea(uniform(rng), uniform(rng));
        const double away = length(Vec3d(p.P) - Vec3d(0.4, 0, 5));
        if (std::fabs(away - 1) < 1e-4) continue;
        EXPECT_EQ(s.accel->keeps(0, p.P, p.n, 0), away < 1);
    }
}

TEST(Solids, InstancesAreSolidsOfTheirOwn) {
    // The same blocks in two instances that lie in one another: each has its hole, though the other fills it.
    Scene s;
    for (int instance = 0; instance < 2; ++instance)
        for (int part = 0; part < 2; ++part) {
            auto a = std::make_shared<scene::Attributes>(at({1, kDifference, 0, float(2 + part), kPart, float(part)}));
            s.shapes.push_back(
                buildShape(ball(part ? 0.5f : 1), a, translateMatrix(0, 0, 5 + 0.25 * instance), instance, s.diag));
        }
    s.ready();
    Ray r;
    r.dir = Vec3(0, 0, 1);
    EXPECT_EQ(s.all(r).size(), 8u);
}

namespace {

/// Of each part its pieces, of several kinds, at a place that may move.
struct Parts : Scene {
    void part(int number, float operation, const std::vector<std::shared_ptr<scene::Primitive>>& pieces, const Matrix& m,
              const Matrix* last = nullptr) {
        for (const auto& p : pieces) {
            ShapeRef s = build(p, m, diag, at({1, operation, 0, float(2 + number), kPart, float(number)}));
            if (last) {
                scene::Transform moves;
                moves.times = {0, 1};
                moves.keys = {Matrix(), inverse(m) * *last};
                ShapeSource source = s->source();
                s = std::make_shared<Placed>(std::move(source), s, moves);
            }
            shapes.push_back(s);
        }
    }
};
std::vector<std::shared_ptr<scene::Primitive>> rod(float r, float h) {
    return {quadric("Cylinder", {r, -h, h, 360}), quadric("Disk", {-h, r, 360}), quadric("Disk", {h, r, 360})};
}

} // namespace

// Lines through a ball around a solid, in all directions: the mean of what of them lies within is the volume over the ball's
// disc. Each goes in as often as it comes out, a million of them nightly. Rods that cross: two make 16/3 r^3, three 8 (2 - sqrt
// 2) r^3 (Steinmetz).
TEST(Solids, VolumesByMonteCarlo) {
    const double r = 0.5, h = 1.5, two = 16. / 3 * r * r * r, three = 8 * (2 - std::sqrt(2.)) * r * r * r,
                 whole = kPi * r * r * 2 * h;
    const Matrix about = rotateMatrix(25, 1, 0.4, -0.3), x = rotateMatrix(90, 0, 1, 0) * about,
                 y = rotateMatrix(90, 1, 0, 0) * about;
    const auto slid = [&](const Matrix& m) {
        return translateMatrix(0, 0, 0.7) * m;
    }; // along itself: the crossing stays the same
    struct Case {
        const char* what;
        float operation;
        int rods;
        bool moves;
        double volume;
    };
    const Case cases[] = {
        {"two rods", kIntersection, 2, false, two},           {"three rods", kIntersection, 3, false, three},
        {"a cross", kUnion, 2, false, 2 * whole - two},       {"a bored rod", kDifference, 2, false, whole - two},
        {"sliding rods", kIntersection, 3, true, three},      {"a sliding drill", kDifference, 2, true, whole - two},
        {"a sliding cross", kUnion, 2, true, 2 * whole - two}};
    for (const Case& c : cases) {
        Parts s;
        const Matrix places[] = {about, x, y};
        for (int i = 0; i < c.rods; ++i) {
            const Matrix last = slid(places[i]);
            s.part(i, c.operation, rod(float(r), float(h)), places[i], c.moves && i > 0 ? &last : nullptr);
        }
        s.ready();
        Rng rng(11 + teststat::seedBase());
        const double R = 2.4;
        const int n = teststat::samples(200'000, 1'000'000);
        double sum = 0, squares = 0;
        int odd = 0;
        for (int i = 0; i < n; ++i) {
            const double z = 2 * uniform(rng) - 1, a = 2 * kPi * uniform(rng), b = 2 * kPi * uniform(rng),
                         q = R * std::sqrt(uniform(rng));
            const Vec3d d(std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a), z);
            const Vec3d u = normalize(cross(d, std::fabs(d.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0))), v = cross(d, u);
            Ray ray;
            ray.org = Vec3(u * (q * std::cos(b)) + v * (q * std::sin(b)) - d * 5.0);
            ray.dir = Vec3(d);
            ray.time = float(uniform(rng));
            const std::vector<Hit> hits = s.all(ray);
            odd += hits.size() % 2 != 0;
            double within = 0;
            for (size_t k = 0; k + 1 < hits.size(); k += 2) within += hits[k + 1].distance - hits[k].distance;
            sum += within, squares += within * within;
        }
        EXPECT_EQ(odd, 0) << c.what;
        const double mean = sum / n, se = std::sqrt((squares / n - mean * mean) / n), disc = kPi * R * R;
        EXPECT_NEAR(mean * disc, c.volume, 4.753 * se * disc) << c.what;
        EXPECT_LT(se * disc, 0.03 * c.volume) << c.what << ": not precise enough to decide";
    }
}

// From within a solid each ray comes to its boundary: a ball with a hole through it and a moving bite, through what is left of
// it.
TEST(Solids, NothingLeaks) {
    Parts s;
    const Matrix m = rotateMatrix(40, 1, 2, 0.5) * scaleMatrix(1.5, 1, 0.8) * translateMatrix(300, -20, 50),
                 bite = translateMatrix(0.2, 0.9, 0.3) * m, bitten = translateMatrix(-0.3, 0.8, -0.3) * m;
    s.part(0, kDifference, {ball(1)}, m);
    s.part(1, kDifference, rod(0.3f, 1.5f), m);
    s.part(2, kDifference, {ball(0.6f)}, bite, &bitten);
    s.ready();
    Rng rng(12 + teststat::seedBase());
    int leaks = 0, asked = 0;
    for (int i = 0; i < teststat::samples(40'000, 1'500'000); ++i) {
        Ray r;
        r.time = float(uniform(rng));
        const Vec3d p(2 * uniform(rng) - 1, 2 * uniform(rng) - 1, 2 * uniform(rng) - 1);
        const Vec3d b = Vec3d(0.2, 0.9, 0.3) * (1 - double(r.time)) + Vec3d(-0.3, 0.8, -0.3) * double(r.time);
        if (length(p) > 0.99 || std::hypot(p.x, p.y) < 0.31 || length(p - b) < 0.61) continue;
        r.org = Vec3(transformPoint(m, p));
        r.dir = Vec3(float(uniform(rng) - 0.5), float(uniform(rng) - 0.5), float(uniform(rng) - 0.5));
        ++asked;
        Hit h;
        leaks += !s.accel->intersect(r, h) || !s.accel->occluded(r);
    }
    EXPECT_EQ(leaks, 0) << "of " << asked;
    EXPECT_GT(asked, 10'000);
}

} // namespace solids_test
