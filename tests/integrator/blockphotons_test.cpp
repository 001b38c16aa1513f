// Photons at vertices that are followed 16 at a time (integrator/blockphotons.h) have the bits of those that go one by one.
#include "integrator/blockrooms.h"
#include "photonmap/photongrid.h"
#include "scene/lightpaths.h"
#include "world/photonmaps.h"
#include <algorithm>
#include <cstring>

namespace blockphotons_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

Settings withShipped(bool blocks, int lanes = 16) {
    Settings s = pathSettings();
    s.shaderPaths.push_back(std::string(ALPENGLOW_SOURCE_DIR) + "/shaders");
    s.rowRequests = blocks;
    s.lanes = lanes;
    return s;
}

/// Sets photons for samples 0 to 3; sample 4 has none.
void setPasses(Scene& s, float width, float window) {
    constexpr uint32_t kPhotons = 1000;
    PhotonEmission emission(s.world, {.all = true, .sky = false, .caustics = true, .width = width}, s.diagnostics);
    PhotonEmission::Thread thread(emission, s.diagnostics);
    emission.markPhotonLights();
    std::vector<std::unique_ptr<photonmap::PhotonGrid>> grids;
    for (uint32_t pass = 0; pass < 4; ++pass) {
        std::vector<StoredPhoton> found;
        ASSERT_TRUE(thread.emit(pass, 0, kPhotons, kPhotons, found, nullptr));
        std::vector<photonmap::Photon> all;
        std::vector<float> times;
        for (const StoredPhoton& p : found) {
            all.push_back(p.photon);
            if (window > 0) times.push_back(p.time);
        }
        grids.push_back(std::make_unique<photonmap::PhotonGrid>(std::move(all), .5f, times, window));
    }
    setPhotonPasses(*s.world, 0, std::move(grids));
}
Traced gathering(const std::string& rib, const Settings& settings, float width = 0, float window = 0) {
    Scene s(rib, settings);
    setPasses(s, width, window);
    return trace(s);
}

const std::string kMirrors =
    "AttributeBegin\nSurface \"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [1 1 1]\nPolygon \"P\" [-2 "
    "-1.9 3  -2 -1.9 8  2 -1.9 8  2 -1.9 3]\nAttributeEnd\nAttributeBegin\nSurface \"slmaterial\" \"color diffusecolor\" [0 0 "
    "0] \"color transmissive\" [1 1 1] \"float kn\" 1.5\nTranslate -.6 .6 3.4\nSphere .3 -.3 .3 360\nAttributeEnd\n"
    "AttributeBegin\nSurface \"matte\"\nPolygon \"P\" [-9 -1.95 0  -9 -1.95 20  9 -1.95 20  9 -1.95 0]\nPolygon \"P\" [-9 -9 "
    "8.8  -9 9 8.8  9 9 8.8  9 -9 8.8]\nAttributeEnd\n";

/// Shaders with narrow lobes.
void writeNarrow() {
    const std::string begin = "() { normal n = faceforward(normalize(N), I); vector V = -normalize(I); float c = n . V; Oi = 1; ";
    const auto write = [&](const std::string& name, const std::string& value) {
        writeShader(name, "surface " + name + begin + "Ci = " + value + "; }\n");
    };
    write("roughmetal", "mix(color(.9, .7, .5), color 1, pow(1 - c, 3)) * trace(P, n, \"distribution\", \"cook-torrance\", "
                        "\"roughness\", .06, \"samplearealights\", 1, \"type\", \"specular\")");
    write("grazing", ".9 * (1 - c) * trace(P, reflect(-V, n), \"distribution\", \"slphong\", \"horizon\", n, \"exponent\", 300, "
                     "\"samplearealights\", 1, \"type\", \"specular\")");
    write("polished", "Cs * .3 * trace(P, reflect(-V, n), \"distribution\", \"slphong\", \"exponent\", 300, \"type\", "
                      "\"specular\") + .2 * phong(n, V, 400) + .3 * diffuse(n)");
    write("coated", "color(.4, .3, .2) * diffuse(n) + 8 * (1 - .5 * c) * specular(n, V, .02)");
    write("roughglass", "trace(P, normalize(N), \"distribution\", \"glass-ggx\", \"roughness\", .06, \"eta\", 1.5, "
                        "\"samplearealights\", 1, \"type\", \"specular\")");
    writeShader("twocalls", "surface twocalls() { normal n = normalize(N); Oi = 1; if (I . n > 0) Ci = .9 * trace(P, n, "
                            "\"distribution\", \"glass-ggx\", \"roughness\", .06, \"eta\", 1.5, \"samplearealights\", 1, "
                            "\"type\", \"specular\"); else Ci = .8 * specular(n, -normalize(I), .01) + .2 * diffuse(n); }\n");
}

} // namespace

TEST(BlockPhotons, AreGathered) {
    writeNarrow();
    writeGlossy();
    writeFacets();
    writeShader("waxen", "surface waxen() { Oi = 1; Ci = .3 * diffuse(faceforward(normalize(N), I)) + .5 * subsurface(P, N, "
                         "\"reflectance\", color(.8, .6, .4), \"meanfreepath\", .1, \"ior\", 1.3); }\n");
    writeShader("limited", R"(surface limited() {
    normal n = faceforward(normalize(N), I);
    Oi = 1;
    Ci = .4 * trace(P, vector n, "distribution", "cosine", "samplecone", PI / 2, "samplearealights", 1, "maxdist", 2 + xcomp(P))
         + .4 * trace(P + .1 * n, vector n, "distribution", "cosine", "samplecone", PI / 2, "subset", "")
         + .1 * trace(P, vector n, "distribution", "cosine", "samplecone", PI / 2, "hitsides", "both");
})");
    struct Case {
        std::string shader, more;
        float width = 0;
        double least = .33; ///< of all points, those in blocks
    };
    const std::string clear = "Opacity .5 .6 .7\n", many = manyLights(6), fog = "Atmosphere \"fog\" \"distance\" 9\n";
    for (const Case& c :
         {Case{"matte", ""}, Case{"matte", many}, Case{"matte", clear}, Case{"matte", fog}, Case{"glossy", "", .5f},
          Case{"facets", clear}, Case{"roughmetal", "", .1f}, Case{"roughmetal", many, .1f}, Case{"grazing", "", .1f},
          Case{"polished", clear, .1f}, Case{"coated", "", .1f}, Case{"coated", many, .1f}, Case{"roughglass", "", .1f},
          Case{"twocalls", "", .1f}, Case{"waxen", ""}, Case{"limited", ""}}) {
        const std::string rib = roomOf("\"" + c.shader + "\"", kMirrors + c.more);
        const Widths lanes(rib);
        const Traced one = gathering(rib, withShipped(false, lanes.single), c.width),
                     all = gathering(rib, withShipped(true, lanes.rows), c.width);
        const std::string what = c.shader + " " + c.more.substr(0, 20);
        EXPECT_EQ(one.inRows, 0u);
        EXPECT_GT(double(all.inRows), c.least * double(all.points)) << what;
        EXPECT_EQ(differences(one, all), 0u) << what;
        EXPECT_GT(differences(one, trace(rib, false, 16, -1, withShipped(false))), 20u) << what << ": no photons";
    }
}

// Kernels that wait, light path outputs, motion, depth limits.
TEST(BlockPhotons, AreGatheredWhateverIsAsked) {
    writeNarrow();
    writeShader("threshold", R"(surface threshold() {
    normal n = faceforward(normalize(N), I);
    color light = trace(P, vector(n), "distribution", "cosine", "samplecone", PI / 2, "samplearealights", 1);
    Ci = Cs * (comp(light, 1) > .1 ? light : .3 * light);
    Oi = 1;
})");
    Diagnostics d;
    Settings paths = withShipped(true), shallow = paths, outputs = paths;
    paths.lightPaths =
        std::make_shared<scene::LightPaths>(std::vector<scene::LightPaths::Source>{{"C<RD>S*L", {}}, {"C.*<RD>.+L", {}}}, d);
    ASSERT_EQ(d.all().size(), 0u);
    shallow.maxDepth = 2;
    outputs.firstSeen = true;
    const std::string moving = "MotionBegin [0 1]\nTranslate 0 0 0\nTranslate .2 0 0\nMotionEnd\n";
    struct Case {
        const char* shader;
        const Settings& settings;
        float width = .1f, window = 0;
    };
    for (const Case& c : {Case{"threshold", paths}, Case{"coated", paths}, Case{"twocalls", shallow}, Case{"coated", outputs},
                          Case{"matte", paths, 0, .3f}}) {
        const std::string rib =
            (c.window > 0 ? "Shutter 0 1\n" : "") +
            roomOf("\"" + std::string(c.shader) + "\"",
                   (c.window > 0 ? moving : "") + kMirrors + "Attribute \"trace\" \"int maxspeculardepth\" 3\n");
        Settings single = c.settings;
        single.rowRequests = false;
        const Traced one = gathering(rib, single, c.width, c.window), all = gathering(rib, c.settings, c.width, c.window);
        EXPECT_EQ(one.inRows, 0u);
        EXPECT_GT(double(all.inRows), .33 * double(all.points)) << c.shader;
        EXPECT_EQ(differences(one, all), 0u) << c.shader;
    }
}

// indirectdiffuse() by way of the photon maps of the surfaces that its rays meet.
TEST(BlockPhotons, OfMapsAreGathered) {
    writeShader("gathering", R"(surface gathering() {
    normal n = faceforward(normalize(N), I);
    Oi = 1;
    Ci = Cs * (.5 * diffuse(n) + .5 * indirectdiffuse(P, n, 2));
})");
    const std::string rib = roomOf("\"gathering\"", "Attribute \"visibility\" \"int diffuse\" 1 \"int specular\" 1\nAttribute "
                                                    "\"photon\" \"string globalmap\" \"room.photons\"\n");
    for (const Hider h : {Hider::Path, Hider::Raytrace}) {
        Settings blocks = withShipped(true);
        blocks.hider = h;
        Settings single = blocks;
        single.rowRequests = false;
        const auto traced = [&](const Settings& settings, bool photons) {
            Scene s(rib, settings);
            std::vector<photonmap::Photon> all;
            for (int i = 0; photons && i < 4000; ++i) { // on the walls
                photonmap::Photon& p = all.emplace_back();
                const float x = -2 + .04f * float(i % 100), z = float(i / 100) * .2f + 1;
                p.P = i % 2 ? Vec3(x, -2, z) : Vec3(x, z - 3, 9);
                p.power = Color(.01f * float(1 + i % 3), .02f, .01f);
                p.from = photonmap::packUnit(i % 2 ? Vec3(0, 1, 0) : Vec3(0, 0, -1));
                p.normal = p.from;
                p.reflected[0] = p.reflected[1] = p.reflected[2] = 200;
            }
            setPhotonMap(*s.world, "room.photons", std::move(all));
            return trace(s);
        };
        const Traced one = traced(single, true), all = traced(blocks, true);
        EXPECT_EQ(one.inRows, 0u);
        EXPECT_GT(all.inRows, all.points / 3) << int(h);
        EXPECT_EQ(differences(one, all), 0u) << int(h);
        EXPECT_GT(differences(one, traced(single, false)), 20u) << int(h) << ": no photons";
    }
}

namespace {

struct Flown {
    std::vector<StoredPhoton> photons;
    uint64_t inRows, points;
};
Flown flown(const std::string& rib, const Settings& settings, const PhotonUse& use) {
    constexpr uint32_t kPhotons = 2000;
    Scene s(rib, settings);
    PhotonEmission emission(s.world, use, s.diagnostics);
    PhotonEmission::Thread thread(emission, s.diagnostics);
    Flown f;
    EXPECT_TRUE(thread.emit(3, 0, kPhotons, kPhotons, f.photons, nullptr));
    f.inRows = thread.counters().inRows;
    f.points = thread.counters().points;
    return f;
}
size_t differences(const Flown& a, const Flown& b) {
    size_t n = std::max(a.photons.size(), b.photons.size()) - std::min(a.photons.size(), b.photons.size());
    for (size_t i = 0; i < std::min(a.photons.size(), b.photons.size()); ++i) {
        const StoredPhoton &p = a.photons[i], &q = b.photons[i];
        n += std::memcmp(&p.photon, &q.photon, sizeof p.photon) != 0 || p.number != q.number || p.binding != q.binding ||
             !(p.way == q.way) || p.time != q.time || p.caustic != q.caustic;
    }
    return n;
}
/// Photons of a room in blocks and, with narrower kernels, point by point. least: of all points, those in blocks.
void expectSame(const std::string& rib, const std::string& what, const PhotonUse& use = {.sky = false}, double least = .9,
                const Settings& settings = withShipped(true)) {
    Settings single = settings;
    single.rowRequests = false;
    single.lanes = (what.size() + rib.size()) % 2 ? 4 : 8;
    const Flown one = flown(rib, single, use), all = flown(rib, settings, use);
    EXPECT_EQ(one.inRows, 0u);
    EXPECT_GE(double(all.inRows), least * double(all.points)) << what;
    EXPECT_GT(one.photons.size(), 10u) << what;
    EXPECT_EQ(differences(one, all), 0u) << what;
}
constexpr PhotonUse kCaustics{.all = true, .sky = false, .caustics = true, .width = .1f};

} // namespace

TEST(BlockPhotons, FlyAsShadersSay) {
    writeNarrow();
    writeGlossy();
    writeFacets();
    writeShader("around", R"(surface around() {
    normal n = faceforward(normalize(N), I);
    float i;
    Oi = Os;
    for (i = 0; i < 3; i += 1) Ci += .1 * diffuse(n) + .1 * specular(n, -normalize(I), .01 + .01 * i);
})");
    writeShader("waxen", "surface waxen() { Oi = 1; Ci = .3 * diffuse(faceforward(normalize(N), I)) + .5 * subsurface(P, N, "
                         "\"reflectance\", color(.8, .6, .4), \"meanfreepath\", .1, \"ior\", 1.3); }\n");
    writeShader("bumpy", R"(displacement bumpy() { P += .03 * sin(20 * u) * normalize(N); N = calculatenormal(P); })");
    writeShader("beer", "volume beer(float k = .1) { Ci *= exp(-k * length(I)); }\n");
    writeShader("apart", "surface apart() { normal n = faceforward(normalize(N), I); Oi = Os; Ci = .5 * diffuse(n) + .5 * "
                         "indirectdiffuse(P, n, 2) + .1 * trace(P, reflect(normalize(I), n), \"weight\", 0); }\n");
    struct Case {
        std::string shader, more;
    };
    const std::string clear = "Opacity .5 .6 .7\n", bumpy = "ShadingRate 100\nAttribute \"displacementbound\" \"float sphere\" "
                                                            ".1\nDisplacement \"bumpy\"\n";
    for (const Case& c :
         {Case{"matte", ""}, Case{"plastic", clear}, Case{"glossy", ""}, Case{"facets", clear + "Sides 1\n"},
          Case{"roughmetal", clear}, Case{"grazing", ""}, Case{"polished", "Sides 1\n"}, Case{"coated", ""},
          Case{"coated", bumpy}, Case{"roughglass", ""}, Case{"twocalls", ""}, Case{"around", clear}, Case{"waxen", ""},
          Case{"matte", "Atmosphere \"beer\"\n"}, Case{"apart", ""},
          Case{"coated", "Attribute \"trace\" \"int maxspeculardepth\" 1\n"},
          Case{"polished", "Attribute \"trace\" \"int maxdiffusedepth\" 1 \"int maxspeculardepth\" 2 \"float bias\" .01\n"}}) {
        const std::string rib = roomOf("\"" + c.shader + "\"", kMirrors + c.more), what = c.shader + " " + c.more;
        expectSame(rib, what);
        expectSame(rib, what + "caustics", kCaustics);
    }
}

TEST(BlockPhotons, FlyAsModelsSay) {
    writeShader("photonwaits", "surface photonwaits() { color c = trace(P, reflect(normalize(I), normalize(N))); Oi = Os; Ci = "
                               "comp(c, 0) > .1 ? .5 : .25; }\n");
    std::string balls; // of all models
    int i = 0;
    for (const char* model : {"matte", "plastic", "chrome", "glass", "water", "transparent"})
        for (const char* shader : {"plastic", "photonwaits"})
            balls += "AttributeBegin\nAttribute \"photon\" \"string shadingmodel\" \"" + std::string(model) + "\"\nSurface \"" +
                     shader + "\"\nOpacity .7 .6 .5\nColor .8 .7 .6\nTranslate " + std::to_string(.4 * (i % 4) - .6) + " " +
                     std::to_string(.4 * (i / 4) - .4) + " 3.5\nSphere .15 -.15 .15 360\nAttributeEnd\n",
                ++i;
    for (const char* shader : {"matte", "photonwaits"}) {
        const std::string rib = roomOf("\"" + std::string(shader) + "\"", kMirrors + balls);
        expectSame(rib, shader, {.sky = false}, .9);
        expectSame(rib, shader, kCaustics, 0);
        expectSame(rib, shader, {.sky = false, .learns = true}, 0);
    }
}

TEST(BlockPhotons, FlyThroughMediaAndMotion) {
    writeNarrow();
    const std::string fog = "AttributeBegin\nSurface \"null\"\nInterior \"medium\" \"color scattering\" [.3 .2 .1] \"color "
                            "absorption\" [.05 .02 .1]\nTranslate 0 0 5\nSphere 1.9 -1.9 1.9 360\nAttributeEnd\n";
    const std::string moving = "MotionBegin [0 1]\nTranslate 0 0 0\nTranslate .2 0 0\nMotionEnd\n";
    Settings direct = withShipped(true), local = direct, shallow = direct, unbiased = direct;
    direct.indirect = false;
    local.localRoulette = true;
    shallow.maxDepth = 2;
    unbiased.unbiased = true;
    struct Case {
        const char* what;
        std::string rib;
        Settings settings;
    };
    const std::string coated = roomOf("\"coated\"", kMirrors);
    for (const Case& c : {Case{"fog", roomOf("\"matte\"", fog + kMirrors), withShipped(true)},
                          Case{"fog about highlights", roomOf("\"coated\"", fog + kMirrors), withShipped(true)},
                          Case{"motion", "Shutter 0 1\n" + roomOf("\"coated\"", moving + kMirrors), withShipped(true)},
                          Case{"direct", coated, direct}, Case{"local", coated, local}, Case{"shallow", coated, shallow},
                          Case{"unbiased", coated, unbiased}}) {
        expectSame(c.rib, c.what, {.sky = false}, .8, c.settings);
        expectSame(c.rib, std::string(c.what) + ", caustics", kCaustics, .8, c.settings);
    }
}

// A photon shading model replaces what the shader says, its indirectdiffuse() as well: the photons are those of another shader.
TEST(BlockPhotons, ModelsReplaceTheWholeShader) {
    writeShader("gathers", R"(surface gathers() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * (diffuse(n) + indirectdiffuse(P, n, 8));
})");
    for (const char* model : {"matte", "plastic"}) {
        const std::string of = "Attribute \"photon\" \"string shadingmodel\" \"" + std::string(model) + "\"\n";
        const auto photons = [&](const std::string& shader) {
            return flown(roomOf(shader, of), withShipped(true), {.sky = false});
        };
        const Flown one = photons("\"matte\""), other = photons("\"gathers\"");
        const auto scattered = [](const StoredPhoton& p) { return p.photon.bounces > 0; };
        EXPECT_GT(std::count_if(one.photons.begin(), one.photons.end(), scattered), 200) << model;
        EXPECT_EQ(differences(one, other), 0u) << model;
    }
}

// Calls that are read one by one, because a shader computes the name of a distribution or of a kind of rays: the photons, and the
// light that paths gather of them, are those of a shader that says the same in a way that rows hold. Call sites have the same
// numbers in both, so both have the same bits.
TEST(BlockPhotons, AtRequestsMadeOneByOne) {
    const std::string begin = "() { normal n = faceforward(normalize(N), I); Oi = Os; string d = ", never = "xcomp(P) > 1e9 ? ";
    const std::string facets = "; Ci = .3 * diffuse(n) + .6 * trace(P, n, \"distribution\", d, \"roughness\", .06, "
                               "\"samplearealights\", 1, \"type\", k); }\n";
    struct Pair {
        std::string name, single, rows;
    };
    for (const Pair& p :
         {Pair{"named", never + "\"ggx\" : \"cook-torrance\", k = \"specular\"", "\"cook-torrance\", k = \"specular\""},
          Pair{"typed", "\"ggx\", k = " + never + "\"diffuse\" : \"specular\"", "\"ggx\", k = \"specular\""}}) {
        writeShader(p.name + "single", "surface " + p.name + "single" + begin + p.single + facets);
        writeShader(p.name + "rows", "surface " + p.name + "rows" + begin + p.rows + facets);
        const std::string single = roomOf('"' + p.name + "single\"", kMirrors), rows = roomOf('"' + p.name + "rows\"", kMirrors);
        for (const PhotonUse& use : {PhotonUse{.sky = false}, kCaustics}) {
            const Flown one = flown(single, withShipped(true), use), all = flown(rows, withShipped(true), use);
            EXPECT_LT(one.inRows, all.inRows) << p.name;
            EXPECT_GT(all.photons.size(), 10u) << p.name;
            EXPECT_EQ(differences(one, all), 0u) << p.name << (use.caustics ? ", caustics" : "");
        }
        const Traced one = gathering(single, withShipped(true), .1f), all = gathering(rows, withShipped(true), .1f);
        EXPECT_LT(one.inRows, all.inRows) << p.name;
        EXPECT_EQ(differences(one, all), 0u) << p.name << ", gathered";
    }
}

} // namespace blockphotons_test
