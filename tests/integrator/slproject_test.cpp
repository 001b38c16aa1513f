// shaders/include/slproject.h against SLProject's rules written out plainly (docs/design/slproject.md).
#include "integrator/floorscene.h"
#include "integrator/maps.h"
#include <cmath>

namespace slproject_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2] \"st\" [0 0 1 0 1 1 0 1]\n";

/// Ci of a body that has slproject.h and the string `map`.
Color valueOf(const std::string& body, const std::string& map = "\"\"") {
    writeShader("slp", "#include \"slproject.h\"\nsurface slp(string map = \"\";) { Oi = 1; Ci = 0; " + body + " }\n");
    Scene s("WorldBegin\nSurface \"slp\" \"string map\" [" + map + "]\n" + kSquare + "WorldEnd\n");
    const Color c = s.one(rayTo({0, 0, 0}, {.2f, .3f, 2}));
    EXPECT_EQ(s.messages(), "") << body;
    return c;
}

void expectNear(const Color& c, const Color& want, const std::string& what) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], 2e-5f) << what << " " << k;
}

std::string number(double v) { return std::to_string(v); }

} // namespace

TEST(SlProject, AListOfColoursIsAPictureOfHeightOne) {
    const float red[4] = {.1f, .7f, .4f, .9f};
    for (double u : {.125, .3, .5, .95, 1.3, -.2}) {
        const double x = (u - std::floor(u)) * 4 - .5, i = std::floor(x), f = x - i;
        const int a = (int(i) + 4) % 4, b = (int(i) + 1) % 4;
        const float want = float((1 - f) * double(red[a]) + f * double(red[b]));
        expectNear(
            valueOf(
                "color list[4] = {color(.1, 0, 0), color(.7, 1, 0), color(.4, 2, 0), color(.9, 3, 0)}; Ci = slTexture1D(list, " +
                number(u) + "); setcomp(Ci, 1, 0);"),
            {want, 0, 0}, "u " + number(u));
    }
}

TEST(SlProject, PicturesRepeatAndBeginBelow) {
    const auto at = [](int x, int y, int c) { return float((5 * x + 3 * y + 7 * c) % 16) / 16; };
    const std::string map = writeMap("slp2.exr", 8, 8, at);
    for (auto [u, v] : {std::pair{.3, .4}, {1.6, -.3}, {-2.45, 3.7}}) {
        const double s = u - std::floor(u), t = 1 - (v - std::floor(v)), x = s * 8 - .5, y = t * 8 - .5;
        const int i = int(std::floor(x)), j = int(std::floor(y));
        Color want;
        for (int c = 0; c < 3; ++c) {
            const double a = x - i, b = y - j;
            want[c] = float((1 - b) * ((1 - a) * double(at(i, j, c)) + a * double(at(i + 1, j, c))) +
                            b * ((1 - a) * double(at(i, j + 1, c)) + a * double(at(i + 1, j + 1, c))));
        }
        expectNear(valueOf("Ci = slTexture2D(map, " + number(u) + ", " + number(v) + ");", map), want, "plain");
        // The same place by a texture matrix of scale 2 and an offset.
        expectNear(
            valueOf("Ci = slTexture2D(map, " + number((u - .25) / 2) + ", " + number((v - .5) / 2) + ", 2, 2, .25, .5);", map),
            want, "matrix");
    }
}

TEST(SlProject, WrapModesAndFilters) {
    const auto at = [](int x, int y, int c) { return float((5 * x + 3 * y + 7 * c) % 16) / 16; };
    const std::string map = writeMap("slp4.exr", 8, 8, at);
    // The middles of texels, so that nearest and bilinear agree; v grows upward.
    const auto texel = [&](int column, int rowFromBelow) {
        return Color(at(column, 7 - rowFromBelow, 0), at(column, 7 - rowFromBelow, 1), at(column, 7 - rowFromBelow, 2));
    };
    const struct {
        double u, v;
        const char *wrapu, *wrapv;
        int column, row;
    } cases[] = {{1 + 2.5 / 8, -1.5 / 8, "repeat", "repeat", 2, 6}, {1 + 2.5 / 8, -1.5 / 8, "mirror", "repeat", 5, 6},
                 {1 + 2.5 / 8, -1.5 / 8, "clamp", "mirror", 7, 1},  {-3.5, 2 + 3.5 / 8, "clamp", "mirror", 0, 3},
                 {2.5 / 8, 4.5 / 8, "clamp", "clamp", 2, 4},        {-2.5 / 8, 1.25, "mirror", "clamp", 2, 7}};
    for (const auto& c : cases)
        for (const char* filter : {"nearest", "bilinear"})
            expectNear(valueOf("Ci = slTexture2D(map, " + number(c.u) + ", " + number(c.v) + ", \"" + c.wrapu + "\", \"" +
                                   c.wrapv + "\", \"" + filter + "\");",
                               map),
                       texel(c.column, c.row), std::string(c.wrapu) + c.wrapv + filter);
    // Away from the middles: the texel, or a mean of two of a row.
    const double u = 3.9 / 8, v = 4.5 / 8;
    expectNear(valueOf("Ci = slTexture2D(map, " + number(u) + ", " + number(v) + ", \"repeat\", \"repeat\", \"nearest\");", map),
               texel(3, 4), "nearest");
    expectNear(valueOf("Ci = slTexture2D(map, " + number(u) + ", " + number(v) + ", \"repeat\", \"repeat\", \"bilinear\");", map),
               texel(3, 4) * .6f + texel(4, 4) * .4f, "bilinear");
}

TEST(SlProject, TextureMatrixWithATurn) {
    // Scale (2, 3), a turn of 90 degrees, then the offset: u' = -3 v + .1, v' = 2 u + .2.
    expectNear(valueOf("float a = 0, b = 0; slTransform(.3, .4, 2, 3, 90, .1, .2, a, b); Ci = color(a, b, 0);"), {-1.1f, .8f, 0},
               "90");
    const float h = std::sqrt(.5f);
    expectNear(valueOf("float a = 0, b = 0; slTransform(1, .5, 1, 2, 45, 0, 0, a, b); Ci = color(a, b, 0);"), {0, 2 * h, 0},
               "45");
}

TEST(SlProject, TheMaterialHasThem) {
    const auto at = [](int x, int y, int c) { return float((5 * x + 3 * y + 7 * c) % 16) / 16; };
    const std::string map = writeMap("slp5.exr", 8, 8, at);
    const std::string lit = "LightSource \"distantlight\" 1 \"from\" [0 0 0] \"to\" [0 0 1]\n";
    const auto value = [&](const std::string& parameters, const std::string& more) {
        Scene s("WorldBegin\n" + lit + "Surface \"slmaterial\" \"string texturename\" [" + map +
                    "] \"string filter\" \"nearest\" " + parameters + "\n" + "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2] " +
                    more + "\nWorldEnd\n",
                withShaders(Hider::Path));
        return s.estimate(rayTo({0, 0, 0}, {0, 0, 2}), 64);
    };
    // (s, t) is (2.5, 3.5) / 8 everywhere, (s2, t2) is (6.5, 1.5) / 8. Under light of 1 along the normal the albedo is seen.
    const std::string first = "\"varying float s\" [.3125 .3125 .3125 .3125] \"varying float t\" [.4375 .4375 .4375 .4375]";
    const std::string second = " \"varying float s2\" [.8125 .8125 .8125 .8125] \"varying float t2\" [.1875 .1875 .1875 .1875]";
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(value("", first).mean(k), at(2, 3, k), 1e-4);
        EXPECT_NEAR(value("\"float uvindex\" 1", first + second).mean(k), at(6, 1, k), 1e-4);
        // v from below is 4.5 / 8: turned by 90 degrees u' is 1 - 4.5 / 8, v' is 2.5 / 8.
        EXPECT_NEAR(value("\"float rotation\" 90 \"float uoffset\" 1", first).mean(k), at(3, 5, k), 1e-4);
        EXPECT_NEAR(value("\"float uoffset\" 1 \"string wrapu\" \"mirror\"", first).mean(k), at(5, 3, k), 1e-4);
    }
}

TEST(SlProject, StacksOverABox) {
    const std::string map = writeMap("slp3.exr", 4, 16, [](int x, int y, int c) {
        return c == 0 ? (float(x) + .5f) / 4 : c == 1 ? 1 - (float(y % 4) + .5f) / 4 : (float(y / 4) + .5f) / 4;
    });
    std::string stack = map;
    stack.insert(stack.size() - 1, "*4"); // inside of the quotes
    // r, g, b grow with x, y and z of the box; y is turned over. Between voxel centres that is exact.
    expectNear(valueOf("Ci = slTexture3D(map, point \"object\" (.5, 2.2, -3), point(0, 2, -4), point(1, 3, -2));", stack),
               {.5f, .2f, .5f}, "box");
    expectNear(valueOf("Ci = slTexture3D(map, point \"object\" (1.5, 2.2, -3), point(0, 2, -4), point(1, 3, -2));", stack),
               {0, 0, 0}, "beside it");
    expectNear(valueOf("float a; vector g; slTexture3D(map, point \"object\" (.5, 2.5, -3), point(0, 2, -4), point(1, 3, -2), a, "
                       "g); Ci = color(a, xcomp(g), 0);",
                       stack),
               {.5f, 0, 0}, "grey into alpha");
    // The square is seen at (.2, .3, 2) and reaches from -1 to 1; of its third side, which has no length, the middle is taken.
    expectNear(valueOf("Ci = slTexture3D(map, P);", stack), {.6f, .65f, .5f}, "of the primitive");
}

TEST(SlProject, SixFacesByDirection) {
    const char* names[6] = {"px", "nx", "py", "ny", "pz", "nz"};
    for (int f = 0; f < 6; ++f)
        writeMap(std::string("slpcube_") + names[f] + ".exr", 8, 8, [f](int x, int y, int c) {
            return c == 0 ? float(f) : c == 1 ? (float(x) + .5f) / 8 : (float(y) + .5f) / 8;
        });
    const std::string map = "\"" + shaderFolder() + "/slpcube_<FACE>.exr\"";
    struct Case {
        const char* direction;
        int face;
        float uc, vc;
    };
    // uc, vc of docs/design/slproject.md over the greatest component; u = (uc + 1) / 2, and the row from above (1 - vc) / 2.
    for (const Case& k : {Case{"2, .4, -.6", 0, .3f, .2f},
                          {"-2, .4, -.6", 1, -.3f, .2f},
                          {".4, 2, .6", 2, .2f, -.3f},
                          {".4, -2, .6", 3, .2f, .3f},
                          {".4, .6, 2", 4, .2f, .3f},
                          {".4, .6, -2", 5, -.2f, .3f}})
        expectNear(valueOf(std::string("Ci = slTextureCube(map, vector(") + k.direction + "));", map),
                   {float(k.face), (k.uc + 1) / 2, (1 - k.vc) / 2}, k.direction);
}

TEST(SlProject, BumpsByHeightsAndNormals) {
    const auto at = [](int x, int y, int) { return float((x - 4) * (x - 4) + 2 * y) / 64; };
    const std::string map = writeMap("slpbump_H.exr", 8, 8, at);
    // At the middle of texel (5, 3), where v is 1 - 3.5 / 8; v grows upward.
    const float du = -3 * (at(6, 3, 0) - at(4, 3, 0)), dv = -3 * (at(5, 2, 0) - at(5, 4, 0));
    expectNear(valueOf("float a, b; slSlopes(map, \"height\", 5.5 / 8, 1 - 3.5 / 8, 3, a, b); Ci = color(a, b, 0);", map),
               {du, dv, 0}, "heights");
    expectNear(valueOf("float a, b; slSlopes(map, \"normal\", 5.5 / 8, 1 - 3.5 / 8, 3, a, b); Ci = color(a, b, 0);", map),
               {2 * at(5, 3, 0) - 1, 2 * at(5, 3, 1) - 1, 0}, "normals");
    expectNear(valueOf("float a, b; slSlopes(map, \"diffuse\", .4, .4, 3, a, b); Ci = color(a, b, 0);", map), {0, 0, 0},
               "others");
}

TEST(SlProject, KindsByNames) {
    const std::pair<const char*, const char*> names[] = {
        {"wood_C.png", "diffuse"},    {"wood_D.jpg", "diffuse"},      {"wood_N.png", "normal"},    {"wood_H.tif", "height"},
        {"wood_S.png", "specular"},   {"wood_G.png", "specular"},     {"wood_R.png", "roughness"}, {"wood_M.png", "metallic"},
        {"wood_O.png", "occlusion"},  {"wood_A.png", "occlusion"},    {"arial_F.png", "font"},     {"sky.hdr", "hdr"},
        {"rockHeight.png", "height"}, {"rock-albedo.png", "diffuse"}, {"rock_nrm2.png", "normal"}, {"thing.png", "diffuse"}};
    std::string body = "float n = 0;";
    for (const auto& [name, kind] : names)
        body +=
            std::string(" if (slTextureType(\"") + name + "\") == \"" + kind + "\") n += 1; else printf(\"" + name + "\\n\");";
    expectNear(valueOf(body + " Ci = n;"), Color(float(std::size(names))), "names");
}

} // namespace slproject_test
