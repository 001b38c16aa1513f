// Random requests, most of them wrong: nothing may crash, hang or give a point that is not finite.
#include "../geometry/make.h"
#include "accel/accel.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace fuzz_test {

using namespace alpenglow;
using namespace alpenglow::geometry;
using namespace alpenglow::geometry::test;

TEST(Fuzz, RandomPrimitivesAreDrawnOrReported) {
    std::mt19937 rng(31);
    auto pick = [&](int n) { return int(rng() % unsigned(n)); };
    const char* kinds[] = {
        "Sphere",  "Cone",           "Cylinder",       "Hyperboloid",           "Paraboloid", "Disk",      "Torus",
        "Polygon", "GeneralPolygon", "PointsPolygons", "PointsGeneralPolygons", "Patch",      "PatchMesh", "NuPatch",
        "Curves"};
    const float special[] = {0, 1, -1, 0.5f, 360, -360, 720, 1e-20f, 1e20f, NAN, INFINITY, 3, 90, -90};
    auto number = [&] { return pick(3) ? float(pick(2000) - 1000) / 250 : special[pick(14)]; };
    int drawn = 0, reported = 0;
    for (int round = 0; round < 3000; ++round) {
        auto p = std::make_shared<scene::Primitive>();
        p->kind = kinds[pick(15)];
        for (int i = pick(9); i-- > 0;) p->numbers.push_back(number());
        for (int i = pick(6); i-- > 0;) p->ints.push_back(pick(9) - (pick(5) == 0 ? 3 : 0));
        for (int i = pick(12); i-- > 0;) p->ints2.push_back(pick(8) - (pick(9) == 0));
        for (int i = pick(20); i-- > 0;) p->ints3.push_back(pick(8));
        p->strings = {pick(2) ? "bilinear" : "bicubic", pick(2) ? "periodic" : "nonperiodic", pick(2) ? "periodic" : "what"};
        bool clean = pick(4) != 0;
        auto values = [&](int n) {
            std::vector<float> v;
            for (int i = 0; i < n; ++i) v.push_back(clean ? float(pick(2000)) / 250 : number());
            return v;
        };
        if (pick(5)) p->params.push_back(points(values(3 * pick(30))));
        if (pick(3) == 0) p->params.push_back(param("Pw", scene::Class::Vertex, scene::Type::HPoint, values(4 * pick(30))));
        p->params.push_back(param("x", scene::Class(pick(6)), scene::Type::Color, values(pick(50))));
        p->params.push_back(param("N", scene::Class(pick(6)), scene::Type::Normal, values(pick(50))));
        std::vector<float> knots;
        for (int i = 0; i < 12; ++i) knots.push_back(float(i / 2));
        p->params.push_back(param("uknot", scene::Class::Constant, scene::Type::Float, knots));
        p->params.push_back(param("vknot", scene::Class::Constant, scene::Type::Float, knots));
        Diagnostics diag;
        scene::Attributes a;
        a.sides = 1 + pick(2);
        ShapeRef s = build(p, pick(8) ? skewed() : scaleMatrix(1e-12, 1e12, 1), diag, a);
        if (!s) {
            ++reported;
            EXPECT_GE(diag.errors() + diag.warnings(), 1) << p->kind;
            continue;
        }
        ++drawn;
        DiceOptions opt;
        opt.camera = {true, 30};
        s->dice(opt, diag);
        accel::Accel accel({s}, {}, diag);
        for (int i = 0; i < 20; ++i) {
            accel::Ray r;
            r.dir = Vec3(float(pick(200) - 100) / 60, float(pick(200) - 100) / 60, 3);
            accel::Hit h;
            if (!accel.intersect(r, h)) continue;
            SurfacePoint q = accel.point(h);
            EXPECT_TRUE(std::isfinite(q.P.x + q.P.y + q.P.z + q.n.x + q.n.y + q.n.z + q.N.x + q.pError)) << p->kind;
            for (size_t v = 0; v < s->primvars().size(); ++v) {
                float out[3];
                s->interpolate(int(v), q, out, nullptr, nullptr);
                EXPECT_TRUE(std::isfinite(out[0])) << p->kind;
            }
        }
    }
    EXPECT_GT(drawn, 500);
    EXPECT_GT(reported, 500);
}

} // namespace fuzz_test
