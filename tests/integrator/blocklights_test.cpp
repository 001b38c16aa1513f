// Lights of every kind, sampled by vertices in blocks (integrator/vertexlight.h): the bits do not depend on how requests are
// read, nor on the lanes of kernels. LightTable, Lamps and others compare the light itself with closed forms.
#include "integrator/blockrooms.h"
#include "world/impl.h"

namespace blocklights_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

Settings under(Hider h) {
    Settings s;
    s.hider = h;
    return s;
}

const std::string kSky = "LightSource \"envlight\" 9 \"intensity\" .3\n";
const std::string kFog = "AttributeBegin\nSurface \"null\" Interior \"medium\" \"color scattering\" [.1 .12 .2]\n"
                         "Translate 0 0 5\nSphere 7.5 -7.5 7.5 360\nAttributeEnd\n";

/// An area light of this shader above the room.
std::string lampOf(const std::string& shader, int handle = 77, const std::string& attributes = "") {
    const std::string h = std::to_string(handle);
    return "AttributeBegin\nAreaLightSource " + shader.substr(0, shader.find(' ')) + " " + h +
           (shader.find(' ') == std::string::npos ? "" : shader.substr(shader.find(' '))) +
           "\nSurface \"constant\"\nColor 0 0 0\n" + attributes +
           "Polygon \"P\" [-1 2.4 4  1 2.4 4  1 2.4 6  -1 2.4 6] \"st\" [0 0  1 0  1 1  0 1]\nAttributeEnd\nIlluminate " + h +
           " 1\n";
}

} // namespace

TEST(BlockLights, ObeyWhatSwitchesLightOff) {
    writeFacets();
    Settings none = pathSettings(), direct = none, rays = none, samples = none;
    none.indirect = none.direct = false;
    direct.indirect = false;
    rays.bsdfOnly = true;
    samples.lightOnly = true;
    for (const Settings& s : {none, direct, rays, samples})
        for (const std::string& more : {std::string(), kSky, manyLights(6), "Opacity .5 .6 .7\n" + kFog})
            expectSameBits(roomOf("\"facets\"", more), s, .3,
                           more + std::to_string(s.direct) + std::to_string(s.indirect) + std::to_string(s.bsdfOnly));
    writeShader("cares", R"(surface cares() {
    normal n = faceforward(normalize(N), I);
    color c = trace(P, vector(n), "distribution", "cosine", "samplecone", PI / 2, "samplearealights", 1, "type", "diffuse");
    Ci = Cs * (comp(c, 1) > .1 ? c : .3 * c);
})");
    for (const Settings& s : {direct, rays, samples}) expectSameBits(roomOf("\"cares\"", kSky), s, .3, "a kernel that waits");
}

TEST(BlockLights, AnswerWhatLightsAskOfSurfaces) {
    writeShader("asksarea", R"(light asksarea(float intensity = 3) {
    float shine = 0, hump = 0;
    color tint = 1;
    surface("shine", shine); surface("tint", tint); displacement("hump", hump);
    illuminate(P, N, PI / 2) Cl = intensity * (.2 + shine + hump) * tint;
})");
    writeShader("askspoint", R"(light askspoint(float intensity = 5) {
    float shine = 0;
    surface("shine", shine);
    illuminate(point "shader" (0, 2, 4)) Cl = intensity * (.2 + shine) / (L . L);
})");
    writeShader("askssky", R"(light askssky() {
    float shine = 0;
    surface("shine", shine);
    solar() Cl = .3 * (.2 + shine);
})");
    writeShader("asksambient", R"(light asksambient() { float shine = 0; surface("shine", shine); Cl = .2 * (1 + shine); })");
    const std::string parameters = "output varying float shine = .5; output varying color tint = 1;";
    writeShader("answers", "surface answers(" + parameters + R"() {
    normal n = faceforward(normalize(N), I);
    Ci = .2 * Cs * ambient();
    shine = .4 * mod(floor(9 * u), 3);
    tint = color(.5, u, v);
    Ci += Cs * (.4 * diffuse(n) + .2 * specular(n, -normalize(I), .2))
        + .2 * trace(P, vector n, "distribution", "oren-nayar", "roughness", .5, "samplearealights", 1)
        + .1 * trace(P, reflect(normalize(I), n));
    Oi = Os;
})");
    writeShader("milkyanswers", "surface milkyanswers(" + parameters + R"() {
    normal n = faceforward(normalize(N), I);
    shine = .4 * mod(floor(9 * u), 3);
    Ci = Cs * subsurface(P, n, "scattering", color(20, 30, 40), "absorption", color(.5, .2, .1), "ior", 1.3) + .2 * diffuse(n);
})");
    writeShader("waitsandanswers", "surface waitsandanswers(" + parameters + R"() {
    normal n = faceforward(normalize(N), I);
    shine = .4 * mod(floor(9 * u), 3);
    color c = trace(P, vector(n), "distribution", "cosine", "samplecone", PI / 2, "samplelights", 1, "type", "diffuse");
    shine = 1;
    Ci = Cs * (comp(c, 1) > .1 ? c : .3 * c);
})");
    writeShader("humps", R"(displacement humps(output varying float hump = 0;) {
    hump = .5 * mod(floor(9 * v), 2);
    P += .03 * sin(20 * u) * normalize(N);
    N = calculatenormal(P);
})");
    const std::string all = lampOf("\"asksarea\"") + "LightSource \"askspoint\" 78\nLightSource \"askssky\" 79\n"
                                                     "LightSource \"asksambient\" 80\n";
    const std::string humps = "ShadingRate 2500\nAttribute \"displacementbound\" \"float sphere\" .1\nDisplacement \"humps\"\n";
    expectSameBits(roomOf("\"answers\"", all + humps), pathSettings(), .3, humps, 1); // ends under the sky
    size_t turn = 0; // not nightly: every other scene of each shader
    for (const char* shader : {"\"answers\"", "\"milkyanswers\"", "\"waitsandanswers\""}) {
        for (const std::string& more : {all, all + kFog, all + "Opacity .5 .6 .7\n", all + manyLights(6)})
            if (chosen(turn++, 2)) expectSameBits(roomOf(shader, more), pathSettings(), .3, shader + more);
        ++turn;
    }
}

TEST(BlockLights, KeepWhatLightsWriteToOutputs) {
    writeShader("tells", R"(light tells(float by = 5) {
    illuminate(P, N, PI / 2) { Cl = by; if (xcomp(Ps) > .2) outputchannel("told", by * (1 + ycomp(P))); }
})");
    writeShader("tellspoint", R"(light tellspoint(float by = 7) {
    illuminate(point "shader" (0, 2, 4)) { Cl = by / (L . L); if (ycomp(Ps) > 0) outputchannel("told", by); }
})");
    writeShader("tellswide", R"(light tellswide(float by = 3) {
    illuminate(P, N, PI / 2) { Cl = by * min(10 * area(P), 1); outputchannel("wide", by + area(P)); }
})");
    writeFacets();
    Settings s = pathSettings();
    s.outputs = {{"told"}, {"wide"}};
    const std::string tellers =
        lampOf("\"tells\"") + "LightSource \"tellspoint\" 78\n" + lampOf("\"tellswide\"", 79, "Sides 1\n");
    for (const std::string& more : {tellers, tellers + kFog, tellers + manyLights(6), tellers + "Opacity .5 .6 .7\n"}) {
        expectSameBits(roomOf("\"facets\"", more), s, .3, more);
        float told = 0, wide = 0;
        for (const SampleResult& r : trace(roomOf("\"facets\"", more), true, 16, -1, s).samples) {
            told = std::max(told, r.aovs[0]);
            wide = std::max(wide, r.aovs[1]);
        }
        EXPECT_GE(told, 7) << more;
        EXPECT_GT(wide, 3) << more;
    }
}

TEST(BlockLights, TakeOneOfTheSamplesThatLightsMake) {
    writeShader("makes", R"(class makes(float intensity = 2;) {
    public void generateSamples(string integrationdomain; output __radiancesample samples[]) {
        uniform float i;
        resize(samples, 3);
        for (i = 0; i < 3; i += 1) {
            vector to = point "shader" (2 * i - 2, 2, 4) - Ps;
            samples[i]->direction = normalize(to);
            samples[i]->distance = length(to);
            samples[i]->setLightRadiance(intensity * color(1, i, .5) / (to . to), 1);
        }
    }
})");
    writeFacets();
    const std::string light = "LightSource \"makes\" 77\n";
    for (const std::string& more : {light, light + kFog, light + manyLights(6)})
        expectSameBits(roomOf("\"facets\"", more), pathSettings(), .3, more);
}

TEST(BlockLights, FollowLightsThatTrace) {
    writeShader("sees", R"(light sees(float part = 1) {
    illuminate(point "shader" (0, 2, 4)) Cl = part * (trace(Ps, vector "shader" (0, 1, .3)) + .5);
})");
    writeShader("shades", R"(light shades(float part = 9) {
    illuminate(point "shader" (1, 2, 4)) Cl = part * transmission(Ps, point "shader" (1, 2, 4)) / (L . L);
})");
    writeShader("waitsabove", R"(light waitsabove(float part = 1) {
    illuminate(P, N, PI / 2) {
        color c = trace(Ps, vector "shader" (0, 1, .3));
        if (comp(c, 0) >= .2) Cl = part;
        else Cl = part * c;
    }
})");
    writeFacets();
    const std::string lights = "LightSource \"sees\" 77\nLightSource \"shades\" 78\n" + lampOf("\"waitsabove\"", 79);
    Settings local = pathSettings();
    local.localRoulette = true;
    for (const Settings& s : {pathSettings(), local})
        for (const std::string& more : {lights, lights + "Opacity .5 .6 .7\n"})
            expectSameBits(roomOf("\"facets\"", more), s, .3, more);
    expectSameBits(roomOf("\"facets\"", lights + kFog), pathSettings(), .3, kFog, 3);
    expectSameBits(roomOf("\"matte\"", lights + manyLights(6)), pathSettings(), .3, "many", 3);
}

TEST(BlockLights, ChooseOfTheLightsThatAreOnWhereListsShareOne) {
    writeFacets(); // the later half of the balls is not lit by some of the lights
    for (const std::string& many : {std::string(), manyLights(6)})
        for (const std::string& more : {kSky, kFog})
            for (const char* shader : {"\"plastic\"", "\"facets\""}) {
                std::string rib = roomOf(shader, many + more);
                const size_t half = rib.find("AttributeBegin\nColor [0.680");
                ASSERT_NE(half, std::string::npos);
                rib.insert(half, "Illuminate 1 0\nIlluminate 4 0\n" + std::string(many.empty() ? "" : "Illuminate 25 0\n"));
                Traced traced[2];
                for (const bool blocks : {false, true}) {
                    Settings s = pathSettings();
                    s.rowRequests = blocks;
                    s.listedLights = 0;
                    Scene scene(rib, s);
                    traced[blocks] = trace(scene);
                }
                EXPECT_GT(sumOf(traced[0]), 1) << many << more << shader;
                EXPECT_EQ(differences(traced[0], traced[1]), 0u) << many << more << shader;
                EXPECT_GT(traced[1].inRows, traced[1].points / 3) << many << more << shader;
            }
}

TEST(BlockLights, ChooseAmongManyAsTheCallsOfTheirPointsSay) {
    // Wide lights of one program and of several; calls with a bias, a limit of distance, an origin of their own.
    writeShader("filters", R"(light filters(float intensity = 3) {
    illuminate(P, N, PI / 2) Cl = intensity * (.2 + min(10 * area(P), 1)) * filterstep(.5, mod(9 * s, 1));
})");
    writeShader("near", R"(surface near() {
    normal n = faceforward(normalize(N), I);
    float some = mod(floor(9 * u), 3), i;
    Ci = Cs * (.3 * diffuse(n)
       + .3 * trace(P, n, "distribution", "oren-nayar", "roughness", .5, "samplelights", 1, "bias", .05 * some, "maxdist",
                    1 + 2 * v)
       + .2 * trace(P, reflect(normalize(I), n), "samplecone", .2, "samplearealights", 1, "maxdist", 2)
       + .1 * trace(P + .1 * some * n, vector n, "samplecone", 1, "samplearealights", 1));
    for (i = 0; i < some; i += 1)
        Ci += .1 * trace(P, n, "distribution", "ggx", "roughness", .2 + .2 * i, "wo", -I, "samplearealights", 1, "maxdist",
                         3 + i);
})");
    writeFacets();
    const std::string wide = lampOf("\"filters\"") + lampOf("\"filters\" \"float intensity\" 5", 78) +
                             "AttributeBegin\nTranslate 2 0 0\n" + lampOf("\"filters\" \"float intensity\" 2", 79) +
                             "AttributeEnd\nIlluminate 79 1\n";
    Settings local = pathSettings();
    local.localRoulette = true;
    for (const char* shader : {"\"near\"", "\"facets\""})
        for (const std::string& more : {std::string(), kSky, std::string("Opacity .5 .6 .7\n"), kFog})
            for (const Settings& s : {pathSettings(), local})
                expectSameBits(roomOf(shader, manyLights(6) + wide + more), s, .3, more);
}

TEST(BlockLights, SeeEmittersThroughAtmospheresAndMedia) {
    writeFacets();
    const std::string haze = "Atmosphere \"fog\" \"distance\" 5 \"background\" [.3 .2 .1]\n";
    const std::string lamp = lampOf("\"slrect\" \"float intensity\" 4", 77, haze);
    const std::string clear = "AttributeBegin\nInterior \"medium\" \"color scattering\" [0 0 0] \"color absorption\" [.1 .2 .1]\n"
                              "Surface \"null\"\nTranslate 0 0 5\nSphere 2.2 -2.2 2.2 360\nAttributeEnd\n";
    for (const std::string& more : {lamp, lamp + kFog, lamp + clear, lamp + clear + manyLights(6)})
        expectSameBits(roomOf("\"facets\"", more), pathSettings(), .3, more);
}

TEST(BlockLights, KeepTheStrategiesOfLights) {
    writeShader("both", R"(surface both() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * (.4 * diffuse(n) + .2 * trace(P, n, "distribution", "oren-nayar", "roughness", .5, "samplelights", 1)
       + .2 * trace(P, reflect(normalize(I), n), "samplecone", .2, "samplearealights", 1));
})");
    writeShader("unsampled", "light unsampled(float __importancesample = 0;) { illuminate(P, N, PI / 2) Cl = 2; }\n");
    const auto of = [](const std::string& strategy) {
        return "Attribute \"light\" \"string samplingstrategy\" \"" + strategy + "\"\n";
    };
    const std::string lights =
        "AttributeBegin\n" + of("illuminance") + "LightSource \"pointlight\" 77 \"intensity\" 5 \"from\" [0 1 3]\n" +
        "AttributeEnd\nIlluminate 77 1\n" + lampOf("\"slrect\" \"float intensity\" 4", 78, "") + "AttributeBegin\n" +
        of("illuminance") + lampOf("\"slrect\" \"float intensity\" 3", 79) + "AttributeEnd\nIlluminate 79 1\nAttributeBegin\n" +
        of("trace") + lampOf("\"unsampled\"", 80) + "AttributeEnd\nIlluminate 80 1\n";
    for (const std::string& more : {lights, lights + manyLights(6)})
        expectSameBits(roomOf("\"both\"", more), pathSettings(), .3, more);
}

TEST(BlockLights, TakeAsManySamplesAsRays) {
    writeShader("lookup", R"(surface lookup(float samples = 3;) {
    normal n = faceforward(normalize(N), I);
    float some = 1 + mod(floor(9 * u), 3);
    Ci = Cs * (.4 * trace(P, n, "distribution", "oren-nayar", "roughness", .5, "samplelights", 1, "samples", samples * some)
       + .2 * trace(P, n, "distribution", "ggx", "roughness", .3, "wo", -I, "samplearealights", 1, "samples", 2, "maxdist", 4)
       + .1 * trace(P, reflect(normalize(I), n), "samplecone", .1));
    Oi = Os;
})");
    writeShader("lookwaits", R"(surface lookwaits(float samples = 3;) {
    normal n = faceforward(normalize(N), I);
    color c = trace(P, n, "distribution", "oren-nayar", "roughness", .5, "samplelights", 1, "samples", samples);
    Ci = Cs * (comp(c, 1) > .1 ? c : .3 * c);
})");
    writeShader("solarcone", R"(light solarcone() { solar(vector "shader" (-1, -1, 1), .1) Cl = .3; })");
    writeShader("tellswide", R"(light tellswide(float by = 3) {
    illuminate(P, N, PI / 2) { Cl = by * min(10 * area(P), 1); outputchannel("wide", by + area(P)); }
})");
    const std::string shadows = "Attribute \"light\" \"string shadows\" \"on\"\n";
    const std::string lights = "AttributeBegin\n" + shadows +
                               "LightSource \"pointlight\" 77 \"intensity\" 5 \"from\" [0 1 3] \"float radius\" .2\n" +
                               "AttributeEnd\nIlluminate 77 1\nLightSource \"solarcone\" 78\n" + lampOf("\"tellswide\"", 79);
    size_t turn = 0; // not nightly: every two of hider, shader and scene have their turn
    for (const Hider hider : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        for (const char* shader : {"\"lookup\"", "\"lookup\" \"samples\" 9", "\"lookwaits\" \"samples\" 1", "\"lookwaits\""}) {
            for (const std::string& more : {lights, lights + kSky + "Opacity .5 .6 .7\n", lights + manyLights(6)}) {
                if (!chosen(turn++, 3)) continue;
                Settings s = under(hider);
                s.outputs = {{"wide"}};
                expectSameBits(roomOf(shader, more), s, std::string(shader) == "\"lookwaits\"" ? -1 : .2,
                               shader + more + std::to_string(int(hider)), 1);
            }
            ++turn;
        }
    }
}

TEST(BlockLights, SampleWhatTheRaysOfACallHit) {
    writeShader("sets", R"(surface sets() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * (.2 * trace(P, n, "distribution", "oren-nayar", "roughness", .5, "samplelights", 1, "hitsides", "both")
       + .2 * trace(P, n, "distribution", "ggx", "roughness", .3, "wo", -I, "samplearealights", 1, "hitsides", "back",
                    "maxdist", 4)
       + .2 * trace(P, n, "distribution", "cosine", "samplecone", PI / 2, "samplearealights", 1, "subset", "some")
       + .2 * trace(P, n, "distribution", "cosine", "samplecone", PI / 2, "samplelights", 1, "hitmode", "primitive"));
    Oi = Os;
})");
    writeShader("setsandloops", R"(surface setsandloops() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * (.2 * diffuse(n) + .2 * specular(n, -normalize(I), .2)
       + .2 * trace(P, n, "distribution", "oren-nayar", "roughness", .5, "samplelights", 1, "subset", "some", "hitmode", "shader")
       + .2 * trace(P, n, "distribution", "ggx", "roughness", .3, "wo", -I, "samplearealights", 1, "hitsides", "front"));
    Oi = Os;
})");
    const std::string in = "Attribute \"grouping\" \"string membership\" \"some\"\n";
    const std::string lights = lampOf("\"slrect\" \"float intensity\" 4", 77, in + "Sides 1\n") +
                               "AttributeBegin\nScale 1 -1 1\n" + lampOf("\"slrect\" \"float intensity\" 2", 78, "Sides 1\n") +
                               "AttributeEnd\nIlluminate 78 1\n" + "AttributeBegin\n" + in +
                               "Surface \"constant\"\nOpacity .3 .4 .5\nTranslate 0 1 4\nSphere .3 -.3 .3 360\nAttributeEnd\n";
    for (const Hider hider : {Hider::Path, Hider::Raytrace})
        for (const char* shader : {"\"sets\"", "\"setsandloops\""})
            for (const std::string& more : {lights, lights + "Opacity .5 .6 .7\n", lights + manyLights(6)})
                expectSameBits(roomOf(shader, more), under(hider), hider == Hider::Path ? .3 : -1, shader + more, 2);
}

TEST(BlockLights, LightTheExitsOfWalks) {
    // Where the surface is clear, the energy rule leaves nothing of the light of surfaces.
    writeShader("thinmilk", R"(surface thinmilk() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * subsurface(P, n, "scattering", color(20, 30, 40), "absorption", color(.5, .2, .1), "ior", 1.3);
    Oi = mod(floor(9 * u), 3) / 2;
})");
    expectSameBits(roomOf("\"thinmilk\"", kSky), pathSettings(), .3, "thin", 2);
    writeShader("milky", R"(surface milky() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * subsurface(P, n, "scattering", color(20, 30, 40), "absorption", color(.5, .2, .1), "ior", 1.3);
})");
    for (const Hider hider : {Hider::Hidden, Hider::Raytrace})
        expectSameBits(roomOf("\"milky\"", hider == Hider::Hidden ? kSky : manyLights(6)), under(hider), -1, "milky", 2);
}

} // namespace blocklights_test
