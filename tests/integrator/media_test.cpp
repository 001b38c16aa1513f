// Interior and Exterior: which volume shader runs over which way, by Beer's law exp(-k d) with ways that are known.
#include "integrator/floorscene.h"

namespace media_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

class Media : public ::testing::TestWithParam<Hider> {
protected:
    void SetUp() override {
        writeShader("beer", "volume beer(float k = 1) { Ci *= exp(-k * length(I)); }\n");
        writeShader("ahead", "surface ahead() { Oi = 1; Ci = trace(P, normalize(I)); }\n");
        // Refraction with the right index on each way through.
        writeShader("bends", "surface bends(float index = 1.5) { normal n = normalize(N); vector i = normalize(I); Oi = 1;\n"
                             "    Ci = trace(P, (i . n < 0) ? refract(i, n, 1 / index) : refract(i, -n, index)); }\n");
        writeShader("reflects", "surface reflects() { Oi = 1; Ci = trace(P, reflect(normalize(I), normalize(N))); }\n");
        writeShader("shine", "surface shine() { Oi = 1; Ci = Cs; }\n"); // gives the same under every hider
    }
    /// What a ray along z sees that begins at (x, 0, z). The eye is in the plane there.
    Color seen(const std::string& inside, float x = 0, float z = -5) {
        Scene s("WorldBegin\nSides 2\nAttribute \"trace\" \"maxspeculardepth\" 9\nTranslate 0 0 " + std::to_string(-z) + "\n" +
                    inside + "WorldEnd\n",
                settings());
        return s.one(rayTo({x, 0, 0}, {x, 0, 1}));
    }
    static Settings settings() {
        Settings s = withShaders(GetParam());
        s.maxDepth = 12;
        s.roulette = false;
        return s;
    }
};
const char kWall[] =
    "AttributeBegin Surface \"shine\" Color 1 1 1 Polygon \"P\" [-99 -99 9  -99 99 9  99 99 9  99 -99 9] AttributeEnd\n";
std::string ball(float radius, const std::string& before) {
    const std::string r = std::to_string(radius);
    return "AttributeBegin " + before + " Sphere " + r + " -" + r + " " + r + " 360 AttributeEnd\n";
}
void expectAll(const Color& c, double want, const std::string& what, double error = 2e-5) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want, error) << what;
}

TEST_P(Media, TheInsideOfGlass) {
    const std::string beer = "Interior \"beer\" \"k\" .6 ";
    expectAll(seen(kWall + ball(1, "Surface \"ahead\" " + beer)), std::exp(-.6 * 2), "through the middle");
    for (float b : {0.f, .3f, .8f}) // the chord of the refracted ray
        expectAll(seen(kWall + ball(1, "Surface \"bends\" " + beer), b), std::exp(-.6 * 2 * std::sqrt(1 - b * b / 2.25)),
                  "refracted");
    // Turned inside out: the inside is the side that N points away from.
    expectAll(seen(kWall + ball(1, "ReverseOrientation Surface \"ahead\" " + beer), 0), std::exp(-.6 * 8),
              "inside out: what is beyond it is its inside");
    // Nothing is taken on the way to the glass and behind it; the Atmosphere of what is met is for ways that are in no medium.
    const std::string misty = "Atmosphere \"beer\" \"k\" .1 ";
    expectAll(seen(misty + kWall + ball(1, "Surface \"ahead\" " + beer)), std::exp(-.1 * 4 - .6 * 2 - .1 * 8),
              "with an atmosphere");
}

// As the eye's, the way of a traced ray goes on behind what it passes through: the Atmosphere of what it meets counts all of it.
TEST_P(Media, TheWayOfTracedRaysThroughSheets) {
    const auto square = [](const std::string& before, double z) {
        const std::string d = std::to_string(z);
        return "AttributeBegin " + before + " Polygon \"P\" [-9 -9 " + d + "  -9 9 " + d + "  9 9 " + d + "  9 -9 " + d +
               "] AttributeEnd\n";
    };
    const std::string sheets = square("Surface \"constant\" Opacity 0 0 0", 1) + square("Surface \"constant\" Opacity 0 0 0", 3);
    const std::string air = "Atmosphere \"beer\" \"k\" .1 ", mirror = square("Surface \"ahead\"", -2);
    expectAll(seen(sheets + mirror + square(air + "Surface \"shine\" Color 1 1 1", 9)), std::exp(-.1 * 11), "a surface");
    expectAll(seen(sheets + square(air + "Surface \"shine\" Color 1 1 1", 9)), std::exp(-.1 * 14), "the eye itself");
}

TEST_P(Media, WhatIsNotOpaque) {
    const std::string beer = "Interior \"beer\" \"k\" .6 ", veil = "Surface \"constant\" Color 0 0 0 Opacity .25 .25 .25 ";
    expectAll(seen(kWall + ball(1, veil + beer)), .75 * .75 * std::exp(-.6 * 2), "seen through");
    expectAll(seen("Atmosphere \"beer\" \"k\" .1 " + std::string(kWall) + ball(1, veil + beer)),
              .75 * .75 * std::exp(-.1 * 4 - .6 * 2 - .1 * 8), "and an atmosphere before and behind");
    expectAll(seen(kWall + ball(1, veil)), .75 * .75, "no medium");
    // A volume that says its opacity, too, takes its share once.
    writeShader("half", "volume half() { Ci *= .5; Oi = 1 - (1 - Oi) * .5; }\n");
    expectAll(seen(kWall + ball(1, veil + "Interior \"half\"")), .75 * .75 * .5, "with Oi");
}

TEST_P(Media, OneInTheOther) {
    const std::string outer = ball(2, "Surface \"ahead\" Interior \"beer\" \"k\" .1 "), ahead = "Surface \"ahead\" ";
    expectAll(seen(kWall + outer + ball(1, ahead + "Interior \"beer\" \"k\" .7 ")), std::exp(-.1 * 2 - .7 * 2), "two");
    expectAll(seen(kWall + outer + ball(1, ahead)), std::exp(-.1 * 4), "what has no volumes bounds none");
    expectAll(seen(kWall + outer + ball(1, ahead + "Exterior \"beer\" \"k\" 0 ")), std::exp(-.1 * 1),
              "an outside that is said: empty inside, and around");
    expectAll(
        seen(kWall + outer + ball(1.5, ahead + "Interior \"beer\" \"k\" .2 ") + ball(1, ahead + "Interior \"beer\" \"k\" .7 ")),
        std::exp(-.1 * 1 - .2 * 1 - .7 * 2), "three");
    // Neither inside the other: the middle is in both, and the one that was entered last counts.
    expectAll(seen(kWall + ("AttributeBegin Translate 0 0 -.5 " + ball(1, ahead + "Interior \"beer\" \"k\" .1 ")) +
                   "AttributeEnd AttributeBegin Translate 0 0 .5 " + ball(1, ahead + "Interior \"beer\" \"k\" .7 ") +
                   "AttributeEnd\n"),
              std::exp(-.1 * 1 - .7 * 2), "overlapping");
}

TEST_P(Media, TheOutside) {
    // A mirror at z = 0 that faces the eye, a wall behind the eye at z = -9: Exterior for the way of the reflection alone.
    const std::string wall =
        "AttributeBegin Surface \"shine\" Polygon \"P\" [-99 -99 -9  -99 99 -9  99 99 -9  99 -99 -9] AttributeEnd\n";
    const std::string mirror = "Polygon \"P\" [-9 -9 0  -9 9 0  9 9 0  9 -9 0] AttributeEnd\n",
                      begin = "AttributeBegin Surface \"reflects\" ";
    expectAll(seen(wall + begin + "Exterior \"beer\" \"k\" .2 " + mirror) *
                  seen(wall + begin + "Interior \"beer\" \"k\" .2 " + mirror),
              std::exp(-.2 * 9), "one of the two sides");
    // A ball's outside is out.
    const std::string shiny = ball(1, "Surface \"reflects\" Exterior \"beer\" \"k\" .2 Interior \"beer\" \"k\" 5 ");
    expectAll(seen(wall + shiny), std::exp(-.2 * 8), "a ball");
    // A mirror inside a medium that is in none itself keeps the ray where it is.
    expectAll(seen(wall +
                   "AttributeBegin Surface \"reflects\" Polygon \"P\" [-.5 -.5 0  -.5 .5 0  .5 .5 0  .5 -.5 0] AttributeEnd\n" +
                   ball(1, "Surface \"ahead\" Interior \"beer\" \"k\" .3 ")),
              std::exp(-.3 * 2), "inside");
}

TEST_P(Media, TheEyeInside) {
    const std::string beer = "Interior \"beer\" \"k\" .3 ";
    // The ball is about the eye, at the origin.
    expectAll(seen(ball(2, "Surface \"shine\" " + beer), 0, 0), std::exp(-.3 * 2), "the wall of a room");
    expectAll(seen(kWall + ball(2, "Surface \"ahead\" " + beer), 0, 0), std::exp(-.3 * 2), "out of it");
    expectAll(seen(ball(1, "Surface \"shine\" Translate 0 0 3 ") + ball(6, "Surface \"constant\" " + beer), 0, 0),
              std::exp(-.3 * 2), "something in it");
    expectAll(seen(ball(2, "Surface \"ahead\" Interior \"beer\" \"k\" .7 ") + ball(6, "Surface \"shine\" " + beer), 0, 0),
              std::exp(-.7 * 2 - .3 * 4), "two");
    // A wall that is seen from behind is no room.
    for (const char* way : {"outside", "inside"})
        expectAll(seen("Orientation \"" + std::string(way) + "\" " + beer + kWall, 0, 0), 1, way);
}

TEST_P(Media, TransmissionAndTheirMessages) {
    writeShader("asks", "surface asks() { Oi = 1; Ci = transmission(P, P + vector(0, 0, -8)); }\n");
    const std::string far =
        "AttributeBegin Surface \"asks\" Polygon \"P\" [-99 -99 4  -99 99 4  99 99 4  99 -99 4] AttributeEnd\n";
    const std::string veil = "Opacity .25 .25 .25 Attribute \"visibility\" \"int camera\" 0 \"int specular\" 1 \"int "
                             "transmission\" 1 Surface \"constant\" ";
    expectAll(seen("Attribute \"visibility\" \"int camera\" 1 \"int transmission\" 1 " + far +
                   ball(1, veil + "Interior \"beer\" \"k\" .6 ")),
              .75 * .75 * std::exp(-.6 * 2), "through a ball");
    // Ends inside.
    writeShader("asksin", "surface asksin() { Oi = 1; Ci = transmission(P, P + vector(0, 0, -4)); }\n");
    const std::string in =
        "AttributeBegin Surface \"asksin\" Polygon \"P\" [-99 -99 4  -99 99 4  99 99 4  99 -99 4] AttributeEnd\n";
    expectAll(seen("Attribute \"visibility\" \"int camera\" 1 \"int transmission\" 1 " + in +
                   ball(1, veil + "Interior \"beer\" \"k\" .6 ")),
              .75 * std::exp(-.6), "into a ball");
    // Who it is, and what it was given.
    writeShader("tellsitself",
                "volume tellsitself(float k = 0) { Ci = (shadername() == \"tellsitself\") ? color(k, length(I), 1) : 0; }\n");
    const Color c = seen(kWall + ball(1, "Surface \"ahead\" Interior \"tellsitself\" \"k\" .25 "));
    EXPECT_NEAR(c.x, .25, 1e-6);
    EXPECT_NEAR(c.y, 2, 1e-5);
    EXPECT_NEAR(c.z, 1, 1e-6);
}

TEST_P(Media, VolumesAreRegions) {
    const auto region = [](const std::string& volume, const std::string& before = {}, const std::string& shader = "Interior") {
        return kWall + ("AttributeBegin " + shader + " \"beer\" \"k\" .6 " + before + " Volume " + volume + " AttributeEnd\n");
    };
    const auto left = [](double way) { return std::exp(-.6 * way); };
    const std::string box = "\"box\" [-1 .5 -2 2 -.25 1.25] [0 0 0]", egg = "\"ellipsoid\" [-1 1 -1 1 -2 2] [0 0 0]",
                      can = "\"cylinder\" [-1 1 -2 2 -3 3] [0 0 0]", hat = "\"cone\" [-1 1 -1 1 0 2] [0 0 0]";
    expectAll(seen(region(box)), left(1.5), "box");
    expectAll(seen(region(box, "Rotate 20 0 1 0")), left(1.5 / std::cos(20 * kPi / 180)), "box, turned");
    expectAll(seen(region(box), .7f), 1, "beside it");
    for (float b : {0.f, .3f, .8f}) {
        expectAll(seen(region(egg), b), left(4 * std::sqrt(1 - b * b)), "ellipsoid");
        expectAll(seen(region(can), b), left(6), "cylinder, along it");
        expectAll(seen(region(can, "Rotate 90 0 1 0"), b), left(2), "cylinder, across");
        expectAll(seen(region(hat), b), left(2 * (1 - b)), "cone, along it");
        if (b > 0) expectAll(seen(region(hat, "Rotate 90 0 1 0"), b), left(2 * (1 - b / 2)), "cone, across"); // 0: in its base
    }
    // However the sides of surfaces are said, and by the shader of the later name; mirrored and many times as large.
    for (const char* before : {"ReverseOrientation", "Orientation \"lh\"", "Orientation \"rh\"", "Sides 1", "Scale -1 1 1",
                               "Opacity .5 .5 .5", "Displacement \"bumpy\"", "Surface \"shine\""})
        for (const std::string& v : {egg, can, hat, "\"box\" [-1 1 -1 1 -1 3] [0 0 0]" + std::string()})
            expectAll(seen(region(v, before)), v == can ? left(6) : v == hat ? left(2) : left(4), before + v);
    expectAll(seen(region(box, "Scale 2 2 2")), left(3), "scaled");
    expectAll(seen(region(box, "", "VPAtmosphere")), left(1.5), "Atmosphere"); // and no fog before and behind it
    expectAll(seen(region(box, "Atmosphere \"beer\" \"k\" 5 ")), left(1.5) * std::exp(-5 * 4.75), "both: before it, fog");
    expectAll(seen(region("\"box\" [-1 1 -1 1 -1 3] [0 0 0]"), 0, 0), left(3), "the eye in it");
    // Constant variables are the shader's.
    expectAll(seen(region("\"box\" [-1 .5 -2 2 -.25 1.25] [2 2 2] \"constant float k\" [.2]")), std::exp(-.2 * 1.5), "variable");
    expectAll(
        seen(region("\"box\" [-2 2 -2 2 -2 2] [0 0 0] AttributeEnd AttributeBegin Interior \"beer\" \"k\" .1 Volume " + box)),
        left(2.5) * std::exp(-.1 * 1.5), "one in the other");
}

INSTANTIATE_TEST_SUITE_P(All, Media, ::testing::Values(Hider::Hidden, Hider::Raytrace, Hider::Path));

TEST(MediaLight, ThroughABall) {
    // A light above a floor, a veil with an inside between: what the floor gets, over what it gets without, at the point below.
    writeShader("beer", "volume beer(float k = 1) { Ci *= exp(-k * length(I)); }\n");
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        const std::string light =
            "WorldBegin\nSides 2\nAttribute \"light\" \"string shadows\" \"on\" Attribute \"visibility\" \"int camera\" 1 \"int "
            "transmission\" 1 LightSource \"pointlight\" 1 \"from\" [0 0 0] \"intensity\" 9\n"
            "AttributeBegin Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1 Polygon \"P\" [-9 -9 6  -9 9 6  9 9 6  9 -9 6] "
            "AttributeEnd\n";
        const std::string veil =
            ball(1, "Translate 0 0 3 Surface \"constant\" Color 0 0 0 Opacity .25 .25 .25 Interior \"beer\" \"k\" .6 ");
        const CameraRay below = rayTo({2, 0, 4.5}, {0, 0, 6});
        const double without = Scene(light + "WorldEnd\n", withShaders(h)).one(below).x;
        EXPECT_GT(without, .01);
        EXPECT_NEAR(Scene(light + veil + "WorldEnd\n", withShaders(h)).one(below).x / without, .75 * .75 * std::exp(-.6 * 2),
                    2e-5)
            << int(h);
    }
}

// Volume shaders that loop over lights whose light comes through volumes: those ask for no light themselves, else a ball that is
// lit by a lamp would be lit through itself without end.
TEST(MediaLight, LoopsThatWouldRunInThemselves) {
    writeShader("litvolume",
                "volume litvolume(float k = .5) { color sum = 0; illuminance(P) sum += Cl; Ci = Ci * exp(-k * length(I)) + "
                ".01 * sum; }\n");
    writeShader("through",
                "light through() { illuminate(point \"shader\" (0, 0, 0)) Cl = 4 * transmission(Ps, point \"shader\" (0, 0, "
                "0)); }\n");
    const std::string seen = "Attribute \"visibility\" \"int camera\" 1 \"int transmission\" 1\nLightSource \"through\" 1\n";
    const std::string floor =
        "AttributeBegin Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1 Polygon \"P\" [-9 -9 6  -9 9 6  9 9 6  9 -9 "
        "6] AttributeEnd\n";
    const std::string lamp =
        "AttributeBegin Atmosphere \"litvolume\" AreaLightSource \"slrect\" 2 \"float intensity\" 5 Surface "
        "\"constant\" Color 0 0 0 Polygon \"P\" [-1 2 3  1 2 3  1 2 4  -1 2 4] AttributeEnd Illuminate 2 1\n";
    const std::string veil = "Surface \"constant\" Color 0 0 0 Opacity .25 .25 .25 ";
    for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        // The floor below the middle: through both sides of the veil and two units of the volume.
        const auto at = [&](const std::string& ball) {
            return Scene(inWorld(seen + floor + ball), withShaders(h)).one(rayTo({2, 0, 4.5}, {0, 0, 6})).x;
        };
        const double without = at("");
        EXPECT_GT(without, .01);
        EXPECT_NEAR(at(ball(1, "Translate 0 0 3 " + veil + "Interior \"litvolume\" ")) / without, .75 * .75 * std::exp(-.5 * 2),
                    .02)
            << int(h);
        Scene lit(inWorld(seen + lamp + "Atmosphere \"litvolume\" " + floor), withShaders(h));
        EXPECT_GT(lit.one(rayTo({2, 0, 4.5}, {0, 0, 6})).x, 0) << int(h);
    }
}

// What shines by itself behind sheets and balls has the same ways before it as what its shader colours.
TEST(MediaLight, TheWayToEmitters) {
    writeShader("beer", "volume beer(float k = 1) { Ci *= exp(-k * length(I)); }\n");
    writeShader("ahead", "surface ahead() { Oi = 1; Ci = trace(P, normalize(I)); }\n");
    Settings set = withShaders(Hider::Path);
    set.roulette = false;
    const auto seen = [&](const std::string& inside) {
        return Scene(inWorld("Attribute \"trace\" \"maxspeculardepth\" 9 Translate 0 0 5\n" + inside), set)
            .one(rayTo({0, 0, 0}, {0, 0, 1}))
            .x;
    };
    const auto square = [](const std::string& before, double z) {
        const std::string d = std::to_string(z);
        return "AttributeBegin " + before + " Polygon \"P\" [-99 -99 " + d + "  -99 99 " + d + "  99 99 " + d + "  99 -99 " + d +
               "] AttributeEnd\n";
    };
    const std::string air = "Atmosphere \"beer\" \"k\" .1 ", beer = "Interior \"beer\" \"k\" .6 ",
                      clear = "Surface \"constant\" Color 0 0 0 Opacity 0 0 0 ";
    const std::string lamp = square("Attribute \"light\" \"string shadows\" \"off\" AreaLightSource \"slrect\" 7 \"float "
                                    "intensity\" 1 Surface \"constant\" Color 0 0 0",
                                    9);
    const float bare = seen(lamp);
    ASSERT_GT(bare, 0);
    const auto expectLeft = [&](const std::string& scene, double thick, const char* what) {
        EXPECT_NEAR(std::log(seen(scene) / bare), -thick, 1e-4) << what;
    };
    expectLeft(air + lamp, .1 * 14, "alone");
    expectLeft(square(clear, 1) + square(clear, 3) + air + lamp, .1 * 14, "sheets");
    expectLeft(square("Surface \"ahead\"", -2) + square(clear, 1) + square(clear, 3) + air + lamp, .1 * 11,
               "sheets and a mirror");
    expectLeft(air + lamp + ball(1, clear + beer), .1 * 4 + .6 * 2 + .1 * 8, "a ball");
    expectLeft(air + lamp + ball(1, "Surface \"ahead\" " + beer), .1 * 4 + .6 * 2 + .1 * 8, "a ball that sends rays itself");
    expectLeft(square("Surface \"ahead\"", -2) + air + lamp + ball(1, clear + beer), .1 * 1 + .6 * 2 + .1 * 8,
               "a ball and a mirror");
}

// Both sides of a ball take from a shadow ray, whatever it is that rays meet of it.
TEST(MediaLight, BallsTakeTwice) {
    writeShader("straight", "surface straight() { Oi = 1; Ci = transmission(P, P + vector(0, 0, -8)); }\n");
    const std::string seen = "Attribute \"visibility\" \"int camera\" 1 \"int transmission\" 1 AttributeBegin Surface "
                             "\"straight\" Polygon \"P\" [-99 -99 9  -99 99 9  99 99 9  99 -99 9] AttributeEnd\n";
    for (const char* shape : {"Sphere 1 -1 1 360", "Torus .5 .25 0 360 360", "Cylinder 1 -1 1 360", "Paraboloid 1 0 .5 360"})
        for (Hider h : {Hider::Raytrace, Hider::Path}) {
            Scene s("WorldBegin\nSides 2\n" + seen +
                        "AttributeBegin Translate 0 0 5 Rotate 90 1 0 0 Attribute \"visibility\" \"int camera\" 0 Surface "
                        "\"constant\" Opacity .25 .25 .25 " +
                        shape + " AttributeEnd\nWorldEnd\n",
                    withShaders(h));
            const bool torus = shape[0] == 'T', bowl = shape[0] == 'P'; // through the ring twice; across the bowl
            const double layers = torus ? 4 : 2;
            EXPECT_NEAR(s.one(rayTo({.11f, bowl ? -.3f : .02f, 0}, {.11f, bowl ? -.3f : .02f, 1})).x, std::pow(.75, layers), 1e-5)
                << shape;
        }
}

TEST(MediaLight, EveryEstimatorOfAnEmitter) {
    // A disk of radius R at height H over a point: E / pi = L sin^2 = L R^2 / (R^2 + H^2). The outside of the floor takes half of
    // light wherever it goes, the atmosphere of the emitter, which is for ways in no medium, nothing.
    writeShader("halves", "volume halves() { Ci *= .5; }\n");
    writeShader("tenth", "volume tenth() { Ci *= .1; }\n");
    const std::string scene = "WorldBegin\nSides 2\n"
                              "AttributeBegin Atmosphere \"tenth\" AreaLightSource \"slrect\" 7 \"float intensity\" 4 Surface "
                              "\"constant\" Color 0 0 0 Translate 0 0 2 Disk 0 1 360 AttributeEnd Illuminate 7 1\n"
                              "AttributeBegin Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1 Color 1 1 1 ";
    const std::string floor = "Polygon \"P\" [-9 -9 4  -9 9 4  9 9 4  9 -9 4] AttributeEnd\nWorldEnd\n";
    for (int way = 0; way < 3; ++way) {
        Settings s = withShaders(Hider::Path);
        s.bsdfOnly = way == 1;
        s.lightOnly = way == 2;
        Scene plain(scene + floor, s), out(scene + "Exterior \"halves\" Interior \"halves\" " + floor, s);
        const CameraRay at = rayTo({3, 0, 3}, {0, 0, 4});
        const Moments a = plain.estimate(at, samples(40000)), b = out.estimate(at, samples(40000));
        EXPECT_GT(a.mean(), 0) << way;
        EXPECT_NEAR(b.mean() / a.mean(), 5, kZ * 5 * (a.se() / a.mean() + b.se() / b.mean()) + 1e-4) << way;
    }
}

} // namespace

} // namespace media_test
