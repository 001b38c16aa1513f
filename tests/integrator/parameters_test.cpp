// Every optional parameter of the shadeops that ask maps and rays, in scenes where each answer is known whatever they say: maps
// of one colour, and closed rooms of one brightness.
#include "integrator/floorscene.h"
#include "integrator/maps.h"

namespace parameters_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// A map of one colour.
std::string plain(const std::string& name, int width, Color c) { return "\"map\" " + writeMap(name, width, 16, c); }

void near(const Color& got, const Color& want, double tolerance, const std::string& what) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], want[k], tolerance) << what << ", component " << k;
}

// Sums of weighted texels: one colour stays to the rounding of the weights.
TEST(Parameters, OfTexture) {
    writeShader("alltexture", R"(surface alltexture(string map = ""; float form = 0;) {
    float f = 0;
    color c = 0;
    if (form == 0) { f = texture(map[1]); c = color texture(map); }
    else if (form == 1) { f = texture(map[1], s, t); c = color texture(map, s, t); }
    else if (form == 2) { f = texture(map[1], 0, 0, 1, 0, 1, 1, 0, 1); c = color texture(map, 0, 0, 1, 0, 1, 1, 0, 1); }
    else {
        f = texture(map[1], s, t, "filter", "box", "width", 2, "swidth", 1.5, "twidth", 0.5, "blur", 0.01, "sblur", 0.02,
                    "tblur", 0.03, "fill", 0.9, "lerp", 1, "samples", 8, "bias", 0.1, "ignoreabove", 1e30, "minwidth", 0,
                    "expand", 0, "maxdist", 1e6, "samplecone", 0, "minsamples", 2, "label", "a", "subset", "",
                    "excludesubset", "", "hitmode", "default", "hitsides", "both");
        c = color texture(map, "filter", "triangle", "blur", 0.2, "lerp", 1);
    }
    Oi = 1;
    Ci = c + color(f, 0, 0);
}
)");
    const std::string map = plain("parameters_wood.exr", 16, {.5f, .25f, .125f});
    for (int form = 0; form < 4; ++form) {
        Scene s(inWorld("Surface \"alltexture\" " + map + " \"form\" " + std::to_string(form) + "\n" + kFloor),
                under(Hider::Hidden));
        near(s.one(kView), {.75f, .25f, .125f}, 1e-5, "form " + std::to_string(form));
    }
}

// A channel that the file does not have is what "fill" says.
TEST(Parameters, FillOfTexture) {
    writeShader("filled", R"(surface filled(string map = "";) {
    Oi = 1;
    Ci = color(texture(map[7], s, t, "fill", 0.9), texture(map[7], s, t), texture(map[2], s, t, "fill", 0.9));
}
)");
    Scene s(inWorld("Surface \"filled\" " + plain("parameters_wood.exr", 16, {.5f, .25f, .125f}) + "\n" + kFloor),
            under(Hider::Hidden));
    near(s.one(kView), {.9f, 0, .125f}, 1e-5, "fill");
}

TEST(Parameters, OfEnvironment) {
    writeShader("allsky", R"(surface allsky(string map = ""; float form = 0;) {
    float f = 0;
    color c = 0;
    vector a = vector(0, 1, 0), b = vector(0.1, 1, 0), d = vector(0.1, 1, 0.1), e = vector(0, 1, 0.1);
    if (form == 0) { f = environment(map[1], a); c = color environment(map, a); }
    else if (form == 1) { f = environment(map[1], a, b, d, e); c = color environment(map, a, b, d, e); }
    else {
        f = environment(map[1], a, "filter", "box", "width", 2, "swidth", 1.5, "twidth", 0.5, "blur", 0.01, "sblur", 0.02,
                        "tblur", 0.03, "fill", 0.9, "lerp", 1, "samples", 8, "bias", 0.1, "ignoreabove", 1e30, "minwidth", 0,
                        "expand", 0, "maxdist", 1e6, "samplecone", 0, "minsamples", 2, "label", "a", "subset", "",
                        "excludesubset", "", "hitmode", "default", "hitsides", "both");
        c = color environment(map, a, b, d, e, "blur", 0.2);
    }
    Oi = 1;
    Ci = c + color(f, 0, 0);
}
)");
    const std::string map = plain("parameters_sky.exr", 32, {.5f, .25f, .125f});
    for (int form = 0; form < 3; ++form) {
        Scene s(inWorld("Surface \"allsky\" " + map + " \"form\" " + std::to_string(form) + "\n" + kFloor), under(Hider::Hidden));
        near(s.one(kView), {.75f, .25f, .125f}, 1e-5, "form " + std::to_string(form));
    }
}

// A map without slopes does not tilt the normal.
TEST(Parameters, OfBump) {
    writeShader("allbump", R"(surface allbump(string map = "";) {
    point a = bump(map, N, dPdu, dPdv, "blur", 0.1, "width", 2), b = bump(map, N, dPdu, dPdv, s, t, "blur", 0.1),
        c = bump(map, N, dPdu, dPdv);
    Oi = 1;
    Ci = color(length(vector(a)), length(vector(b)), length(vector(c)));
}
)");
    Scene s(inWorld("Surface \"allbump\" " + plain("parameters_bump.exr", 16, Color(.5f)) + "\n" + kFloor), under(Hider::Hidden));
    near(s.one(kView), Color(0), 1e-4, "bump");
}

// The height sin(2 PI s) has the slope 2 PI cos(2 PI s), so the bump of a plane is -2 PI cos(2 PI s) along s; its slopes are (2
// PI)^2 sin(2 PI s) times those of s. Compared as parts of (2 PI)^2: the map has 256 texels, and slopes are differences over one
// of them, which are off by (2 PI / 256)^2 / 6 = 1e-4; between texels the filter makes steps of about 1 / 100 of them.
TEST(Parameters, SlopesOfBump) {
    writeShader("slopebump", R"(surface slopebump(string map = "";) {
    float x = 0.3 * u + 0.2 * v + 0.1, y = 0.4 * v, k = 2 * PI;
    point g = bump(map, normal(0, 0, 1), vector(1, 0, 0), vector(0, 1, 0), x, y);
    Oi = 1;
    Ci = color(Du(xcomp(g)) / (k * k) - 0.3 * sin(k * x), Dv(xcomp(g)) / (k * k) - 0.2 * sin(k * x), xcomp(g) / k + cos(k * x));
}
)");
    const std::string wave = writeMap(
        "parameters_wave.exr", 256, 256, [](int x, int, int) { return float(std::sin(2 * kPi * (x + .5) / 256)); },
        "periodic,periodic");
    Scene s(inWorld("Attribute \"shade\" \"derivatives\" \"exact\"\nSurface \"slopebump\" \"map\" " + wave + "\n" + kFloor),
            under(Hider::Hidden));
    // Slopes of .36 at most, two texels of phase off (2 pi / 256 each): .018.
    for (int i = 0; i < 16; ++i)
        near(s.one(rayTo({0, 8, 0}, {float(i % 4 * 20 - 31), 0, float(i / 4 * 20 - 27)})), Color(0), .02,
             "slopes " + std::to_string(i));
}

/// A room of brightness 1 around a floor.
std::string room(const std::string& surface) {
    return inWorld("AttributeBegin\nAttribute \"visibility\" \"trace\" 1 \"transmission\" 1\nSurface \"constant\"\nSphere 50 -50 "
                   "50 360\nAttributeEnd\nSurface " +
                   surface + "\nPolygon \"P\" [-1 0 -1  -1 0 1  1 0 1  1 0 -1]\n");
}

TEST(Parameters, OfTrace) {
    writeShader("alltrace", R"(surface alltrace() {
    vector up = vector "world" (0, 1, 0), hn = 0;
    color tr = 0.5, ec = 0.5, ue = 0.5, al = 0.5, ua = 0.5;
    float far = 0;
    color one = trace(P, up, far, "label", "a", "subset", "", "bias", 0.001, "hitmode", "default", "hitsides", "both",
                      "maxdist", 1e6, "samplecone", 0, "samples", 1, "type", "specular", "weight", color(1), "minsamples", 1,
                      "samplebase", 0, "excludesubset", "", "raytype", "specular", "raylabel", "a", "maxhitdist", 1e6,
                      "environmentmap", "", "environmentspace", "current", "environmenttint", color(1), "exponent", 1000,
                      "samplearealights", 0, "transmission", tr, "hitnormal", hn, "environmentcontribution", ec,
                      "unshadowedenvironment", ue, "arealightcontribution", al, "unshadowedarealight", ua);
    color cosine = trace(P, up, "bsdf", "cosine", "wo", up, "horizon", vector(0), "roughness", 0.5, "roughnessv", 0.5,
                         "udir", vector(1, 0, 0), "eta", {color(1.5)}, "absorption", color(0), "lobeparameters", {1, 1},
                         "samplecone", 1, "samples", 4);
    Oi = 1;
    Ci = color(comp(one, 0), comp(cosine, 1), far / 50 + comp(ec, 0) + comp(al, 0));
}
)");
    Scene s(room("\"alltrace\""), under(Hider::Raytrace));
    near(s.one(kView), Color(1), 1e-3, "trace"); // "bias" is a part of the way
}

// Smooth glass seen straight on: ((1.5 - 1) / (1.5 + 1))^2 = 0.04 is reflected, the rest goes through, and both meet
// brightness 1.
TEST(Parameters, PartsOfTrace) {
    writeShader("tracedparts", R"(surface tracedparts() {
    vector up = vector "world" (0, 1, 0);
    float far = 0;
    color a[2] = trace(P, up, "distribution", "glass-ggx", "roughness", 0, "eta", 1.5, "wo", up);
    color b[2] = trace(P, up, far, "distribution", "glass-ggx", "roughness", 0, "eta", 1.5, "wo", up);
    float straight = trace(P, up);
    Oi = 1;
    Ci = color(comp(a[0], 0) + comp(b[0], 0), comp(a[1], 0) + comp(b[1], 0), (far + straight) / 50);
}
)");
    Scene s(room("\"tracedparts\""), under(Hider::Raytrace));
    near(s.one(kView), {.08f, 1.92f, 2}, 5e-3, "parts");
}

TEST(Parameters, OfTransmission) {
    writeShader("alltransmission", R"(surface alltransmission() {
    point above = P + vector "world" (0, 3, 0), behind = P + vector "world" (0, 90, 0);
    color free = transmission(P, above, "label", "a", "subset", "", "bias", 0.001, "hitmode", "default", "hitsides", "both",
                              "maxdist", 1e6, "samplecone", 0, "samples", 2, "type", "transmission", "weight", color(1),
                              "minsamples", 1, "samplebase", 0, "excludesubset", "", "raytype", "transmission", "raylabel", "a",
                              "maxhitdist", 1e6);
    Oi = 1;
    Ci = free + color(0, 1, 0) * transmission(P, behind, "samples", 2);
}
)");
    Scene s(room("\"alltransmission\""), under(Hider::Raytrace));
    near(s.one(kView), Color(1), 1e-5, "transmission");
}

TEST(Parameters, OfBmrtsRays) {
    writeShader("allbmrt", R"(surface allbmrt() {
    vector up = vector "world" (0, 1, 0), n = 0, r = 0;
    point h = P, m = P;
    color c = 0;
    float d = 0;
    color free = visibility(P, P + 3 * up, "label", "a", "subset", "", "excludesubset", "", "hitmode", "default",
                            "hitsides", "both", "bias", 0.001, "maxdist", 1e6);
    float far = rayhittest(P, up, h, n, "label", "a", "subset", "", "excludesubset", "", "hitmode", "default", "hitsides", "both",
                           "bias", 0.001, "maxdist", 1e6);
    float found = fulltrace(P, up, c, d, h, n, m, r, "label", "a", "subset", "", "excludesubset", "", "hitmode", "default",
                            "hitsides", "both", "bias", 0.001, "maxdist", 1e6);
    Oi = 1;
    Ci = color(comp(free, 0), far / 50, (found + comp(c, 2) + d / 50) / 3);
}
)");
    Scene s(room("\"allbmrt\""), under(Hider::Raytrace));
    near(s.one(kView), Color(1), 1e-3, "BMRT");
}

// Categories of lights: what a list holds, and what the light of a turn belongs to.
TEST(Parameters, CategoriesOfLights) {
    writeShader(
        "lampof",
        "light lampof(string __category = \"\"; float bright = 1;) { solar(vector \"world\" (0, -1, 0), 0) Cl = bright; }\n");
    writeShader("asksall", R"(surface asksall() {
    shader keys[] = getlights("category", "key"), all[] = getlights();
    float mine = 0;
    illuminance(P) mine += islightcategory("key") * comp(Cl, 0);
    Oi = 1;
    Ci = color(arraylength(keys), arraylength(all), mine);
}
)");
    Scene s(inWorld("LightSource \"lampof\" 1 \"__category\" \"key\" \"bright\" 3\nLightSource \"lampof\" 2 \"__category\" "
                    "\"fill,key\" \"bright\" 4\n"
                    "LightSource \"lampof\" 3 \"__category\" \"fill\" \"bright\" 8\nSurface \"asksall\"\n" +
                    std::string(kFloor)),
            under(Hider::Hidden));
    near(s.one(kView), {2, 3, 7}, 1e-6, "categories");
}

TEST(Parameters, AmbientLight) {
    writeShader("onlyambient", "surface onlyambient() { Oi = 1; Ci = ambient(); }\n");
    Scene s(inWorld("LightSource \"ambientlight\" 1 \"intensity\" .25\nLightSource \"ambientlight\" 2 \"intensity\" .5 "
                    "\"lightcolor\" [1 0 0]\nSurface \"onlyambient\"\n" +
                    std::string(kFloor)),
            withShaders(Hider::Hidden));
    near(s.one(kView), {.75f, .25f, .25f}, 1e-6, "ambient");
}

} // namespace

// A filter that differs from point to point: where its name means nothing the default holds, whoever shares the strip.
TEST(Parameters, FiltersOfPointsAreTheirOwn) {
    const std::string map = writeMap("filtermap.exr", 8, 8, [](int x, int, int) { return x < 4 ? 0.f : 1.f; });
    writeShader("filtered", R"(surface filtered(string map = "";) {
    string f = "box";
    if (s > .3) f = "nothing";
    if (s > .35) f = "gaussian";
    Ci = float texture(map, s, t, "filter", f, "blur", .6);
    Oi = 1;
})");
    const auto look = [&](const std::vector<float>& at, int lanes) {
        Settings set = withShaders(Hider::Hidden);
        set.lanes = lanes;
        Scene scene("WorldBegin\nSides 2\nSurface \"filtered\" \"map\" [" + map +
                        "]\nPolygon \"P\" [0 0 1  1 0 1  1 1 1  0 1 1] \"st\" [0 0  1 0  1 1  0 1]\nWorldEnd\n",
                    set);
        std::vector<CameraRay> rays;
        for (float x : at) rays.push_back(rayTo({x, .5f, 0}, {x, .5f, 1}));
        std::vector<float> out;
        for (const SampleResult& r : scene.trace(rays)) out.push_back(r.color.x);
        return out;
    };
    const std::vector<float> together = look({.28f, .29f, .32f, .36f}, 16), alone = look({.32f}, 4);
    EXPECT_EQ(together[2], alone[0]);
    EXPECT_GT(std::fabs(together[1] - together[2]), .02f) << together[1]; // a box is not the default
    EXPECT_LT(std::fabs(together[2] - together[3]), .1f) << together[2];  // which is the gaussian
}

} // namespace parameters_test
