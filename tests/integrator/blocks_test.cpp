// Vertices that are followed 16 at a time (integrator/blockvertices.h) have the bits of those that go one by one.
#include "display/imageio.h"
#include "integrator/harness.h"
#include "scene/lightpaths.h"
#include <cmath>

namespace blocks_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

struct Traced {
    std::vector<SampleResult> samples;
    uint64_t inBlocks, points, cut;
};
Settings pathSettings() {
    Settings s;
    s.hider = Hider::Path;
    return s;
}
Traced trace(const std::string& rib, bool blocks, int lanes = 16, int maxDepth = -1, Settings s = pathSettings()) {
    s.maxDepth = maxDepth;
    s.blocks = blocks;
    s.lanes = lanes;
    Scene scene(rib, s);
    std::vector<CameraRay> rays;
    const int side = nightly() ? 30 : 20;
    for (int i = 0; i < side * side; ++i) {
        CameraRay r = rayTo({0, 0, 0}, {float(i % side) / float(side) - .48f, float(i / side) / float(side) - .48f, 1});
        r.px = i % side, r.py = i / side, r.sample = uint32_t(i % 5), r.spread = .001f;
        rays.push_back(r);
    }
    Traced t;
    t.samples.resize(rays.size());
    Integrator integrator(scene.world, scene.diagnostics);
    integrator.trace(rays, t.samples, nullptr);
    t.inBlocks = integrator.counters().inBlocks;
    t.points = integrator.counters().points;
    t.cut = integrator.counters().depthCap;
    return t;
}

const char* const kLights =
    "LightSource \"pointlight\" 1 \"intensity\" 9 \"from\" [1 2 3] \"float radius\" .3\n"
    "LightSource \"distantlight\" 2 \"intensity\" .4 \"from\" [1 1 -1] \"to\" [0 0 0]\n"
    "LightSource \"ambientlight\" 3 \"intensity\" .2\n"
    "AttributeBegin\nAreaLightSource \"slrect\" 4 \"float intensity\" 5\nSurface \"constant\"\nColor 0 0 0\n"
    "Polygon \"P\" [-1 2.5 4  1 2.5 4  1 2.5 6  -1 2.5 6]\nAttributeEnd\n"
    "AttributeBegin\nAreaLightSource \"arealight\" 5 \"float intensity\" 2\nSurface \"constant\"\nTranslate -2 1 4\n"
    "Sphere .3 -.3 .3 360\nAttributeEnd\n"
    "AttributeBegin\nAreaLightSource \"slrect\" 6 \"float intensity\" 3\nSurface \"constant\"\nColor 0 0 0\n"
    "Polygon \"P\" [1.5 -1 4  1.5 0 4  1.5 0 4.5  1.5 -1 4.5]\nAttribute \"visibility\" \"int diffuse\" 0\n"
    "Polygon \"P\" [-1.5 0 3  -1.5 .7 3.2  -1.5 0 3.6]\nAttributeEnd\n"
    "LightSource \"spotlight\" 7 \"intensity\" 9 \"from\" [0 2 3] \"to\" [0 0 5] \"coneangle\" .7\n"
    "Illuminate 4 1\nIlluminate 5 1\nIlluminate 6 1\n";

/// A room of balls of one shader.
std::string roomOf(const std::string& shader, const std::string& more = "") {
    std::string s = "WorldBegin\nSides 2\n" + std::string(kLights) + more + "Surface " + shader + "\n";
    for (int i = 0; i < 9; ++i)
        s += "AttributeBegin\nColor [" + std::to_string(.2 + .08 * i) + " .6 .7]\nTranslate " + std::to_string(i % 3 - 1) + " " +
             std::to_string(i / 3 - 1) + " " + std::to_string(4 + .2 * i) + "\nSphere .4 -.4 .4 360\nAttributeEnd\n";
    return s + "Polygon \"P\" [-9 -2 0  -9 -2 20  9 -2 20  9 -2 0]\nPolygon \"P\" [-9 -9 9  -9 9 9  9 9 9  9 -9 9]\nWorldEnd\n";
}

/// Lamps of all kinds, so many that chance chooses among them.
std::string manyLights(double brightest) {
    std::string s;
    int handle = 20;
    const auto at = [](int i, float y) {
        return std::to_string(std::sin(float(i)) * 3) + " " + std::to_string(y) + " " +
               std::to_string(4 + 3 * std::cos(float(i)));
    };
    for (int i = 0; i < 12; ++i)
        s += "LightSource \"pointlight\" " + std::to_string(handle++) + " \"intensity\" 1 \"from\" [" + at(i, 2) + "]" +
             (i % 3 == 0 ? " \"float radius\" .2\n" : "\n");
    for (int i = 0; i < 3; ++i)
        s += "LightSource \"distantlight\" " + std::to_string(handle++) + " \"intensity\" .1 \"from\" [" + at(i, 5) +
             "] \"to\" [0 0 0]\n";
    for (int i = 0; i < 12; ++i) {
        s += "AttributeBegin\nAreaLightSource \"slrect\" " + std::to_string(handle) + " \"float intensity\" " +
             std::to_string(i == 5 ? brightest : i + 1.) + (i == 7 ? " \"int __importancesample\" 0" : "") +
             "\nSurface \"constant\"\nColor 0 0 0\nTranslate " + at(5 * i, 1) + "\n";
        if (i % 4 == 0) s += "Sides 1\n";
        if (i % 5 == 4) s += "Attribute \"visibility\" \"int specular\" 0\n";
        s += "Polygon \"P\" [-.2 .3 -.2  .2 .3 -.2  .2 .3 .2  -.2 .3 .2]";
        s += i % 4 == 1 ? " \"constant float intensity\" [2]\n" : "\n";
        if (i % 3 == 0) s += "Polygon \"P\" [0 .5 0  .4 .5 0  0 .5 .9]\n";
        if (i % 6 == 5) s += "Sphere .1 -.1 .1 360\n";
        s += "AttributeEnd\nIlluminate " + std::to_string(handle++) + " 1\n";
    }
    return s + "LightSource \"envlight\" 90 \"float intensity\" .2\nIlluminate 90 1\n";
}

size_t differences(const Traced& a, const Traced& b) {
    size_t n = 0;
    for (size_t i = 0; i < a.samples.size(); ++i)
        n += !(a.samples[i].color == b.samples[i].color) || a.samples[i].z != b.samples[i].z ||
             a.samples[i].parts != b.samples[i].parts || !(a.samples[i].albedo == b.samples[i].albedo) ||
             !(a.samples[i].normal == b.samples[i].normal) || a.samples[i].aovs != b.samples[i].aovs;
    return n;
}
void writeFacets() {
    writeShader("facets", R"(surface facets() {
    normal n = faceforward(normalize(N), I);
    Ci = .4 * diffuse(n)
         + .5 * trace(P, vector n, "distribution", "ggx", "wo", -I, "roughness", .3, "eta", color(.2, .9, 1.1), "k", 3)
         + .2 * trace(P, vector n, "distribution", "oren-nayar", "roughness", .5, "samplearealights", 1);
    Oi = Os;
})");
}
double sumOf(const Traced& t) {
    double sum = 0;
    for (const SampleResult& s : t.samples) sum += s.color.x + s.color.y + s.color.z;
    return sum;
}
} // namespace

TEST(Blocks, HaveTheBitsOfSinglePoints) {
    writeShader("glossy", R"(surface glossy() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * (.9 * diffuse(n) + .8 * specular(n, -normalize(I), .2) + .2 * phong(n, -normalize(I), 9));
    if (xcomp(P) > 0) Ci += .3 * trace(P, reflect(normalize(I), n), "samplecone", .1, "samples", 3);
})");
    writeFacets();
    writeShader("cut", R"(surface cut() {
    Oi = mod(xcomp(8 * P), 1) < .5 ? Os : color(0);
    Ci = Oi * Cs * diffuse(faceforward(normalize(N), I));
})");
    for (const char* shader :
         {"\"matte\"", "\"plastic\"", "\"glossy\"", "\"facets\"", "\"cut\"", "\"slmaterial\"",
          "\"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [.9 1 1] \"float shininess\" 9",
          "\"slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float kn\" 1.5"}) {
        const std::string rib = roomOf(shader);
        const Traced one = trace(rib, false), all = trace(rib, true), narrow = trace(rib, true, 4);
        EXPECT_GT(sumOf(one), 1) << shader;
        EXPECT_EQ(one.inBlocks, 0u);
        EXPECT_GT(all.inBlocks, all.points / 3) << shader; // shadow rays run "cut" for its opacity
        EXPECT_EQ(differences(one, all), 0u) << shader;
        EXPECT_EQ(differences(one, narrow), 0u) << shader << ", kernels of 4 lanes";
    }
}

TEST(Blocks, ChooseAmongManyLights) {
    writeShader("both", R"(surface both() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * (.5 * diffuse(n) + .3 * specular(n, -normalize(I), .2))
         + .2 * trace(P, vector n, "distribution", "oren-nayar", "roughness", .5, "samplearealights", 1);
})");
    writeShader("own", R"(light own(float intensity = 1; varying float part = .5; color lightcolor = 1;) {
    illuminate(P, N, PI / 2) Cl = part * intensity * lightcolor;
})");
    const std::string own =
        "AttributeBegin\nAreaLightSource \"own\" 88 \"float intensity\" 3\nSurface \"constant\"\nColor 0 0 0\n"
        "Polygon \"P\" [-1 2 5  1 2 5  1 2 6  -1 2 6] \"varying float part\" [.1 .5 .9 .2]\nAttributeEnd\n"
        "AttributeBegin\nAreaLightSource \"own\" 89 \"float intensity\" 2\nSurface \"constant\"\nColor 0 0 0\n"
        "Polygon \"P\" [2 2 5  2 1 5  2 1 6  2 2 6]\nAttributeEnd\nIlluminate 88 1\nIlluminate 89 1\n";
    for (const char* shader : {"\"matte\"", "\"plastic\"", "\"both\"", "\"slmaterial\""})
        for (const std::string more : {"", "Opacity .5 .6 .7\n", own.c_str()}) {
            const std::string rib = roomOf(shader, manyLights(1e38) + more);
            const Traced one = trace(rib, false), all = trace(rib, true), narrow = trace(rib, true, 4);
            EXPECT_GT(sumOf(one), 1) << shader;
            EXPECT_EQ(one.inBlocks, 0u);
            EXPECT_GT(all.inBlocks, all.points / 3) << shader;
            EXPECT_EQ(differences(one, all), 0u) << shader << more;
            EXPECT_EQ(differences(one, narrow), 0u) << shader << more << ", kernels of 4 lanes";
        }
}

TEST(Blocks, FollowWhatKernelsWaitFor) {
    writeShader("threshold", R"(surface threshold(float samples = 1;) {
    normal n = faceforward(normalize(N), I);
    float dist = 0;
    color light = trace(P, vector(n), dist, "distribution", "cosine", "samplecone", PI / 2, "samplearealights", 1,
                        "samples", samples, "type", "diffuse");
    Ci = Cs * (comp(light, 1) > .1 ? light : .3 * light + color(0, .01, .03) * (dist < 1e30 ? 1 : 0));
})");
    writeShader("twice", R"(surface twice() {
    normal n = faceforward(normalize(N), I);
    color a = trace(P, vector(n), "distribution", "oren-nayar", "roughness", .4, "samplearealights", 1), b = 0;
    if (comp(a, 0) > .2) b = trace(P, reflect(normalize(I), n));
    else b = trace(P, reflect(normalize(I), n), "samplecone", .2) * trace(P, vector(n), "samplecone", 1);
    Ci = .6 * Cs * a + .3 * b * b;
})");
    writeShader("around", R"(surface around() {
    normal n = faceforward(normalize(N), I);
    float i;
    color c = 0;
    for (i = 0; i < 3; i += 1) {
        color t = trace(P, vector(n), "distribution", "cosine", "samplecone", PI / 2);
        c += t * t;
    }
    Ci = .2 * Cs * c;
})");
    size_t turn = 0; // not nightly: every two of shader, scene and depth have their turn
    for (const char* shader : {"\"threshold\"", "\"threshold\" \"samples\" 3", "\"twice\"", "\"around\""}) {
        for (const std::string& more : {std::string(), std::string("Opacity .5 .6 .7\n"), manyLights(6)}) {
            size_t of = turn++;
            for (const int depth : {0, 2, 9}) {
                if (!chosen(of++, 3)) continue;
                const std::string rib = roomOf(shader, more);
                const Traced one = trace(rib, false, 16, depth), all = trace(rib, true, 16, depth);
                EXPECT_GT(sumOf(one), 1) << shader;
                EXPECT_EQ(one.inBlocks, 0u);
                if (std::string(shader) == "\"threshold\"" && depth > 0)
                    EXPECT_GT(all.inBlocks, all.points / 2) << shader << depth;
                EXPECT_EQ(differences(one, all), 0u) << shader << more << depth;
                EXPECT_EQ(differences(one, trace(rib, true, 4, depth)), 0u) << shader << more << depth;
                EXPECT_EQ(one.cut, all.cut) << shader << more << depth;
            }
        }
        ++turn;
    }
}

TEST(Blocks, LetLightThroughAndLeaveWhatNeedsALook) {
    writeShader("many", R"(surface many() {
    normal n = faceforward(normalize(N), I);
    float i;
    for (i = 0; i < 40; i += 1) Ci += .015 * Cs * diffuse(n);
})");
    writeShader("tiny", R"(surface tiny() { Ci = diffuse(normal(1e-25 * normalize(N))); })");
    for (const char* shader : {"many", "tiny"}) {
        const std::string rib = roomOf("\"" + std::string(shader) + "\"");
        const Traced one = trace(rib, false), all = trace(rib, true);
        EXPECT_GT(sumOf(one), 1) << shader;
        EXPECT_EQ(differences(one, all), 0u) << shader;
        EXPECT_LT(all.inBlocks, all.points) << shader;
    }
    for (const char* shader : {"\"matte\"", "\"facets\"", "\"glossy\""}) {
        const std::string rib = roomOf(shader, "Opacity .5 .6 .7\nAttribute \"trace\" \"bias\" .01\n");
        const Traced all = trace(rib, true);
        EXPECT_EQ(differences(trace(rib, false), all), 0u) << shader;
        EXPECT_GT(all.inBlocks, all.points / 2) << shader;
    }
}

TEST(Blocks, TellOfLightWhatOutputsAsk) {
    writeShader("apart", R"(surface apart(output varying color soft = 0, sheen = 0;) {
    normal n = faceforward(normalize(N), I);
    soft = Cs * diffuse(n);
    sheen = .4 * specular(n, -normalize(I), .2);
    Ci = .8 * soft + sheen;
})");
    writeFacets();
    Settings local = pathSettings(), first = local, paths = local, outputs = local;
    local.localRoulette = first.firstSeen = true;
    Diagnostics d;
    paths.lightPaths = std::make_shared<scene::LightPaths>(
        std::vector<scene::LightPaths::Source>{{"C<RD>L", {}}, {"C<RG>[LO]", {}}, {"C.*<RD>.+L", {}}}, d);
    ASSERT_EQ(d.all().size(), 0u);
    outputs.outputs = {{"soft"}, {"sheen"}};
    writeShader("bumpy", R"(displacement bumpy() { P += .03 * sin(20 * u) * normalize(N); N = calculatenormal(P); })");
    const std::string bumpy = "ShadingRate 16\nAttribute \"displacementbound\" \"float sphere\" .1\nDisplacement \"bumpy\"\n";
    const std::string inside = "Interior \"medium\" \"color scattering\" [0 0 0] \"color absorption\" [.2 .5 .3]\n";
    const std::string fog = "Atmosphere \"fog\" \"distance\" 9 \"background\" [.3 .2 .1]\n";
    size_t turn = 0; // not nightly: every setting and scene, and each of both with both shaders
    for (const Settings& s : {pathSettings(), local, first, paths, outputs}) {
        for (const std::string& more :
             {std::string(), fog, fog + "Opacity .5 .6 .7\n", inside + "Opacity .5 .6 .7\n", bumpy, manyLights(6)}) {
            size_t of = turn++;
            for (const char* shader : {"\"apart\"", "\"facets\""}) {
                if (!chosen(of++, 2) || (more == bumpy && !s.lightPaths)) continue; // to dice the room takes long
                const std::string rib = roomOf(shader, more);
                const Traced one = trace(rib, false, 16, -1, s), all = trace(rib, true, 16, -1, s);
                EXPECT_GT(sumOf(one), 1) << shader << more;
                EXPECT_EQ(differences(one, all), 0u) << shader << more;
                EXPECT_EQ(differences(one, trace(rib, true, 4, -1, s)), 0u) << shader << more;
                EXPECT_GT(all.inBlocks, s.outputs.empty() ? all.points / 4 : 0) << shader << more;
            }
        }
        ++turn; // the number of scenes is even
    }
}

TEST(Blocks, AreFollowedThroughFog) {
    // Fog about the eye and all else but a wall, and milk in it; with lamps that are rows, that are none, and more than are
    // asked.
    const auto fog = [](const std::string& more) {
        return "AttributeBegin\nSurface \"null\" Interior \"medium\" \"color scattering\" [.1 .12 .2] "
               "\"color absorption\" [.02 .01 .03] \"float anisotropy\" .4 " +
               more + "\nTranslate 0 0 5\nSphere 7.5 -7.5 7.5 360\nAttributeEnd\n";
    };
    const std::string milk =
        "AttributeBegin\nSurface \"null\" Interior \"medium\" \"color scattering\" [5 5 4] \"color emission\" "
        "[.1 0 0] \"float anisotropy\" -.2 \"float priority\" 1\nTranslate 0 .5 4\nSphere .7 -.7 .7 360\n"
        "AttributeEnd\n";
    const std::string biased = "Attribute \"trace\" \"bias\" .01\n";
    Diagnostics d;
    Settings paths = pathSettings(), local = paths, byDistance = paths;
    paths.lightPaths = std::make_shared<scene::LightPaths>(
        std::vector<scene::LightPaths::Source>{{"C<RD>L", {}}, {"CV.*[LO]", {}}, {"C.*<RD>.+L", {}}}, d);
    ASSERT_EQ(d.all().size(), 0u);
    local.localRoulette = true;
    byDistance.mediumSampling = MediumSampling::Distance;
    size_t i = 0; // not nightly: every two of settings, scene, shader and depth have their turn
    for (const Settings& s : {pathSettings(), paths, local, byDistance}) {
        size_t j = 0;
        for (const std::string& more :
             {fog(""), fog("") + milk + "Opacity .5 .6 .7\n", biased + fog(""), fog("") + manyLights(6)}) {
            size_t k = 0;
            for (const char* shader : {"\"matte\"", "\"plastic\""}) {
                const bool turn = chosen(i + j + k++, 2);
                size_t l = 0;
                for (const int depth : {1, -1}) {
                    if (!turn || !chosen(i / 2 + j + l++, 2)) continue;
                    const std::string rib = roomOf(shader, more);
                    const Traced one = trace(rib, false, 16, depth, s), all = trace(rib, true, 16, depth, s);
                    EXPECT_GT(sumOf(one), 1) << shader << more;
                    EXPECT_EQ(one.inBlocks, 0u);
                    EXPECT_GT(all.inBlocks, all.points / (depth < 0 ? 4 : 8))
                        << shader << more; // at the end skies are looked for
                    EXPECT_EQ(differences(one, all), 0u) << shader << more << depth;
                    EXPECT_EQ(differences(one, trace(rib, true, 4, depth, s)), 0u) << shader << more << depth;
                    EXPECT_EQ(one.cut, all.cut) << shader << more << depth;
                }
            }
            ++j;
        }
        ++i;
    }
}

TEST(Blocks, EndPathsWhereTheyAreAsLongAsTheyMayBe) {
    for (const char* shader :
         {"\"matte\"", "\"plastic\"", "\"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [.9 1 1]"})
        for (const std::string more : {"", "Opacity .5 .6 .7\n", "LightSource \"envlight\" 9 \"intensity\" .3\n"})
            for (int depth = 0; depth < 4; ++depth) {
                const std::string rib = roomOf(shader, more);
                const Traced one = trace(rib, false, 16, depth), all = trace(rib, true, 16, depth);
                EXPECT_GT(sumOf(one), 1) << shader << more << depth;
                EXPECT_EQ(differences(one, all), 0u) << shader << more << depth;
                EXPECT_EQ(one.cut, all.cut) << shader << more << depth;
                EXPECT_GT(all.cut, 0u) << shader << more << depth;
                EXPECT_GT(all.inBlocks, all.points / 3) << shader << more << depth; // shadow rays ask for opacity, too
            }
}

TEST(Blocks, FollowLobesToTheDepthsOfTheirSurfaces) {
    writeShader("two", R"(surface two() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * (.4 * diffuse(n) + .3 * specular(n, -normalize(I), .3) + .2 * trace(P, reflect(normalize(I), n)));
    Oi = Os;
})");
    const std::string sky = "LightSource \"envlight\" 9 \"intensity\" .3\n", clear = "Opacity .5 .6 .7\n";
    const std::string fog = "AttributeBegin\nSurface \"null\" Interior \"medium\" \"color scattering\" [.1 .12 .2]\n"
                            "Translate 0 0 5\nSphere 7.5 -7.5 7.5 360\nAttributeEnd\n";
    const std::string matte = "AttributeBegin\nMatte 1\nSurface \"two\"\nTranslate .3 .2 3\nSphere .5 -.5 .5 360\nAttributeEnd\n";
    for (const std::string& more : {sky, clear + sky, fog, matte})
        for (const auto& [diffuse, specular] : {std::pair(0, 0), {1, 0}, {0, 2}, {2, -1}, {-1, 1}}) {
            const std::string rib = roomOf("\"two\"", "Attribute \"trace\" \"int maxdiffusedepth\" " + std::to_string(diffuse) +
                                                          " \"int maxspeculardepth\" " + std::to_string(specular) + "\n" + more);
            const Traced one = trace(rib, false), all = trace(rib, true), narrow = trace(rib, true, 4);
            EXPECT_GT(sumOf(one), 1) << more << diffuse << specular;
            EXPECT_EQ(differences(one, all), 0u) << more << diffuse << specular;
            EXPECT_EQ(differences(one, narrow), 0u) << more << diffuse << specular;
            EXPECT_EQ(one.cut, all.cut) << more << diffuse << specular;
            EXPECT_GT(all.inBlocks, all.points / 3) << more << diffuse << specular;
        }
}

TEST(Blocks, FollowLoopsAndWalksBelowSurfaces) {
    // Turns without a weight, of different number at neighbouring points, with lights and without.
    writeShader("turns", R"(surface turns() {
    normal n = faceforward(normalize(N), I);
    color sum = .2 * diffuse(n);
    float i, many = 1 + mod(floor(40 * u), 3);
    for (i = 0; i < many; i += 1) {
        float w = mod(floor(30 * v) + i, 3) * .12;
        sum += w * specular(n, -normalize(I), .1 + .1 * i);
        sum += .1 * trace(P, reflect(normalize(I), normalize(n + .1 * i * vector(xcomp(P), 1, 0))), "samplecone", .1 * i);
    }
    Ci = Cs * sum;
})");
    writeShader("milky", R"(surface milky() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * subsurface(P, n, "scattering", color(20, 30, 40), "absorption", color(.5, .2, .1), "ior", 1.3)
         + .2 * specular(n, -normalize(I), .2);
    Oi = Os;
})");
    writeShader("apart2", R"(surface apart2() {
    normal n = faceforward(normalize(N), I);
    Ci = Cs * (.6 * diffuse(n) + .1 * specular(n, -normalize(I), .2));
    if (mod(floor(9 * u), 3) > 0) Ci += mod(floor(9 * v), 2) * .5 * Cs * indirectdiffuse(P, n, 4);
})");
    writeShader("near", R"(surface near() {
    normal n = faceforward(normalize(N), I);
    float some = mod(floor(9 * u), 3);
    Ci = Cs * (.3 * diffuse(n)
       + .3 * trace(P, n, "distribution", "oren-nayar", "roughness", .5, "samplelights", 1, "bias", .05 * some, "maxdist",
                    1 + 2 * v)
       + .2 * trace(P, reflect(normalize(I), n), "samplecone", .2, "samplearealights", 1, "maxdist", 2, "weight", color(some))
       + .2 * indirectdiffuse(P, n, 4, "maxdist", 3, "falloff", some, "bias", .01));
})");
    writeShader("away", R"(surface away() {
    normal n = faceforward(normalize(N), I);
    float some = mod(floor(9 * u), 2);
    Ci = .3 * Cs * diffuse(n) + .4 * trace(P + .1 * some * n, vector n, "samplecone", 1, "samplearealights", 1, "samples", 2)
         + .2 * trace(P + .1 * some * n, reflect(normalize(I), n));
})");
    const std::string sky = "LightSource \"envlight\" 9 \"intensity\" .3\n";
    const std::string shallow = "Attribute \"trace\" \"int maxdiffusedepth\" 1 \"int maxspeculardepth\" 1\n";
    Settings local = pathSettings();
    local.localRoulette = true;
    size_t turn = 0; // not nightly: a third of shader, scene and setting, each of them several times
    for (const char* shader : {"\"turns\"", "\"milky\"", "\"apart2\"", "\"near\"", "\"away\""})
        for (const std::string& more : {std::string(), sky, shallow, sky + "Opacity .5 .6 .7\n"})
            for (const Settings& s : {pathSettings(), local}) {
                if (!chosen(turn++, 3)) continue;
                const std::string rib = roomOf(shader, more);
                const Traced one = trace(rib, false, 16, -1, s), all = trace(rib, true, 16, -1, s);
                EXPECT_GT(sumOf(one), 1) << shader << more;
                EXPECT_EQ(one.inBlocks, 0u);
                EXPECT_GT(all.inBlocks, all.points / 3) << shader << more;
                EXPECT_EQ(differences(one, all), 0u) << shader << more;
                EXPECT_EQ(differences(one, trace(rib, true, 4, -1, s)), 0u) << shader << more;
            }
}

TEST(Blocks, SampleLightsThatFilterOverTheirSurface) {
    writeShader("filters", R"(light filters(float intensity = 3) {
    illuminate(P, N, PI / 2) Cl = intensity * (.2 + min(10 * area(P), 1)) * filterstep(.5, mod(9 * s, 1));
})");
    writeFacets();
    const std::string lamp =
        "AttributeBegin\nAreaLightSource \"filters\" 77\nSurface \"constant\"\nColor 0 0 0\n"
        "Polygon \"P\" [-1 2.4 4  1 2.4 4  1 2.4 6  -1 2.4 6] \"st\" [0 0  1 0  1 1  0 1]\nAttributeEnd\nIlluminate 77 1\n";
    const std::string fog = "AttributeBegin\nSurface \"null\" Interior \"medium\" \"color scattering\" [.1 .12 .2]\n"
                            "Translate 0 0 5\nSphere 7.5 -7.5 7.5 360\nAttributeEnd\n";
    for (const std::string& more : {lamp, lamp + fog, lamp + manyLights(6)}) {
        const std::string rib = roomOf("\"facets\"", more);
        const Traced one = trace(rib, false), all = trace(rib, true);
        EXPECT_GT(sumOf(one), 1) << more;
        EXPECT_EQ(differences(one, all), 0u) << more;
        EXPECT_EQ(differences(one, trace(rib, true, 4)), 0u) << more;
        if (more != lamp + manyLights(6)) EXPECT_GT(all.inBlocks, all.points / 3) << more;
    }
}

TEST(Blocks, FollowAllLobesUnderOtherHiders) {
    writeShader("several", R"(surface several() {
    normal n = faceforward(normalize(N), I);
    float i, some = 1 + mod(floor(9 * u), 3);
    color sum = .3 * diffuse(n) + .2 * specular(n, -normalize(I), .2);
    for (i = 0; i < some; i += 1)
        sum += .1 * trace(P, reflect(normalize(I), n), "samplecone", .1 * i, "samples", 3 * some, "maxdist", 2 + i);
    Ci = Cs * (sum + .3 * trace(P, n, "distribution", "ggx", "roughness", .3, "wo", -I) + .2 * indirectdiffuse(P, n, 5));
    Oi = Os;
})");
    writeShader("waiting", R"(surface waiting() {
    normal n = faceforward(normalize(N), I);
    color c = trace(P, reflect(normalize(I), n));
    Ci = comp(c, 0) > .1 ? color(1) : .5 * c + .2 * diffuse(n);
})");
    const std::string sky = "LightSource \"envlight\" 9 \"intensity\" .3\n", clear = "Opacity .5 .6 .7\n";
    const std::string shallow = "Attribute \"trace\" \"int maxdiffusedepth\" 1 \"int maxspeculardepth\" 1\n";
    const std::string fog = "Atmosphere \"fog\" \"distance\" 9 \"background\" [.3 .2 .1]\n";
    for (const Hider hider : {Hider::Hidden, Hider::Raytrace})
        for (const char* shader : {"\"several\"", "\"waiting\""})
            for (const std::string& more : {sky, clear, shallow + sky, fog}) {
                Settings s;
                s.hider = hider;
                s.maxDepth = 3;
                const std::string rib = roomOf(shader, more);
                const Traced one = trace(rib, false, 16, 3, s), all = trace(rib, true, 16, 3, s);
                EXPECT_GT(sumOf(one), 1) << shader << more;
                EXPECT_EQ(one.inBlocks, 0u);
                EXPECT_GT(all.inBlocks, all.points / 4) << shader << more << int(hider);
                EXPECT_EQ(differences(one, all), 0u) << shader << more << int(hider);
                EXPECT_EQ(differences(one, trace(rib, true, 4, 3, s)), 0u) << shader << more << int(hider);
                EXPECT_EQ(one.cut, all.cut) << shader << more << int(hider);
            }
}

TEST(Blocks, LookPicturesUpAndKnowHowLargePointsAre) {
    display::Image m = display::makeImage(32, 16, display::defaultChannels(3));
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            for (int c = 0; c < 3; ++c) m.pixel(x, y)[c] = float((x / 2 + y / 2 + c) % 3) / 2;
    Diagnostics d;
    display::WriteOptions o;
    o.format = display::Format::Exr;
    o.policy = {shaderFolder(), false, -1};
    ASSERT_TRUE(display::writeImage("squares.exr", m, o, d));
    const std::string map = '"' + shaderFolder() + "/squares.exr\"";
    writeShader("painted", "surface painted() { normal n = faceforward(normalize(N), I); Ci = Ci + diffuse(n) * color texture(" +
                               map + ", s, t) + .2 * ambient() + specular(n, -normalize(I), .2) * float texture(" + map +
                               "[1], 3 * s, t, \"blur\", .02); }");
    writeShader("sized",
                "surface sized() { Ci = diffuse(faceforward(normalize(N), I)) * (1 - exp(-9999 * area(P))) + du * .1; }");
    writeShader("shiny",
                "surface shiny() { normal n = faceforward(normalize(N), I); Ci = .2 * diffuse(n) + .1 * color environment(" +
                    map + ", reflect(I, n)) + .1 * color(E) * s; }");
    for (const char* shader : {"painted", "sized", "shiny"}) {
        const std::string rib = roomOf("\"" + std::string(shader) + "\"");
        const Traced one = trace(rib, false), all = trace(rib, true);
        EXPECT_GT(sumOf(one), 1) << shader;
        EXPECT_EQ(differences(one, all), 0u) << shader;
        EXPECT_GT(all.inBlocks, all.points / 2) << shader;
    }
}

} // namespace blocks_test
