// What estimators count, once and in full: light that a shader asks for in two ways, rays that must tell what is in their way,
// lights that take light away, surfaces that give back more than they receive.
#include "transport/floorscene.h"

namespace estimators_test {

using namespace alpenglow;
using namespace alpenglow::transport;
using namespace alpenglow::transport::testing;

namespace {

/// A surface of the floor: `up` is its normal; `value` a color.
std::string shows(const std::string& value, const std::string& before = "") {
    static int number = 0;
    const std::string name = "estimate" + std::to_string(number++);
    writeShader(name, "surface " + name +
                          "() {\n    vector up = vector \"world\" (0, 1, 0), aside = vector \"world\" (1, 0, 0);\n" +
                          "    normal n = normal \"world\" (0, 1, 0);\n    color sum = 0, t = 0;\n" + before +
                          "\n    Ci = " + value + ";\n    Oi = 1;\n}\n");
    return "Surface \"" + name + "\"\n";
}
/// A black disk of that radius and radiance, facing down.
std::string disk(double height, double radius, double radiance) {
    writeShader("steady", "light steady(float radiance = 1) { illuminate(P, N, PI / 2) Cl = radiance; }\n");
    return "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nAttribute \"light\" \"string units\" \"radiance\"\n"
           "AreaLightSource \"steady\" 7 \"radiance\" " +
           std::to_string(radiance) + "\nSurface \"constant\"\nColor 0 0 0\nTranslate 0 " + std::to_string(height) +
           " 0\nRotate 90 1 0 0\nDisk 0 " + std::to_string(radius) + " 360\nAttributeEnd\nIlluminate 7 1\n";
}
/// The part of the hemisphere that such a disk fills, by the cosine.
double ofDisk(double height, double radius) { return radius * radius / (radius * radius + height * height); }
/// A shell about everything that shows `colour`, and is no light.
std::string shell(double colour, double radius = 20) {
    const std::string r = std::to_string(radius), c = " " + std::to_string(colour);
    return "AttributeBegin\nAttribute \"visibility\" \"trace\" 1 \"transmission\" 1\nSurface \"constant\"\nColor" + c + c + c +
           "\nSphere " + r + " -" + r + " " + r + " 360\nAttributeEnd\n";
}
const CameraRay kNear = rayTo({.2f, .3f, -.1f}, {0, 0, 0});

Moments of(const std::string& surface, const std::string& others, Settings s, int n) {
    return Scene(world(others + surface + kFloor), s).estimate(kNear, n);
}
Settings traced(Hider h, bool suspend = false) {
    Settings s = withShaders(h);
    s.suspend = suspend;
    return s;
}

} // namespace

// A surface that would give back twice what it receives gives all of the light of lights, and of what surfaces send it so much
// that the sum is no more than it receives. The disks fill 1, 80 and 99 % of the hemisphere.
TEST(EnergyRule, LightsInFull) {
    const std::string surface = shows("2 * diffuse(n)");
    for (const double radius : {.05, 1., 5.})
        for (int mode = 0; mode < 3; ++mode)
            for (const bool suspend : {false, true}) {
                Settings s = traced(Hider::Path, suspend);
                s.bsdfOnly = mode == 1;
                s.lightOnly = mode == 2;
                const int n = samples(mode == 1 && radius < 1 ? 200000 : 10000);
                expectMean(of(surface, disk(.5, radius, 1), s, n), 2 * ofDisk(.5, radius), .03,
                           "radius " + std::to_string(radius) + " mode " + std::to_string(mode));
            }
    const Settings s = traced(Hider::Path);
    expectMean(of(surface, "LightSource \"envlight\" 1 \"intensity\" 1\n", s, 400), 2, 1e-5, "sky");
    expectMean(of(surface, shell(.5), s, 400), .5, 1e-5, "shell");
    expectMean(of(surface, disk(2, .7, 5) + shell(.5), s, samples(10000)), 10 * ofDisk(2, .7) + .5 * (1 - ofDisk(2, .7)), .01,
               "lamp in a shell");
}
// A pane that all light passes and that shines besides: its highlight is a mirror of the sky, as dark as it makes what it lights.
TEST(EnergyRule, AHighlightOnWhatIsClear) {
    writeShader("pane", "surface pane() { Oi = 0; Ci = .5 * diffuse(normal \"world\" (0, 1, 0)); }\n");
    const std::string below =
        "AttributeBegin\nSurface \"constant\"\nColor .25 .25 .25\nTranslate 0 -1 0\n" + std::string(kFloor) + "AttributeEnd\n";
    expectMean(of("Surface \"pane\"\n", below + "LightSource \"envlight\" 1 \"intensity\" 1\n", traced(Hider::Path), 400), .75,
               1e-5, "pane");
}

} // namespace estimators_test
