// trace() that samples area lights: what its light samples find is what its rays could meet. A disk of radius 1/2 and radiance 1
// hangs 1 above the floor: "cosine" gives R^2 / (R^2 + h^2) = 1/5 of it, and of the part within a distance D, whose radius is
// sqrt(D^2 - h^2), the same.
#include "integrator/harness.h"

namespace tracelights_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

// Radiance: raytrace would take the light for one of its day, which no ray meets.
const std::string kDisk =
    "AttributeBegin\nAttribute \"light\" \"string units\" \"radiance\"\nAttribute \"grouping\" \"membership\" "
    "\"lamps\"\nAreaLightSource \"hanging\" 1\nSurface \"black\"\nDisk 1 .5 360\nAttributeEnd\nIlluminate 1 1\n";
const std::string kCard =
    "AttributeBegin\nAttribute \"grouping\" \"membership\" \"cards\"\nSurface \"black\"\nDisk 1.5 .25 360\nAttributeEnd\n";
const CameraRay kFloorSeen = rayTo({0, 0, 1.75f}, {0, 0, 2});

void writeLight() { writeShader("hanging", "light hanging() { illuminate(P, vector \"world\" (0, 0, 1), PI / 2) Cl = 1; }\n"); }

/// By light samples and rays, by light samples alone, by rays alone; affine and waiting kernels; both hiders that trace.
void expectAll(const std::string& options, const std::string& others, double want, const std::string& floor = "",
               double precision = .02) {
    static int number = 0;
    const std::string name = "asking" + std::to_string(number++);
    writeShader("black", "surface black() { Oi = 1; Ci = 0; }\n");
    writeLight();
    writeShader(name, "surface " + name +
                          "() { Oi = 1; Ci = trace(P, vector(faceforward(normalize(N), I)), \"distribution\", \"cosine\", "
                          "\"samplecone\", PI / 2, "
                          "\"samplearealights\", 1" +
                          options + "); }\n");
    for (int mode = 0; mode < 5; ++mode) {
        Settings s;
        s.hider = mode == 4 ? Hider::Raytrace : Hider::Path;
        s.lightOnly = mode == 1;
        s.bsdfOnly = mode == 2;
        s.suspend = mode == 3;
        Scene scene("WorldBegin\nSides 2\n" + others + floor + "Surface \"" + name +
                        "\"\nPolygon \"P\" [-9 -9 2  9 -9 2  9 9 2  -9 9 2]\nWorldEnd\n",
                    s);
        const Moments m = scene.estimate(kFloorSeen, 40000);
        if (want == 0) EXPECT_EQ(m.mean(), 0) << options << " mode " << mode;
        else expectMean(m, want, precision, options + " mode " + std::to_string(mode));
    }
}

TEST(TraceLights, WithinADistance) {
    expectAll("", kDisk, .2);
    expectAll(", \"maxdist\", 1.05", kDisk, .1025 / 1.1025);
    expectAll(", \"maxdist\", .9", kDisk, 0);
    expectAll(", \"maxdist\", 1.2", kDisk, .2);
    expectAll(", \"bias\", .01, \"maxdist\", 2", kDisk, .2);
}
TEST(TraceLights, OfASet) {
    expectAll(", \"subset\", \"lamps\"", kDisk, .2);
    expectAll(", \"subset\", \"cards\"", kDisk, 0);
    expectAll(", \"excludesubset\", \"lamps\"", kDisk, 0);
    // The card covers the disk exactly: where it is not of the set, its shadow is not either.
    expectAll("", kDisk + kCard, 0);
    expectAll(", \"subset\", \"lamps\"", kDisk + kCard, .2);
    expectAll(", \"excludesubset\", \"cards\"", kDisk + kCard, .2);
    expectAll("", kDisk + kCard, .2, "Attribute \"grouping\" \"string tracesubset\" \"lamps\"\n");
}
// One-sided cards are met from one side only, by rays and by shadows alike.
TEST(TraceLights, Sides) {
    writeLight();
    for (const bool turned : {false, true}) {
        std::string card = kCard;
        card.insert(card.find("Disk"), turned ? "Sides 1\nReverseOrientation\n" : "Sides 1\n");
        double front = 0, back = 0;
        for (const char* side : {"front", "back"}) {
            Settings s;
            s.hider = Hider::Path;
            writeShader("black", "surface black() { Oi = 1; Ci = 0; }\n");
            const std::string name = std::string("oneside") + side;
            writeShader(name, "surface " + name +
                                  "() { Oi = 1; Ci = trace(P, vector(faceforward(normalize(N), I)), \"distribution\", "
                                  "\"cosine\", \"samplecone\", PI / 2, "
                                  "\"samplearealights\", 1, \"hitsides\", \"" +
                                  side + "\"); }\n");
            double means[2];
            for (int mode = 0; mode < 2; ++mode) {
                s.lightOnly = mode == 0;
                s.bsdfOnly = mode == 1;
                Scene scene("WorldBegin\nSides 2\n" + kDisk + card + "Surface \"" + name +
                                "\"\nPolygon \"P\" [-9 -9 2  9 -9 2  9 9 2  -9 9 2]\nWorldEnd\n",
                            s);
                means[mode] = scene.estimate(kFloorSeen, 20000).mean();
            }
            EXPECT_NEAR(means[0], means[1], .02) << side;
            (side[0] == 'f' ? front : back) = means[0];
        }
        EXPECT_NEAR(front + back, .2, .02); // of one of them the card is in the way
        EXPECT_NEAR(std::min(front, back), 0, 1e-6);
    }
}
// "maxdist" bounds what a ray meets. One that meets nothing within it sees the sky, as if nothing were behind.
TEST(TraceLights, SkyBehindADistance) {
    writeShader("black", "surface black() { Oi = 1; Ci = 0; }\n");
    const std::string roof = "LightSource \"envlight\" 5 \"intensity\" [2]\nAttributeBegin\nSurface \"black\"\nPolygon \"P\" "
                             "[-99 -99 1  99 -99 1  99 99 1  -99 99 1]\nAttributeEnd\n";
    for (const auto& [options, want] :
         {std::pair<std::string, double>{"", 0}, {", \"maxdist\", 2", 0}, {", \"maxdist\", .5", 2}, {", \"maxhitdist\", .5", 2}})
        for (const bool wait : {false, true}) {
            Settings s;
            s.hider = Hider::Path;
            s.suspend = wait;
            static int number = 0;
            const std::string name = "skyward" + std::to_string(number++);
            writeShader(name, "surface " + name + "() { Oi = 1; Ci = trace(P, vector(faceforward(normalize(N), I))" + options +
                                  "); }\n");
            Scene scene("WorldBegin\nSides 2\n" + roof + "Surface \"" + name +
                            "\"\nPolygon \"P\" [-9 -9 2  9 -9 2  9 9 2  -9 9 2]\nWorldEnd\n",
                        s);
            EXPECT_NEAR(scene.one(kFloorSeen).x, want, 1e-5) << options;
        }
}

// A hollow ball of radius 2 that shines with e and is lit by lights, each of which sees what lies opposite: X = e + a X + a k X.
// Every vertex asks all lights, and what each of them sees asks all again: without roulette some 6^32 rays a sample.
TEST(TraceLights, LightsThatSeeWhatTheyLight) {
    const double e = .25, a = .4, k = .6;
    writeShader("lookout",
                "light lookout(float part = 1;) {\n    vector n = -normalize(vector(Ps));\n" // the eye is in the middle
                "    illuminate(Ps + n) Cl = part * trace(Ps, n);\n}\n");
    writeShader("chooser", "light chooser(float part = 1;) {\n    vector n = -normalize(vector(Ps));\n"
                           "    illuminate(Ps + n) {\n        color c = trace(Ps, n);\n" // it waits: its sign decides
                           "        if (comp(c, 0) >= 0) Cl = part * c; else Cl = 0;\n    }\n}\n");
    writeShader("hollow",
                "surface hollow(float e = .25, a = .4;) { Oi = 1; Ci = e + a * diffuse(faceforward(normalize(N), I)); }\n");
    for (const char* light : {"lookout", "chooser"}) {
        std::string rib = "WorldBegin\n";
        for (int i = 0; i < 6; ++i)
            rib += "LightSource \"" + std::string(light) + "\" " + std::to_string(i + 1) + " \"part\" [" + std::to_string(k / 6) +
                   "]\n";
        Settings s;
        s.hider = Hider::Path;
        Scene scene(rib + "Surface \"hollow\"\nSides 2\nSphere 2 -2 2 360\nWorldEnd\n", s);
        ASSERT_TRUE(scene.world);
        Counters c;
        const int n = samples(2000, 3000); // heavy tails
        const Moments m = scene.estimate(rayTo({0, 0, 0}, {.1f, .2f, 1}), n, &c);
        expectMean(m, e / (1 - a - a * k), .05, light);
        // A tree near to going on for ever: the mean of 3,000 is between 92 and 104 by the seed.
        EXPECT_LT(double(c.specular + c.diffuse) / n, 120) << light;
    }
}

} // namespace

} // namespace tracelights_test
