// Points against closed forms.
#include "accel/accel.h"
#include "make.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace points_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;
using scene::Class;
using scene::Type;

namespace {

using Rng = std::mt19937;
double uniform(Rng& r) { return r() / 4294967296.0; }
Vec3d within(Rng& r, double size) {
    const double x = uniform(r), y = uniform(r), z = uniform(r);
    return Vec3d(2 * x - 1, 2 * y - 1, 2 * z - 1) * size;
}
std::shared_ptr<scene::Primitive> particles(std::vector<float> P, const char* type = nullptr, float width = 0.5f) {
    auto p = std::make_shared<scene::Primitive>();
    p->kind = "Points";
    p->params = {points(std::move(P)), param("constantwidth", Class::Constant, Type::Float, {width})};
    if (type) {
        scene::Param t = param("type", Class::Uniform, Type::String, {});
        t.strings = {type};
        p->params.push_back(t);
    }
    return p;
}
const std::vector<float> kThree{0, 0, 0, 2, 0, 0, 0, 2, 1};

} // namespace

TEST(Points, DiscsFaceTheRayTheEyeOrThePicture) {
    Rng rng(1);
    const Matrix m = rotateMatrix(40, 1, 2, 3) * scaleMatrix(2, 2, 2) * translateMatrix(1, 0, 8);
    for (Facing facing : {Facing::Ray, Facing::Eye, Facing::Picture})
        for (bool mirrored : {false, true}) {
            Diagnostics diag;
            auto a = std::make_shared<scene::Attributes>();
            a->sides = 1;
            const ShapeRef s = buildShape(particles(kThree), a, mirrored ? scaleMatrix(-1, 1, 1) * m : m, -1, diag, facing);
            ASSERT_TRUE(s);
            ASSERT_EQ(s->exactPrims(), 3u);
            int met = 0;
            for (int i = 0; i < 3000; ++i) {
                const uint32_t k = rng() % 3;
                const Vec3d c = transformPoint(s->toCamera(), Vec3d(kThree[3 * k], kThree[3 * k + 1], kThree[3 * k + 2]));
                const Vec3d o = facing == Facing::Ray ? within(rng, 9) : Vec3d(0.0), aim = c + within(rng, 0.7), d = aim - o;
                const Vec3d toward = facing == Facing::Ray ? -d : facing == Facing::Eye ? -c : Vec3d(0, 0, -1);
                const double t = dot(c - o, toward) / dot(d, toward), away = length(o + d * t - c);
                if (std::fabs(away - 0.5) < 1e-9) continue; // 0.5 wide, twice as large
                ExactHit h[4];
                const int n = s->exactHits(k, o, d, -INFINITY, INFINITY, Shape::Wanted::All, h);
                ASSERT_EQ(n, away < 0.5) << int(facing);
                if (!n) continue;
                ++met;
                EXPECT_NEAR(h[0].t, t, 1e-9 * (1 + std::fabs(t)));
                const SurfacePoint p = s->evaluateHit(k, h[0].u, h[0].v);
                EXPECT_LT(length(o + d * t - Vec3d(p.P)), 1e-6 + 2 * roundingError(p.P));
                EXPECT_LT(length(Vec3d(p.n) - normalize(toward)), 1e-5);
                EXPECT_GT(dot(p.Ng, p.n), 0);
                EXPECT_EQ(p.u, 0);
                EXPECT_EQ(p.t, 0);
            }
            EXPECT_GT(met, 500);
        }
}

TEST(Points, SpheresAndSquaresAndDiscsWithNormals) {
    Diagnostics diag;
    Rng rng(2);
    const Matrix m = rotateMatrix(30, 0, 0, 1) * translateMatrix(0, 0, 6);
    const ShapeRef balls = build(particles(kThree, "sphere"), m, diag),
                   squares = build(particles(kThree, "patch"), translateMatrix(0, 0, 6), diag);
    auto request = particles(kThree);
    request->params.push_back(param("N", Class::Varying, Type::Normal, {0, 0, -1, 0, 1, 0, 1, 0, 0}));
    const ShapeRef discs = build(request, m, diag);
    EXPECT_EQ(diag.all().size(), 0u);
    for (int i = 0; i < 2000; ++i) {
        const uint32_t k = rng() % 3;
        const Vec3d q(kThree[3 * k], kThree[3 * k + 1], kThree[3 * k + 2]), c = transformPoint(m, q);
        const Vec3d o = within(rng, 9), d = c + within(rng, 0.3) - o;
        const double away = length(cross(c - o, d)) / length(d);
        ExactHit h[4];
        const int n = balls->exactHits(k, o, d, -INFINITY, INFINITY, Shape::Wanted::All, h);
        ASSERT_EQ(n, away < 0.25 ? 2 : 0);
        for (int j = 0; j < n; ++j) {
            const SurfacePoint p = balls->evaluateHit(k, h[j].u, h[j].v);
            EXPECT_NEAR(length(Vec3d(p.P) - c), 0.25, 2e-6);
            EXPECT_LT(length(Vec3d(p.n) - (Vec3d(p.P) - c) * 4.0), 1e-5);
            EXPECT_LT(length(o + d * h[j].t - Vec3d(p.P)), 2e-6);
        }
        // v upward, u to the right in the picture; along the axis nothing is turned.
        const Vec3d at = q + Vec3d(0, 0, 6), by(uniform(rng) - 0.5, uniform(rng) - 0.5, 0);
        ASSERT_EQ(squares->exactHits(k, at + by - Vec3d(0, 0, 4), Vec3d(0, 0, 1), -INFINITY, INFINITY, Shape::Wanted::All, h),
                  std::max(std::fabs(by.x), std::fabs(by.y)) < 0.25);
        if (std::max(std::fabs(by.x), std::fabs(by.y)) < 0.25) {
            const SurfacePoint p = squares->evaluateHit(k, h[0].u, h[0].v);
            EXPECT_NEAR(p.v, 0.5 + 2 * by.y, 1e-5);
            EXPECT_NEAR(std::fabs(p.u - 0.5), 2 * std::fabs(by.x), 1e-5);
        }
        const Vec3d normal = k == 0   ? Vec3d(0, 0, -1)
                             : k == 1 ? Vec3d(0, 1, 0)
                                      : Vec3d(1, 0, 0),
                    turned = transformVector(m, normal);
        const double t = dot(c - o, turned) / dot(d, turned);
        ASSERT_EQ(discs->exactHits(k, o, d, -INFINITY, INFINITY, Shape::Wanted::All, h), length(o + d * t - c) < 0.25);
        if (length(o + d * t - c) < 0.25) EXPECT_LT(length(Vec3d(discs->evaluateHit(k, h[0].u, h[0].v).n) - turned), 1e-5);
    }
}

TEST(Points, AreasAndDensities) {
    Rng rng(3);
    for (const char* type : {"particle", "sphere", "patch"}) {
        Diagnostics diag;
        auto request = particles(kThree, type);
        request->params[1] = param("width", Class::Varying, Type::Float, {0.2f, 0.4f, 0.6f});
        const ShapeRef s = build(request, scaleMatrix(2, 2, 2) * translateMatrix(0, 0, 9), diag);
        const double squares = 0.1 * 0.1 + 0.2 * 0.2 + 0.3 * 0.3, form = type[0] == 's'                     ? 4 * kPi
                                                                         : type[1] == 'a' && type[2] == 't' ? 4
                                                                                                            : kPi;
        EXPECT_NEAR(s->area(), 4 * form * squares, 1e-5) << type;
        double sum = 0;
        int count[3] = {};
        const int n = 30000;
        for (int i = 0; i < n; ++i) {
            SurfacePoint p;
            s->sampleFrom(Vec3(0, 0, 0), uniform(rng), uniform(rng), p);
            ASSERT_LT(p.prim, 3u);
            ++count[p.prim];
            const double density = s->sampleDensity(p);
            EXPECT_NEAR(density * s->area(), 1, 1e-3) << type;
            sum += 1 / density;
        }
        EXPECT_NEAR(sum / n, s->area(), 1e-3 * s->area()) << type;
        EXPECT_NEAR(count[2] / double(n), 9. / 14, 0.02);
    }
}

TEST(Points, VariablesAndFaultyNumbers) {
    Diagnostics diag;
    auto request = particles({0, 0, 5, NAN, 0, 5, 2, 0, 5, 3, 0, 5});
    request->params[1] = param("width", Class::Varying, Type::Float, {0.2f, 0.4f, -0.6f, 0.8f});
    request->params.push_back(param("value", Class::Varying, Type::Float, {1, 2, 3, 4}));
    const ShapeRef s = build(request, Matrix(), diag);
    ASSERT_TRUE(s);
    ASSERT_EQ(s->exactPrims(), 2u);
    ASSERT_EQ(diag.all().size(), 2u);
    EXPECT_NE(diag.all()[0].message.find("1 with a number that is not finite"), std::string::npos);
    EXPECT_NE(diag.all()[1].message.find("1 without a width"), std::string::npos);
    float f;
    s->interpolate(s->findPrimvar("value"), s->evaluate(1, 0.5, 0.5), &f, nullptr, nullptr);
    EXPECT_EQ(f, 4);
    EXPECT_FALSE(build(particles({}), Matrix(), diag));
    EXPECT_TRUE(build(particles(kThree, "tadpole"), Matrix(), diag));
    EXPECT_NE(diag.all().back().message.find("tadpole"), std::string::npos);
}

} // namespace points_test
