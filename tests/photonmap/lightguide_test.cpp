// The light guide: what it draws, and that paths have the same light with it, without it, and with one that is wrong.
#include "integrator/floorscene.h"
#include "integrator/integrator.h"
#include "world/impl.h"
#include "world/lightguide.h"
#include <random>

namespace lightguide_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

std::mt19937 g_random(5); // of one test program; each use seeds it anew
float uniform() { return std::uniform_real_distribution<float>()(g_random); }

/// A square of edge 2 in the plane y = 3.
FlatEmitter square() {
    FlatEmitter e{};
    const double corners[4][3] = {{-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}};
    for (int i = 0; i < 4; ++i) std::copy_n(corners[i], 3, e.corner[i]);
    const int of[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (int t = 0; t < 2; ++t) std::copy_n(of[t], 3, e.corners[t]);
    e.count = 2, e.cornerCount = 4;
    return e;
}

Settings path(bool blocks = true) {
    Settings s = withShaders(Hider::Path);
    s.rowRequests = blocks;
    return s;
}

/// A room of 6 x 4 x 6 with a window of .6 x .6 in the wall x = 3, at height 1.7 to 2.3, outside of which `light` is.
std::string room(const std::string& light) {
    const auto wall = [](double z0, double z1, double y0, double y1) {
        char text[200];
        std::snprintf(text, sizeof text, "Polygon \"P\" [3 %g %g  3 %g %g  3 %g %g  3 %g %g]\n", y0, z0, y0, z1, y1, z1, y1, z0);
        return std::string(text);
    };
    return light + "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1 Color .6 .6 .6\n" + wall(-3, 3, 0, 1.7) +
           wall(-3, 3, 2.3, 4) + wall(-3, -.3, 1.7, 2.3) + wall(.3, 3, 1.7, 2.3) +
           "Polygon \"P\" [-3 0 -3  -3 0 3  -3 4 3  -3 4 -3]\nPolygon \"P\" [-3 0 -3  3 0 -3  3 0 3  -3 0 3]\n"
           "Polygon \"P\" [-3 4 -3  3 4 -3  3 4 3  -3 4 3]\nPolygon \"P\" [-3 0 3  3 0 3  3 4 3  -3 4 3]\n"
           "Polygon \"P\" [-3 0 -3  3 0 -3  3 4 -3  -3 4 -3]\n";
}
const std::string kSky = "LightSource \"envlight\" 1 \"float intensity\" 5\n";
/// A lamp of 6 x 4 a little behind the window.
const std::string kLamp = "AttributeBegin AreaLightSource \"slrect\" 1 \"float intensity\" 5 Surface \"constant\" Color 0 0 0 "
                          "Polygon \"P\" [3.5 0 -3  3.5 0 3  3.5 4 3  3.5 4 -3] AttributeEnd\nIlluminate 1 1\n";
/// A sky that is bright toward +x, so that it has a table.
std::string sideSky() {
    writeShader("sidesky", "light sidesky() { solar() Cl = 40 * pow(max(0, xcomp(normalize(-L))), 6) + .2; }\n");
    return "LightSource \"sidesky\" 1\n";
}

/// Camera rays over the room, from inside.
std::vector<CameraRay> inside(int count) {
    g_random.seed(11);
    std::vector<CameraRay> rays;
    for (int i = 0; i < count; ++i) {
        CameraRay r = rayTo({-1, 1.5f, 0}, {-3 + 6 * uniform(), .01f, -3 + 6 * uniform()});
        r.px = i, r.sample = 0x40000000u;
        rays.push_back(r);
    }
    return rays;
}

LightGuideFigures learn(Scene& s, int paths) {
    LightGuideFigures f;
    EXPECT_TRUE(mayGuideLights(*s.world));
    EXPECT_TRUE(learnLights(s.world, inside(paths), s.diagnostics, nullptr, f));
    return f;
}

/// A guide for the first light, of directions that mean nothing.
void guideWrongly(Scene& s) {
    const auto& w = static_cast<const WorldImpl&>(*s.world);
    const BoundLight& l = w.lights()[0];
    g_random.seed(3);
    std::vector<SeenLight> seen;
    for (int i = 0; i < 4000; ++i) {
        const Vec3 P(6 * uniform() - 3, 4 * uniform(), 6 * uniform() - 3);
        const Vec3 w1 = normalize(Vec3(.2f + uniform(), uniform() - .3f, .7f * uniform() - .1f));
        seen.push_back({P, w1, 1, 1e3f, l.guidable ? 0 : 1e-3f}); // drawn very rarely, so that a guide promises much
    }
    const LightDomain domain = l.isSky() ? LightDomain() : LightDomain(l.emitter->flat()[0]);
    std::vector<Vec3> many;
    for (int i = 0; l.guidable && i < 40000; ++i) many.emplace_back(6 * uniform() - 3, 4 * uniform(), 6 * uniform() - 3);
    auto guide =
        l.guidable ? std::make_shared<const LightGuide>(domain, seen, many) : std::make_shared<const LightGuide>(domain, seen);
    EXPECT_GT(guide->used(), 0u);
    w.photons()->lightGuides.assign(w.lights().size(), nullptr);
    w.photons()->lightGuides[0] = guide;
}

} // namespace

TEST(LightGuide, BinsOfASquareCoverItsSolidAngle) {
    g_random.seed(7);
    const LightDomain d(square());
    const Vec3 P(.4f, 0, -.2f);
    Moments angle;
    for (int i = 0; i < 200000; ++i) {
        const int bin = int(uniform() * float(d.bins()));
        const Vec3 w = d.direction(P, bin, {uniform(), uniform()});
        int found = -1;
        float density = 0;
        ASSERT_TRUE(d.find(P, w, found, density));
        // A direction at the edge of a bin may be found in the next.
        if (found == bin) angle.add(Color(float(d.bins()) / density));
    }
    // Solid angle of a rectangle: sum over its corners of atan(x y / (h sqrt(x^2 + y^2 + h^2))).
    const auto corner = [](double x, double y) { return std::atan(x * y / (3 * std::sqrt(x * x + y * y + 9))); };
    const double want = corner(.6, 1.2) + corner(.6, .8) + corner(1.4, 1.2) + corner(1.4, .8);
    EXPECT_NEAR(angle.mean(), want, kZ * angle.se() + 1e-4);
    int bin;
    float density;
    EXPECT_FALSE(d.find(P, {0, -1, 0}, bin, density));
    EXPECT_FALSE(d.find(P, {1, 0, 0}, bin, density));
    EXPECT_FALSE(d.find({0, 3, 0}, {1, 0, 0}, bin, density)) << "in its plane";
}

TEST(LightGuide, BinsOfASkyCoverTheSphere) {
    g_random.seed(8);
    const LightDomain d;
    Moments angle;
    for (int i = 0; i < 200000; ++i) {
        const int bin = int(uniform() * float(d.bins()));
        const Vec3 w = d.direction({}, bin, {uniform(), uniform()});
        ASSERT_NEAR(length(w), 1, 1e-5);
        int found = -1;
        float density = 0;
        ASSERT_TRUE(d.find({}, w, found, density));
        if (found == bin) angle.add(Color(float(d.bins()) / density));
    }
    EXPECT_NEAR(angle.mean(), 4 * kPi, kZ * angle.se() + 1e-3);
}

TEST(LightGuide, FollowsWhatIsVisibleOnlyWhereThatPays) {
    g_random.seed(9);
    // From the floor at x < 0 only the half x < 0 of the square is visible, elsewhere all of it.
    std::vector<SeenLight> seen;
    while (seen.size() < 8000) {
        const Vec3 P(8 * uniform() - 4, 0, 8 * uniform() - 4), at(2 * uniform() - 1, 3, 2 * uniform() - 1);
        if (P.x < 0 && at.x > 0) continue;
        const Vec3 to = at - P, w = normalize(to);
        const float pdf = dot(to, to) / (4 * w.y);
        seen.push_back({P, w, 1, 1 / pdf, pdf});
    }
    const LightGuide guide(LightDomain(square()), seen);
    const Vec3 behind(-2, 0, 1.3f), before(3, 0, 1.3f);
    EXPECT_EQ(guide.find(before), nullptr) << "the light's own density is as good";
    const LightGuide::Cell* cell = guide.find(behind);
    ASSERT_NE(cell, nullptr);
    EXPECT_GT(cell->share, .4f);
    int there = 0;
    for (int i = 0; i < 10000; ++i) {
        const Vec3 w = guide.draw(*cell, behind, {uniform(), uniform()});
        there += (behind + w * (3 / w.y)).x < 0;
        ASSERT_GT(guide.density(*cell, behind, w), 0);
    }
    EXPECT_GT(there, 9500);
    EXPECT_EQ(guide.find({0, 50, 0}), nullptr);
    EXPECT_EQ(guide.find({NAN, 0, 0}), nullptr);
}

TEST(LightGuide, PathsHaveTheSameLight) {
    const CameraRay ray = rayTo({-1, 1.5f, 0}, {1.2f, 0, .4f});
    for (const auto& [name, light] :
         {std::pair<std::string, std::string>("sky", kSky), {"lamp", kLamp}, {"sky with a table", sideSky()}}) {
        Scene s(inWorld(room(light)), path(true));
        EXPECT_EQ(static_cast<const WorldImpl&>(*s.world).lights()[0].sky != nullptr, name == "sky with a table");
        const int n = samples(60000);
        const Moments plain = s.estimate(ray, n);
        EXPECT_GT(learn(s, 80000).used, 0u) << name;
        const Moments guided = s.estimate(ray, n);
        const double se = std::hypot(plain.se(), guided.se());
        EXPECT_NEAR(plain.mean(), guided.mean(), kZ * se) << name;
        if (name != "sky with a table") EXPECT_LT(guided.se(), .75 * plain.se()) << name;
        EXPECT_LT(se, .06 * plain.mean()) << name << ": not precise enough to decide";
        guideWrongly(s);
        const Moments wrong = s.estimate(ray, n);
        EXPECT_NEAR(plain.mean(), wrong.mean(), kZ * std::hypot(plain.se(), wrong.se())) << name << ", a guide that is wrong";
    }
}

// A floor of reflectance .6 under a uniform sky of radiance 5 has radiance 3; the guide knows a part of that sky only.
TEST(LightGuide, FloorUnderASky) {
    Scene s(inWorld(kSky + "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1 Color .6 .6 .6\n" + kFloor), path(true));
    guideWrongly(s);
    expectMean(s.estimate(kView, samples(40000)), 3, .01, "floor");
}

// Exits of subsurface walks gather light as other points do, so a guide must not take light from their rays.
TEST(LightGuide, LightThatLeavesBelow) {
    Scene s(inWorld(kSky + "Surface \"standard\" \"subsurface\" 1 \"float specular\" 0 \"color subsurface_radius\" [.2 .2 .2]\n" +
                    kFloor),
            path());
    const int n = samples(20000);
    const Moments plain = s.estimate(kView, n);
    guideWrongly(s);
    const Moments wrong = s.estimate(kView, n);
    const double se = std::hypot(plain.se(), wrong.se());
    EXPECT_NEAR(plain.mean(), wrong.mean(), kZ * se);
    EXPECT_LT(se, .01 * plain.mean());
}

TEST(LightGuide, BlocksHaveTheBitsOfSinglePoints) {
    for (const std::string& light : {kSky, kLamp, sideSky()}) {
        std::vector<std::vector<SampleResult>> all;
        for (const bool blocks : {true, false}) {
            Scene s(inWorld(room(light)), path(blocks));
            guideWrongly(s);
            std::vector<CameraRay> rays = inside(1500);
            for (CameraRay& r : rays) r.sample = 0;
            all.push_back(s.trace(rays));
        }
        size_t differ = 0;
        for (size_t i = 0; i < all[0].size(); ++i) differ += !(all[0][i].color == all[1][i].color);
        EXPECT_EQ(differ, 0u);
    }
}

} // namespace lightguide_test
