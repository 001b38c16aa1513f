// texture(), environment() and textureinfo() of shaders: what maps are found, and what shaders see of those that are not.
#include "integrator/maps.h"

namespace texturemaps_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2] \"st\" [0 0 1 0 1 1 0 1]\n";

void expectColor(const Color& c, const Color& want, float within = 1e-5f) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], within) << k;
}

struct Looked {
    Color color;
    std::string said;
};
Looked looked(const std::string& before, const std::string& surface, int errors = 0) {
    Scene s(before + "WorldBegin\n" + surface + "\n" + kSquare + "WorldEnd\n", {}, errors);
    const Color c = s.one(rayTo({0, 0, 0}, {.2f, .3f, 2}));
    return {c, s.messages()};
}

} // namespace

TEST(TextureMaps, TilesBySpellings) {
    for (int column : {0, 1})
        writeMap("spelt." + std::to_string(1001 + column) + ".exr", 4, 4,
                 [&](int, int, int c) { return c == column ? 1.f : 0.f; });
    writeShader(
        "spelt",
        "surface spelt(string map = \"\";) { Oi = 1; Ci = color texture(map, 1.5, .5) + 2 * color texture(map, .5, .5); }\n");
    for (const char* number : {"UDIM", "<UDIM>", "<udim>", "%(UDIM)d", "_MAPID_"}) {
        const Looked l = looked("", "Surface \"spelt\" \"string map\" [\"" + shaderFolder() + "/spelt." + number + ".exr\"]");
        EXPECT_EQ(l.said, "") << number;
        expectColor(l.color, {2, 1, 0});
    }
}

TEST(TextureMaps, AMissingMapIsOneErrorAndAChosenColour) {
    writeShader("lost", "surface lost() { Oi = 1; string made = (u < 2) ? \"lost2.tif\" : \"\";\n"
                        "    Ci = color texture(\"lost.tif\", s, t) + color environment(\"lost.tif\", N) * 2 + 4 * color "
                        "texture(made, s, t) + texture(\"\", s, t); }\n");
    const Looked chosen = looked("Option \"texture\" \"color missing\" [1 0 .5]\n", "Surface \"lost\"");
    expectColor(chosen.color, {7, 0, 3.5f});
    EXPECT_EQ(chosen.said.find("\"lost.tif\" was not found"), chosen.said.rfind("\"lost.tif\" was not found")) << chosen.said;
    expectColor(looked("", "Surface \"lost\"").color, {0, 0, 0});
    writeShader("lostpart", "surface lostpart() { Oi = 1; float b = texture(\"lost.tif\"[2], s, t), o = texture(\"lost.tif\"[3], "
                            "s, t, \"fill\", .25); Ci = color(b, o, 0); }\n");
    expectColor(looked("Option \"texture\" \"color missing\" [1 0 .5]\n", "Surface \"lostpart\"").color, {.5f, .25f, 0});
}

TEST(TextureMaps, AnUnknownFilterIsSaidOnce) {
    const std::string map = writeMap("plain.exr", 4, 4, Color(.5f));
    writeShader("filters",
                "surface filters(string map = \"\";) { Oi = 1; string f = (u < 2) ? \"bux\" : \"box\";\n"
                "    Ci = color texture(map, s, t, \"filter\", \"boxx\") + color texture(map, s, t, \"filter\", f); }\n");
    const Looked l = looked("", "Surface \"filters\" \"string map\" [" + map + "]");
    expectColor(l.color, {1, 1, 1});
    EXPECT_NE(l.said.find("there is no filter \"boxx\""), std::string::npos) << l.said;
    EXPECT_NE(l.said.find("there is no filter \"bux\""), std::string::npos) << l.said;
}

TEST(TextureMaps, InformationAboutMaps) {
    display::Image m = display::makeImage(8, 6, {"z"});
    Matrix camera;
    camera.m[3][0] = 3; // moves by 3 along x
    m.worldToCamera = camera;
    m.worldToNDC = display::screenToNDC(); // world is its screen
    m.metadata["textureformat"] = "Shadow";
    Diagnostics d;
    display::WriteOptions o;
    o.sample = display::Sample::Float;
    o.policy = {shaderFolder(), false, -1};
    ASSERT_TRUE(display::writeImage("told.exr", m, o, d));
    writeShader(
        "told",
        "surface told(string map = \"\";) { Oi = 1; uniform matrix v = 0, p = 0; uniform string w = \"\", t = \"\", f = \"\"; "
        "uniform float r[2] = {0, 0}, faces = 7;\n"
        "    float found = textureinfo(map, \"viewingmatrix\", v) + textureinfo(map, \"projectionmatrix\", p) + textureinfo(map, "
        "\"wrapmodes\", w) + textureinfo(map, \"resolution\", r)\n"
        "        + textureinfo(map, \"type\", t) + textureinfo(map, \"format\", f) + textureinfo(map, \"facecount\", faces);\n"
        "    point a = transform(v, point \"world\" (0, 0, 0)), b = transform(p, point \"world\" (.5, .25, 0));\n"
        "    Ci = color(xcomp(a), 10 * xcomp(b) + ycomp(b), found + 10 * r[0] + 100 * r[1] + ((w == \"clamp,clamp\" && t == "
        "\"shadow\" && f == \"float\" && faces == 0) ? .5 : 0)); }\n");
    const Looked l = looked("Translate 0 0 1\n", "Surface \"told\" \"string map\" [\"" + shaderFolder() + "/told.exr\"]");
    EXPECT_EQ(l.said, "");
    expectColor(l.color, {3, 5.25f, 7 + 80 + 600 + .5f}, 1e-4f);
}

TEST(TextureMaps, OpacityIsAChannelCalledA) {
    writeShader("clear",
                "surface clear(string map = \"\";) { Oi = 1; float a = 7; float found = textureinfo(map, \"hasalpha\", a); "
                "Ci = color(a, found, 0); }\n");
    for (const int channels : {1, 2, 3, 4}) { // y, y a, r g b, r g b a
        Diagnostics d;
        display::WriteOptions o;
        o.policy = {shaderFolder(), false, -1};
        ASSERT_TRUE(display::writeImage("clear.exr", display::makeImage(2, 2, display::defaultChannels(channels)), o, d));
        const Looked l = looked("", "Surface \"clear\" \"string map\" [\"" + shaderFolder() + "/clear.exr\"]");
        expectColor(l.color, {channels % 2 ? 0.f : 1.f, 1, 0});
    }
}

// Bars along s: a footprint that is long in t sees one of them, until it is widened as far as it is long.
TEST(TextureMaps, FootprintsAreWidenedAsTheOptionSays) {
    const std::string map =
        writeMap("bars.exr", 64, 64, [](int x, int, int) { return x / 8 % 2 ? 1.f : 0.f; }, "periodic,periodic");
    writeShader("bars", "surface bars(string map = \"\";) { Oi = 1; float c = 12 / 64, h = .002;\n"
                        "    Ci = color texture(map, c - h, .3, c + h, .3, c - h, .7, c + h, .7); }\n");
    const std::string surface = "Surface \"bars\" \"string map\" [" + map + "]";
    EXPECT_GT(looked("", surface).color.x, .95f);
    EXPECT_GT(looked("Option \"texture\" \"float maxanisotropy\" 16\n", surface).color.x, .9f);
    const Looked one = looked("Option \"texture\" \"float maxanisotropy\" 1\n", surface);
    EXPECT_NEAR(one.color.x, .5f, .06f);
    EXPECT_EQ(one.said, "");
    const Looked wrong = looked("Option \"texture\" \"float maxanisotropy\" 0\n", surface, 1);
    EXPECT_GT(wrong.color.x, .95f);
    EXPECT_NE(wrong.said.find("\"maxanisotropy\" must be a number >= 1"), std::string::npos) << wrong.said;
}

// A lookup whose slopes somebody wants takes another way than one without: its value is the same.
TEST(TextureMaps, ValuesWithAndWithoutSlopesAreTheSame) {
    const std::string map = writeMap(
        "slopes.exr", 64, 64, [](int x, int y, int c) { return float((x * 7 + y * 13 + c * 31) % 64) / 64; }, "periodic,black");
    writeShader("slopes", "surface slopes(string map = \"\";) { Oi = 1; color a = color texture(map, 3 * s, 3 * t), b = color "
                          "texture(map, 3 * s, 3 * t);\n"
                          "    Ci = (a - b) * 1e6 + .001 * Du(b); }\n");
    const Looked l = looked("", "Surface \"slopes\" \"string map\" [" + map + "]");
    writeShader(
        "noslopes",
        "surface noslopes(string map = \"\";) { Oi = 1; color b = color texture(map, 3 * s, 3 * t); Ci = .001 * Du(b); }\n");
    const Looked n = looked("", "Surface \"noslopes\" \"string map\" [" + map + "]");
    expectColor(l.color, n.color, 1e-6f);
}

} // namespace texturemaps_test
