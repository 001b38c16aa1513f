// Random scenes whose lamps are found in two ways: as lights, which are sampled and weighed against the rays of lobes, and as
// surfaces that shine, which only rays find. The second way knows no lights, so it shares no sampling with the first. No guides:
// these are learned by the renderer, not by the integrator.
#include "integrator/floorscene.h"
#include <random>

namespace randomscenes_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// Makes the same scene twice: with lights, and with surfaces that send the same radiance.
class RandomScene {
public:
    explicit RandomScene(uint32_t seed) : random_(seed) {
        const bool sky = chance(.4);
        if (sky) addSky();
        else
            for (int i = chance(.3) ? 2 : 1; i > 0; --i) addLamp(i);
        body_ += "AttributeBegin " + material() + "Polygon \"P\" [-2 -1 -2  2 -1 -2  2 -1 2  -2 -1 2] AttributeEnd\n";
        if (!sky && chance(.5))
            body_ +=
                "AttributeBegin Color .7 .5 .4 Surface \"matte\" Polygon \"P\" [-2 -1 2  2 -1 2  2 2 2  -2 2 2] AttributeEnd\n";
        for (int i = 0; i < 3; ++i) addObject();
    }
    std::string asLights() const { return inWorld(lights_ + body_); }
    std::string asSurfaces() const { return inWorld(surfaces_ + body_); }

private:
    double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    bool chance(double p) { return number(0, 1) < p; }
    std::string text(double from, double to) { return std::to_string(number(from, to)) + " "; }
    std::string colour(double from, double to) { return text(from, to) + text(from, to) + text(from, to); }
    std::string place(double x, double low, double high) {
        return "Translate " + text(-x, x) + text(low, high) + text(-x, x) + "Rotate " + text(0, 360) + text(-1, 1) + text(-1, 1) +
               text(.1, 1);
    }
    void addSky() {
        const std::string q = "\"float e\" " + std::string(chance(.5) ? "4 " : "60 ") + "\"vector d\" [" + colour(-1, 1) + "] ";
        lights_ += "LightSource \"skylight\" 1 " + q + "\n";
        surfaces_ += "AttributeBegin Surface \"skysurface\" " + q + "Sphere 1000 -1000 1000 360 AttributeEnd\n";
    }
    void addLamp(int handle) {
        const std::string s = text(.5, 1), shape = chance(.3)   ? "Sphere .5 -.5 .5 360 "
                                                   : chance(.3) ? "Cylinder .2 -.5 .5 360 "
                                                   : chance(.5) ? "Disk 0 " + s + "360 "
                                                                : "Polygon \"P\" [-.9 -.8 0  .9 -.8 0  1 .8 0  -.9 1 0] ";
        const std::string begin = "AttributeBegin Attribute \"visibility\" \"int camera\" 0 Translate " + text(-.8, .8) +
                                  text(1.1, 1.6) + text(-.8, .8) + "Rotate " + text(60, 120) + "1 0 0 ";
        const std::string radiance = colour(1, 4), number = std::to_string(handle);
        lights_ += begin + "AreaLightSource \"slrect\" " + number + " \"float intensity\" 1 \"color lightcolor\" [" + radiance +
                   "] Surface \"constant\" Color 0 0 0 " + shape + "AttributeEnd Illuminate " + number + " 1\n";
        surfaces_ += begin + "Color " + radiance + "Surface \"onesided\" " + shape + "AttributeEnd\n";
    }
    std::string material() {
        const std::string base = "Color " + colour(.2, .9);
        switch (int(number(0, 6))) {
        case 0:
            return "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [.8 .8 .8] ";
        case 1:
            return "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float kn\" 1.4 "
                   "\"string fresnel\" \"exact\" ";
        case 2:
            return base + "Surface \"plastic\" \"roughness\" " + text(.1, .3);
        case 3:
            return base + "Surface \"standard\" \"specular_roughness\" " + text(.2, .5) + "\"coat\" .5 ";
        default:
            return base + "Surface \"matte\" ";
        }
    }
    void addObject() {
        const std::string s = text(.25, .5);
        std::string shape = "Sphere .4 -.4 .4 360 ", made = material();
        if (chance(.2))
            made = "Surface \"null\" Interior \"medium\" \"color scattering\" [" + colour(.3, 3) + "] \"anisotropy\" " +
                   text(-.4, .6);
        else if (chance(.3)) shape = "Torus " + s + ".15 0 360 360 ";
        else if (chance(.3)) shape = "Polygon \"P\" [-.4 -.4 0  .5 -.4 .1  .1 .5 0] ";
        else if (chance(.3))
            shape =
                "Curves \"cubic\" [4 4] \"nonperiodic\" \"P\" [-.6 0 0  -.2 .6 0  .2 -.6 0  .6 0 .3  -.6 .2 0  -.2 -.6 0  .2 .6 "
                "0  .6 0 -.3] \"constantwidth\" [.12] ";
        if (chance(.2)) made += "Opacity .5 .4 .3 ";
        body_ += "AttributeBegin " + place(.9, -.6, .5) + made + shape + "AttributeEnd\n";
    }

    std::mt19937 random_;
    std::string lights_, surfaces_, body_;
};

/// The mean over a grid of rays that see the whole scene.
Moments meanOf(const std::string& rib, int samplesEach) {
    Scene s(rib, withShaders(Hider::Path));
    Moments all;
    for (int n = 0; n < samplesEach; ++n) {
        std::vector<CameraRay> rays;
        for (int i = 0; i < 64; ++i) {
            CameraRay r = rayTo({0, 0, -4}, {float(i % 8) * .5f - 1.75f, float(i / 8) * .4f - 1.4f, 0});
            r.px = i;
            r.py = n;
            rays.push_back(r);
        }
        Color sum(0);
        for (const SampleResult& r : s.trace(rays)) sum += r.color;
        all.add(sum / 64.f);
    }
    return all;
}

} // namespace

TEST(RandomScenes, LightsSendWhatSurfacesOfTheSameRadianceSend) {
    const std::string sky = "(float e = 4; vector d = vector(0, 1, 0))",
                      radiance = "5 * pow(max(0, w . normalize(d)), e) + color(.2, .3, .5) * (.6 + .4 * ycomp(w)); }\n";
    writeShader("skylight", "light skylight" + sky + " { solar() { vector w = -normalize(L); Cl = " + radiance + "}\n");
    writeShader("skysurface", "surface skysurface" + sky + " { vector w = normalize(I); Oi = 1; Ci = " + radiance);
    writeShader("onesided", "surface onesided() { Oi = 1; Ci = N . I < 0 ? Cs : color 0; }\n");
    const int scenes = samples(8, 200);
    int precise = 0;
    for (int seed = 1; seed <= scenes; ++seed) {
        const RandomScene scene{uint32_t(seed)};
        const Moments sampled = meanOf(scene.asLights(), 120), found = meanOf(scene.asSurfaces(), 480);
        for (int k = 0; k < 3; ++k) {
            const double se = std::hypot(sampled.se(k), found.se(k));
            precise += k == 1 && se < .02 * found.mean(k);
            EXPECT_NEAR(sampled.mean(k), found.mean(k), kZ * se) << seed << " " << k << scene.asLights();
        }
    }
    EXPECT_GE(precise, scenes / 3) << "scenes whose light is known to 2 %";
}

} // namespace randomscenes_test
