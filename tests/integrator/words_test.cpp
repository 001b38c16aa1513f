// Words of published light shaders: Ngs, getlights(); and rays that are asked for nothing but the light of area lights.
#include "integrator/floorscene.h"

namespace words_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

std::string scene(const std::string& lights, const std::string& surface) {
    return "WorldBegin\nSides 2\n" + lights + "AttributeBegin\nSurface \"" + surface + "\"\n" + kFloor +
           "AttributeEnd\nWorldEnd\n";
}
void expectEverywhere(const std::string& rib, Color want, const std::string& what) {
    for (Hider h : {Hider::Hidden, Hider::Path})
        for (bool suspend : {false, true}) {
            Scene s(rib, under(h, suspend));
            const Color c = s.one(kView);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(c[k], want[k], 1e-5 * std::max(1.f, want[k]))
                    << what << ", hider " << int(h) << (suspend ? ", suspended" : "") << s.messages();
            EXPECT_EQ(s.diagnostics.warnings(), 0) << what << s.messages();
        }
}

// Whatever the shader of the surface makes of N: the floor's own normal is (0, 1, 0).
TEST(PublishedLights, GeometricNormalOfTheLitPoint) {
    writeShader("ngs", R"(light ngs() {
    extern normal Ngs;
    illuminate(point "world" (0, 2, 0)) {
        vector n = vtransform("world", vector(normalize(Ngs)));
        Cl = color(abs(xcomp(n)), abs(ycomp(n)), abs(zcomp(n)));
    }
}
)");
    writeShader("turnedn", "surface turnedn() { Oi = 1; Ci = 0; N = ntransform(\"world\", \"current\", normal(1, 0, 0)); "
                           "illuminance(P) Ci += Cl; }\n");
    writeShader("plainn",
                "surface plainn() { Oi = 1; Ci = diffuse(faceforward(normalize(N), I)); }\n"); // straight below the light
    expectEverywhere(scene("LightSource \"ngs\" 1\n", "turnedn"), {0, 1, 0}, "illuminance");
    expectEverywhere(scene("LightSource \"ngs\" 1\n", "plainn"), {0, 1, 0}, "diffuse");
}

// A light without area has no normal of its own: N is that of the lit point, which PRMan's indirectlight.sl and its kin light.
TEST(PublishedLights, NormalOfLightsWithoutArea) {
    const std::string tells = "{ vector n = vtransform(\"world\", vector(normalize(N))); "
                              "Cl = color(abs(xcomp(n)), abs(ycomp(n)), abs(zcomp(n))) + color(0, 1, 0); }";
    writeShader("nabove", "light nabove() { illuminate(Ps + normalize(N)) " + tells + " }\n");
    writeShader("npoint", "light npoint() { illuminate(point \"world\" (0, 2, 0)) " + tells + " }\n");
    writeShader("nsolar", "light nsolar() { solar(vector \"world\" (0, -1, 0), 0) " + tells + " }\n");
    writeShader("allofn", "surface allofn() { Oi = 1; Ci = 0; illuminance(P, shadingnormal(N), PI / 2) Ci += Cl; }\n");
    writeShader("diffusen", "surface diffusen() { Oi = 1; Ci = diffuse(faceforward(normalize(N), I)); }\n");
    for (const char* light : {"nabove", "npoint", "nsolar"})
        for (const char* surface : {"allofn", "diffusen"})
            expectEverywhere(scene(std::string("LightSource \"") + light + "\" 1\n", surface), {0, 2, 0},
                             std::string(light) + ", " + surface);
}

// The lights of the surface that is lit, with itself; those that are off for it are not there.
TEST(PublishedLights, LightsOfTheLitSurface) {
    writeShader("lamp", "light lamp(float c = 1; string __category = \"\";) { illuminate(point \"world\" (0, 2, 0)) Cl = c; }\n");
    const std::string lamps = "LightSource \"lamp\" 1 \"float c\" 3 \"string __category\" \"a\"\nLightSource \"lamp\" 2 \"float "
                              "c\" 4 \"string __category\" \"a,b\"\n"
                              "LightSource \"counts\" 9 \"string __category\" \"n\"\n";
    writeShader("bycount", "surface bycount() { Oi = 1; Ci = 0; illuminance(\"n\", P) Ci += Cl; }\n");
    const struct {
        const char* body;
        float all, without;
    } cases[] = {{"shader l[] = getlights(); Cl = arraylength(l);", 3, 2},
                 {"shader l[] = getlights(\"category\", \"a\"); Cl = arraylength(l);", 2, 1},
                 {"shader l[] = getlights(\"category\", \"b\"); float f = 0; if (arraylength(l) > 0) f = l[0]->c; Cl = f;", 4, 0},
                 {"shader l = getlight(\"1\"); Cl = l->c;", 3, 3},
                 {"shader l = getlight(\"2\"); Cl = (l == null) ? 7 : 5;", 5, 7}};
    for (const auto& c : cases) {
        writeShader("counts", std::string("light counts(string __category = \"\";) { illuminate(point \"world\" (0, 2, 0)) { ") +
                                  c.body + " } }\n");
        expectEverywhere(scene(lamps, "bycount"), Color(c.all), c.body);
        expectEverywhere(scene(lamps + "Illuminate 2 0\n", "bycount"), Color(c.without), std::string("one off: ") + c.body);
    }
}

// One light does not run another: they could run each other without end.
TEST(PublishedLights, LightsDoNotRunEachOther) {
    writeShader("lamp", "light lamp(float c = 1; string __category = \"\";) { illuminate(point \"world\" (0, 2, 0)) Cl = c; }\n");
    writeShader("asksother", "light asksother() { vector D = 0; color C = 5; shader l = getlight(\"1\"); l->light(D, C); "
                             "illuminate(point \"world\" (0, 2, 0)) Cl = C; }\n");
    writeShader("alllight", "surface alllight() { Oi = 1; Ci = 0; illuminance(P) Ci += Cl; }\n");
    Scene s(scene("LightSource \"lamp\" 1\nLightSource \"asksother\" 2\n", "alllight"), under(Hider::Hidden));
    EXPECT_NEAR(s.one(kView).x, 1 + 5, 1e-5);
    EXPECT_NE(s.messages().find("not yet available in a light shader"), std::string::npos) << s.messages();
}

// evalparam() in a co-shader means its parameters, as the scene sets them.
TEST(PublishedWords, ParametersOfTheShaderWhoseMethodRuns) {
    writeShader("named", "class named(float gain = 1; string which = \"gain\";) { public float get() { float x = 0; float ok = "
                         "evalparam(which, x); return 10 * ok + x; } }\n");
    writeShader("asksnamed", "surface asksnamed(float gain = 7;) { shader h = getshader(\"A\"); float own = 0; float ok = "
                             "evalparam(\"gain\", own); Oi = 1; Ci = color(h->get(), own + ok, 0); }\n");
    expectEverywhere(scene("Shader \"named\" \"A\" \"float gain\" 3\n", "asksnamed"), {13, 8, 0}, "co-shader");
}

// trace() of which nothing but the light of area lights is wanted sends no ray where there is no such light; the result itself
// needs them.
TEST(TraceForAreaLights, NoRaysWithoutLights) {
    const auto write = [](const char* name, const char* result) {
        writeShader(name, std::string("surface ") + name + R"(() {
    normal Nf = faceforward(normalize(N), I);
    color gives = 0;
    color c = trace(P, vector(Nf), "type", "transmission", "samplearealights", 1, "samples", 16, "bsdf", "cosine",
                    "arealightcontribution", gives);
    Oi = 1;
    Ci = )" + result + R"(;
    if (comp(gives, 0) > 1000) Ci = 0;
}
)");
    };
    write("lightonly", "color(0.25) + gives");
    write("everything", "color(0.25) + gives + 0.5 * c");
    const std::string card = "AttributeBegin\nAttribute \"visibility\" \"transmission\" 1\nSurface \"constant\"\nPolygon \"P\" "
                             "[-9 3 -9  -9 3 9  9 3 9  9 3 -9]\nAttributeEnd\n";
    const auto rays = [&](const char* name, const std::string& more, Color& color) {
        std::string rib = scene("", name);
        rib.insert(rib.find("AttributeBegin"), more);
        Scene s(rib, under(Hider::Raytrace));
        Counters counters;
        color = s.trace({&kView, 1}, &counters)[0].color;
        return counters.diffuse + counters.specular + counters.transmission;
    };
    Color c;
    EXPECT_EQ(rays("lightonly", card, c), 0u);
    EXPECT_EQ(c.x, .25f);
    EXPECT_GE(rays("everything", card, c), 16u);
    // A light to one side: of the directions some meet the ball about it.
    const std::string light =
        "AttributeBegin\nTranslate 2 3 0\nAttribute \"light\" \"string units\" \"radiance\" AreaLightSource \"arealight\" 7 "
        "\"intensity\" 1\nSphere 0.2 -0.2 0.2 360\nAttributeEnd\nIlluminate 7 1\n";
    EXPECT_LT(rays("lightonly", light, c), 16u);
}

} // namespace

} // namespace words_test
