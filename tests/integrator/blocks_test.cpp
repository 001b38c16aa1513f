// Requests that are read in rows (integrator/loberequests.h) have the bits of those that are read one by one.
#include "display/imageio.h"
#include "integrator/blockrooms.h"
#include "scene/lightpaths.h"

namespace blocks_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

TEST(Blocks, HaveTheBitsOfSinglePoints) {
    writeGlossy();
    writeFacets();
    writeShader("cut", R"(surface cut() {
    Oi = mod(xcomp(8 * P), 1) < .5 ? Os : color(0);
    Ci = Oi * Cs * diffuse(faceforward(normalize(N), I));
})");
    for (const char* shader :
         {"\"matte\"", "\"plastic\"", "\"glossy\"", "\"facets\"", "\"cut\"", "\"slmaterial\"",
          "\"slmaterial\" \"color diffusecolor\" [0 0 0] \"color specularcolor\" [.9 1 1] \"float shininess\" 9",
          "\"slmaterial\" \"color diffusecolor\" [0 0 0] \"color transmissive\" [1 1 1] \"float kn\" 1.5"}) {
        expectSameBits(roomOf(shader), pathSettings(), .3, shader); // shadow rays run "cut" for its opacity
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
            expectSameBits(roomOf(shader, manyLights(1e38) + more), pathSettings(), .3, shader + more);
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
                const bool most = std::string(shader) == "\"threshold\"" && depth > 0;
                expectSameBits(roomOf(shader, more), pathSettings(), most ? .5 : -1, shader + more, depth);
            }
        }
        ++turn;
    }
}

TEST(Blocks, LetLightThroughAndTakeWhatNeedsALook) {
    writeShader("many", R"(surface many() {
    normal n = faceforward(normalize(N), I);
    float i;
    for (i = 0; i < 40; i += 1) Ci += .015 * Cs * diffuse(n);
})");
    writeFacets();
    writeGlossy();
    writeShader("tiny", R"(surface tiny() { Ci = diffuse(normal(1e-25 * normalize(N))); })");
    for (const char* shader : {"many", "tiny"}) {
        const Traced all = expectSameBits(roomOf("\"" + std::string(shader) + "\""), pathSettings(), -1, shader);
        EXPECT_EQ(all.inRows < all.points, std::string(shader) == "tiny") << shader; // its normals are read one by one
    }
    for (const char* shader : {"\"matte\"", "\"facets\"", "\"glossy\""}) {
        const std::string rib = roomOf(shader, "Opacity .5 .6 .7\nAttribute \"trace\" \"bias\" .01\n");
        expectSameBits(rib, pathSettings(), .5, shader);
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
    const std::string bumpy = "ShadingRate 2500\nAttribute \"displacementbound\" \"float sphere\" .1\nDisplacement \"bumpy\"\n";
    const std::string inside = "Interior \"medium\" \"color scattering\" [0 0 0] \"color absorption\" [.2 .5 .3]\n";
    const std::string fog = "Atmosphere \"fog\" \"distance\" 9 \"background\" [.3 .2 .1]\n";
    size_t turn = 0; // not nightly: every setting and scene, and each of both with both shaders
    for (const Settings& s : {pathSettings(), local, first, paths, outputs}) {
        for (const std::string& more :
             {std::string(), fog, fog + "Opacity .5 .6 .7\n", inside + "Opacity .5 .6 .7\n", bumpy, manyLights(6)}) {
            size_t of = turn++;
            for (const char* shader : {"\"apart\"", "\"facets\""}) {
                if (!chosen(of++, 2) || (more == bumpy && !s.lightPaths)) continue; // to dice the room takes long
                expectSameBits(roomOf(shader, more), s, s.outputs.empty() ? .25 : 0, shader + more);
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
                    expectSameBits(roomOf(shader, more), s, depth < 0 ? .25 : .125, shader + more, depth); // at the end: skies
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
                const Traced all = expectSameBits(roomOf(shader, more), pathSettings(), .3, shader + more, depth);
                EXPECT_GT(all.cut, 0u) << shader << more << depth;
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
        expectSameBits(roomOf("\"" + std::string(shader) + "\""), pathSettings(), .5, shader);
    }
}

} // namespace blocks_test
