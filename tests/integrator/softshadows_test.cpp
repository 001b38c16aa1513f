// Soft shadows of lights that stand at a point: a disk about it that faces the lit point casts them (docs/light.md). Behind the
// edge of a half plane the part of the disk that is seen has a closed form.
#include "integrator/floorscene.h"

namespace softshadows_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// The part of a disk of radius 1 on the side x < t of a line.
double partOfDisk(double t) {
    if (t <= -1 || t >= 1) return t > 0;
    return .5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPi;
}

// Above the origin at height 2, with radius .5; a half plane at height 1 that begins at x = edge. So x < 2 edge of the disk is
// seen.
constexpr double kRadius = .5;
double seen(double edge) { return partOfDisk(2 * edge / kRadius); }
std::string half(double edge) {
    const std::string x = std::to_string(edge);
    return "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nPolygon \"P\" [" + x + " 1 -9  " + x +
           " 1 9  9 1 9  9 1 -9]\nAttributeEnd\n";
}

/// Lights, and what each gives the origin where nothing is in the way.
struct Lamp {
    const char* call;
    double open;
};
const Lamp kLamps[] = {
    {"\"pointlight\" 1 \"float intensity\" 2", .5},
    {"\"slpoint\" 1 \"float intensity\" 2 \"float kc\" 0 \"float kq\" 1", .5 / kPi},
    {"\"spotlight\" 1 \"float intensity\" 2 \"point to\" [0 0 0] \"float coneangle\" .02 \"float conedeltaangle\" .01", .5},
    {"\"slspot\" 1 \"float intensity\" 2 \"point to\" [0 0 0] \"float cutoff\" .02 \"float kc\" 0 \"float kq\" 1", .5 / kPi}};
std::string lampText(const char* call, const std::string& radius = ".5", int n = 1) {
    return "Attribute \"light\" \"string shadows\" \"on\"\nLightSource " + std::string(call) +
           " \"point from\" [0 2 0] \"float radius\" " + radius + " \"float samples\" " + std::to_string(n) + "\n";
}
const std::string kMatte = "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n" + std::string(kFloor);
const CameraRay kLightDirected = rayTo({-.3f, .5f, -.4f}, {0, 0, 0});

void writeLambert() {
    writeShader("sums", "surface sums() { Oi = 1; illuminance(P, N, PI/2) Ci += Cl * (normalize(L) . normalize(N)); }\n");
    writeShader("waits",
                "surface waits() { color c = 0; illuminance(P, N, PI/2) c += Cl * (normalize(L) . normalize(N)); Oi = 1; "
                "Ci = (comp(c, 0) > -1) ? c : color(2); }\n");
}

} // namespace

TEST(SoftShadows, BehindAnEdgeUnderPath) {
    writeLambert();
    for (const Lamp& lamp : kLamps)
        for (const double edge : {-.05, .1})
            for (const char* surface : {"matte\" \"float Ka\" 0 \"float Kd\" 1 \"", "sums", "waits"}) {
                const std::string s(surface), shader = s.substr(0, s.find('"'));
                const std::string floor = shader == "matte" ? kMatte : "Surface \"" + shader + "\"\n" + kFloor;
                Scene scene(inWorld(lampText(lamp.call) + floor + half(edge)), withShaders(Hider::Path));
                Counters c;
                const int n = 4096;
                const Moments m = scene.estimate(kLightDirected, n, &c);
                expectMean(m, lamp.open * seen(edge), .05, lamp.call + shader + std::to_string(edge));
                EXPECT_EQ(c.shadow, uint64_t(n)) << lamp.call << shader;
            }
}

TEST(SoftShadows, AllSamplesUnderTheOthers) {
    writeLambert();
    for (const Lamp& lamp : kLamps)
        for (const Hider h : {Hider::Raytrace, Hider::Hidden})
            for (const double edge : {-.05, .1}) {
                Scene scene(inWorld(lampText(lamp.call, ".5", 256) + kMatte + half(edge)), withShaders(h));
                Counters c;
                // 256 points of a net: each cell of 16 x 16 has one, and the edge cuts at most 2 * 16 of them in u and 16 more.
                EXPECT_NEAR(scene.estimate(kLightDirected, 1, &c).mean(), lamp.open * seen(edge), lamp.open * 48 / 256)
                    << lamp.call;
                EXPECT_EQ(c.shadow, 256u) << lamp.call;
                Scene many(inWorld(lampText(lamp.call, ".5", 4) + kMatte + half(edge)), withShaders(h));
                expectMean(many.estimate(kLightDirected, 2048), lamp.open * seen(edge), .03, lamp.call);
            }
}

TEST(SoftShadows, OfRadiusZeroAreThoseOfThePoint) {
    for (const Hider h : {Hider::Raytrace, Hider::Path})
        for (const double edge : {-.05, .1}) {
            Scene scene(inWorld(lampText(kLamps[0].call, "0", 9) + kMatte + half(edge)), withShaders(h));
            Counters c;
            const Moments m = scene.estimate(kLightDirected, 16, &c);
            EXPECT_NEAR(m.mean(), edge > 0 ? .5 : 0, 1e-6);
            EXPECT_EQ(c.shadow, 16u);
        }
}

// What is lit wholly has no noise: only the shadow knows the disk.
TEST(SoftShadows, TheGeometryIsThatOfTheCentre) {
    for (const Hider h : {Hider::Raytrace, Hider::Path}) {
        Scene scene(inWorld(lampText(kLamps[0].call, "1.5", 4) + kMatte), withShaders(h));
        const Moments m = scene.estimate(rayTo({1.f, .5f, 0}, {1.5f, 0, 0}), 64);
        const double d2 = 1.5 * 1.5 + 4;
        EXPECT_NEAR(m.mean(), 2 / d2 * 2 / std::sqrt(d2), 2e-6);
        EXPECT_NEAR(m.se(), 0, 1e-8);
    }
}

// Of a light low beside the point, half of the disk is below the horizon: the floor itself is in its way.
TEST(SoftShadows, WhatIsBelowTheHorizonIsNotSeen) {
    const std::string lamp = "Attribute \"light\" \"string shadows\" \"on\"\nLightSource \"pointlight\" 1 \"float intensity\" 1 "
                             "\"point from\" [2 .01 0] \"float radius\" .5 \"float samples\" 4\n";
    const double d2 = 4 + 1e-4, open = .01 / std::sqrt(d2) / d2;
    for (const Hider h : {Hider::Raytrace, Hider::Path}) {
        Scene scene(inWorld(lamp + kMatte), withShaders(h));
        // The disk stands almost upright: what is above the floor is .5 + 2 (.01 / .5) / pi of it.
        expectMean(scene.estimate(kLightDirected, 4096), open * partOfDisk(.02), .02, "low");
    }
}

// Loops in the blocks of others have samples of their own: the product has the product of the means.
TEST(SoftShadows, NestedLoops) {
    writeShader("product",
                "surface product() { Oi = 1; illuminance(P, N, PI/2) { color outer = Cl; illuminance(P, N, PI/2) Ci += "
                "Cl * outer; } }\n");
    for (const Hider h : {Hider::Raytrace, Hider::Path}) {
        Scene scene(inWorld(lampText("\"pointlight\" 1 \"float intensity\" 4") + "Surface \"product\"\n" + kFloor + half(.1)),
                    withShaders(h));
        expectMean(scene.estimate(kLightDirected, 8192), seen(.1) * seen(.1), .03, "product");
    }
}

TEST(SoftShadows, OfAnyShaderAndByHandles) {
    writeShader("ownsoft",
                "light ownsoft(output float __shadowradius = .5;) { illuminate(point \"world\" (0, 2, 0)) Cl = 1; }\n");
    writeShader("byhandle",
                "surface byhandle() { shader all[] = getlights(); Oi = 1; vector l; color c; if (arraylength(all) > 0) "
                "{ all[0]->light(l, c); Ci = c; } }\n");
    for (const char* surface : {"matte", "byhandle"}) {
        const std::string looks = std::string("Surface \"") + surface + "\"" +
                                  (std::string(surface) == "matte" ? " \"float Ka\" 0 \"float Kd\" 1\n" : "\n") + kFloor;
        Scene scene(inWorld("LightSource \"ownsoft\" 1\n" + looks + half(.1)), withShaders(Hider::Path));
        expectMean(scene.estimate(kLightDirected, 4096), seen(.1), .03, surface);
    }
}

TEST(SoftShadows, NonsenseIsSaid) {
    Scene negative(inWorld(lampText(kLamps[0].call, "-1") + kMatte + half(.1)), withShaders(Hider::Path));
    EXPECT_NEAR(negative.estimate(kLightDirected, 4).mean(), .5, 1e-6);
    EXPECT_NE(negative.messages().find("the shadows of a point"), std::string::npos) << negative.messages();
    Scene scene(inWorld(lampText(kLamps[0].call, ".1", 0) + kMatte), withShaders(Hider::Raytrace));
    EXPECT_NEAR(scene.estimate(kLightDirected, 4).mean(), .5, 1e-6);
    EXPECT_NE(scene.messages().find("1 is used"), std::string::npos) << scene.messages();
    Scene many(inWorld(lampText(kLamps[0].call, ".1", 5000) + kMatte), withShaders(Hider::Raytrace));
    Counters c;
    EXPECT_NEAR(many.estimate(kLightDirected, 1, &c).mean(), .5, 1e-6);
    EXPECT_EQ(c.shadow, 4096u);
    EXPECT_NE(many.messages().find("4096"), std::string::npos) << many.messages();
}

} // namespace softshadows_test
