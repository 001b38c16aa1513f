// trace() with "samplelights" 1: a lobe sees point, spot and distant lights as well, each light once, by samples of its value.
// The floor y = 0, a point of it at the origin. Closed forms are those of docs/light.md.
#include "integrator/floorscene.h"

namespace samplelights_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kPoint = "LightSource \"pointlight\" 1 \"intensity\" 8 \"point from\" [1 2 0]\n"; // 8 cos a / d^2 = 8 * 2 / 5^1.5
const double kPointValue = 8 * 2 / std::pow(5, 1.5);
const char* kSun = "LightSource \"distantlight\" 2 \"intensity\" .5 \"point from\" [3 4 0] \"point to\" [0 0 0]\n";
const double kSunValue = .5 * .8;
const char* kSky = "LightSource \"envlight\" 3 \"intensity\" .25\n";

/// `lights`: "samplelights" or "samplearealights". `more`: makes that points are looked at one by one.
std::string look(const std::string& lights, const std::string& more = "") {
    const std::string name = "look" + std::to_string(lights.size()) + (more.empty() ? "" : "far");
    writeShader(name, "surface " + name +
                          "() { Oi = 1; Ci = trace(P, vector(0, 1, 0), \"distribution\", \"cosine\", \"samplecone\", PI / 2, \"" +
                          lights + "\", 1, \"type\", \"diffuse\"" + more + "); }\n");
    return "Surface \"" + name + "\"\n";
}

} // namespace

// In blocks and point by point, under every hider, affine and waiting.
TEST(SampleLights, EachLightOnce) {
    for (const Hider h : {Hider::Path, Hider::Raytrace})
        for (const bool suspend : {false, true})
            for (const char* more : {"", ", \"maxdist\", 1e6"}) {
                Settings s = under(h, suspend);
                const std::string what =
                    std::string(h == Hider::Path ? "path" : "raytrace") + (suspend ? ", waiting" : "") + more;
                const std::string surface = look("samplelights", more);
                Scene both(inWorld(std::string(kPoint) + kSun + surface + kFloor), s);
                EXPECT_NEAR(both.one(kView).x, kPointValue + kSunValue, 2e-5) << what;
                Scene none(inWorld(std::string(kPoint) + kSun + look("samplearealights", more) + kFloor), s);
                EXPECT_EQ(none.one(kView).x, 0) << what;
            }
    Scene sky(inWorld(std::string(kPoint) + kSun + kSky + look("samplelights") + kFloor), under(Hider::Path));
    expectMean(sky.estimate(kView, samples(2000)), kPointValue + kSunValue + .25, .01, "with a sky");
}
// With diffuse() each has its own part, and a sphere that shines is seen by both techniques.
TEST(SampleLights, AreaLightsAsBefore) {
    const std::string lamp =
        "AttributeBegin\nAttribute \"light\" \"string units\" \"radiance\" AreaLightSource \"slrect\" 7 \"intensity\" 3\n"
        "Surface \"constant\"\nColor 0 0 0\nTranslate 0 2 0\nSphere .5 -.5 .5 360\nAttributeEnd\nIlluminate 7 1\n";
    for (int mode = 0; mode < 3; ++mode) {
        Settings s = withShaders(Hider::Path);
        s.bsdfOnly = mode == 1;
        s.lightOnly = mode == 2;
        Scene scene(inWorld(lamp + look("samplelights") + kFloor), s);
        expectMean(scene.estimate(kView, samples(mode == 1 ? 60000 : 8000)), 3 * .0625, .02, "mode " + std::to_string(mode));
    }
}
// A light of "illuminance" loops is not for trace(), one beyond "maxdist" neither, an opaque wall is in the way, and a mirror
// sees no point.
TEST(SampleLights, WhatIsLeftOut) {
    const std::string surface = look("samplelights");
    const auto value = [](const std::string& scene) { return Scene(inWorld(scene), under(Hider::Path)).one(kView).x; };
    EXPECT_EQ(value("Attribute \"light\" \"string samplingstrategy\" \"illuminance\"\n" + std::string(kPoint) + surface + kFloor),
              0);
    EXPECT_EQ(value(kPoint + look("samplelights", ", \"maxdist\", 2") + kFloor), 0);
    EXPECT_NEAR(value(kSun + look("samplelights", ", \"maxdist\", 2") + kFloor), kSunValue, 1e-5);
    EXPECT_EQ(value(kPoint + surface + kFloor + "Surface \"constant\"\nTranslate .5 1 0\nSphere .3 -.3 .3 360\n"), 0);
    writeShader("mirrorlook", "surface mirrorlook() { Oi = 1; Ci = trace(P, vector(0, 1, 0), \"samplelights\", 1); }\n");
    EXPECT_EQ(value(std::string(kPoint) + "Surface \"mirrorlook\"\n" + kFloor), 0);
}
// Facets under a point light are those of the shadeop that loops over lights.
TEST(SampleLights, FacetsAsOfTheLoop) {
    const char* args[][2] = {{"ggx", "\"roughness\", .3, \"roughnessv\", .15"},
                             {"beckmann", "\"roughness\", .3, \"roughnessv\", .15"}};
    for (const auto& [op, pairs] : args) {
        writeShader("facetlook",
                    std::string("surface facetlook(float which = 0;) { vector V = -normalize(I), u = vector(1, 0, 0);\n") +
                        "color eta[2] = {color(.2, .4, 1.3), color(3, 2, 1)};\nOi = 1;\nif (which == 0) Ci = " + op +
                        "(normal(0, 1, 0), V, .3, .15, u, eta[0], eta[1]);\nelse Ci = trace(P, vector(0, 1, 0), "
                        "\"distribution\", \"" +
                        op + "\", \"wo\", V, \"udir\", u, " + pairs + ", \"eta\", eta, \"samplelights\", 1);\n}\n");
        Scene loop(inWorld(std::string(kPoint) + kSun + "Surface \"facetlook\" \"which\" 0\n" + kFloor), under(Hider::Raytrace));
        Scene traced(inWorld(std::string(kPoint) + kSun + "Surface \"facetlook\" \"which\" 1\n" + kFloor), under(Hider::Path));
        const Color a = loop.one(kView), b = traced.one(kView);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 2e-5 * (1 + a[k])) << op;
        EXPECT_GT(a.x, .05);
    }
}

} // namespace samplelights_test
