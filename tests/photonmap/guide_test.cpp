// The caustic guide: what it draws, and that paths have the same light with it, without it, and with one that is wrong.
#include "integrator/floorscene.h"
#include "integrator/integrator.h"
#include "world/causticguide.h"
#include "world/photonmaps.h"
#include <random>

namespace guide_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

Settings path(bool blocks = true) {
    Settings s = withShaders(Hider::Path);
    s.rowRequests = blocks;
    return s;
}

/// As the renderer does it.
GuideFigures guide(Scene& s, float brightness = 1, uint32_t count = 40000) {
    PhotonEmission emission(s.world, {.all = true, .sky = true, .caustics = true, .learns = true}, s.diagnostics);
    PhotonEmission::Thread thread(emission, s.diagnostics);
    std::vector<StoredPhoton> found;
    EXPECT_TRUE(thread.emit(0xfffffffeu, 0, 8000, 8000, found, nullptr));
    emission.learn(found, 0xfffffffeu, 8000);
    found.clear();
    EXPECT_TRUE(thread.emit(0xfffffffdu, 0, count, count, found, nullptr));
    return guideCaustics(*s.world, found, emission.power(), brightness);
}

/// Photons that never were, all over a box, from anywhere.
GuideFigures guideWrongly(Scene& s, Vec3 low, Vec3 high) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> u;
    std::vector<StoredPhoton> wrong(4000);
    for (StoredPhoton& p : wrong) {
        for (int k = 0; k < 3; ++k) p.photon.P[k] = low[k] + (high[k] - low[k]) * u(random);
        p.photon.normal = photonmap::packUnit(normalize(Vec3(u(random) - .5f, 2 * u(random) - 1, u(random) - .5f)));
        p.photon.power = Color(.003f);
        p.way = Vec3(4 * u(random) - 2, 4 * u(random) - 2, 4 * u(random) - 2);
        p.caustic = true;
    }
    return guideCaustics(*s.world, wrong, 1, .2f);
}

void expectSame(const Moments& a, const Moments& b, double precision, const std::string& what) {
    for (int k = 0; k < 3; ++k) {
        const double se = std::hypot(a.se(k), b.se(k));
        EXPECT_NEAR(a.mean(k), b.mean(k), kZ * se + 1e-6) << what << ", channel " << k;
        EXPECT_LT(se, precision * std::fabs(b.mean(k))) << what << ": not precise enough to decide";
    }
}

const std::string kMirror = "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [1 1 1]\n";
const std::string kGlass = "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float kn\" "
                           "1.5 \"string fresnel\" \"exact\"\n";
const std::string kMatte = "Surface \"slmaterial\" \"color diffusecolor\" [.8 .6 .4]\n";
const std::string kMirrorBelow = "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2]\n",
                  kCeiling = "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n",
                  kWideFloor = "Polygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\n",
                  kBall = "AttributeBegin " + kGlass + "Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\n";
/// Shines down, and is not there from above.
std::string lamp(double y, double half, double radiance) {
    char text[400];
    std::snprintf(text, sizeof text,
                  "AttributeBegin Sides 1 AreaLightSource \"slrect\" 1 \"float intensity\" %g Surface \"constant\" Color 0 0 0 "
                  "Polygon \"P\" [%g %g %g  %g %g %g  %g %g %g  %g %g %g] AttributeEnd\nIlluminate 1 1\n",
                  radiance, -half, y, -half, half, y, -half, half, y, half, -half, y, half);
    return text;
}

struct Case {
    std::string name, scene;
    CameraRay ray;
    double precision;
};

std::vector<Case> cases() {
    writeShader("beer", "volume beer(float k = 1) { Ci *= exp(-k * length(I)); }\n");
    writeShader("half", "surface half() { normal n = faceforward(normalize(N), I); Oi = 1; Ci = .4 * diffuse(n) + .4 * trace(P, "
                        "reflect(normalize(I), n)); }\n");
    writeShader("sheet", "surface sheet() { Oi = .5; Ci = .5 * diffuse(faceforward(normalize(N), I)); }\n");
    writeShader("two",
                "surface two() { normal n = faceforward(normalize(N), I); Oi = 1; Ci = color(.5, .4, .3) * diffuse(n) + .4 * "
                "specular(n, -normalize(I), .2) + .2 * trace(P, n, \"distribution\", \"oren-nayar\", \"roughness\", .4, "
                "\"samplearealights\", 1); }\n");
    writeShader("waits", "surface waits() { color c = trace(P, reflect(normalize(I), normalize(N))); if (comp(c, 0) > .5) c = .5 "
                         "+ .5 * c; Oi = 1; Ci = c; }\n");
    const CameraRay up = rayTo({1.1f, 1.2f, 0}, {1, 2, 0}), down = rayTo({.3f, .6f, 1.4f}, {.1f, 0, .1f});
    const auto mirrored = [](const std::string& mirror, const std::string& ceiling, const std::string& more = "") {
        return lamp(1, .5, 5) + "AttributeBegin " + mirror + kMirrorBelow + "AttributeEnd\n" + more + ceiling + kCeiling;
    };
    const std::string sheet =
        "AttributeBegin Surface \"sheet\" Polygon \"P\" [-1 1.5 -1  -1 1.5 1  1 1.5 1  1 1.5 -1] AttributeEnd\n";
    return {
        {"mirror", mirrored(kMirror, kMatte), up, .04},
        {"glass ball", lamp(3, .8, 5) + kBall + kMatte + kWideFloor, down, .04},
        {"mirror that spreads, too", mirrored("Surface \"half\" ", kMatte), up, .04},
        {"several lobes", mirrored(kMirror, "Surface \"two\" "), up, .04},
        {"behind a sheet", mirrored(kMirror, kMatte, sheet), up, .05},
        {"a pane before the lamp",
         mirrored(kMirror, kMatte,
                  "AttributeBegin Surface \"sheet\" Polygon \"P\" [-1 .5 -1  -1 .5 1  1 .5 1  1 .5 -1] AttributeEnd\n"),
         up, .05},
        {"a ball that is overruled before the lamp",
         "AttributeBegin Surface \"null\" Interior \"medium\" \"color absorption\" [.1 .1 .1] \"color scattering\" [0 0 0] "
         "\"float "
         "priority\" 2 Translate 0 1 0 Sphere 1.6 -1.6 1.6 360 AttributeEnd\n" +
             mirrored(kMirror, kMatte,
                      "AttributeBegin " + kMatte +
                          "Interior \"medium\" \"float priority\" 1 Translate 0 .5 0 Sphere .3 -.3 .3 360 AttributeEnd\n"),
         up, .05},
        {"mirror that waits", mirrored("Surface \"waits\" ", kMatte), up, .05},
        {"water",
         lamp(3, .8, 5) + "AttributeBegin " + kGlass + "Polygon \"P\" [-9 1 -9  -9 1 9  9 1 9  9 1 -9] AttributeEnd\n" + kMatte +
             kWideFloor,
         rayTo({.3f, .6f, .4f}, {.1f, 0, .1f}), .04},
        {"air",
         "AttributeBegin Atmosphere \"beer\" \"k\" .3 " + lamp(1, .5, 5) +
             "AttributeEnd Illuminate 1 1 AttributeBegin Atmosphere \"beer\" \"k\" .5 " + kMirror + kMirrorBelow +
             "AttributeEnd Atmosphere \"beer\" \"k\" .2 " + kMatte + kCeiling,
         up, .05},
        {"fog",
         "AttributeBegin Surface \"null\" Interior \"medium\" \"color scattering\" [.3 .2 .1] \"color absorption\" "
         "[.1 .1 .1] Translate 0 1 0 Sphere 1.6 -1.6 1.6 360 AttributeEnd\n" +
             mirrored(kMirror, kMatte),
         up, .06},
        {"mirror of the principled surface",
         mirrored("Surface \"standard\" \"base_color\" [1 1 1] \"metalness\" 1 \"specular_roughness\" 0 ", kMatte), up, .04},
        {"ball of its glass",
         lamp(3, .8, 5) +
             "AttributeBegin Surface \"standard\" \"transmission\" 1 \"specular_roughness\" 0 Translate 0 1 0 Sphere .6 -.6 .6 "
             "360 AttributeEnd\n" +
             kMatte + kWideFloor,
         down, .04},
        {"sky in a mirror", "LightSource \"envlight\" 3\n" + mirrored(kMirror, kMatte), up, .04}};
}

} // namespace

TEST(CausticGuide, DrawsByItsDensity) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> u;
    std::vector<GuidePhoton> photons;
    const Vec3 n(0, 1, 0);
    for (int i = 0; i < 3000; ++i) { // from a ring of mirrors above, near and wide enough for the lobes to be seen
        const float a = 6.2832f * u(random);
        photons.push_back({{2 * u(random) - 1, 0, 2 * u(random) - 1},
                           {std::cos(a) + .3f * u(random), 1 + .2f * u(random), std::sin(a)},
                           SurfaceTree::sideOf(n),
                           .001f});
    }
    const CausticGuide guide(photons, 1);
    EXPECT_GT(guide.cells(), 20u);
    EXPECT_EQ(guide.find({0, 0, 0}, SurfaceTree::sideOf(-n)), nullptr);
    EXPECT_EQ(guide.find({9, 0, 0}, SurfaceTree::sideOf(n)), nullptr);
    EXPECT_EQ(guide.find({NAN, 0, 0}, SurfaceTree::sideOf(n)), nullptr);
    for (const Vec3& P : {Vec3(.1f, 0, .2f), Vec3(-.9f, 0, .7f), Vec3(.5f, 0, -.5f)}) {
        const CausticGuide::Cell* cell = guide.find(P, SurfaceTree::sideOf(n));
        ASSERT_NE(cell, nullptr);
        EXPECT_NEAR(cell->irradiance, 3 / 4., .4) << "3 units of light over 4 of area";
        // The integral of the density, and that of functions by both: evenly over the sphere, and by draws.
        Moments whole, even, drawn;
        for (int i = 0; i < 400000; ++i) {
            const float z = 2 * u(random) - 1, r = std::sqrt(1 - z * z), a = 6.28318531f * u(random);
            const Vec3 w(r * std::cos(a), r * std::sin(a), z), v = guide.draw(*cell, P, {u(random), u(random)});
            const double d = guide.density(*cell, P, w) * 4 * kPi;
            whole.add(Color(float(d)));
            even.add(w * w * float(d));
            drawn.add(v * v);
            ASSERT_NEAR(length(v), 1, 1e-5);
        }
        EXPECT_NEAR(whole.mean(), 1, kZ * whole.se());
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(even.mean(k), drawn.mean(k), kZ * std::hypot(even.se(k), drawn.se(k)));
    }
}

TEST(CausticGuide, FindsTogetherAsAlone) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> u(-1, 1);
    std::vector<GuidePhoton> photons;
    for (int i = 0; i < 5000; ++i) { // on four of six sides, most of them near a corner, so that leaves lie at different depths
        const float far = i % 4 ? .1f : 1.f;
        photons.push_back({Vec3(u(random), u(random), u(random)) * far, {0, 0, 3}, 1 + i % 4, .01f});
    }
    const CausticGuide guide(photons, 1);
    int met = 0;
    for (int turn = 0; turn < 200; ++turn) {
        std::vector<SurfaceTree::Point> points;
        for (size_t i = 0; i < size_t(turn) % SurfaceTree::kTogether + 1; ++i)
            points.push_back({Vec3(u(random), u(random), u(random)) * (i % 5 == 4 ? 3.f : i % 2 ? .1f : 1.f), 1 + int(i) % 6});
        if (turn == 7) points[0].P.y = NAN;
        const CausticGuide::Cell* found[SurfaceTree::kTogether];
        guide.find(points, found);
        for (size_t i = 0; i < points.size(); ++i) {
            EXPECT_EQ(found[i], guide.find(points[i].P, points[i].side));
            met += found[i] != nullptr;
        }
    }
    EXPECT_GT(met, 500);
}

TEST(CausticGuide, SendsByWhatTheEyeGets) {
    std::vector<GuidePhoton> photons(100, {{0, 0, 0}, {0, 1, 0}, SurfaceTree::sideOf({0, 1, 0}), .01f});
    for (size_t i = 0; i < photons.size(); ++i) photons[i].P = {float(i % 10), 0, float(i / 10)};
    const CausticGuide guide(photons, 2);
    const CausticGuide::Cell* cell = guide.find({4, 0, 4}, SurfaceTree::sideOf({0, 1, 0}));
    ASSERT_NE(cell, nullptr);
    int last = 1;
    for (float brings = 1000; brings > 1e-7f; brings *= .7f) {
        const int code = guide.codeFor(*cell, brings);
        if (code == 0) { // from here on never
            EXPECT_EQ(last, CausticGuide::kMostCode);
            EXPECT_EQ(guide.codeFor(*cell, brings / 1000), 0);
            break;
        }
        EXPECT_GE(code, last) << brings;
        EXPECT_LE(code, CausticGuide::kMostCode);
        last = code;
    }
    EXPECT_EQ(CausticGuide::chanceOf(1), 1);
    EXPECT_EQ(CausticGuide::chanceOf(3), .25f);
    EXPECT_EQ(guide.codeFor(*cell, NAN), 0);
}

TEST(CausticGuide, PathsHaveTheSameLight) {
    for (const Case& c : cases()) {
        Scene s(inWorld(c.scene), path());
        const int n = samples(60000);
        const Moments plain = s.estimate(c.ray, n);
        Counters counted;
        const GuideFigures figures = guide(s, .3f);
        const Moments guided = s.estimate(c.ray, n, &counted);
        expectSame(guided, plain, c.precision, c.name);
        EXPECT_EQ(counted.guided > 0, c.name != "mirror that waits") << c.name << ": " << figures.photons;
        Counters wrong;
        guideWrongly(s, {-2, -.1f, -2}, {2, 2.1f, 2});
        expectSame(s.estimate(c.ray, n / 4, &wrong), plain, 2 * c.precision, c.name + ", a guide that is wrong");
        EXPECT_GT(wrong.guided, 0u) << c.name;
    }
}

TEST(CausticGuide, LessNoise) {
    const auto all = cases();
    for (const size_t i : {0u, 1u, 6u}) {
        Scene s(inWorld(all[i].scene), path());
        const int n = samples(40000);
        const double without = s.estimate(all[i].ray, n).se();
        guide(s, .3f);
        EXPECT_LT(s.estimate(all[i].ray, n).se(), .7 * without) << all[i].name;
    }
}

// A lamp that shines down on a mirror, and is not there from above. A ceiling over it is lit by the lamp's image alone: a disk of
// radiance L and radius R whose image is H below gives E / pi = L R^2 / (R^2 + H^2) (Siegel and Howell, configuration C-21).
const std::string kLampDown =
    "AttributeBegin Sides 1 AreaLightSource \"slrect\" 1 \"float intensity\" 5 Surface \"constant\" Color "
    "0 0 0 Translate 0 1 0 Rotate 90 1 0 0 Disk 0 .1 360 AttributeEnd\nIlluminate 1 1\n";
constexpr double kImage = 5 * .1 * .1 / (.1 * .1 + 3 * 3);

TEST(CausticGuide, ImageOfALampInAMirror) {
    for (const bool exact : {true, false}) {
        Scene s(inWorld(kLampDown + "AttributeBegin " + kMirror + kMirrorBelow +
                        "AttributeEnd\nSurface \"matte\" \"float Ka\" 0 \"float "
                        "Kd\" 1 Color .5 .5 .5 " +
                        kCeiling),
                [&] {
                    Settings set = path();
                    set.maxDepth = 2; // the image, and nothing that the ceiling sends on
                    return set;
                }());
        if (exact) guide(s, .01f);
        else guideWrongly(s, {-2, 1.9f, -2}, {2, 2.1f, 2});
        expectMean(s.estimate(rayTo({.02f, 1.2f, 0}, {0, 2, 0}), samples(exact ? 40000 : 400000)), .5 * kImage, exact ? .02 : .06,
                   exact ? "learned" : "wrong");
    }
}

// A small wall with a sky behind it, lit by the sky's image in a large mirror alone. Where the sky has radiance L c^k at an angle
// of cosine c to an axis, and that axis is b off the wall's normal in the mirror, E / pi = 2 L cos b / (k + 2) (what the wall's
// horizon and the mirror's edges cut off is below .6^k).
TEST(CausticGuide, ImageOfASun) {
    writeShader("sidesun", "light sidesun() { solar() { vector w = -normalize(L);"
                           " Cl = 20 * pow(max(0, .8660254 * xcomp(w) + .5 * ycomp(w)), 200); } }\n");
    Settings set = path();
    set.maxDepth = 2; // the image, and nothing that the wall sends on
    for (const bool exact : {true, false}) {
        Scene s(inWorld("LightSource \"sidesun\" 1\nAttributeBegin " + kMirror +
                        "Polygon \"P\" [-2 -3 -4  -2 -3 4  -2 5 4  -2 5 -4] AttributeEnd\nSurface \"matte\" \"float Ka\" 0 "
                        "\"float Kd\" 1 Color .5 .5 .5 Polygon \"P\" [0 -.2 -.2  0 -.2 .2  0 .2 .2  0 .2 -.2]"),
                set);
        const CameraRay ray = rayTo({-1, .05f, .3f}, {0, 0, 0});
        Counters n;
        const Moments without = s.estimate(ray, samples(40000));
        if (exact) EXPECT_GT(guide(s, .01f).photons, 500u);
        else guideWrongly(s, {-.2f, -.2f, -.2f}, {.2f, .2f, .2f});
        const Moments guided = s.estimate(ray, samples(exact ? 40000 : 400000), &n);
        expectMean(guided, .5 * 20 * .8660254 * 2 / 202, exact ? .01 : .06, exact ? "learned" : "wrong");
        EXPECT_GT(n.guided, 0u);
        if (exact) EXPECT_LT(guided.se(), .3 * without.se());
    }
}

// No ray meets a light without size, so its photons would only aim rays in vain.
TEST(CausticGuide, LightsThatNoRayMeetsDoNotGuide) {
    const std::string mirror = "AttributeBegin " + kMirror + kMirrorBelow + "AttributeEnd\nSurface \"matte\" " + kCeiling;
    for (const std::string light :
         {"LightSource \"pointlight\" 2 \"from\" [0 1 0]\n", "LightSource \"distantlight\" 2 \"to\" [0 -1 0]\n"}) {
        Scene alone(inWorld(light + mirror), path()), withLamp(inWorld(light + kLampDown + mirror), path());
        EXPECT_EQ(guide(alone, .01f).photons, 0u) << light;
        EXPECT_GT(guide(withLamp, .01f).photons, 0u) << light;
    }
}

// A ceiling that would give back twice what it receives gives back all of it.
TEST(CausticGuide, ImageUnderTheEnergyRule) {
    writeShader("much", "surface much() { Oi = 1; Ci = 2 * diffuse(faceforward(normalize(N), I)); }\n");
    Settings shallow = path();
    shallow.maxDepth = 2;
    Scene s(inWorld(kLampDown + "AttributeBegin " + kMirror + kMirrorBelow + "AttributeEnd\nSurface \"much\" " + kCeiling),
            shallow);
    guide(s, .01f);
    expectMean(s.estimate(rayTo({.02f, 1.2f, 0}, {0, 2, 0}), samples(40000)), kImage, .02, "much");
}

// A wide lamp, whose image rays of lobes find as well as the guide does, so that the weights of both count: at two lobes, of
// which each has its part, and behind three sheets that pass .6 each.
TEST(CausticGuide, ImageOfAWideLamp) {
    const std::string begin = "() { normal n = faceforward(normalize(N), I); Oi = 1; Ci = ";
    writeShader("beside", "surface beside" + begin +
                              ".5 * diffuse(n) + .5 * trace(P, n, \"distribution\", \"oren-nayar\", \"roughness\", 0, "
                              "\"samplearealights\", 1); }\n");
    writeShader("passes", "surface passes() { Oi = 1; Ci = .6 * trace(P, normalize(I)); }\n");
    const std::string wide =
                          "AttributeBegin Sides 1 AreaLightSource \"slrect\" 1 \"float intensity\" 5 Surface \"constant\" Color "
                          "0 0 0 Translate 0 1 0 Rotate 90 1 0 0 Disk 0 2 360 AttributeEnd\nIlluminate 1 1\n",
                      mirror = "AttributeBegin " + kMirror + kMirrorBelow + "AttributeEnd\nSurface \"beside\" " + kCeiling;
    std::string sheets = "AttributeBegin Surface \"passes\"\n";
    for (const char* x : {"1.2", "1", ".8"})
        sheets += std::string("Polygon \"P\" [") + x + " 1.3 -.1  " + x + " 1.3 .1  " + x + " 1.8 .1  " + x + " 1.8 -.1]\n";
    const double image = 5 * 2 * 2 / (2 * 2 + 3 * 3.);
    for (const bool behind : {false, true}) {
        Settings set = path();
        set.maxDepth = behind ? 5 : 2; // the image, and nothing that the ceiling sends on
        Scene s(inWorld(wide + (behind ? sheets + "AttributeEnd\n" : "") + mirror), set);
        guideWrongly(s, {-2, 1.9f, -2}, {2, 2.1f, 2});
        Counters n;
        const CameraRay ray = behind ? rayTo({1.6f, 1.2f, 0}, {0, 2, 0}) : rayTo({.02f, 1.2f, 0}, {0, 2, 0});
        expectMean(s.estimate(ray, samples(40000), &n), (behind ? .216 : 1) * image, behind ? .012 : .01,
                   behind ? "behind sheets" : "two lobes");
        EXPECT_GT(n.guided, 500u);
    }
}

TEST(CausticGuide, BlocksHaveTheBitsOfSinglePoints) {
    for (const Case& c : cases()) {
        std::vector<std::vector<SampleResult>> all;
        for (const bool blocks : {true, false}) {
            Scene s(inWorld(c.scene), path(blocks));
            if (nightly()) guide(s, .3f);
            else guideWrongly(s, {-2, -.1f, -2}, {2, 2.1f, 2}); // bits do not depend on what a guide knows
            std::vector<CameraRay> rays;
            for (int i = 0; i < (nightly() ? 1500 : 600); ++i) {
                CameraRay r = c.ray;
                r.px = i % 40, r.py = i / 40, r.sample = uint32_t(i % 3);
                rays.push_back(r);
            }
            Counters n;
            all.push_back(s.trace(rays, &n));
            if (!blocks) EXPECT_EQ(n.inRows, 0u);
            if (c.name != "mirror that waits") EXPECT_GT(n.guided, 0u) << c.name;
        }
        size_t differ = 0;
        for (size_t i = 0; i < all[0].size(); ++i) differ += !(all[0][i].color == all[1][i].color);
        EXPECT_EQ(differ, 0u) << c.name;
    }
}

// Outputs by light path, and those of one light, have their parts of what guided rays bring.
TEST(CausticGuide, OutputsHaveTheirParts) {
    writeShader("gives",
                "surface gives(output varying color __d = 0) { __d = .5 * diffuse(faceforward(normalize(N), I)); Oi = 1; Ci = "
                "__d; }\n");
    Settings set = path();
    set.outputs = {"__d"};
    Scene s(inWorld(lamp(1, .5, 5) + "AttributeBegin " + kMirror + kMirrorBelow + "AttributeEnd\nSurface \"gives\" " + kCeiling),
            set);
    const CameraRay ray = rayTo({1.1f, 1.2f, 0}, {1, 2, 0});
    guide(s, .3f);
    std::vector<CameraRay> rays(4000, ray);
    for (size_t i = 0; i < rays.size(); ++i) rays[i].px = int(i);
    Moments difference, whole;
    for (const SampleResult& r : s.trace(rays)) {
        ASSERT_EQ(r.aovs.size(), 3u);
        difference.add(r.color - Color(r.aovs[0], r.aovs[1], r.aovs[2]));
        whole.add(r.color);
    }
    EXPECT_GT(whole.mean(), 5 * whole.se());
    EXPECT_NEAR(difference.mean(), 0, kZ * difference.se() + 1e-6) << "all light of the ceiling is in its output";
}

} // namespace guide_test
