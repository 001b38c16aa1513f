// Lights with several blocks, the sky in loops, who samples whom, area lights that mean an intensity, choosing among many lights,
// and the plane that cuts what the camera sees. A large white floor y = 0 seen at the origin, as in units_test.
#include "base/limits.h"
#include "integrator/harness.h"

namespace lightfeatures_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kFloor = "Polygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]\n";
const CameraRay kView = rayTo({.3f, .8f, -.4f}, {0, 0, 0});

Settings under(Hider h, int mode = 0) {
    Settings s;
    s.hider = h;
    s.bsdfOnly = mode == 1;
    s.lightOnly = mode == 2;
    return s;
}
std::string scene(const std::string& lights, const std::string& surface) {
    return "WorldBegin\nSides 2\n" + lights + "AttributeBegin\nSurface " + surface + "\n" + kFloor + "AttributeEnd\nWorldEnd\n";
}
void writeLooks() {
    writeShader("floorloop", R"(surface floorloop() {
    normal Nf = faceforward(normalize(N), I);
    color sum = 0;
    illuminance(P, Nf, PI / 2) { sum += Cl * (normalize(L) . Nf); }
    Oi = 1;
    Ci = sum;
}
)");
    writeShader("floortrace", R"(surface floortrace() {
    normal Nf = faceforward(normalize(N), I);
    Oi = 1;
    Ci = trace(P, vector(Nf), "distribution", "cosine", "samplecone", PI / 2, "samplearealights", 1, "type", "diffuse");
}
)");
}
std::string disk(const std::string& attributes, const std::string& light) {
    return "AttributeBegin\n" + attributes + "Attribute \"light\" \"string units\" \"radiance\" AreaLightSource " + light +
           "\nSurface \"constant\"\nColor 0 0 0\nTranslate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\nAttributeEnd\n" +
           "Illuminate 7 1\n";
}
const double kDiskValue = 5 * .49 / 4.49; // L R^2 / (R^2 + h^2)

// Two points and a direction from one shader: 8/4 + 8 cos / 5 + .5. Cl behind several blocks belongs to none.
TEST(LightBlocks, AllOfThemLight) {
    writeShader("fourlights", R"(light fourlights(float on = 1;) {
    illuminate(point "world" (0, 2, 0)) Cl = 8 / (L . L);
    if (on > 0) {
        illuminate(point "world" (1, 2, 0)) Cl = 8 / (L . L);
    }
    solar(vector "world" (0, -1, 0), 0) Cl = .5;
    Cl = .25;
}
)");
    const double second = 8 * (2 / std::sqrt(5.0)) / 5;
    for (int on : {1, 0}) {
        std::string rib = scene("LightSource \"fourlights\" 1 \"float on\" " + std::to_string(on) + "\n",
                                "\"matte\" \"float Ka\" 1 \"float Kd\" 1");
        double want = 2 + on * second + .5;
        Scene hidden(rib, under(Hider::Hidden));
        EXPECT_NEAR(hidden.one(kView).x, want, 1e-5);
        Scene path(rib, under(Hider::Path));
        expectMean(path.estimate(kView, samples(4000)), want, .01, "path");
        EXPECT_EQ(path.messages().find("illuminate"), std::string::npos) << path.messages();
    }
}
// A category or Illuminate switches all blocks of a light.
TEST(LightBlocks, SwitchedTogether) {
    writeShader("twolights",
                "light twolights() { solar(vector(0, -1, 0), 0) Cl = .5; illuminate(point \"world\" (0, 2, 0)) Cl = 4; }\n");
    Scene on(scene("LightSource \"twolights\" 1\n", "\"matte\" \"float Ka\" 0 \"float Kd\" 1"), under(Hider::Hidden));
    EXPECT_NEAR(on.one(kView).x, 4.5, 1e-5);
    Scene off(scene("LightSource \"twolights\" 1\nIlluminate 1 0\n", "\"matte\" \"float Ka\" 0 \"float Kd\" 1"),
              under(Hider::Hidden));
    EXPECT_EQ(off.one(kView).x, 0);
}
// Both blocks of an area light emit: 5 seen from the front, half of the light from a block of 2 and one of 3.
TEST(LightBlocks, OfAnAreaLight) {
    writeShader("twoemitters", "light twoemitters() { illuminate(P, N, PI / 2) Cl = 2; illuminate(P, N, PI / 2) Cl = 3; }\n");
    for (int mode : {0, 1, 2}) {
        Scene s(scene(disk("", "\"twoemitters\" 7"), "\"matte\" \"float Ka\" 0 \"float Kd\" 1"), under(Hider::Path, mode));
        EXPECT_NEAR(s.one(rayTo({.1f, 0.5f, .2f}, {0, 2, 0})).x, 5, 1e-5);
        expectMean(s.estimate(kView, samples(mode == 1 ? 200000 : 20000)), kDiskValue, .01, "mode " + std::to_string(mode));
    }
}

// The loop's sky: radiance L from everywhere is L; a half plane takes half.
TEST(SkyInLoops, WholeAndHalf) {
    writeLooks();
    std::string half = "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nPolygon \"P\" [0 .5 -9000  9000 .5 -9000  9000 .5 "
                       "9000  0 .5 9000]\nAttributeEnd\n";
    std::string sky = "LightSource \"envlight\" 1 \"float intensity\" 3\n";
    CameraRay view = rayTo({-.3f, .2f, -.4f}, {0, 0, 0});
    for (const char* look : {"\"floorloop\"", "\"matte\" \"float Ka\" 0 \"float Kd\" 1"}) {
        Scene whole(scene(sky, look), under(Hider::Path));
        expectMean(whole.estimate(view, samples(10000)), 3, .01, look);
        Scene blocked(scene(sky + half, look), under(Hider::Path));
        expectMean(blocked.estimate(view, samples(40000)), 1.5, .01, std::string("half, ") + look);
    }
    Scene hidden(scene(sky, "\"floorloop\""), under(Hider::Hidden));
    EXPECT_NEAR(hidden.one(view).x, 3, 1e-5); // without rays: one light that faces the surface
}
// A narrow cone about the normal of half angle a sees sin^2 a of the sky.
TEST(SkyInLoops, Cone) {
    writeShader("conesky", "surface conesky() { color c = 0; illuminance(P, normal(0, 1, 0), .4) { c += Cl * (normalize(L) . "
                           "vector(0, 1, 0)); } Ci = c; Oi = 1; }\n");
    Scene s(scene("LightSource \"envlight\" 1 \"float intensity\" 3\n", "\"conesky\""), under(Hider::Path));
    expectMean(s.estimate(kView, samples(10000)), 3 * std::pow(std::sin(.4), 2), .01, "cone");
}
// The strategy gives a light to illuminance or to trace(); diffuse() always has all.
TEST(SamplingStrategy, Partitions) {
    writeLooks();
    const struct {
        const char* strategy;
        bool loop, trace;
    } cases[] = {{"", true, true}, {"illuminance", true, false}, {"trace", false, true}};
    for (const auto& c : cases) {
        std::string attribute =
            *c.strategy ? std::string("Attribute \"light\" \"samplingstrategy\" \"") + c.strategy + "\"\n" : "";
        for (bool sky : {false, true}) {
            std::string light = sky ? attribute + "LightSource \"envlight\" 7 \"float intensity\" 5\n"
                                    : disk(attribute, "\"slrect\" 7 \"float intensity\" 5");
            double value = sky ? 5 : kDiskValue;
            std::string what = std::string(c.strategy) + (sky ? " sky" : " disk");
            for (const char* look : {"\"floorloop\"", "\"floortrace\"", "\"matte\" \"float Ka\" 0 \"float Kd\" 1"}) {
                bool lit = look[6] == 'l' ? c.loop : look[6] == 't' ? c.trace : true;
                Scene s(scene(light, look), under(Hider::Path));
                Moments m = s.estimate(kView, samples(10000));
                if (lit) expectMean(m, value, .02, what + look);
                else EXPECT_EQ(m.mean(), 0) << what << look;
            }
        }
    }
}

// I / d^2 from an area light: read as radiance pi I / A, so that far away it is a point light of intensity I. On a disk's axis: I
// / (R^2 + h^2).
TEST(IntensityLight, IsDetectedAndSpread) {
    writeShader("oldarea", "light oldarea(float intensity = 1;) { illuminate(P, N, PI / 2) Cl = intensity / (L . L); }\n");
    writeLooks();
    for (int mode : {0, 1, 2, 3}) {
        Scene s(scene(disk("", "\"oldarea\" 7 \"float intensity\" 5"),
                      mode == 3 ? "\"floorloop\"" : "\"matte\" \"float Ka\" 0 \"float Kd\" 1"),
                under(Hider::Path, mode == 3 ? 0 : mode));
        expectMean(s.estimate(kView, samples(mode == 1 ? 200000 : 20000)), 5 / 4.49, .01, "mode " + std::to_string(mode));
        EXPECT_NE(s.messages().find("divides by the distance itself"), std::string::npos) << s.messages();
        EXPECT_EQ(s.messages().find("divides"), s.messages().rfind("divides")); // once
    }
    Scene plain(scene(disk("", "\"slrect\" 7 \"float intensity\" 5"), "\"matte\""), under(Hider::Path));
    EXPECT_EQ(plain.messages().find("divides"), std::string::npos);
}

// Sixty lights: about eight are sampled, the mean is the sum of all. Every estimator with emitters among them.
TEST(ManyLights, SumStaysTheSame) {
    std::string lights;
    double want = 0;
    for (int i = 0; i < 60; ++i) {
        double x = std::sin(i * 1.7) * (1 + i % 7), z = std::cos(i * 2.3) * (1 + i % 5), y = .6 + .31 * (i % 4),
               power = .2 + i % 3;
        double d2 = x * x + y * y + z * z;
        if (i % 10 == 9) { // a sphere wholly above the horizon: L (R / d)^2 cos a
            double radius = .2;
            lights += "AttributeBegin\nAttribute \"light\" \"string units\" \"radiance\" AreaLightSource \"slrect\" " +
                      std::to_string(i + 1) + " \"float intensity\" " + std::to_string(power * 8) +
                      "\nSurface \"constant\"\nColor 0 0 0\nOpacity 0 0 0\nTranslate " + std::to_string(x) + " " +
                      std::to_string(y) + " " + std::to_string(z) + "\nSphere .2 -.2 .2 360\nAttributeEnd\nIlluminate " +
                      std::to_string(i + 1) + " 1\n";
            want += power * 8 * radius * radius / d2 * y / std::sqrt(d2);
        } else {
            lights += "LightSource \"pointlight\" " + std::to_string(i + 1) + " \"float intensity\" " + std::to_string(power) +
                      " \"point from\" [" + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "]\n";
            want += power * y / std::sqrt(d2) / d2;
        }
    }
    for (int mode : {0, 2}) {
        Scene s(scene(lights, "\"matte\" \"float Ka\" 0 \"float Kd\" 1"), under(Hider::Path, mode));
        Counters c;
        int n = samples(20000);
        expectMean(s.estimate(kView, n, &c), want, .01, "mode " + std::to_string(mode));
        EXPECT_LE(double(c.shadow) / n, limits::kLightsSampled + 1.5);
        EXPECT_GE(double(c.shadow) / n, limits::kLightsSampled / 2);
    }
    // Behind the first vertex, a mirror far away, about three are sampled; the mean is the same.
    writeShader("mirrors", "surface mirrors() { Ci = trace(P, reflect(normalize(I), normalize(N))); }");
    const Vec3 at(50, 1, 0), down(0, -1, 0), n = normalize(normalize(-at) - down), t(n.y, -n.x, 0);
    std::string mirror = "AttributeBegin\nSurface \"mirrors\"\nPolygon \"P\" [";
    for (const Vec3& c : {at - t - Vec3(0, 0, 1), at + t - Vec3(0, 0, 1), at + t + Vec3(0, 0, 1), at - t + Vec3(0, 0, 1)})
        mirror += std::to_string(c.x) + " " + std::to_string(c.y) + " " + std::to_string(c.z) + " ";
    Scene behind(scene(mirror + "]\nAttributeEnd\n" + lights, "\"matte\" \"float Ka\" 0 \"float Kd\" 1"), under(Hider::Path));
    Counters c;
    const int n3 = samples(40000);
    expectMean(behind.estimate(rayTo({50, 9, 0}, at), n3, &c), want, .015, "behind a mirror");
    EXPECT_LE(double(c.shadow) / n3, limits::kLightsSampledDeeper + 1.5);
    Scene hidden(scene(lights, "\"matte\" \"float Ka\" 0 \"float Kd\" 1"), under(Hider::Hidden)); // all are visited
    Moments m = hidden.estimate(kView, 2000);
    EXPECT_LE(std::fabs(m.mean() - want), 4 * m.se() + 1e-4 * want);
}

// What lies on the side the normal points to is cut for the camera; its shadow stays.
TEST(ClippingPlane, CutsWhatTheCameraSees) {
    auto wall = [](double z, const char* color) {
        std::string at = std::to_string(z);
        return std::string("AttributeBegin\nSurface \"constant\"\nColor ") + color + "\nPolygon \"P\" [-9 -9 " + at + " 9 -9 " +
               at + " 9 9 " + at + " -9 9 " + at + "]\nAttributeEnd\n";
    };
    std::string world = "WorldBegin\nSides 2\n" + wall(4, "1 0 0") + wall(6, "0 1 0") + wall(8, "0 0 1") + "WorldEnd\n";
    const struct {
        const char* planes;
        Color want;
    } cases[] = {{"", {1, 0, 0}},
                 {"ClippingPlane 0 0 5 0 0 1\n", {1, 0, 0}},
                 {"ClippingPlane 0 0 5 0 0 -1\n", {0, 1, 0}},
                 {"ClippingPlane 0 0 7 0 0 -1\n", {0, 0, 1}},
                 {"ClippingPlane 0 0 9 0 0 -1\n", {0, 0, 0}},
                 {"ClippingPlane 0 0 3 0 0 1\n", {0, 0, 0}},
                 {"ClippingPlane 0 0 5 0 0 -1\nClippingPlane 0 0 5.5 0 0 1\n", {0, 0, 0}},
                 {"ClippingPlane 0 0 5 0 0 -1\nClippingPlane 0 0 7 0 0 1\n", {0, 1, 0}},
                 {"ClippingPlane 0 1 0 0 1 0\n", {1, 0, 0}},   // along the ray, on the side that stays
                 {"ClippingPlane 0 -1 0 0 1 0\n", {0, 0, 0}}}; // and on the other
    for (Hider h : {Hider::Hidden, Hider::Path})
        for (const auto& c : cases) {
            Scene s(c.planes + world, under(h));
            Color got = s.one(rayTo({0, 0, 0}, {0, 0, 1}));
            for (int k = 0; k < 3; ++k) EXPECT_EQ(got[k], c.want[k]) << c.planes;
        }
    // A roof that is cut away still shades the floor from a distant light above it.
    std::string roofed = "ClippingPlane 0 .5 0 0 1 0\nWorldBegin\nSides 2\nLightSource \"distantlight\" 1 \"point from\" [0 1 0] "
                         "\"point to\" [0 0 0]\n"
                         "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nPolygon \"P\" [-1 1 -1  1 1 -1  1 1 1  -1 1 "
                         "1]\nAttributeEnd\nSurface \"matte\"\n" +
                         std::string(kFloor) + "WorldEnd\n";
    Scene s(roofed, under(Hider::Path));
    EXPECT_EQ(s.one(rayTo({.1f, 2, .1f}, {0, 0, 0})).x, 0);
    EXPECT_NEAR(s.estimate(rayTo({5, 2, .1f}, {5, 0, 0}), 100).mean(), 1, .05);
}

} // namespace

} // namespace lightfeatures_test
