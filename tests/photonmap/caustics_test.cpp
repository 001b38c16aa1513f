// Hider "path" "caustics": photons bring what comes by way of mirrors and glass, paths bring the rest. Both together are the
// light that paths alone find, and closed forms where there are some.
#include "integrator/floorscene.h"
#include "integrator/integrator.h"
#include "photonmap/photonmap.h"
#include "world/photonmaps.h"

namespace caustics_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

Settings path() { return withShaders(Hider::Path); }

struct Gathering {
    float width = 0;  ///< of lobes that photons follow, radians
    float window = 0; ///< photons that are as near in time count; 0: all do
};
/// Sets photons for samples 0 to passes - 1. Of learning, as the renderer does it.
void passes(Scene& s, uint32_t passes, uint32_t count, float radius, const Gathering& how = {}) {
    PhotonEmission emission(s.world, {.all = true, .sky = false, .caustics = true, .width = how.width}, s.diagnostics);
    PhotonEmission::Thread thread(emission, s.diagnostics);
    std::vector<StoredPhoton> found;
    ASSERT_TRUE(thread.emit(0xffffffffu, 0, 20000, 20000, found, nullptr));
    emission.learn(found, 0xffffffffu, 20000);
    emission.markPhotonLights();
    std::vector<std::unique_ptr<photonmap::PhotonGrid>> grids;
    constexpr uint32_t kBlock = 1000;
    for (uint32_t pass = 0; pass < passes; ++pass) {
        found.clear();
        for (uint32_t first = 0; first < count; first += kBlock) // large blocks touch more memory than caches hold
            ASSERT_TRUE(thread.emit(pass, first, std::min(kBlock, count - first), count, found, nullptr));
        std::vector<photonmap::Photon> all;
        std::vector<float> times;
        for (const StoredPhoton& p : found) {
            all.push_back(p.photon);
            if (how.window > 0) times.push_back(p.time);
        }
        grids.push_back(std::make_unique<photonmap::PhotonGrid>(std::move(all), radius, times, how.window));
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
const std::string kGlass = "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float kn\" "
                           "1.5 \"string fresnel\" \"exact\"\n";
const std::string kMatte = "Surface \"slmaterial\" \"color diffusecolor\" [.8 .6 .4]\n";
std::string lamp(double y, double half, double radiance) {
    char text[400];
    std::snprintf(text, sizeof text,
                  "AttributeBegin Sides 1 AreaLightSource \"slrect\" 1 \"float intensity\" %g Surface \"constant\" Color 0 0 0 "
                  "Polygon \"P\" [%g %g %g  %g %g %g  %g %g %g  %g %g %g] AttributeEnd\nIlluminate 1 1\n",
                  radiance, -half, y, -half, half, y, -half, half, y, half, -half, y, half);
    return text;
}

// A point light and a mirror: the light's image shines as well as the light does. No path finds it.
TEST(Caustics, MirrorImageOfAPointLight) {
    Scene s(inWorld("LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 1 0]\nAttributeBegin " + kMirror +
                    "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" + kMatte +
                    "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n"),
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

// The same in air that takes light. What an eye sees on each way is dimmed by the air of the surface that it sees: the way from
// the mirror to the ceiling by the mirror's, over 2; the light has no surface, so its way to the mirror by nobody's.
TEST(Caustics, MirrorImageInAtmospheres) {
    writeShader("beer", "volume beer(float k = 1) { Ci *= exp(-k * length(I)); }\n");
    const std::string light = "LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 1 0]\n";
    Scene s(
        inWorld(light + "AttributeBegin Atmosphere \"beer\" \"k\" .5 " + kMirror +
                "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" +
                "Atmosphere \"beer\" \"k\" .25 Surface \"slmaterial\" \"color diffusecolor\" [.1 .1 .1] Polygon \"P\" [-2 2 -2 "
                " -2 2 2  2 2 2  2 2 -2]\n"),
        path());
    const CameraRay ray = rayTo({.1f, 1.2f, 0}, {0, 2, 0});
    const double image = .1 * 4 / 9 * std::exp(-.5 * 2 - .25 * std::hypot(.1, .8));
    const double paths = estimate(s, ray, 64, 64).mean();
    passes(s, 64, 5000, .2f);
    const Moments m = estimate(s, ray, 64, 64);
    EXPECT_NEAR(m.mean() - paths, image, 4.5 * m.se() + .04 * image);
    EXPECT_LT(m.se(), .06 * image);
}

// What moves while the shutter is open: each time has its own image. A mirror that sinks, and a light that rises.
TEST(Caustics, MirrorImagesOfEachTime) {
    const std::string
        mirror = "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2]",
        light = "LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 1 0]\n",
        ceiling = "Surface \"slmaterial\" \"color diffusecolor\" [.1 .1 .1] Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n";
    const auto moving = [](double y) {
        return "MotionBegin [0 1] Translate 0 0 0 Translate 0 " + std::to_string(y) + " 0 MotionEnd ";
    };
    struct Case {
        std::string name, scene;
        double first, last;
    }; // how far the image lies below the ceiling
    for (const Case& c :
         {Case{"mirror", light + "AttributeBegin " + kMirror + moving(-1) + mirror + " AttributeEnd\n" + ceiling, 3, 5},
          Case{"light",
               "TransformBegin " + moving(-.75) + light + "TransformEnd AttributeBegin " + kMirror + mirror + " AttributeEnd\n" +
                   ceiling,
               3, 2.25}}) {
        Scene s("Shutter 0 1\n" + inWorld(c.scene), path());
        const auto seenAt = [&](float t, uint32_t count) {
            CameraRay ray = rayTo({.1f, 1.6f, 0}, {0, 2, 0});
            ray.time = ray.shutter = t;
            return estimate(s, ray, count, 64);
        };
        std::map<float, double> without;
        for (const float t : {0.f, .5f, 1.f}) without[t] = seenAt(t, 4).mean();
        passes(s, 40, 14000, .3f, {.window = .1f}); // of all times
        for (const auto& [t, paths] : without) {
            const Moments m = seenAt(t, 40);
            const double d = c.first + (c.last - c.first) * double(t), image = .1 * 4 / (d * d);
            EXPECT_NEAR(m.mean() - paths, image, 4.5 * m.se() + .08 * image)
                << c.name << " at " << t; // half a window at the ends: 4 %
            EXPECT_LT(m.se(), .08 * image);
        }
    }
}

// Mirrors that spread light, too, whatever stands first, and a sheet that does and lets half of it through: each way has its own
// chance.
TEST(Caustics, HalfOfAMirror) {
    const char* const begin = "{ normal n = faceforward(normalize(N), I); Oi = 1; Ci = ";
    writeShader("mirrorlast",
                std::string("surface mirrorlast() ") + begin + ".4 * diffuse(n) + .4 * trace(P, reflect(normalize(I), n)); }\n");
    writeShader("mirrorfirst",
                std::string("surface mirrorfirst() ") + begin + ".4 * trace(P, reflect(normalize(I), n)) + .4 * diffuse(n); }\n");
    writeShader("sheet", "surface sheet() { Oi = .5; Ci = .5 * diffuse(faceforward(normalize(N), I)); }\n");
    const std::string
        light = "LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 1 0]\n",
        sheet = "AttributeBegin Surface \"sheet\" Polygon \"P\" [-.5 1.5 -.5  -.5 1.5 .5  .5 1.5 .5  .5 1.5 -.5] AttributeEnd\n",
        ceiling = "Surface \"slmaterial\" \"color diffusecolor\" [.1 .1 .1] Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n";
    struct Case {
        std::string name, surface, more;
        double part;
    };
    for (const Case& c : {Case{"last", "Surface \"mirrorlast\"", "", .4}, Case{"first", "Surface \"mirrorfirst\"", "", .4},
                          Case{"sheet", kMirror, sheet, .5}}) {
        Scene s(inWorld(light + "AttributeBegin " + c.surface + " Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" +
                        c.more + ceiling),
                path());
        const CameraRay ray = rayTo({.1f, 1.7f, 0}, {0, 2, 0});
        const uint32_t count = nightly() ? 64 : 48;
        const Moments paths = estimate(s, ray, count, 100);
        passes(s, count, 12000, .3f);
        const Moments both = estimate(s, ray, count, 100);
        const double image = c.part * .1 * 4 / 9, se = std::hypot(paths.se(), both.se());
        EXPECT_NEAR(both.mean() - paths.mean(), image, 4.5 * se + .15 * image) << c.name; // and what the surfaces send on of it
        EXPECT_LT(se, .08 * image) << c.name << ": not precise enough to decide";
    }
}

namespace {

/// A scene with light that photons bring, a place to look at, and how well both estimates agree there.
struct CausticScene {
    std::string name, scene;
    CameraRay ray;
    double precision;
    float width = 0;
};

std::vector<CausticScene> causticScenes() {
    const std::string floor = kMatte + "Polygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\n";
    const std::string mirror = kMirror + "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2]\n",
                      ceiling = kMatte + "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n";
    return {
        {"mirror",
         lamp(1, .5, 5) + "AttributeBegin " + kMirror + "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" + kMatte +
             "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n",
         rayTo({1.1f, 1.2f, 0}, {1, 2, 0}), .06},
        {"glass ball",
         lamp(3, .8, 5) + "AttributeBegin " + kGlass + "Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\n" + floor,
         rayTo({.3f, .6f, 1.4f}, {.1f, 0, .1f}), .04},
        // A floor below water that light comes through: refraction takes energy for radiance.
        {"water",
         lamp(3, .8, 5) + "AttributeBegin " + kGlass + "Polygon \"P\" [-9 1 -9  -9 1 9  9 1 9  9 1 -9] AttributeEnd\n" + floor,
         rayTo({.3f, .6f, .4f}, {.1f, 0, .1f}), .05},
        // Lobes other than diffuse() gather, too.
        {"glossy floor",
         lamp(3, .8, 5) + "AttributeBegin " + kGlass + "Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\n" +
             "Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [.8 .6 .4] \"float shininess\" "
             "3\nPolygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\n",
         rayTo({.3f, .6f, 1.4f}, {.1f, 0, .1f}), .05},
        // A lamp that a displacement lifts from the mirror to the middle: photons start where light samples and rays find it.
        {"displaced lamp",
         "AttributeBegin AreaLightSource \"both5\" 1 Surface \"constant\" Color 0 0 0 Attribute \"displacementbound\" \"float "
         "sphere\" 2\n"
         "Displacement \"lift\" Patch \"bilinear\" \"P\" [-.5 .1 -.5  .5 .1 -.5  -.5 .1 .5  .5 .1 .5] AttributeEnd\nIlluminate 1 "
         "1\nAttributeBegin " +
             kMirror + "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" + kMatte +
             "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n",
         rayTo({1.1f, 1.2f, 0}, {1, 2, 0}), .06},
        // A sky whose attribute says that it sends photons: paths that met the mirror find it, too.
        {"sky",
         "Attribute \"light\" \"int emitphotons\" 1\nLightSource \"envlight\" 1\nAttributeBegin " + kMirror +
             "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" + kMatte +
             "Polygon \"P\" [-.5 1 -.5  -.5 1 .5  .5 1 .5  .5 1 -.5]\n",
         rayTo({1.1f, .4f, 0}, {.1f, 1, 0}), .07},
        // Nothing gathers photons in a medium: paths bring all that is scattered there, and none rests on what has such a normal.
        {"fog",
         lamp(1, .8, 5) + "AttributeBegin " + kMirror +
             "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n"
             "AttributeBegin Surface \"null\" Interior \"medium\" \"color scattering\" [1 .7 .4] Translate 0 2 0 Sphere .5 -.5 "
             ".5 360 AttributeEnd\n",
         rayTo({2, 2, 0}, {0, 2, 0}), .13},
        // Light that a mirror sends into a surface walks there once, not once as photons and once more from the eye.
        {"below a surface",
         lamp(1, .5, 5) + "AttributeBegin " + kMirror +
             "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\nSurface \"waxen\" Polygon \"P\" [-2 2 -2  -2 2 2  2 2 "
             "2  2 2 -2]\n",
         rayTo({1.1f, 1.2f, 0}, {1, 2, 0}), .06},
        // Air that differs from surface to surface; and a ball of a volume about the lamp, which some of the ways leave, others
        // enter again.
        {"air",
         "AttributeBegin Atmosphere \"beer\" \"k\" .3 " + lamp(1, .5, 5) +
             "AttributeEnd Illuminate 1 1 AttributeBegin Atmosphere \"beer\" \"k\" .5 " + mirror +
             "AttributeEnd Atmosphere \"beer\" \"k\" .2 " + ceiling,
         rayTo({1.1f, 1.2f, 0}, {1, 2, 0}), .06},
        {"volume",
         lamp(1, .5, 5) +
             "AttributeBegin Surface \"null\" Interior \"beer\" \"k\" .4 Translate 0 1 0 Sphere .9 -.9 .9 360 AttributeEnd "
             "AttributeBegin " +
             "Atmosphere \"beer\" \"k\" .5 " + mirror + "AttributeEnd " + ceiling,
         rayTo({1.1f, 1.2f, 0}, {1, 2, 0}), .06}};
}

} // namespace

// An area light: paths find its image in the mirror too. With photons these are left out, and the sum stays.
TEST(Caustics, TogetherAsPathsAlone) {
    writeShader("beer", "volume beer(float k = 1) { Ci *= exp(-k * length(I)); }\n");
    writeShader("waxen", "surface waxen() { Oi = 1; Ci = subsurface(P, N, \"reflectance\", color(.8, .6, .4), \"meanfreepath\", "
                         ".01, \"ior\", 1); }\n");
    writeShader("lift", "displacement lift() { P += vector \"world\" (0, .9, 0); }\n");
    writeShader("both5", "light both5() { illuminate(P, N, PI) Cl = 5; }\n");
    for (const CausticScene& c : causticScenes()) {
        Scene s(inWorld(c.scene), path());
        const Moments plain = s.estimate(c.ray, samples(40000));
        const uint32_t count = nightly() ? 100 : 40;
        passes(s, count, 10000, .06f);
        expectSame(estimate(s, c.ray, count, nightly() ? 100 : 40), plain, (nightly() ? 1 : 2) * c.precision, c.name);
    }
}

// Narrow lobes: photons follow them as mirrors, paths leave out their light, whether they would have sampled the lamp or met it.
TEST(Caustics, NarrowLobesTogetherAsPathsAlone) {
    // Weights that depend on where a surface is seen from: an eye sees another weight than the light does.
    const char* const begin =
        "{ normal n = faceforward(normalize(N), I); vector V = -normalize(I); float c = n . V; Oi = 1; Ci = ";
    const auto write = [&](const std::string& name, const std::string& value) {
        writeShader(name, "surface " + name + "() " + begin + value + "; }\n");
    };
    write("roughmetal", "mix(color(.9, .7, .5), color 1, pow(1 - c, 3)) * trace(P, n, \"distribution\", \"cook-torrance\", "
                        "\"roughness\", .06, \"samplearealights\", 1, \"type\", \"specular\")");
    write("grazing", ".9 * (1 - c) * trace(P, reflect(-V, n), \"distribution\", \"slphong\", \"horizon\", n, \"exponent\", 300, "
                     "\"samplearealights\", 1, \"type\", \"specular\")");
    write("coated", "color(.4, .3, .2) * diffuse(n) + 8 * (1 - .5 * c) * specular(n, V, .02)");
    write("roughglass", "trace(P, normalize(N), \"distribution\", \"glass-ggx\", \"roughness\", .06, \"eta\", 1.5, "
                        "\"samplearealights\", 1, \"type\", \"specular\")");
    const std::string ceiling = kMatte + "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n",
                      floor = kMatte + "Polygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\n";
    const auto below = [&](const std::string& surface) {
        return lamp(1, .5, 5) + "AttributeBegin " + surface + " Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" +
               ceiling;
    };
    const CameraRay up = rayTo({1.1f, 1.2f, 0}, {1, 2, 0});
    struct Case {
        std::string name, scene;
        CameraRay ray;
        double precision;
    };
    for (const Case& c :
         {Case{"metal", below("Surface \"roughmetal\""), up, .05}, Case{"grazing", below("Surface \"grazing\""), up, .06},
          Case{"coated", below("Surface \"coated\""), up, .05},
          Case{"rough glass",
               lamp(3, .8, 5) +
                   "AttributeBegin Surface \"roughglass\" Polygon \"P\" [-9 1 -9  -9 1 9  9 1 9  9 1 -9] AttributeEnd\n" + floor,
               rayTo({.3f, .6f, .4f}, {.1f, 0, .1f}), .05},
          Case{"rough ball",
               lamp(3, .8, 5) + "AttributeBegin Surface \"roughglass\" Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\n" +
                   floor,
               rayTo({.3f, .6f, 1.4f}, {.1f, 0, .1f}), .05},
          // What is thrown about a refracted direction stays with the paths: photons would not find all of it.
          Case{"translucent ball",
               lamp(3, .8, 5) +
                   "AttributeBegin Surface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float "
                   "kn\" 1.5 "
                   "\"float shininess\" 300 \"float translucency\" 300 Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\n" +
                   floor,
               rayTo({.3f, .6f, 1.4f}, {.1f, 0, .1f}), .05}}) {
        Scene s(inWorld(c.scene), path());
        const Moments plain = s.estimate(c.ray, samples(60000));
        const uint32_t count = nightly() ? 100 : 24;
        passes(s, count, 10000, .06f, {.width = .1f});
        expectSame(estimate(s, c.ray, count, nightly() ? 100 : 24), plain, (nightly() ? 1 : 2) * c.precision, c.name);
    }
}

// What a shader says of a narrow lobe that depends on how far away it is seen from, which of its calls it is, and how deep rays
// may go: the same as without photons.
TEST(Caustics, NarrowLobesAsTheirShadersAndDepthsSay) {
    const std::string glass = "trace(P, n, \"distribution\", \"glass-ggx\", \"roughness\", .06, \"eta\", 1.5, "
                              "\"samplearealights\", 1, \"type\", \"specular\"); ";
    const std::string begin = "() { normal n = normalize(N); Oi = 1; ";
    writeShader("plainglass", "surface plainglass" + begin + "Ci = " + glass + "}\n");
    writeShader("tinted",
                "surface tinted" + begin +
                    "float a = length(I); color k = 1; if (I . n > 0) k = color(exp(-.2 * a), exp(-a), exp(-2 * a)); Ci = k * " +
                    glass + "}\n");
    writeShader("twocalls", "surface twocalls" + begin + "if (I . n > 0) Ci = " + glass + "else Ci = " + glass + "}\n");
    writeShader(
        "twolobes",
        "surface twolobes" + begin +
            "n = faceforward(n, I); vector V = -normalize(I); Ci = 4 * specular(n, V, .02) + 2 * specular(n, V, .01); }\n");
    const std::string floor = kMatte + "Polygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\n",
                      ceiling = kMatte + "Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n";
    const auto ball = [&](const std::string& surface) {
        return lamp(3, .8, 5) + "AttributeBegin " + surface + " Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\n" + floor;
    };
    const auto below = [&](const std::string& surface) {
        return lamp(1, .5, 5) + "AttributeBegin " + surface + " Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n" +
               ceiling;
    };
    const auto depth = [](int most) { return "Attribute \"trace\" \"int maxspeculardepth\" " + std::to_string(most) + " "; };
    const CameraRay up = rayTo({1.1f, 1.2f, 0}, {1, 2, 0}), down = rayTo({.3f, .6f, 1.4f}, {.1f, 0, .1f});
    struct Case {
        std::string name, scene;
        CameraRay ray;
        double precision;
    };
    for (const Case& c :
         {Case{"length of I", ball("Surface \"tinted\""), down, .03}, Case{"two calls", ball("Surface \"twocalls\""), down, .03},
          Case{"two lobes", below("Surface \"twolobes\""), up, .05},
          // The last lobe before the lamp is sampled: it may be one deeper.
          Case{"no rays", below(depth(0) + "Surface \"twolobes\""), up, .07},
          Case{"no second ray", ball(depth(1) + "Surface \"plainglass\""), down, .08}}) {
        Scene s(inWorld(c.scene), path());
        const Moments plain = s.estimate(c.ray, samples(60000));
        const uint32_t count = nightly() ? 100 : 24;
        passes(s, count, 10000, .06f, {.width = .1f});
        expectSame(estimate(s, c.ray, count, nightly() ? 100 : 24), plain, (nightly() ? 1 : 2) * c.precision, c.name);
    }
}

// Lights that are off for a surface, or whose highlights are: neither photons nor paths bring them by way of its narrow lobes.
TEST(Caustics, NarrowLobesOfLightsThatAreOff) {
    writeShader(
        "highlight",
        "surface highlight() { normal n = faceforward(normalize(N), I); Oi = 1; Ci = 4 * specular(n, -normalize(I), .02); }\n");
    writeShader("nohighlight", "light nohighlight(float intensity = 1; output float __nonspecular = .75;) { illuminate(P, N, PI "
                               "/ 2) Cl = intensity; }\n");
    const std::string
        off = "Illuminate 1 0\n",
        on = "", mirror = "Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2] AttributeEnd\n",
        ceiling = "Surface \"slmaterial\" \"color diffusecolor\" [.1 .1 .1] Polygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n";
    const auto scene = [&](const std::string& light, const std::string& illuminate) {
        std::string with = lamp(1, .5, 5);
        with.replace(with.find("slrect"), 6, light);
        return inWorld(with + "AttributeBegin " + illuminate + "Surface \"highlight\" " + mirror + ceiling);
    };
    const CameraRay ray = rayTo({1.1f, 1.2f, 0}, {1, 2, 0});
    const auto seen = [&](const std::string& light, const std::string& illuminate) {
        Scene s(scene(light, illuminate), path());
        passes(s, 40, 10000, .1f, {.width = .1f});
        return estimate(s, ray, 40, 40);
    };
    const Moments all = seen("slrect", on), none = seen("slrect", off), quarter = seen("nohighlight", on);
    Scene plain(scene("slrect", off), path());
    const double dark = plain.estimate(ray, 20000).mean(), image = all.mean() - dark;
    EXPECT_GT(image, 20 * all.se());
    EXPECT_NEAR(none.mean(), dark, kZ * none.se() + 1e-5);
    EXPECT_NEAR(quarter.mean() - dark, image / 4, kZ * std::hypot(quarter.se(), all.se()) + .01 * image);
}

// Without photons of its sample a path is what it was, bit by bit.
TEST(Caustics, NothingWithoutPasses) {
    const std::string scene =
        inWorld(lamp(3, .8, 5) + "AttributeBegin " + kGlass + "Translate 0 1 0 Sphere .6 -.6 .6 360 AttributeEnd\n" + kMatte +
                "Polygon \"P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3]\n");
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

// Narrower circles have less bias: at the edge of a shadow that a mirror throws, it is the part of the circle that lies in the
// shadow. Of the finest, which holds few photons, nightly.
TEST(Caustics, BiasShrinksWithTheRadius) {
    // Half of the mirror is missing: to the one side of the middle of the ceiling there is no image.
    Scene s(
        inWorld("LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 1 0]\nAttributeBegin " + kMirror +
                "Polygon \"P\" [0 0 -2  0 0 2  2 0 2  2 0 -2] AttributeEnd\nSurface \"slmaterial\" \"color diffusecolor\" [.01 "
                ".01 .01]\nPolygon \"P\" [-2 2 -2  -2 2 2  2 2 2  2 2 -2]\n"),
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

} // namespace caustics_test
