// Surface shaders that move P displace their primitives; what displacement shaders share and do not share.
#include "integrator/floorscene.h"

namespace moving_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kSquare = "Patch \"bilinear\" \"P\" [-1 -1 3  1 -1 3  -1 1 3  1 1 3]\n";
std::string square(const std::string& shaders, const std::string& x = "0") {
    return "AttributeBegin\nShadingRate 25\nTranslate " + x + " 0 0\n" + shaders + "\n" + kSquare + "AttributeEnd\n";
}

// The square z = 3 comes half a unit nearer, once: the depth of the sample and the P that later statements see.
TEST(SurfaceMovesP, OnceAndForRays) {
    writeShader("nearer", "surface nearer(float by = .5;) { P -= vector \"world\" (0, 0, by); Oi = 1; Ci = color(zcomp(P)); }\n");
    for (Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        Scene s(inWorld(square("Surface \"nearer\"")), under(h));
        const CameraRay ray = rayTo({0, 0, 0}, {.3f, .2f, 3});
        const SampleResult r = s.trace({&ray, 1})[0];
        EXPECT_NEAR(r.z, 2.5, 1e-5);
        EXPECT_NEAR(r.color.x, 2.5, 1e-5);
        EXPECT_NE(s.messages().find("surface shader \"nearer\" moves P: it displaces its primitives"), std::string::npos)
            << s.messages();
        // At z = 2.5 the square ends at x = 1: this ray met the square of z = 3 at x = 1.08 and is the first to hit only the
        // moved one.
        EXPECT_NEAR(s.one(rayTo({0, 0, 0}, {.9f, 0, 2.5f})).x, 2.5, 1e-5);
        EXPECT_EQ(s.one(rayTo({0, 0, 0}, {1.02f, 0, 2.5f})).x, 0);
    }
}
TEST(SurfaceMovesP, ASphereGrows) {
    writeShader("grows", "surface grows(float by = .2;) { P += by * normalize(N); N = calculatenormal(P); Oi = 1; Ci = "
                         "color(length(P - point \"object\" (0, 0, 0))); }\n");
    Scene s(inWorld("Translate 0 0 4\nSurface \"grows\"\nSphere 1 -1 1 360\n"), under(Hider::Path));
    auto height = [](float y) { return rayTo({0, y, 0}, {0, y, 4}); };
    EXPECT_NEAR(s.one(height(1.15f)).x, 1.2, 1e-3);
    EXPECT_EQ(s.one(height(1.22f)).x, 0);
}
// Direct light and shadows are those of the moved floor: a light one above it, and a card beneath it that shades only where it
// was.
TEST(SurfaceMovesP, LightMeetsTheMovedSurface) {
    writeShader("lifted", "surface lifted() { P += vector \"world\" (0, 1, 0); normal Nf = faceforward(normalize(N), I); Oi = 1; "
                          "Ci = diffuse(Nf); }\n");
    writeShader("liftedloop", R"(surface liftedloop() {
    P += vector "world" (0, 1, 0);
    normal Nf = faceforward(normalize(N), I);
    color sum = 0;
    illuminance(P, Nf, PI / 2) sum += Cl * (normalize(L) . Nf);
    Oi = 1;
    Ci = sum;
}
)");
    const std::string lights = "LightSource \"pointlight\" 1 \"intensity\" 3 \"from\" [0 2 0]\n";
    const std::string card =
        "AttributeBegin\nSurface \"constant\"\nPolygon \"P\" [-2 .5 -2  -2 .5 2  2 .5 2  2 .5 -2]\nAttributeEnd\n";
    for (const char* name : {"lifted", "liftedloop"})
        for (Hider h : {Hider::Hidden, Hider::Path}) {
            Scene s(inWorld(lights + card + "Surface \"" + name +
                            "\"\nShadingRate 9\nPolygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2]\n"),
                    under(h));
            EXPECT_NEAR(s.one(rayTo({.3f, 2.5f, -.4f}, {0, 1, 0})).x, 3, 1e-4) << name;
        }
}
// Its opacity belongs to the moved surface too: a quarter where P is at its new place.
TEST(SurfaceMovesP, OpacityOfShadows) {
    writeShader("veil", "surface veil() { P += vector \"world\" (0, 1, 0); Oi = abs(ycomp(transform(\"world\", P)) - 1) < .001 ? "
                        "color(.25) : color(1); Ci = 0; }\n");
    Scene s(
        inWorld("LightSource \"pointlight\" 1 \"intensity\" 4 \"from\" [0 2 0]\n"
                "AttributeBegin\nSurface \"veil\"\nShadingRate 9\nPolygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2]\nAttributeEnd\n"
                "Surface \"matte\" \"Ka\" 0 \"Kd\" 1\nPolygon \"P\" [-2 .5 -2  -2 .5 2  2 .5 2  2 .5 -2]\n"),
        under(Hider::Path));
    EXPECT_NEAR(s.one(rayTo({.1f, .9f, -.1f}, {0, .5f, 0})).x, .75 * 4 / (1.5 * 1.5), 1e-3);
}
// Rays, or lights that need more than their shaders, decide where P goes: that is not known when the primitive is diced. It
// stays, and says so; the shader sees its own P.
TEST(SurfaceMovesP, NotByRays) {
    writeShader(
        "bylight",
        "surface bylight() { illuminance(P) P -= vector \"world\" (0, 0, .5) * comp(Cl, 0); Oi = 1; Ci = color(zcomp(P)); }\n");
    writeShader("byrays", "surface byrays() { if (comp(transmission(P, P + vector(0, 0, -1)), 0) > .5) P -= vector \"world\" (0, "
                          "0, .5); Oi = 1; Ci = color(zcomp(P)); }\n");
    writeShader("seen", "light seen() { solar(vector(0, 0, 1), 0) Cl = transmission(Ps, Ps - vector(0, 0, 9)); }\n");
    const std::string sun = "LightSource \"distantlight\" 1 \"intensity\" 1 \"to\" [0 0 1]\n";
    struct Case {
        const char* shader;
        std::string lights;
        Hider hider;
    };
    for (const Case& k : {Case{"byrays", sun, Hider::Hidden}, Case{"bylight", sun, Hider::Path},
                          Case{"bylight", "LightSource \"seen\" 1\n", Hider::Hidden},
                          Case{"bylight", "Attribute \"light\" \"string shadows\" \"on\"\n" + sun, Hider::Hidden}}) {
        Scene s(inWorld(k.lights + square("Surface \"" + std::string(k.shader) + "\"")), under(k.hider));
        const CameraRay ray = rayTo({0, 0, 0}, {.3f, .2f, 3});
        const SampleResult r = s.trace({&ray, 1})[0];
        EXPECT_NEAR(r.z, 3, 1e-5) << k.shader << k.lights;
        EXPECT_NEAR(r.color.x, 2.5, 1e-5) << k.shader << k.lights;
        EXPECT_NE(s.messages().find("warning: surface shader \"" + std::string(k.shader) + "\" moves P by"), std::string::npos)
            << s.messages();
    }
}
// What lights are given decides: the square is where the sum of their parameters puts it, and of those in whose cone it lies.
TEST(SurfaceMovesP, ByLightsThatAreKnown) {
    writeShader("bysource", "surface bysource() { float by = 0, sum = 0; illuminance(P) { lightsource(\"intensity\", by); sum += "
                            "by; } P -= vector \"world\" (0, 0, sum); Oi = 1; Ci = color(zcomp(P)); }\n");
    writeShader(
        "bylight",
        "surface bylight() { illuminance(P) P -= vector \"world\" (0, 0, .5) * comp(Cl, 0); Oi = 1; Ci = color(zcomp(P)); }\n");
    const std::string lights = "LightSource \"distantlight\" 1 \"intensity\" .25 \"to\" [0 0 1]\n"
                               "LightSource \"pointlight\" 2 \"intensity\" .5 \"from\" [0 0 0]\n"
                               "LightSource \"spotlight\" 3 \"intensity\" 1 \"from\" [9 0 0] \"to\" [9 0 3] \"coneangle\" .1\n";
    for (Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        Scene s(inWorld(lights + square("Surface \"bysource\"")), under(h));
        const CameraRay ray = rayTo({0, 0, 0}, {.3f, .2f, 3});
        const SampleResult r = s.trace({&ray, 1})[0];
        EXPECT_NEAR(r.z, 2.25, 1e-5) << int(h);
        EXPECT_NEAR(r.color.x, 2.25, 1e-5) << int(h);
        EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
    }
    Scene s(inWorld("LightSource \"distantlight\" 1 \"intensity\" .5 \"to\" [0 0 1]\n" + square("Surface \"bylight\"")),
            under(Hider::Hidden));
    const CameraRay ray = rayTo({0, 0, 0}, {.3f, .2f, 3});
    EXPECT_NEAR(s.trace({&ray, 1})[0].z, 2.75, 1e-5);
}
// Assigning P what it was moves nothing, and light may decide about what is not P.
TEST(SurfaceMovesP, OnlyWhereItMoves) {
    writeShader("same", "surface same() { P = P; if (u > 2 && 1 > 2) P += N; Oi = 1; Ci = diffuse(N); }\n");
    Scene s(inWorld(square("Surface \"same\"")), under(Hider::Hidden));
    EXPECT_EQ(s.messages(), "");
    writeShader("talkslifted", "surface talkslifted() { P -= vector \"world\" (0, 0, .5); printf(\"once\\n\"); illuminance(P, N, "
                               "PI) Ci += Cl; Oi = 1; }\n");
    Scene t(inWorld(square("Surface \"talkslifted\"")), under(Hider::Hidden));
    t.one(rayTo({0, 0, 0}, {.3f, .2f, 3}));
    ::testing::internal::CaptureStdout();
    t.world->flushPrints(true);
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "once\n");
}
// With a displacement shader the surface stays where that put it.
TEST(SurfaceMovesP, NotBesideADisplacement) {
    writeShader("push", "displacement push(float by = .25;) { P -= vector \"world\" (0, 0, by); }\n");
    writeShader("nearer", "surface nearer(float by = .5;) { P -= vector \"world\" (0, 0, by); Oi = 1; Ci = color(zcomp(P)); }\n");
    Scene s(inWorld(square("Displacement \"push\"\nSurface \"nearer\"")), under(Hider::Hidden));
    const CameraRay ray = rayTo({0, 0, 0}, {.3f, .2f, 3});
    EXPECT_NEAR(s.trace({&ray, 1})[0].z, 2.75, 1e-5);
}
// A class that is surface and displacement displaces where it is named as surface only.
TEST(Displacement, OfAClass) {
    writeShader("both", R"(class both(float by = .5;) {
    public void displacement(output point P; output normal N) { P -= vector "world" (0, 0, by); }
    public void surface(output color Ci, Oi) { Oi = 1; Ci = color(zcomp(P)); }
}
)");
    Scene s(inWorld(square("Surface \"both\"")), under(Hider::Hidden));
    const CameraRay ray = rayTo({0, 0, 0}, {.3f, .2f, 3});
    const SampleResult r = s.trace({&ray, 1})[0];
    EXPECT_NEAR(r.z, 2.5, 1e-5);
    EXPECT_NEAR(r.color.x, 2.5, 1e-5);
}
// One Displacement request under two Surfaces: each keeps its own.
TEST(Displacement, SharedByTwoSurfaces) {
    writeShader("push", "displacement push(float by = .25;) { P -= vector \"world\" (0, 0, by); }\n");
    writeShader("first", "surface first() { Oi = 1; Ci = .25; }\n");
    writeShader("second", "surface second() { Oi = 1; Ci = .75; }\n");
    Scene s(inWorld("Displacement \"push\"\n" + square("Surface \"first\"", "-1.5") + square("Surface \"second\"", "1.5")),
            under(Hider::Hidden));
    const CameraRay rays[] = {rayTo({0, 0, 0}, {-1.5f, 0, 3}), rayTo({0, 0, 0}, {1.5f, 0, 3})};
    const auto r = s.trace(rays);
    EXPECT_EQ(r[0].color.x, .25f);
    EXPECT_EQ(r[1].color.x, .75f);
}
// Shapes under one Displacement request have object spaces of their own.
TEST(Displacement, ObjectSpaceOfEachShape) {
    writeShader("objectnormal", "displacement objectnormal() { N = normal(vector(transform(\"object\", P))); }\n");
    writeShader("shownormal", "surface shownormal() { Oi = 1; Ci = color(xcomp(N), ycomp(N), zcomp(N)); }\n");
    const std::string shapes = std::string("TransformBegin\nTranslate -1.5 0 0\n") + kSquare +
                               "TransformEnd\nTransformBegin\nTranslate 1.5 0 0\n" + kSquare + "TransformEnd\n";
    Scene s(inWorld("Displacement \"objectnormal\"\nSurface \"shownormal\"\n" + shapes), under(Hider::Hidden));
    const CameraRay rays[] = {rayTo({0, 0, 0}, {-1.25f, .5f, 3}), rayTo({0, 0, 0}, {1.75f, .5f, 3})};
    const auto r = s.trace(rays);
    for (int k : {0, 1}) {
        EXPECT_NEAR(r[size_t(k)].color.x, .25, 1e-4) << k;
        EXPECT_NEAR(r[size_t(k)].color.y, .5, 1e-4) << k;
        EXPECT_NEAR(r[size_t(k)].color.z, 3, 1e-4) << k;
    }
}
// Primitive variables override its parameters, and getvar(null, ...) finds them; of one batch with primitives without them.
TEST(Displacement, PrimitiveVariables) {
    writeShader("push", "displacement push(float by = .25;) { P -= vector \"world\" (0, 0, by); }\n");
    writeShader("pushvar",
                "displacement pushvar() { float far = .125; getvar(null, \"far\", far); P -= vector \"world\" (0, 0, far); }\n");
    writeShader("depth", "surface depth() { Oi = 1; Ci = color(zcomp(P)); }\n");
    const std::string declared = "Declare \"by\" \"uniform float\"\nDeclare \"far\" \"uniform float\"\n";
    auto with = [](const char* x, const char* more) {
        return std::string("TransformBegin\nTranslate ") + x +
               " 0 0\nPatch \"bilinear\" \"P\" [-1 -1 3  1 -1 3  -1 1 3  1 1 3] " + more + "\nTransformEnd\n";
    };
    const CameraRay rays[] = {rayTo({0, 0, 0}, {-1.5f, 0, 3}), rayTo({0, 0, 0}, {1.5f, 0, 3})};
    Scene a(declared + inWorld("Displacement \"push\"\nSurface \"depth\"\n" + with("-1.5", "\"by\" [.5]") + with("1.5", "")),
            under(Hider::Hidden));
    auto r = a.trace(rays);
    EXPECT_NEAR(r[0].color.x, 2.5, 1e-5);
    EXPECT_NEAR(r[1].color.x, 2.75, 1e-5);
    Scene b(declared + inWorld("Displacement \"pushvar\"\nSurface \"depth\"\n" + with("-1.5", "\"far\" [1]") + with("1.5", "")),
            under(Hider::Hidden));
    r = b.trace(rays);
    EXPECT_NEAR(r[0].color.x, 2, 1e-5);
    EXPECT_NEAR(r[1].color.x, 2.875, 1e-5);
}
// So do volumes.
TEST(Volumes, AskThePrimitive) {
    writeShader(
        "asksvolume",
        "volume asksvolume() { float far = .125; float f = getvar(null, \"far\", far); Ci = color(f, far, 0); Oi = 1; }\n");
    auto with = [](const char* x, const char* more) {
        return std::string("TransformBegin\nTranslate ") + x +
               " 0 0\nPatch \"bilinear\" \"P\" [-1 -1 3  1 -1 3  -1 1 3  1 1 3] " + more + "\nTransformEnd\n";
    };
    const CameraRay rays[] = {rayTo({0, 0, 0}, {-1.5f, 0, 3}), rayTo({0, 0, 0}, {1.5f, 0, 3})};
    Scene s(inWorld("Atmosphere \"asksvolume\"\nSurface \"constant\"\n" + with("-1.5", "\"uniform float far\" [1]") +
                    with("1.5", "")),
            under(Hider::Hidden));
    auto r = s.trace(rays);
    EXPECT_EQ(r[0].color, Color(1, 1, 0));
    EXPECT_EQ(r[1].color, Color(0, .125f, 0));
}

} // namespace

} // namespace moving_test
