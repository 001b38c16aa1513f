// The discs that close round curves at their ends, against closed forms.
#include "accel/accel.h"
#include "make.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tubes_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using scene::Class;
using scene::Type;

namespace {

using Rng = std::mt19937;
double uniform(Rng& r) { return r() / 4294967296.0; }
Vec3d within(Rng& r) {
    const double x = uniform(r), y = uniform(r), z = uniform(r);
    return Vec3d(2 * x - 1, 2 * y - 1, 2 * z - 1);
}
/// Two units long along x, about the origin, of radius .25.
ShapeRef tube(const char* type, Diagnostics& diag) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Curves";
    p->strings = {type, "nonperiodic"};
    const bool cubic = std::string(type) == "cubic";
    p->ints = {cubic ? 4 : 3};
    p->params = {points(cubic ? std::vector<float>{-1, 0, 0, -.4f, 0, 0, .4f, 0, 0, 1, 0, 0}
                              : std::vector<float>{-1, 0, 0, .25f, 0, 0, 1, 0, 0}),
                 param("constantwidth", Class::Constant, Type::Float, {.5f})};
    scene::Attributes a;
    a.values["dice:roundcurve"] = param("roundcurve", Class::Constant, Type::Integer, {1});
    return build(p, Matrix(), diag, a);
}

} // namespace

TEST(Tubes, AreClosedByDiscs) {
    for (const char* type : {"cubic", "linear"}) {
        Diagnostics diag;
        const ShapeRef s = tube(type, diag);
        ASSERT_TRUE(s);
        accel::Accel accel({s}, {}, diag);
        for (const double side : {-1., 1.}) {
            Rng rng(3);
            for (int i = 0; i < 200; ++i) {
                const double out = .25 * std::sqrt(uniform(rng)), angle = 2 * kPi * uniform(rng);
                accel::Ray r;
                r.org = Vec3(Vec3d(3 * side, out * std::cos(angle), out * std::sin(angle)));
                r.dir = Vec3(Vec3d(-side, 0, 0));
                accel::Hit h;
                ASSERT_TRUE(accel.intersect(r, h)) << type << out;
                EXPECT_NEAR(h.t, 2, 1e-6);
                const SurfacePoint p = accel.point(h);
                EXPECT_LT(length(Vec3d(p.P) - Vec3d(side, r.org.y, r.org.z)), 1e-6);
                EXPECT_LT(length(Vec3d(p.n) - Vec3d(side, 0, 0)), 1e-6);
                EXPECT_EQ(p.v, side < 0 ? 0 : 1);
                // The partials span the disc, and turn as those of the tube do: their product is the normal.
                EXPECT_GT(dot(normalize(cross(Vec3d(p.dPdu), Vec3d(p.dPdv))), Vec3d(p.n)) * double(p.orientation), .999);
            }
        }
    }
}

TEST(Tubes, NoRayLeavesThem) {
    for (const char* type : {"cubic", "linear"}) {
        Diagnostics diag;
        accel::Accel accel({tube(type, diag)}, {}, diag);
        Rng rng(4);
        int leaks = 0;
        for (int i = 0; i < 20'000; ++i) {
            accel::Ray r;
            r.org = Vec3(within(rng) * .1);
            r.dir = Vec3(within(rng));
            // A part of them at the rim, where disc and tube meet.
            if (i % 4 == 0) {
                const double angle = 2 * kPi * uniform(rng);
                r.dir = Vec3(Vec3d(1, .25 * std::cos(angle), .25 * std::sin(angle))) - r.org;
            }
            accel::Hit h;
            leaks += !accel.intersect(r, h);
        }
        EXPECT_EQ(leaks, 0) << type;
    }
}

TEST(Tubes, DiscsAreSampledByTheirArea) {
    for (const char* type : {"cubic", "linear"}) {
        Diagnostics diag;
        const ShapeRef s = tube(type, diag);
        const double round = 2 * kPi * .25 * 2, disc = kPi * .25 * .25;
        EXPECT_NEAR(s->area(), round + 2 * disc, 1e-5);
        Rng rng(5);
        const int n = 20'000;
        int onDiscs = 0;
        double sum = 0, square = 0;
        for (int i = 0; i < n; ++i) {
            SurfacePoint p;
            s->sampleFrom(Vec3(0, 0, 5), uniform(rng), uniform(rng), p);
            sum += 1 / s->sampleDensity(p);
            if (std::fabs(std::fabs(p.P.x) - 1) > 1e-6f) continue;
            ++onDiscs;
            square += double(p.P.y) * p.P.y + double(p.P.z) * p.P.z;
            EXPECT_NEAR(s->sampleDensity(p), 1 / (round + 2 * disc), 1e-4);
        }
        const double part = 2 * disc / (round + 2 * disc);
        EXPECT_NEAR(onDiscs / double(n), part, 5 * std::sqrt(part / n));
        EXPECT_NEAR(square / onDiscs, .25 * .25 / 2, .003); // even over the area
        EXPECT_NEAR(sum / n, s->area(), .02 * s->area());
    }
}

} // namespace tubes_test
