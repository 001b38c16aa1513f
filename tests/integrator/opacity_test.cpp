// What shadow rays meet takes what its shader's Oi says; atmosphere takes from the light of emitters. Closed forms.
#include "base/limits.h"
#include "integrator/harness.h"
#include "rsl/compiler.h"

namespace opacity_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kFloor = "Polygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]\n";
const char* kSun = "LightSource \"distantlight\" 1 \"point from\" [0 1 0] \"point to\" [0 0 0]\n";

// A pane of [-1, 1]^2 at height 1 with u along x; the floor below is seen from beside it. Rays that leave the floor bring
// nothing.
std::string underPane(const std::string& pane) {
    return std::string("WorldBegin\nSides 2\n") + kSun + "AttributeBegin\n" + pane +
           "\nPatch \"bilinear\" \"P\" [-1 1 -1  1 1 -1  -1 1 1  1 1 1]\nAttributeEnd\nSurface \"matte\"\n" + kFloor +
           "WorldEnd\n";
}
Color floorAt(Scene& s, float x, float z) { return s.one(rayTo({x, .5f, z - .3f}, {x, 0, z})); }

TEST(ShadowOpacity, OfTheShader) {
    writeShader("constantpane", "surface constantpane() { Oi = color(.2, .5, .9); Ci = 0; }\n");
    writeShader("stripepane", "surface stripepane() { Oi = Os * color(u, step(.5, v), 1 - u * v); Ci = 0; }\n");
    writeShader("gluedpane", "surface gluedpane(color tint = 1;) { Oi = tint * Os * 2; Ci = 0; }\n");
    writeShader("printpane", "surface printpane(float k = 1;) { Oi = noise(P * 7); Ci = 0; }\n");
    Settings set;
    set.hider = Hider::Path;
    {
        Scene s(underPane("Surface \"constantpane\""), set);
        Color c = floorAt(s, .3f, .2f);
        EXPECT_NEAR(c.x, .8, 1e-5);
        EXPECT_NEAR(c.y, .5, 1e-5);
        EXPECT_NEAR(c.z, .1, 1e-5);
    }
    {
        Scene s(underPane("Opacity .5 1 1\nSurface \"stripepane\""), set);
        for (float x : {-.7f, -.1f, .4f, .8f})
            for (float z : {-.6f, .5f}) {
                float u = (x + 1) / 2, v = (z + 1) / 2;
                Color c = floorAt(s, x, z);
                EXPECT_NEAR(c.x, 1 - .5f * u, 1e-4);
                EXPECT_NEAR(c.y, v < .5f ? 1 : 0, 1e-5);
                EXPECT_NEAR(c.z, u * v, 1e-4);
            }
        EXPECT_NEAR(floorAt(s, 1.4f, 0).x, 1, 1e-5); // beside it
    }
    {
        Scene s(underPane("Opacity .25 .5 .75\nSurface \"gluedpane\" \"color tint\" [1 .5 1]"), set); // above 1: opaque
        Color c = floorAt(s, .3f, .2f);
        EXPECT_NEAR(c.x, .5, 1e-5);
        EXPECT_NEAR(c.y, .5, 1e-5);
        EXPECT_NEAR(c.z, 0, 1e-5);
    }
    { // Os is the primitive's: no shader needs to run
        Scene s(underPane("Opacity .4 .5 .6\nSurface \"matte\"\nColor 0 0 0"), set);
        Color c = floorAt(s, .3f, .2f);
        EXPECT_NEAR(c.x, .6, 1e-5);
        EXPECT_NEAR(c.z, .4, 1e-5);
    }
}
TEST(ShadowOpacity, TwoPanesMultiply) {
    writeShader("ramp", "surface ramp() { Oi = u; Ci = 0; }\n");
    std::string two = std::string("WorldBegin\nSides 2\n") + kSun +
                      "Surface \"ramp\"\nPatch \"bilinear\" \"P\" [-1 1 -1  1 1 -1  -1 1 1  1 1 1]\n" +
                      "Patch \"bilinear\" \"P\" [-1 2 -1  1 2 -1  -1 2 1  1 2 1]\nSurface \"matte\"\n" + kFloor + "WorldEnd\n";
    Settings set;
    set.hider = Hider::Path;
    Scene s(two, set);
    for (float x : {-.6f, 0.f, .5f}) EXPECT_NEAR(floorAt(s, x, .1f).x, std::pow(1 - (x + 1) / 2, 2), 1e-4);
}
TEST(ShadowOpacity, HitModes) {
    writeShader("ramp", "surface ramp() { Oi = u; Ci = 0; }\n");
    const struct {
        const char* attribute;
        double want;
    } cases[] = {{"", .5},
                 {"Attribute \"shade\" \"transmissionhitmode\" \"shader\"\n", .5},
                 {"Attribute \"shade\" \"transmissionhitmode\" \"primitive\"\n", .75},
                 {"Attribute \"visibility\" \"string transmission\" \"Os\"\n", .75},
                 {"Attribute \"visibility\" \"string transmission\" \"opaque\"\n", 0},
                 {"Attribute \"visibility\" \"string transmission\" \"transparent\"\n", 1}};
    Settings set;
    set.hider = Hider::Path;
    for (const auto& c : cases) {
        Scene s(underPane(std::string(c.attribute) + "Opacity .25 .25 .25\nSurface \"ramp\""), set);
        EXPECT_NEAR(floorAt(s, 0, .1f).x, c.want, 1e-4) << c.attribute;
    }
}
// An opacity that varies as a primitive variable, on a shader that hands it on.
TEST(ShadowOpacity, PrimitiveVariable) {
    std::string rib = std::string("WorldBegin\nSides 2\n") + kSun +
                      "AttributeBegin\nSurface \"matte\"\nColor 0 0 0\nPatch \"bilinear\" \"P\" [-1 1 -1  1 1 -1  -1 1 1  1 1 1] "
                      "\"Os\" [0 0 0  1 1 1  0 0 0  1 1 1]\nAttributeEnd\nSurface \"matte\"\n" +
                      kFloor + "WorldEnd\n";
    Settings set;
    set.hider = Hider::Path;
    Scene s(rib, set);
    for (float x : {-.5f, .2f}) EXPECT_NEAR(floorAt(s, x, .1f).x, 1 - (x + 1) / 2, 1e-4);
}
// The same for transmission(), which shaders call themselves, under hidden too. In the shader of the shadow isshadowray() is 1.
TEST(ShadowOpacity, TransmissionCall) {
    writeShader("onlyshadow", "surface onlyshadow() { Oi = isshadowray() * .75; Ci = 0; }\n");
    writeShader("looktransmission", "surface looktransmission() { Oi = 1; Ci = transmission(P, P + vector(0, 3, 0)); }\n");
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        Settings set;
        set.hider = h;
        Scene s("WorldBegin\nSides 2\nAttributeBegin\nSurface \"onlyshadow\"\nPatch \"bilinear\" \"P\" [-1 1 -1  1 1 -1  -1 1 1  "
                "1 1 1]\nAttributeEnd\nSurface \"looktransmission\"\n" +
                    std::string(kFloor) + "WorldEnd\n",
                set);
        EXPECT_NEAR(floorAt(s, .2f, .1f).x, .25, 1e-5);
        EXPECT_NEAR(floorAt(s, 3, .1f).x, 1, 1e-5);
    }
}
// Beyond the limit of layers nothing comes through, and it is counted.
TEST(ShadowOpacity, Layers) {
    for (int extra : {-1, 3}) {
        std::string panes = "AttributeBegin\nSurface \"constant\"\nOpacity 0 0 0\n";
        for (int i = 0; i < limits::kShadowLayers + extra; ++i) {
            std::string y = std::to_string(1 + i * .01);
            panes += "Polygon \"P\" [-1 " + y + " -1  1 " + y + " -1  1 " + y + " 1  -1 " + y + " 1]\n";
        }
        Settings set;
        set.hider = Hider::Path;
        Scene s(std::string("WorldBegin\nSides 2\n") + kSun + panes +
                    "AttributeEnd\nSurface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n" + kFloor + "WorldEnd\n",
                set);
        EXPECT_NEAR(floorAt(s, .2f, .1f).x, extra < 0 ? 1 : 0, 1e-5);
    }
}
// Light sampling and lobe sampling agree about a pane whose shader makes it transparent: both give (1 - Oi) of the light.
TEST(ShadowOpacity, AllEstimatorsAgree) {
    writeShader("noisypane", "surface noisypane() { Oi = .3 + .4 * step(.5, mod(40 * u, 1)); Ci = 0; }\n");
    double want = .5 * 5 * .49 / 4.49; // half of the stripes take .3, half .7; a stripe is far smaller than the disk
    for (int mode = 0; mode < 3; ++mode) {
        Settings set;
        set.hider = Hider::Path;
        set.bsdfOnly = mode == 1;
        set.lightOnly = mode == 2;
        Scene s("WorldBegin\nSides 2\nAttributeBegin\nAreaLightSource \"slrect\" 7 \"float intensity\" 5\nSurface "
                "\"constant\"\nColor 0 0 0\nTranslate 0 2 0\nRotate 90 1 0 0\n"
                "Disk 0 .7 360\nAttributeEnd\nIlluminate 7 1\nAttributeBegin\nSurface \"noisypane\"\nPatch \"bilinear\" \"P\" "
                "[-4 1.2 -4  4 1.2 -4  -4 1.2 4  4 1.2 4]\nAttributeEnd\n"
                "Surface \"matte\"\n" +
                    std::string(kFloor) + "WorldEnd\n",
                set);
        Moments m = s.estimate(rayTo({.3f, .8f, -.4f}, {0, 0, 0}), samples(mode == 1 ? 200000 : 20000));
        EXPECT_LE(std::fabs(m.mean() - want), kZ * m.se() + .01 * want) << mode;
        EXPECT_LE(m.se(), .01 * want);
    }
}

// Fog between an emitter and who sees it: 5 exp(-d / 3) straight; on the floor the integral over the disk with the same factor.
TEST(Atmosphere, AttenuatesEmitters) {
    const double R = .7, h = 2, D = 3;
    double sum = 0;
    const int n = 2000;
    for (int i = 0; i < n; ++i) { // midpoint rule; E / pi = int L T 2 r h^2 / d^4 dr
        double r = R * (i + .5) / n, d2 = r * r + h * h;
        sum += 5 * std::exp(-std::sqrt(d2) / D) * 2 * r * h * h / (d2 * d2) * R / n;
    }
    writeShader("floorloop2", "surface floorloop2() { color c = 0; illuminance(P, normal(0, 1, 0), PI / 2) { c += Cl * "
                              "(normalize(L) . vector(0, 1, 0)); } Ci = c; Oi = 1; }\n");
    for (int mode = 0; mode < 4; ++mode) {
        Settings set;
        set.hider = Hider::Path;
        set.bsdfOnly = mode == 1;
        set.lightOnly = mode == 2;
        Scene s(std::string("WorldBegin\nSides 2\nAttributeBegin\nAtmosphere \"fog\" \"float distance\" 3\nAreaLightSource "
                            "\"slrect\" 7 \"float intensity\" 5\nSurface \"constant\"\nColor 0 0 0\n"
                            "Translate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\nAttributeEnd\nIlluminate 7 1\nSurface \"") +
                    (mode == 3 ? "floorloop2" : "matte") + "\"\n" + kFloor + "WorldEnd\n",
                set);
        EXPECT_NEAR(s.one(rayTo({0, .5f, 0}, {0, 2, 0})).x, 5 * std::exp(-.5), 1e-4); // 1.5 away
        expectMean(s.estimate(rayTo({.3f, .8f, -.4f}, {0, 0, 0}), samples(mode == 1 ? 200000 : 20000)), sum, .01,
                   "mode " + std::to_string(mode));
    }
}
// What a shader asks for later loses as much as what it knows at once: a lit floor in fog, per channel, with a background.
TEST(Atmosphere, ScalesRequests) {
    writeShader("tintedfog", "volume tintedfog() { color t = color(.2, .5, .8); Ci = Ci * t + color(.1, .2, .3); Oi = 1; }\n");
    writeShader("loopfog", "volume loopfog() { float i; for (i = 0; i < 3; i += 1) Ci = mix(Ci, color(1, 0, 0), .5); if "
                           "(length(I) > 100) Ci = 0; Oi = 1; }\n");
    Settings set;
    set.hider = Hider::Path;
    std::string head = "WorldBegin\nSides 2\nLightSource \"pointlight\" 1 \"float intensity\" 8 \"point from\" [0 2 0]\n";
    CameraRay view = rayTo({.3f, .8f, -.4f}, {0, 0, 0});
    Scene tinted(head + "Atmosphere \"tintedfog\"\nSurface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n" + kFloor + "WorldEnd\n",
                 set);
    Color c = tinted.one(view);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], 2 * (.2 + .3 * k) + .1 * (k + 1), 1e-5);
    Scene looped(head + "Atmosphere \"loopfog\"\nSurface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n" + kFloor + "WorldEnd\n", set);
    Color d = looped.one(view);
    EXPECT_NEAR(d.x, 2 / 8. + 7 / 8., 1e-5);
    EXPECT_NEAR(d.y, 2 / 8., 1e-5);
    EXPECT_EQ(looped.messages().find("not affine"), std::string::npos) << looped.messages();
}
// The proof holds for what ships; a shader it cannot hold for is recognised.
TEST(Atmosphere, SlopeIsProved) {
    writeShader("squarefog", "volume squarefog() { Ci = Ci * Ci; Oi = 1; }\n");
    writeShader("channelfog", "volume channelfog() { Ci = comp(Ci, 0); Oi = 1; }\n");
    rsl::ShaderCompiler compiler;
    rsl::KernelOptions o;
    o.outputs = {"Ci", "Oi", "slope:Ci"};
    const struct {
        const char* name;
        bool affine;
    } cases[] = {{"fog", true}, {"depthcue", true}, {"squarefog", false}, {"channelfog", false}};
    for (const auto& c : cases) {
        Diagnostics d;
        auto shader = compiler.load(c.name, {shaderFolder(), ALPENGLOW_SOURCE_DIR "/shaders"}, d);
        ASSERT_NE(shader, nullptr) << c.name;
        auto k = compiler.analyse(*shader, o, d);
        ASSERT_NE(k, nullptr);
        bool has = false;
        for (const auto& out : k->outputs) has |= out.name == "slope:Ci";
        EXPECT_EQ(has, c.affine) << c.name;
    }
    Settings set;
    set.hider = Hider::Path;
    Scene s(std::string("WorldBegin\nSides 2\nAtmosphere \"squarefog\"\nSurface \"constant\"\nColor .5 .5 .5\n") + kFloor +
                "WorldEnd\n",
            set);
    EXPECT_NEAR(s.one(rayTo({.3f, .8f, -.4f}, {0, 0, 0})).x, .25, 1e-6); // constant light is squared exactly
    EXPECT_NE(s.messages().find("not affine in Ci"), std::string::npos);
}

} // namespace

} // namespace opacity_test
