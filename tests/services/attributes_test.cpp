// attribute(), option() and rayinfo() in rendered scenes, by every name of the 3Delight manual (tables 6.20 and 6.21).
#include "integrator/floorscene.h"
#include "world/objectbox.h"

namespace attributes_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

std::string quoted(const std::string& s) { return "\"" + s + "\""; }

/// What `call` ("attribute" or "option") finds: 1 for found, then what the shader makes of the value v of that type.
Color asked(const std::string& call, const std::string& type, const std::string& name, const std::string& inside,
            const std::string& shown, const std::string& before = "") {
    static int count = 0;
    const std::string shader = "asks" + std::to_string(++count),
                      array = type.find('[') == std::string::npos ? "" : type.substr(type.find('['));
    const std::string base = type.substr(0, type.find('['));
    writeShader(shader, "surface " + shader + "() {\n    " + base + " v" + array +
                            (base == "string" ? " = \"?\""
                             : array.empty()  ? " = 7"
                                              : " = {7}") +
                            ";\n    float found = " + call + "(" + quoted(name) + ", v);\n    Oi = 1;\n    Ci = color(found, " +
                            shown + ");\n}\n");
    Scene s(before + "WorldBegin\nSides 2\n" + inside + "Surface " + quoted(shader) + "\n" + kFloor + "WorldEnd\n" +
                (before.empty() ? "" : "FrameEnd\n"),
            under(Hider::Raytrace));
    return s.one(kView);
}

/// How many of the questions of a shader's body got a wrong answer; it says which.
float wrong(const std::string& variable, const std::string& body, const std::string& rib) {
    static int count = 0;
    const std::string shader = "asksall" + std::to_string(++count);
    writeShader(shader, "surface " + shader + "() {\n    float wrong = 0;\n    " + variable + ";\n" + body +
                            "    Oi = 1;\n    Ci = wrong;\n}\n");
    Scene s("WorldBegin\nSides 2\n" + rib + "Surface " + quoted(shader) + "\n" + kFloor + "WorldEnd\n", under(Hider::Raytrace));
    return s.one(kView).x;
}

TEST(Attributes, Numbers) {
    const struct {
        const char *name, *rib;
        float want;
    } rows[] = {{"Ri:ShadingRate", "ShadingRate 2\n", 2},
                {"Ri:Sides", "", 2},
                {"Ri:Matte", "", 0},
                {"GeometricApproximation:motionfactor", "GeometricApproximation \"motionfactor\" 2\n", 2},
                {"displacementbound:sphere", "Attribute \"displacementbound\" \"float sphere\" .5\n", .5f},
                {"trace:bias", "Attribute \"trace\" \"float bias\" .25\n", .25f},
                {"trace:displacements", "Attribute \"trace\" \"integer displacements\" 1\n", 1},
                {"trace:maxspeculardepth", "Attribute \"trace\" \"integer maxspeculardepth\" 5\n", 5},
                {"trace:maxdiffusedepth", "Attribute \"trace\" \"integer maxdiffusedepth\" 3\n", 3},
                {"photon:estimator", "Attribute \"photon\" \"integer estimator\" 50\n", 50},
                {"sides:doubleshaded", "Attribute \"sides\" \"integer doubleshaded\" 1\n", 1},
                {"visibility:camera", "Attribute \"visibility\" \"integer camera\" 1\n", 1},
                {"visibility:diffuse", "Attribute \"visibility\" \"integer diffuse\" 1\n", 1},
                {"visibility:specular", "Attribute \"visibility\" \"integer specular\" 1\n", 1},
                {"visibility:trace", "Attribute \"visibility\" \"integer trace\" 1\n", 1},
                {"visibility:transmission", "Attribute \"visibility\" \"integer transmission\" 1\n", 1},
                {"visibility:photon", "Attribute \"visibility\" \"integer photon\" 1\n", 1},
                {"dice:hair", "Attribute \"dice\" \"integer hair\" 1\n", 1},
                {"dice:rasterorient", "Attribute \"dice\" \"integer rasterorient\" 0\n", 0},
                {"cull:backfacing", "Attribute \"cull\" \"integer backfacing\" 0\n", 0},
                {"cull:hidden", "Attribute \"cull\" \"integer hidden\" 0\n", 0},
                {"derivatives:smooth", "Attribute \"derivatives\" \"integer smooth\" 0\n", 0},
                {"derivatives:centered", "Attribute \"derivatives\" \"integer centered\" 0\n", 0},
                {"subsurface:scale", "Attribute \"subsurface\" \"float scale\" 3\n", 3},
                {"subsurface:refractionindex", "Attribute \"subsurface\" \"float refractionindex\" 1.5\n", 1.5f},
                {"subsurface:shadingrate", "Attribute \"subsurface\" \"float shadingrate\" 2\n", 2},
                {"subsurface:samples", "Attribute \"subsurface\" \"integer samples\" 9\n", 9},
                {"attribute:light:samples", "Attribute \"light\" \"integer samples\" 4\n", 4},
                {"attribute:light:emitphotons", "Attribute \"light\" \"integer emitphotons\" 1\n", 1},
                {"irradiance:shadingrate", "Attribute \"irradiance\" \"float shadingrate\" 3\n", 3},
                {"irradiance:nsamples", "Attribute \"irradiance\" \"integer nsamples\" 9\n", 9},
                {"hider:composite", "Attribute \"hider\" \"integer composite\" 0\n", 0},
                {"user:mine", "Attribute \"user\" \"uniform float mine\" 11\n", 11},
                {"diffusedepth", "", 0}};
    std::string rib, body;
    for (const auto& r : rows) {
        rib += r.rib;
        body += "    v = 7;\n    if (attribute(" + quoted(r.name) + ", v) != 1 || v != " + std::to_string(r.want) +
                ") { wrong += 1; printf(\"%s %f\\n\", " + quoted(r.name) + ", v); }\n";
    }
    EXPECT_EQ(wrong("float v", body, rib), 0);
    EXPECT_EQ(asked("attribute", "float", "user:nobody", "", "v, 0"), Color(0, 7, 0));
}

TEST(Attributes, Texts) {
    const struct {
        const char *name, *rib, *want;
    } rows[] = {{"Ri:Orientation", "Orientation \"inside\"\n", "inside"},
                {"displacementbound:coordinatesystem", "Attribute \"displacementbound\" \"string coordinatesystem\" \"object\"\n",
                 "object"},
                {"grouping:membership", "Attribute \"grouping\" \"string membership\" \"g\"\n", "g"},
                {"identifier:name", "Attribute \"identifier\" \"string name\" \"thing\"\n", "thing"},
                {"photon:shadingmodel", "Attribute \"photon\" \"string shadingmodel\" \"glass\"\n", "glass"},
                {"photon:causticmap", "Attribute \"photon\" \"string causticmap\" \"c.map\"\n", "c.map"},
                {"photon:globalmap", "Attribute \"photon\" \"string globalmap\" \"g.map\"\n", "g.map"},
                {"subsurface:groupname", "Attribute \"subsurface\" \"string groupname\" \"skin\"\n", "skin"},
                {"attribute:light:samplingstrategy", "Attribute \"light\" \"string samplingstrategy\" \"trace\"\n", "trace"},
                {"light:units", "Attribute \"light\" \"string units\" \"samples\"\n", "samples"},
                {"user:word", "Attribute \"user\" \"uniform string word\" \"w\"\n", "w"}};
    std::string rib, body;
    for (const auto& r : rows) {
        rib += r.rib;
        body += "    v = \"?\";\n    if (attribute(" + quoted(r.name) + ", v) != 1 || v != " + quoted(r.want) +
                ") { wrong += 1; printf(\"%s %s\\n\", " + quoted(r.name) + ", v); }\n";
    }
    EXPECT_EQ(wrong("string v", body, rib), 0);
    EXPECT_EQ(asked("attribute", "string", "Ri:Orientation", "", "v == \"outside\" ? 1 : 0, 0"), Color(1, 1, 0));
}

TEST(Attributes, ColoursArraysAndSpaces) {
    EXPECT_EQ(asked("attribute", "color", "Ri:Color", "Color .5 .25 1\n", "comp(v, 0), comp(v, 1)"), Color(1, .5f, .25f));
    EXPECT_EQ(asked("attribute", "color", "Ri:Opacity", "Opacity .5 .25 1\n", "comp(v, 0), comp(v, 1)"), Color(1, .5f, .25f));
    for (const char* name : {"absorption", "scattering", "meanfreepath", "reflectance"})
        EXPECT_EQ(asked("attribute", "color", std::string("subsurface:") + name,
                        std::string("Attribute \"subsurface\" \"color ") + name + "\" [.5 2 3]\n", "comp(v, 0), comp(v, 1)"),
                  Color(1, .5f, 2))
            << name;
    EXPECT_EQ(asked("attribute", "float[4]", "Ri:DetailRange", "DetailRange 0 1 200000 300000\n", "v[1], v[3]"),
              Color(1, 1, 300000));
    EXPECT_EQ(asked("attribute", "float[8]", "Ri:TextureCoordinates", "TextureCoordinates 0 .5 1 0 0 1 1 .25\n", "v[1], v[7]"),
              Color(1, .5f, .25f));
    EXPECT_EQ(asked("attribute", "matrix", "Ri:Transformation", "Translate 0 0 4\n", "comp(v, 3, 2), comp(v, 0, 0)"),
              Color(1, 4, 1));
    EXPECT_EQ(asked("attribute", "matrix", "Ri:CoordinateSystem:here",
                    "TransformBegin\nTranslate 0 5 0\nCoordinateSystem \"here\"\nTransformEnd\n", "comp(v, 3, 1), comp(v, 3, 0)"),
              Color(1, 5, 0));
    EXPECT_EQ(asked("attribute", "color", "user:tone", "Attribute \"user\" \"uniform color tone\" [.5 2 3]\n",
                    "comp(v, 0), comp(v, 1)"),
              Color(1, .5f, 2));
}

// One side faces the eye; the normal lies across the floor.
TEST(Attributes, Sides) {
    const Color front = asked("attribute", "float", "geometry:frontfacing", "", "v, 0"),
                back = asked("attribute", "float", "geometry:backfacing", "", "v, 0");
    EXPECT_EQ(front.y + back.y, 1);
    EXPECT_EQ(asked("attribute", "float", "geometry:frontfacing", "ReverseOrientation\n", "v, 0").y, back.y);
    EXPECT_EQ(asked("attribute", "normal", "geometry:geometricnormal", "", "abs(ycomp(v)), xcomp(v)"), Color(1, 1, 0));
}

// The box is that of the primitive's own space, whatever turns it; of what moves, that of all times.
TEST(Attributes, BoxOfThePrimitive) {
    const auto box = [](const std::string& before, int k) {
        const std::string n = std::to_string(k);
        return asked("attribute", "float[6]", "geometry:boundingbox", before, "v[" + n + "], v[" + std::to_string(k + 1) + "]");
    };
    EXPECT_EQ(box("", 0), Color(1, -60, 60));
    EXPECT_EQ(box("Rotate 30 0 1 0\n", 2), Color(1, 0, 0));
    EXPECT_EQ(box("Rotate 30 0 1 0\n", 4), Color(1, -60, 60));
    const struct {
        const char* kind;
        std::vector<float> numbers;
        float zmin, zmax, x;
    } quadrics[] = {{"Sphere", {2, -1, 5, 90}, -1, 2, 2},
                    {"Cone", {3, -.5f, 360}, 0, 3, .5f},
                    {"Cylinder", {1.5f, -2, 1, 360}, -2, 1, 1.5f},
                    {"Hyperboloid", {3, 4, -1, .25f, 0, 2, 360}, -1, 2, 5},
                    {"Paraboloid", {1, .5f, 2, 360}, .5f, 2, 1},
                    {"Disk", {.25f, 4, 360}, .25f, .25f, 4},
                    {"Torus", {2, .5f, 0, 360, 360}, -.5f, .5f, 2.5f}};
    for (const auto& q : quadrics) {
        scene::Primitive p;
        p.kind = q.kind;
        p.numbers = q.numbers;
        EXPECT_EQ(objectBox(p), (std::array<float, 6>{-q.x, q.x, -q.x, q.x, q.zmin, q.zmax})) << q.kind;
    }
    scene::Primitive p;
    p.kind = "Sphere";
    p.numbers = {1, -1, 1, 360};
    p.motionKeys.push_back(std::make_shared<scene::Primitive>(p));
    p.motionKeys[0]->numbers = {3, -2, 1, 360};
    EXPECT_EQ(objectBox(p), (std::array<float, 6>{-3, 3, -3, 3, -2, 1}));
    p = {};
    p.kind = "Blobby";
    EXPECT_FALSE(objectBox(p));
}

// The sizes that shaders give add up; the displacement shader names the space.
TEST(Attributes, BoundsOfShaders) {
    writeShader("moves", "displacement moves(float __displacementbound_sphere = .5; string __displacementbound_coordinatesystem "
                         "= \"object\";) { P += 0 * N; }\n");
    writeShader(
        "asksbound",
        R"(surface asksbound(float __displacementbound_sphere = .25; string __displacementbound_coordinatesystem = "world";) {
    float v = 7; string t = "?";
    float a = attribute("shaderdisplacementbound:sphere", v), b = attribute("shaderdisplacementbound:coordinatesystem", t);
    Oi = 1;
    Ci = color(a + b, v, t == "object" ? 1 : t == "world" ? 2 : 0);
}
)");
    auto of = [&](const std::string& more) {
        return Scene("WorldBegin\nSides 2\nShadingRate 64\n" + more + "Surface \"asksbound\"\n" +
                         "Polygon \"P\" [-1 -1 9  1 -1 9  1 1 9  -1 1 9]\n" + "WorldEnd\n",
                     under(Hider::Raytrace))
            .one(rayTo({0, 0, 0}, {.1f, .2f, 9}));
    };
    EXPECT_EQ(of(""), Color(2, .25f, 2));
    EXPECT_EQ(of("Displacement \"moves\"\n"), Color(2, .75f, 1));
}

// In a loop over lights, those of the light.
TEST(Attributes, OfTheLightInALoop) {
    writeShader("askslight", R"(surface askslight() {
    float n = 7; string name = "?";
    Oi = 1;
    illuminance(P) {
        float a = attribute("light:user:n", n), b = attribute("light:identifier:name", name);
        Ci += color(a + b, n, name == "key" ? 1 : 0);
    }
}
)");
    auto light = [](const char* name, const char* n) {
        return std::string("AttributeBegin\nAttribute \"identifier\" \"string name\" ") + name +
               "\nAttribute \"user\" \"uniform float n\" " + n + "\nLightSource \"pointlight\" " + n +
               " \"from\" [0 2 0]\nAttributeEnd\nIlluminate " + n + " 1\n";
    };
    Scene s("WorldBegin\nSides 2\n" + light("\"key\"", "3") + light("\"fill\"", "4") + "Surface \"askslight\"\n" + kFloor +
                "WorldEnd\n",
            under(Hider::Raytrace));
    EXPECT_EQ(s.one(kView), Color(4, 7, 1)) << s.messages();
}

// In a light's own shader, those that it was made with; the surface's are not its.
TEST(Attributes, InLights) {
    writeShader("asksitself", R"(light asksitself(point from = 0;) {
    float n = 7, rate = 7, nobody = 7; string name = "?";
    float a = attribute("user:n", n), b = attribute("identifier:name", name), c = attribute("Ri:ShadingRate", rate),
        d = attribute("user:ofsurface", nobody);
    illuminate(from) Cl = color(a + b + c + d, n + 10 * rate + 100 * nobody, name == "key" ? 1 : 0) / (L . L);
}
)");
    writeShader("sums", "surface sums() { Oi = 1; illuminance(P) Ci += Cl * (L . L); }\n");
    Scene s(std::string("WorldBegin\nSides 2\nAttributeBegin\nAttribute \"identifier\" \"string name\" \"key\"\nAttribute "
                        "\"user\" \"uniform float n\" 3\nShadingRate 2\n"
                        "LightSource \"asksitself\" 1 \"from\" [0 2 0]\nAttributeEnd\nIlluminate 1 1\nAttribute \"user\" "
                        "\"uniform float n\" 5\n"
                        "Attribute \"user\" \"uniform float ofsurface\" 5\nSurface \"sums\"\n") +
                kFloor + "WorldEnd\n",
            under(Hider::Raytrace));
    const Color got = s.one(kView);
    EXPECT_NEAR(got.x, 3, 1e-5) << s.messages();
    EXPECT_NEAR(got.y, 3 + 20 + 700, 1e-3);
    EXPECT_NEAR(got.z, 1, 1e-5);
}

TEST(Options, ByName) {
    const std::string before = "FrameBegin 3\nFormat 64 32 1\nFrameAspectRatio 2\nPixelSamples 3 2\nPixelVariance .5\nShutter "
                               ".25 .75\nClipping 1 100\nCropWindow 0 1 0 .5\n"
                               "ScreenWindow -3 2 -1 1\nDepthOfField 4 .5 10\nHider \"raytrace\"\nDisplay \"here.tif\" \"null\" "
                               "\"rgba\"\nOption \"trace\" \"integer maxdepth\" 5\n"
                               "Option \"limits\" \"integer[2] bucketsize\" [16 8]\nOption \"user\" \"float mine\" 3\nOption "
                               "\"user\" \"string word\" \"w\"\n";
    const struct {
        const char *type, *name, *shown;
        Color want;
    } rows[] = {{"float", "Ri:Frame", "v, 0", {1, 3, 0}},
                {"float[3]", "Ri:Format", "v[0], v[1] + 1000 * v[2]", {1, 64, 1032}},
                {"float[2]", "Ri:PixelSamples", "v[0], v[1]", {1, 3, 2}},
                {"float", "Ri:PixelVariance", "v, 0", {1, .5f, 0}},
                {"float[2]", "Ri:Shutter", "v[0], v[1]", {1, .25f, .75f}},
                {"float[2]", "Ri:Clipping", "v[0], v[1]", {1, 1, 100}},
                {"float[4]", "Ri:CropWindow", "v[1], v[3]", {1, 1, .5f}},
                {"float[4]", "Ri:ScreenWindow", "v[0], v[1]", {1, -3, 2}},
                {"float", "Ri:FrameAspectRatio", "v, 0", {1, 2, 0}},
                {"float[3]", "Ri:DepthOfField", "v[0] + v[1], v[2]", {1, 4.5f, 10}},
                {"string", "Ri:Hider", "v == \"raytrace\" ? 1 : 0, 0", {1, 1, 0}},
                {"string", "Ri:Display", "v == \"here.tif\" ? 1 : 0, 0", {1, 1, 0}},
                {"float", "trace:maxdepth", "v, 0", {1, 5, 0}},
                {"float[2]", "limits:bucketsize", "v[0], v[1]", {1, 16, 8}},
                {"float", "user:mine", "v, 0", {1, 3, 0}},
                {"string", "user:word", "v == \"w\" ? 1 : 0, 0", {1, 1, 0}},
                {"float", "user:nobody", "v, 0", {0, 7, 0}}};
    for (const auto& r : rows) EXPECT_EQ(asked("option", r.type, r.name, "", r.shown, before), r.want) << r.name;
}

// A card one above the floor shows what rayinfo() gives for the ray that comes from there, and for the camera's.
TEST(RayInfo, EveryKeyword) {
    const struct {
        const char* what;
        Color specular, diffuse, camera;
    } rows[] = {
        {"float v = 7; float f = rayinfo(\"depth\", v); Ci = color(f, v, 0);", {1, 1, 0}, {1, 1, 0}, {1, 0, 0}},
        {"float v = 7; float f = rayinfo(\"speculardepth\", v); Ci = color(f, v, 0);", {1, 1, 0}, {1, 0, 0}, {1, 0, 0}},
        {"float v = 7; float f = rayinfo(\"diffusedepth\", v); Ci = color(f, v, 0);", {1, 0, 0}, {1, 1, 0}, {1, 0, 0}},
        {"float v = 7; float f = rayinfo(\"weight\", v); Ci = color(f, v, 0);", {1, 1, 0}, {1, 1, 0}, {1, 1, 0}},
        {"float v = 7; float f = rayinfo(\"length\", v); Ci = color(f, v, 0);", {1, 1, 0}, {1, 1, 0}, {1, 2, 0}},
        {"point v = 7; float f = rayinfo(\"origin\", v); Ci = color(f, ycomp(v), xcomp(v));", {1, 0, 0}, {1, 0, 0}, {1, 3, 0}},
        {"vector v = 7; float f = rayinfo(\"direction\", v); Ci = color(f, ycomp(v), xcomp(v));",
         {1, 1, 0},
         {1, 1, 0},
         {1, -1, 0}},
        {"string v = \"?\"; float f = rayinfo(\"label\", v); Ci = color(f, v == \"probe\" ? 1 : v == \"\" ? 2 : 0, 0);",
         {1, 1, 0},
         {1, 1, 0},
         {1, 2, 0}},
        {"string v = \"?\"; float f = rayinfo(\"type\", v); Ci = color(f, v == \"specular\" ? 1 : v == \"diffuse\" ? 2 : v == "
         "\"camera\" ? 3 : 0, 0);",
         {1, 1, 0},
         {1, 2, 0},
         {1, 3, 0}},
        {"float v = 7; float f = rayinfo(\"nosuch\", v); Ci = color(f, v, 0);", {0, 7, 0}, {0, 7, 0}, {0, 7, 0}}};
    writeShader("sends", "surface sends(string kind = \"specular\";) { Oi = 1; Ci = trace(point \"world\" (0, 0, 0), vector "
                         "\"world\" (0, 1, 0), \"type\", kind, \"label\", \"probe\"); }\n");
    int n = 0;
    for (const auto& r : rows) {
        const std::string card = "tells" + std::to_string(++n);
        writeShader(card, "surface " + card + "() { Oi = 1; " + r.what + " }\n");
        auto of = [&](const char* kind) {
            return "WorldBegin\nSides 2\nAttribute \"visibility\" \"integer trace\" 1\nAttribute \"visibility\" \"integer "
                   "diffuse\" 1\nAttribute \"visibility\" \"integer specular\" 1\n"
                   "Surface \"" +
                   card + "\"\nPolygon \"P\" [-.5 1 -.5  -.5 1 .5  .5 1 .5  .5 1 -.5]\nSurface \"sends\" \"kind\" \"" + kind +
                   "\"\n" + kFloor + "WorldEnd\n";
        };
        const auto near = [&](const Color& c, const Color& want, const char* which) {
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], 1e-5) << r.what << " " << which;
        };
        const CameraRay low = rayTo({3, .5f, 0}, {0, 0, 0});
        near(Scene(of("specular"), under(Hider::Raytrace)).one(low), r.specular, "specular");
        Scene s(of("diffuse"), under(Hider::Raytrace));
        near(s.one(low), r.diffuse, "diffuse");
        near(s.one(rayTo({0, 3, 0}, {0, 1, 0})), r.camera, "camera");
    }
}

} // namespace

} // namespace attributes_test
