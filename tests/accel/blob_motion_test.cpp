// Blobbies whose numbers move: at each time they are the blobby of the numbers of that time, met by rays, lit and evaluated as
// that one is; their points move as their blobs do.
#include "../geometry/make.h"
#include "../statistics/nightly.h"
#include "accel/accel.h"
#include "geometry/placed.h"
#include "scene/scene.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace blob_motion_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using accel::Hit;
using accel::Ray;
using scene::Class;
using scene::Type;
using PrimitivePtr = std::shared_ptr<scene::Primitive>;

namespace {

struct Numbers {
    std::mt19937 rng;
    double one(double size) { return (double(rng()) / 4294967296.0 * 2 - 1) * size; }
    Vec3d three(double size) { return {one(size), one(size), one(size)}; }
};

void add(std::vector<float>& to, const Matrix& m) {
    for (auto& row : m.m)
        for (double x : row) to.push_back(float(x));
}
PrimitivePtr blobby(int leaves, std::vector<int> code, std::vector<float> numbers) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Blobby";
    p->ints = {leaves};
    p->ints2 = std::move(code);
    p->numbers = std::move(numbers);
    p->toWorld = scene::Transform(translateMatrix(0, 0, 8));
    p->attributes = std::make_shared<scene::Attributes>();
    std::const_pointer_cast<scene::Attributes>(p->attributes)->sides = 2;
    return p;
}
PrimitivePtr ball(const Vec3d& at, double radius) { // of its surface
    std::vector<float> f;
    add(f, scaleMatrix(2 * radius, 2 * radius, 2 * radius) * translateMatrix(at.x, at.y, at.z));
    return blobby(1, {1001, 0}, f);
}
/// Three ellipsoids and a segment added, a fourth ellipsoid taken away, a constant in it: all of them turn, grow and go.
PrimitivePtr crowd(Numbers& n) {
    std::vector<float> f;
    for (int i = 0; i < 4; ++i)
        add(f, scaleMatrix(1.5 + n.one(.4), 1.5 + n.one(.4), 1.5 + n.one(.4)) * rotateMatrix(n.one(20), 1, 2, 3) *
                   translateMatrix(i - 1.5 + n.one(.3), n.one(.6), n.one(.6)));
    for (int i = 0; i < 6; ++i) f.push_back(float((i < 3 ? -1.2 : 1.2) * (i % 3 == 1) + n.one(.3)));
    f.push_back(float(.8 + n.one(.2)));
    add(f, rotateMatrix(n.one(30), 0, 1, 1) * translateMatrix(n.one(.2), n.one(.2), n.one(.2)));
    f.push_back(float(.02 + n.one(.02)));
    PrimitivePtr p = blobby(6, {1001, 0, 1001, 16, 1001, 32, 1002, 64, 1000, 87, 0, 5, 0, 1, 2, 3, 4, 1001, 48, 4, 5, 6}, f);
    p->params = {param("tint", Class::Vertex, Type::Color, {}), param("pale", Class::Uniform, Type::Float, {float(n.one(1))})};
    for (int i = 0; i < 18; ++i) p->params[0].numbers.push_back(float(n.one(1)));
    return p;
}
PrimitivePtr moving(const std::vector<PrimitivePtr>& keys, std::vector<float> times) {
    auto p = std::make_shared<scene::Primitive>(*keys[0]);
    p->motionKeys.assign(keys.begin() + 1, keys.end());
    p->motionTimes = std::move(times);
    return p;
}
struct World {
    std::vector<ShapeRef> shapes;
    std::unique_ptr<accel::Accel> accel;
    Diagnostics diag;
    explicit World(const PrimitivePtr& p, double close = 1) {
        scene::Frame f;
        f.options.shutterClose = float(close);
        f.options.hider = "path";
        f.primitives = {p};
        shapes = buildShapes(f, diag);
        diceShapes(shapes, DiceOptions{.camera = DiceCamera::from(f.options)}, diag);
        accel = std::make_unique<accel::Accel>(shapes, std::vector<uint32_t>{}, diag);
    }
    const Shape& shape() const { return *shapes.at(0); }
    SurfacePoint point(const Hit& h, float time) const {
        SurfacePoint p;
        const HitRef ref{h.prim, h.b1, h.b2, &p, time};
        shape().points({&ref, 1}, kNeedAll);
        return p;
    }
};
Ray rayAt(Numbers& n, float time, double around = 2.5) {
    Ray r;
    r.org = Vec3(n.three(5));
    r.dir = Vec3(Vec3d(0, 0, 8) + n.three(around)) - r.org;
    r.time = time;
    return r;
}
void near(const Vec3& a, const Vec3& b, double e, const char* what) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], e) << what;
}

} // namespace

// Against the blobby that has the numbers of the time, at keys and between them. Its numbers are rounded to single, those of the
// moving one not: an ulp of a number moves the surface by about 1e-6.
TEST(BlobMotion, IsAtEachTimeWhatStandsThere) {
    Numbers n{std::mt19937(3)};
    const std::vector<PrimitivePtr> keys = {crowd(n), crowd(n), crowd(n)};
    const PrimitivePtr moves = moving(keys, {0, .25f, 1});
    const World w(moves);
    ASSERT_EQ(w.diag.all().size(), 0u);
    size_t met = 0, off = 0;
    for (const float t : {0.f, .125f, .25f, .4f, .9f, 1.f}) {
        auto standing = std::make_shared<scene::Primitive>(*scene::primitiveAt(moves, t));
        standing->motionKeys.clear();
        standing->motionTimes.clear();
        const World still(standing);
        for (int i = 0; i < 1500; ++i) {
            const Ray r = rayAt(n, t);
            Hit a, b;
            const bool ma = w.accel->intersect(r, a), mb = still.accel->intersect(r, b);
            EXPECT_EQ(w.accel->occluded(r), ma);
            if (ma != mb || (ma && std::fabs(a.distance - b.distance) > 1e-4)) { // only where it all but touches
                ++off;
                continue;
            }
            if (!ma) continue;
            ++met;
            const SurfacePoint p = w.point(a, t), q = still.point(b, 0);
            near(p.P, q.P, 4e-4, "P");
            if (std::fabs(dot(p.n, normalize(r.dir))) < .05) continue;
            near(p.n, q.n, 2e-3, "n");
            if (std::fabs(p.u - q.u) > .01f || std::fabs(dot(p.dPdu, q.dPdu) / dot(q.dPdu, q.dPdu) - 1) > .01)
                continue; // another axis
            near(p.dNdu, q.dNdu, 2e-2 * (1 + length(q.dNdu)), "dNdu");
            float ca[3], cb[3], ua[3], va[3], ub[3], vb[3], fa, fb;
            w.shape().interpolate(w.shape().findPrimvar("tint"), p, ca, ua, va);
            still.shape().interpolate(still.shape().findPrimvar("tint"), q, cb, ub, vb);
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(ca[k], cb[k], 2e-3);
                EXPECT_NEAR(ua[k], ub[k], 2e-2 * (1 + std::fabs(ub[k])));
            }
            w.shape().interpolate(w.shape().findPrimvar("pale"), p, &fa, nullptr, nullptr);
            still.shape().interpolate(still.shape().findPrimvar("pale"), q, &fb, nullptr, nullptr);
            EXPECT_NEAR(fa, fb, 1e-6);
        }
    }
    EXPECT_GT(met, 2000u);
    EXPECT_LT(off, 5u);
}

// A ball that goes and grows: its points go with it and outwards. One that turns: round its middle.
TEST(BlobMotion, VelocitiesAreThoseOfTheBlobs) {
    Numbers n{std::mt19937(4)};
    const World w(moving({ball({-1, 0, 0}, .5), ball({1, .5, 0}, 1)}, {0, 1}));
    for (int i = 0; i < 2000; ++i) {
        const Ray r = rayAt(n, float(i % 17) / 16);
        Hit h;
        if (!w.accel->intersect(r, h)) continue;
        const SurfacePoint p = w.point(h, r.time);
        const Vec3d c = Vec3d(-1, 0, 8) + Vec3d(2, .5, 0) * double(r.time);
        near(p.n, Vec3(normalize(Vec3d(p.P) - c)), 1e-5, "n");
        EXPECT_NEAR(length(Vec3d(p.P) - c), .5 + .5 * double(r.time), 2e-6);
        near(w.shape().velocity(p), Vec3(Vec3d(2, .5, 0) + Vec3d(p.n) * .5), 2e-3, "velocity");
    }
    // Two keys of an ellipsoid, 1 degree apart: at each time nearly the turned one.
    std::vector<float> a, b;
    add(a, scaleMatrix(3, 2, 2) * rotateMatrix(-.5, 0, 0, 1));
    add(b, scaleMatrix(3, 2, 2) * rotateMatrix(.5, 0, 0, 1));
    const World turns(moving({blobby(1, {1001, 0}, a), blobby(1, {1001, 0}, b)}, {0, 1}));
    for (int i = 0; i < 500; ++i) {
        const Ray r = rayAt(n, .5f, 1);
        Hit h;
        if (!turns.accel->intersect(r, h)) continue;
        const SurfacePoint p = turns.point(h, r.time);
        near(turns.shape().velocity(p), cross(Vec3(0, 0, float(kPi / 180)), p.P - Vec3(0, 0, 8)), 1e-4, "turning");
    }
}

// What is shaded when the shutter opens is where it was then: carried by the blob.
TEST(BlobMotion, PointsOfAnotherTime) {
    Numbers n{std::mt19937(5)};
    const World w(moving({ball({-2, 0, 0}, .5), ball({2, .5, 0}, 1)}, {0, 1}));
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
        const Ray r = rayAt(n, float(i % 33) / 32);
        Hit h;
        if (!w.accel->intersect(r, h)) continue;
        ++met;
        const SurfacePoint then = w.point(h, r.time), open = w.point(h, 0);
        const Vec3d c = Vec3d(-2, 0, 8) + Vec3d(4, .5, 0) * double(r.time);
        near(open.P, Vec3(Vec3d(-2, 0, 8) + (Vec3d(then.P) - c) * (.5 / (.5 + .5 * double(r.time)))), 4e-4, "P");
        near(open.n, then.n, 1e-3, "n");
    }
    EXPECT_GT(met, 200);
}

// Areas and samples at a time are those of that time: a ball that grows from nothing.
TEST(BlobMotion, SamplesIntegrateTheSurface) {
    Numbers n{std::mt19937(6)};
    const World w(moving({ball({-1, 0, 0}, 0), ball({1, 0, 0}, 1)}, {0, 1}));
    EXPECT_NEAR(w.shape().area(), 4 * kPi / 3, .05); // mean of 4 pi t^2
    for (const float t : {.3f, .5f, 1.f}) {
        double sum = 0, squares = 0;
        constexpr int kSamples = 150000;
        for (int i = 0; i < kSamples; ++i) {
            SurfacePoint p;
            w.shape().sampleAreaAt((n.one(.5) + .5), (n.one(.5) + .5), t, p, kNeedAll);
            const double d = w.shape().sampleDensity(p), x = d > 0 ? 1 / d : 0;
            if (d > 0) EXPECT_NEAR(length(Vec3d(p.P) - Vec3d(-1 + 2 * double(t), 0, 8)), double(t), 1e-5);
            sum += x, squares += x * x;
        }
        const double mean = sum / kSamples, se = std::sqrt((squares / kSamples - mean * mean) / kSamples);
        EXPECT_NEAR(mean, 4 * kPi * double(t) * double(t), 4.753 * se) << t;
        EXPECT_LT(se, .04 * mean);
    }
}

// From inside each ray meets the skin, from outside a ball that flies by as often as it comes out again; a million nightly.
TEST(BlobMotion, NothingLeaks) {
    Numbers n{std::mt19937(7 + teststat::seedBase())};
    const Vec3d from(-2, -1, 0), by(4, 3, 1);
    const World w(moving({ball(from, .4), ball(from + by, .8)}, {0, 1}));
    int leaks = 0, odd = 0;
    for (int i = 0; i < teststat::samples(30'000, 1'000'000); ++i) {
        Ray r;
        r.time = float(n.one(.5) + .5);
        const Vec3d c = Vec3d(0, 0, 8) + from + by * double(r.time);
        r.org = Vec3(c + n.three(.2));
        r.dir = Vec3(n.three(1));
        leaks += !w.accel->occluded(r);
        if (i % 4) continue;
        r.org = Vec3(c + n.three(3));
        if (length(Vec3d(r.org) - c) < 1.01) continue;
        r.dir = Vec3(c + n.three(.7)) - r.org;
        int crossings = 0;
        Hit h;
        while (crossings < 9 && w.accel->intersect(r, h)) {
            ++crossings;
            r.excludeShape = h.shape, r.excludePrim = h.prim, r.passed = h.distance;
        }
        odd += crossings % 2;
    }
    EXPECT_EQ(leaks, 0);
    EXPECT_EQ(odd, 0);
}

TEST(BlobMotion, KeysOfOtherCodeAreSaid) {
    Numbers n{std::mt19937(8)};
    std::vector<float> two;
    add(two, Matrix());
    add(two, translateMatrix(1, 0, 0));
    const World w(moving({ball({0, 0, 0}, .5), blobby(2, {1001, 0, 1001, 16, 0, 2, 0, 1}, two)}, {0, 1})),
        still(ball({0, 0, 0}, .5));
    ASSERT_EQ(w.shapes.size(), 1u);
    bool said = false;
    for (const Diagnostic& d : w.diag.all())
        said |= d.message.find(" do not match: it is drawn at its first position") != std::string::npos;
    EXPECT_TRUE(said);
    for (int i = 0; i < 300; ++i) {
        const Ray r = rayAt(n, .75f);
        Hit a, b;
        EXPECT_EQ(w.accel->intersect(r, a), still.accel->intersect(r, b));
    }
}

} // namespace blob_motion_test
