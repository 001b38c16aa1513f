// shadow() of depth maps: a lamp at (0, 4, 0) looks down at a square of half width 1 at height 2 over the floor, so the square's
// shadow has half width 2. The map is written from these numbers; the scene itself has the floor alone.
#include "integrator/floorscene.h"
#include "integrator/maps.h"

namespace shadowmaps_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

constexpr int kWidth = 256; // a texel is 1/32 of the floor

/// Depth along -y from the lamp; the map sees the floor from -4 to 4, and the square at that depth.
std::string lampMap(const std::string& name, float square = 2) {
    display::Image z = display::makeImage(kWidth, kWidth, {"z"});
    const auto inside = [](int i) { return i >= kWidth / 4 && i < 3 * kWidth / 4; };
    for (int y = 0; y < kWidth; ++y)
        for (int x = 0; x < kWidth; ++x) z.pixel(x, y)[0] = inside(x) && inside(y) ? square : 4.0f;
    Matrix camera{}, ndc{}; // rows are multiplied from the left
    for (auto* m : {&camera, &ndc})
        for (auto& row : m->m)
            for (double& v : row) v = 0;
    camera.m[0][0] = camera.m[2][1] = camera.m[3][3] = 1;
    camera.m[1][2] = -1, camera.m[3][2] = 4;
    ndc.m[0][0] = .5, ndc.m[2][1] = -.5;
    ndc.m[1][0] = ndc.m[1][1] = -.5, ndc.m[3][0] = ndc.m[3][1] = 2;
    ndc.m[1][3] = -1, ndc.m[3][3] = 4;
    z.worldToCamera = camera;
    z.worldToNDC = ndc;
    z.metadata["textureformat"] = "Shadow";
    Diagnostics d;
    display::WriteOptions o;
    o.format = display::Format::Exr;
    o.sample = display::Sample::Float;
    o.policy = {shaderFolder(), false, -1};
    EXPECT_TRUE(display::writeImage(name, z, o, d));
    return "\"" + shaderFolder() + "/" + name + "\"";
}

CameraRay at(float x, float z = 0) { return rayTo({x, 3, z}, {x, 0, z}); }

Scene floorOf(const std::string& name, const std::string& body, const std::string& before = "", Hider h = Hider::Hidden) {
    writeShader(name, "surface " + name + "(string map = \"\") { Oi = 1; " + body + " }\n");
    return Scene(before + inWorld("Surface \"" + name + "\" \"string map\" " + lampMap("lamp.shd") + " " + kFloor),
                 withShaders(h));
}

TEST(ShadowMaps, TheShadowOfASquare) {
    for (Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        Scene s = floorOf("square", "Ci = shadow(map, P, \"bias\", .01);", "", h);
        for (const float x : {-1.9f, 0.f, 1.9f})
            for (const float z : {-1.9f, 1.9f}) EXPECT_EQ(s.one(at(x, z)).x, 1) << x;
        for (const float x : {-2.1f, 2.1f, 3.9f, 4.1f, 40.f}) { // the last two lie outside of the map
            EXPECT_EQ(s.one(at(x)).x, 0) << x;
            EXPECT_EQ(s.one(at(.5f, x)).x, 0) << x;
        }
        EXPECT_NEAR(s.one(at(2)).x, .5, 1e-4) << "between two texels";
        EXPECT_EQ(s.messages(), "");
    }
}

TEST(ShadowMaps, FormsAgree) {
    Scene s =
        floorOf("forms", "color c = shadow(map, P, \"bias\", .01); float q = shadow(map, P, P, P, P, \"bias\", .01);"
                         " string m = map; if (xcomp(P) > 50) m = \"\"; Ci = color(c[1], q, float shadow(m, P, \"bias\", .01));");
    for (const float x : {1.9f, 2.f, 2.1f}) {
        const Color c = s.one(at(x));
        EXPECT_NEAR(c.x, x < 2 ? 1 : x > 2 ? 0 : .5, 1e-4);
        EXPECT_EQ(c.y, c.x);
        EXPECT_EQ(c.z, c.x);
    }
    EXPECT_EQ(s.messages(), "");
}

// RISpec 15.7.4: both matrices begin in "current" space; the picture reaches from -1 to 1 to the right and from 1 to -1 downward.
TEST(ShadowMaps, MatricesOfTheMap) {
    Scene camera = floorOf("viewing",
                           "matrix m = 0; float f = textureinfo(map, \"viewingmatrix\", m); point q = transform(m, P);"
                           " Ci = f * color(xcomp(q), ycomp(q), zcomp(q));",
                           "Translate 3 -1 2\n");
    Scene screen = floorOf("projected",
                           "matrix m = 0; float f = textureinfo(map, \"projectionmatrix\", m); point q = transform(m, P);"
                           " Ci = color(xcomp(q), ycomp(q), f);",
                           "Translate 3 -1 2\n");
    for (const float x : {-3.f, .5f})
        for (const float z : {-1.f, 2.f}) { // the camera of the map has x to the right, z upward, and -y in front of it
            const Color c = camera.one(at(x + 3, z + 2)), s = screen.one(at(x + 3, z + 2)); // rays are the camera's
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], (k == 0 ? x : k == 1 ? z : 4), 1e-5) << k;
            EXPECT_NEAR(s.x, x / 4, 1e-6);
            EXPECT_NEAR(s.y, z / 4, 1e-6);
            EXPECT_EQ(s.z, 1);
        }
    EXPECT_EQ(camera.messages() + screen.messages(), "");
}

// A filter as wide as b of the map: the part of it that is dark falls linearly over the edge. 32 x 32 comparisons.
TEST(ShadowMaps, BlurIsAPartOfTheMap) {
    Scene s = floorOf("blurred", "Ci = shadow(map, P, \"bias\", .01, \"blur\", .1, \"samples\", 1024);");
    for (float x = 1.5f; x < 2.6f; x += .05f)
        EXPECT_NEAR(s.one(at(x)).x, std::clamp((.25f - x / 8) / .1f + .5f, 0.f, 1.f), 1 / 32. + 1e-3) << x;
}

TEST(ShadowMaps, FourPointsSpanTheFilter) {
    writeShader(
        "four",
        "surface four(string map = \"\") { vector a = vector \"world\" (1, 0, 0), b = vector \"world\" (0, 0, 1); Oi = 1;"
        " float f = shadow(map, P - a - b, P + a - b, P - a + b, P + a + b, \"bias\", .01, \"samples\", 1024); Ci = f; }\n");
    Scene s(inWorld("Surface \"four\" \"string map\" " + lampMap("lamp.shd") + " " + kFloor), withShaders(Hider::Hidden));
    for (float x = .9f; x < 3.2f; x += .1f) EXPECT_NEAR(s.one(at(x)).x, std::clamp((3 - x) / 2, 0.f, 1.f), 1 / 32. + 1e-3) << x;
}

TEST(ShadowMaps, BiasOfCallAttributeAndOption) {
    const std::string plain = "Ci = shadow(map, P);";
    EXPECT_EQ(floorOf("bias0", plain).one(at(0)).x, 1) << ".225 where nobody says";
    EXPECT_EQ(floorOf("bias1", plain, "Option \"shadow\" \"float bias\" 2.1\n").one(at(0)).x, 0)
        << "deeper than the square is high";
    EXPECT_EQ(
        floorOf("bias2", plain, "Option \"shadow\" \"float bias\" 2.1 Attribute \"shadow\" \"float bias\" 1.9\n").one(at(0)).x,
        1);
    EXPECT_EQ(floorOf("bias3", "Ci = shadow(map, P, \"bias\", 2.1);", "Attribute \"shadow\" \"float bias\" 1.9\n").one(at(0)).x,
              0);
    // Evenly from 1 to 3: half of the comparisons pass.
    EXPECT_NEAR(floorOf("bias4", "Ci = shadow(map, P, \"bias0\", 1, \"bias1\", 3, \"samples\", 1024);").one(at(0)).x, .5, .01);
}

// Aqsis: no bias by itself, so what is a tenth behind the square is dark.
TEST(ShadowMaps, TheBiasOfADialect) {
    writeShader("nearby", "surface nearby(string map = \"\") { Oi = 1; Ci = shadow(map, P); }\n");
    const std::string rib = inWorld("Surface \"nearby\" \"string map\" " + lampMap("near.shd", 3.9f) + " " + kFloor);
    for (const char* dialect : {"", "prman", "aqsis"}) {
        Settings settings = withShaders(Hider::Hidden);
        settings.dialect = dialect;
        EXPECT_EQ(Scene(rib, settings).one(at(0)).x, dialect == std::string("aqsis") ? 1 : 0) << dialect;
    }
}

TEST(ShadowMaps, ADefaultBiasThatHidesShadowsIsSaid) {
    // A tenth above the floor, nothing is .225 behind the square.
    const auto low = [](const std::string& name, const std::string& body, const std::string& before = "") {
        writeShader(name, "surface " + name + "(string map = \"\") { Oi = 1; " + body + " }\n");
        return Scene(before + inWorld("Surface \"" + name + "\" \"string map\" " + lampMap("low.shd", 3.9f) + " " + kFloor),
                     withShaders(Hider::Hidden));
    };
    Scene silent = low("lowbias", "Ci = shadow(map, P);");
    EXPECT_EQ(silent.one(at(0)).x, 0);
    EXPECT_NE(silent.messages().find("whose depths are from 3.9 to 4"), std::string::npos) << silent.messages();
    Scene call = low("lowcall", "Ci = shadow(map, P, \"bias\", .01);"),
          option = low("lowoption", "Ci = shadow(map, P);", "Option \"shadow\" \"float bias\" .01\n");
    for (Scene* s : {&call, &option}) {
        EXPECT_EQ(s->one(at(0)).x, 1);
        EXPECT_EQ(s->messages(), "");
    }
}

// A square light of half width 1/2: a point x of the floor sees the part of it beyond 2 - x, by the square's edge half way up.
TEST(ShadowMaps, AreaLightsHavePenumbras) {
    Scene s = floorOf(
        "area",
        "point a = point \"world\" (-.5, 4, -.5), b = point \"world\" (.5, 4, -.5), c = point \"world\" (.5, 4, .5),"
        " d = point \"world\" (-.5, 4, .5); Ci = shadow(map, P, \"bias\", .05, \"samples\", 1024, \"source\", a, b, c, d);");
    // 32 columns of the source, a texel at the edge, and the floor that is left out before its own bias.
    for (float x = 1.2f; x < 2.9f; x += .1f)
        EXPECT_NEAR(s.one(at(x)).x, std::clamp(2.5f - x, 0.f, 1.f), 1 / 32. + 2 * 8. / kWidth) << x;
}

TEST(ShadowMaps, OfLights) {
    writeShader("mapped", "light mapped(string map = \"\") { illuminate(point \"world\" (0, 4, 0)) Cl = 16 / (L . L) * (1 - "
                          "shadow(map, Ps, \"bias\", .01)); }\n");
    const std::string inside =
        "LightSource \"mapped\" 1 \"string map\" " + lampMap("lamp.shd") + " Surface \"matte\" \"Ka\" 0 \"Kd\" 1 " + kFloor;
    Scene hidden(inWorld(inside), withShaders(Hider::Hidden)), path(inWorld(inside), withShaders(Hider::Path));
    for (const float x : {0.f, 1.9f, 2.1f, 3.f}) {
        const double lit = std::pow(16 / (16 + double(x) * x), 1.5);
        EXPECT_NEAR(hidden.one(at(x)).x, x < 2 ? 0 : lit, 1e-5) << x;
        EXPECT_NEAR(path.one(at(x)).x, lit, 1e-4)
            << "rays find no square " << x; // 1e-4: the rest of an indirect bounce cannot be
    }
    EXPECT_NE(path.messages().find("shadow maps of light shaders are not read"), std::string::npos);
    EXPECT_EQ(hidden.messages(), "");
}

// The shipped lights use the map where there is one: nothing but the map knows of the square. Without it, and under path, rays
// find none.
TEST(ShadowMaps, OfShippedLights) {
    const std::string names[] = {"\"shadowspot\" 1 \"coneangle\" 1.4 \"conedeltaangle\" .01 \"beamdistribution\" 0 \"from\" [0 4 "
                                 "0] \"to\" [0 0 0] \"shadowname\" ",
                                 "\"shadowdistant\" 1 \"from\" [0 4 0] \"to\" [0 0 0] \"shadowname\" ",
                                 "\"shadowpoint\" 1 \"from\" [0 4 0] \"shadowname\" ",
                                 "\"shadowpoint\" 1 \"from\" [0 4 0] \"sfnx\" \"none\" \"sfpy\" \"none\" \"sfny\" "};
    for (const std::string& name : names)
        for (const std::string& map : {lampMap("lamp.shd"), std::string("\"none\"")})
            for (const Hider h : {Hider::Hidden, Hider::Path}) {
                Scene s(inWorld("LightSource " + name + map + " \"bias\" .01\nSurface \"matte\" \"Ka\" 0 \"Kd\" 1 " + kFloor),
                        withShaders(h));
                const bool dark = h == Hider::Hidden && map != "\"none\"";
                for (const float x : {0.f, -1.9f}) EXPECT_EQ(s.one(at(x, .5f)).x == 0, dark) << name << map << x;
                for (const float x : {2.1f, 3.f}) EXPECT_GT(s.one(at(x, .5f)).x, .01f) << name << map << x;
                EXPECT_EQ(s.messages().find("error"), std::string::npos) << s.messages();
            }
}

TEST(ShadowMaps, AMissingMapIsSaidOnceAndLit) {
    writeShader("nomap", "surface nomap() { Ci = shadow(\"none.shd\", P); Oi = 1; }\n");
    Scene s(inWorld("Surface \"nomap\" " + std::string(kFloor)), withShaders(Hider::Hidden));
    EXPECT_EQ(s.one(at(0)).x, 0);
    EXPECT_EQ(s.one(at(1)).x, 0);
    EXPECT_EQ(s.diagnostics.errors(), 1) << s.messages();
}

TEST(ShadowMaps, APictureIsNoShadowMap) {
    writeShader("picturemap", "surface picturemap(string map = \"\") { Ci = shadow(map, P); Oi = 1; }\n");
    Scene s(inWorld("Surface \"picturemap\" \"string map\" " + writeMap("picture.exr", 4, 4, Color(1)) + " " + kFloor),
            withShaders(Hider::Hidden));
    EXPECT_EQ(s.one(at(0)).x, 0);
    EXPECT_NE(s.messages().find("is not a shadow map"), std::string::npos) << s.messages();
}

// areashadow() of a class light with the map: the light of its samples is dark where the map says so, and nothing is traced.
TEST(ShadowMaps, SamplesOfClassLights) {
    writeShader("mapped",
                "class mapped(string map = \"\") {\n"
                "    public void generateSamples(string integrationdomain; output __radiancesample samples[]) {\n"
                "        vector to = point \"shader\" (0, 0, 0) - Ps; resize(samples, 1); samples[0]->direction = normalize(to); "
                "samples[0]->distance = length(to);\n"
                "        samples[0]->setLightRadiance(PI * color(1, .5, .25), 1);\n    }\n"
                "    public void shadowSamples(output __radiancesample samples[]) { filterregion f; f->calculate3d(Ps);\n"
                "        areashadow(map, f, samples, \"bias\", .01, \"blur\", 0, \"width\", 1, \"raytrace\", 0, \"label\", "
                "\"l\", \"subset\", \"\", \"hitmode\", \"shader\"); }\n}\n");
    writeShader("shown", "surface shown() { Oi = 1; Ci = 0; illuminance(P) Ci += Cl; }\n");
    const std::string light = "TransformBegin\nTranslate 0 4 0\nLightSource \"mapped\" 1 \"map\" " + lampMap("lamp.shd") +
                              "\nTransformEnd\nSurface \"shown\"\n";
    const std::string card = "AttributeBegin\nSurface \"constant\"\nAttribute \"visibility\" \"camera\" 0 \"transmission\" "
                             "\"opaque\"\nPolygon \"P\" [-90 1 -90  -90 1 90  90 1 90  90 1 -90]\nAttributeEnd\n";
    for (const Hider h : {Hider::Hidden, Hider::Raytrace}) { // under path lights trace their shadows
        Scene s(inWorld(light + kFloor), withShaders(h));
        EXPECT_EQ(s.one(at(0)).x, 0);
        EXPECT_EQ(s.one(at(-1.9f)).y, 0);
        EXPECT_NEAR(s.one(at(2.5f)).x, 1, 1e-5);
        EXPECT_NEAR(s.one(at(2.5f)).z, .25, 1e-5);
        EXPECT_EQ(s.messages(), "");
        EXPECT_NEAR(Scene(inWorld(light + card + kFloor), withShaders(h)).one(at(2.5f)).x, 1, 1e-5);
    }
}

} // namespace

} // namespace shadowmaps_test
