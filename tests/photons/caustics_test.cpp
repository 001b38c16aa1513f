// Hider "path" "caustics": photons bring what comes by way of mirrors and glass, paths bring the rest. Both together are the light
// that paths alone find, and closed forms where there are some.
#include "photons/photonmap.h"
#include "transport/floorscene.h"
#include "transport/photons.h"

using namespace alpenglow;
using namespace alpenglow::transport;
using namespace alpenglow::transport::testing;

namespace {

Settings path() { return withShaders(Hider::Path); }

/// Sets photons for samples 0 to passes - 1. Of learning, as the renderer does it.
void passes(Scene& s, uint32_t passes, uint32_t count, float radius, bool learn = true) {
    PhotonEmission emission(s.world, {.all = true, .sky = false, .caustics = true}, s.diagnostics);
    PhotonEmission::Thread thread(emission, s.diagnostics);
    std::vector<StoredPhoton> found;
    if (learn) {
        ASSERT_TRUE(thread.emit(0xffffffffu, 0, 20000, 20000, found, nullptr));
        emission.learn(found, 0xffffffffu, 20000);
    }
    emission.tellLights();
    std::vector<std::unique_ptr<photons::PhotonGrid>> grids;
    for (uint32_t pass = 0; pass < passes; ++pass) {
        found.clear();
        ASSERT_TRUE(thread.emit(pass, 0, count, count, found, nullptr));
        std::vector<photons::Photon> all;
        for (const StoredPhoton& p : found) all.push_back(p.photon);
        grids.push_back(std::make_unique<photons::PhotonGrid>(std::move(all), radius));
    }
    setPhotonPasses(*s.world, 0, std::move(grids));
}
/// Samples of one ray, some in each pass: the mean of each pass is one sample of the estimate.
Moments estimate(Scene& s, CameraRay ray, uint32_t passes, int each) {
    Moments m;
    for (uint32_t pass = 0; pass < passes; ++pass) {
        std::vector<CameraRay> rays;
        for (int i = 0; i < each; ++i) {
            ray.px = i;
            ray.py = int(pass);
            ray.sample = pass;
            rays.push_back(ray);
        }
        Color sum(0);
        for (const SampleResult& r : s.trace(rays)) sum += r.color;
        m.add(sum / float(each));
    }
    return m;
}
void expectSame(const Moments& a, const Moments& b, double precision, const std::string& what) {
    for (int k = 0; k < 3; ++k) {
        const double se = std::sqrt(a.se(k) * a.se(k) + b.se(k) * b.se(k));
        EXPECT_NEAR(a.mean(k), b.mean(k), kZ * se + .01 * std::fabs(b.mean(k))) << what << ", channel " << k;
        EXPECT_LT(se, precision * std::fabs(b.mean(k))) << what << ": not precise enough to decide";
    }
}

const std::string kMirror = "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [1 1 1]\n";
const std::string kGlass = "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float kn\" 1.5 \"string fresnel\" \"exact\"\n";
const std::string kMatte = "Surface \"slmaterial\" \"color diffusecolor\" [.8 .6 .4]\n";
std::string lamp(double y, double half, double radiance) {
    char text[400];
    std::snprintf(text, sizeof text, "AttributeBegin Sides 1 AreaLightSource \"slrect\" 1 \"float intensity\" %g Surface \"constant\" Color 0 0 0 "
                                     "Polygon \"P\" [%g %g %g  %g %g %g  %g %g %g  %g %g %g] AttributeEnd\nIlluminate 1 1\n",
                  radiance, -half, y, -half, half, y, -half, half, y, half, -half, y, half);
    return text;
}

// A point light and a mirror: the light's image shines as well as the light does. No path finds it.
TEST(Caustics, MirrorImageOfAPointLight) {
    Scene s(world("LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 1 0]\nAttributeBegin " + kMirror +
                  "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" + kMatte + "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n"),
            path());
    const CameraRay ray = rayTo({.1f, 1.2f, 0}, {0, 2, 0});
    const double direct = .8 * 4, image = .8 * 4 / 9;
    Moments m = estimate(s, ray, 64, 64);
    // The ceiling's own light comes back from the mirror by paths; they do not see the point light in it.
    const double paths = m.mean();
    passes(s, 64, 5000, .2f);
    m = estimate(s, ray, 64, 64);
    EXPECT_GT(paths, direct);
    EXPECT_NEAR(m.mean() - paths, image, 4.5 * m.se() + .1 * image) << direct; // and what the ceiling sends on of the image
    EXPECT_LT(m.se(), .06 * image);
}

// Mirrors that spread light, too, whatever stands first, and a sheet that does and lets half of it through: each way has its own chance.
TEST(Caustics, HalfOfAMirror) {
    const char* const begin = "{ normal n = faceforward(normalize(N), I); Oi = 1; Ci = ";
    writeShader("mirrorlast", std::string("surface mirrorlast() ") + begin + ".4 * diffuse(n) + .4 * trace(P, reflect(normalize(I), n)); }\n");
    writeShader("mirrorfirst", std::string("surface mirrorfirst() ") + begin + ".4 * trace(P, reflect(normalize(I), n)) + .4 * diffuse(n); }\n");
    writeShader("sheet", "surface sheet() { Oi = .5; Ci = .5 * diffuse(faceforward(normalize(N), I)); }\n");
    const std::string light = "LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 1 0]\n",
                      sheet = "AttributeBegin Surface \"sheet\" Polygon \"P\" [-.5 1.5 -.5  -.5 1.5 .5  .5 1.5 .5  .5 1.5 -.5] AttributeEnd\n",
                      ceiling = "Surface \"slmaterial\" \"color diffusecolor\" [.1 .1 .1] Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n";
    struct Case { std::string name, surface, more; double part; };
    for (const Case& c : {Case{"last", "Surface \"mirrorlast\"", "", .4}, Case{"first", "Surface \"mirrorfirst\"", "", .4}, Case{"sheet", kMirror, sheet, .5}}) {
        Scene s(world(light + "AttributeBegin " + c.surface + " Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" + c.more + ceiling), path());
        const CameraRay ray = rayTo({.1f, 1.7f, 0}, {0, 2, 0});
        const Moments paths = estimate(s, ray, 64, 100);
        passes(s, 64, 12000, .3f);
        const Moments both = estimate(s, ray, 64, 100);
        const double image = c.part * .1 * 4 / 9, se = std::hypot(paths.se(), both.se());
        EXPECT_NEAR(both.mean() - paths.mean(), image, 4.5 * se + .15 * image) << c.name; // and what the surfaces send on of it
        EXPECT_LT(se, .08 * image) << c.name << ": not precise enough to decide";
    }
}

// An area light: paths find its image in the mirror too. With photons these are left out, and the sum stays.
TEST(Caustics, TogetherAsPathsAlone) {
    struct Case { std::string name, scene; CameraRay ray; double precision; };
    const std::string floor = kMatte + "Polygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\n";
    const Case cases[] = {
        {"mirror", lamp(1, .5, 5) + "AttributeBegin " + kMirror + "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" + kMatte + "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n",
         rayTo({1.1f, 1.2f, 0}, {1, 2, 0}), .06},
        {"glass ball", lamp(3, .8, 5) + "AttributeBegin " + kGlass + "Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\n" + floor, rayTo({.3f, .6f, 1.4f}, {.1f, 0, .1f}), .04},
        // A floor below water that light comes through: refraction takes energy for radiance.
        {"water", lamp(3, .8, 5) + "AttributeBegin " + kGlass + "Polygon \"P\" [-9 1 -9  -9 1 9  9 1 9  9 1 -9] AttributeEnd\n" + floor, rayTo({.3f, .6f, .4f}, {.1f, 0, .1f}), .05},
        // Lobes other than diffuse() gather, too.
        {"glossy floor", lamp(3, .8, 5) + "AttributeBegin " + kGlass + "Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\n" +
                             "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [.8 .6 .4] \"float shininess\" 3\nPolygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\n",
         rayTo({.3f, .6f, 1.4f}, {.1f, 0, .1f}), .05},
        // A lamp that a displacement lifts from the mirror to the middle: photons start where light samples and rays find it.
        {"displaced lamp", "AttributeBegin AreaLightSource \"both5\" 1 Surface \"constant\" Color 0 0 0 Attribute \"displacementbound\" \"float sphere\" 2\n"
                           "Displacement \"lift\" Patch \"bilinear\" \"P\" [-.5 .1 -.5  .5 .1 -.5  -.5 .1 .5  .5 .1 .5] AttributeEnd\nIlluminate 1 1\nAttributeBegin " +
                               kMirror + "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" + kMatte + "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n",
         rayTo({1.1f, 1.2f, 0}, {1, 2, 0}), .06},
        // A sky whose attribute says that it sends photons: paths that met the mirror find it, too.
        {"sky", "Attribute \"light\" \"int emitphotons\" 1\nLightSource \"envlight\" 1\nAttributeBegin " + kMirror +
                    "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" + kMatte + "Polygon \"P\" [-.5 1 -.5  -.5 1 .5  .5 1 .5  .5 1 -.5]\n",
         rayTo({1.1f, .4f, 0}, {.1f, 1, 0}), .07},
        // Nothing gathers photons in a medium: paths bring all that is scattered there, and none rests on what has such a normal.
        {"fog", lamp(1, .8, 5) + "AttributeBegin " + kMirror + "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n"
                    "AttributeBegin Surface \"null\" Interior \"medium\" \"color scattering\" [1 .7 .4] Translate 0 2 0 Sphere .5 -.5 .5 360 AttributeEnd\n",
         rayTo({2, 2, 0}, {0, 2, 0}), .13},
        // Light that a mirror sends into a surface walks there once, not once as photons and once more from the eye.
        {"below a surface", lamp(1, .5, 5) + "AttributeBegin " + kMirror + "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\nSurface \"waxen\" Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n",
         rayTo({1.1f, 1.2f, 0}, {1, 2, 0}), .06}};
    writeShader("waxen", "surface waxen() { Oi = 1; Ci = subsurface(P, N, \"reflectance\", color(.8, .6, .4), \"meanfreepath\", .01, \"ior\", 1); }\n");
    writeShader("lift", "displacement lift() { P += vector \"world\" (0, .9, 0); }\n");
    writeShader("both5", "light both5() { illuminate(P, N, PI) Cl = 5; }\n");
    for (const Case& c : cases) {
        Scene s(world(c.scene), path());
        const Moments plain = s.estimate(c.ray, samples(40000));
        const uint32_t count = nightly() ? 100 : 40;
        passes(s, count, 10000, .06f);
        expectSame(estimate(s, c.ray, count, nightly() ? 100 : 40), plain, (nightly() ? 1 : 2) * c.precision, c.name);
    }
}

// Without photons of its sample a path is what it was, bit by bit.
TEST(Caustics, NothingWithoutPasses) {
    const std::string scene = world(lamp(3, .8, 5) + "AttributeBegin " + kGlass + "Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\n" + kMatte + "Polygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\n");
    Scene a(scene, path()), b(scene, path());
    passes(b, 1, 5000, .05f);
    CameraRay ray = rayTo({.3f, .6f, 1.4f}, {.1f, 0, .1f});
    bool differs = false;
    for (uint32_t sample = 0; sample < 64; ++sample) {
        ray.sample = sample;
        const Color x = a.one(ray), y = b.one(ray);
        if (sample > 0) EXPECT_EQ(x, y);
        else differs = !(x == y);
    }
    EXPECT_TRUE(differs);
}

// What of a circle of a radius lies beyond a straight edge, `d` from its middle.
double beyond(double radius, double d) {
    const double c = d / radius;
    return c >= 1 ? 0 : (std::acos(c) - c * std::sqrt(1 - c * c)) / kPi;
}

// Narrower circles have less bias: at the edge of a shadow that a mirror throws, it is the part of the circle that lies in the shadow. Of
// the finest, which holds few photons, nightly.
TEST(Caustics, BiasShrinksWithTheRadius) {
    // Half of the mirror is missing: to the one side of the middle of the ceiling there is no image.
    Scene s(world("LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 1 0]\nAttributeBegin " + kMirror +
                  "Polygon \"P\" [0 0 -2  0 0 2  2 0 2  2 0 -2] AttributeEnd\nSurface \"slmaterial\" \"color diffusecolor\" [.01 .01 .01]\nPolygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n"),
            path());
    const CameraRay ray = rayTo({.13f, 1.2f, 0}, {.03f, 2, 0}); // .03 within the light
    const double d2 = 9 + .03 * .03, image = .01 * 4 / d2 * 3 / std::sqrt(d2);
    const double paths = estimate(s, ray, 4, 4).mean();
    for (const float radius : {.3f, .1f, .02f}) {
        if (radius < .1f && !nightly()) continue;
        const uint32_t count = nightly() ? 200 : 20;
        passes(s, count, 20000, radius);
        const Moments m = estimate(s, ray, count, 1);
        EXPECT_NEAR((m.mean() - paths) / image, 1 - beyond(radius, .03), kZ * m.se() / image + .02) << radius;
        EXPECT_LT(m.se(), .03 * image) << radius;
    }
}

} // namespace
