// Loops over lights by their handles: getlights(), handle->light().
#include "base/limits.h"
#include "services/lightloopscene.h"

namespace lightloop_test {
namespace {

// handle->light() asks all samples of a light: what it gives is the light of the whole of it, with less noise.
TEST(LightHandles, LightOfAllSamples) {
    writeShader("halfdark", "light halfdark() { illuminate(P, N, PI / 2) Cl = xcomp(transform(\"world\", P)) > 0 ? 8 : 0; }\n");
    surfaceOf("byhandle", R"(    shader all[] = getlights();
    vector l = 0; color c = 0;
    all[0]->light(l, c);
    Ci = c * max(0, normalize(-l) . normal "world" (0, 1, 0));)");
    auto with = [&](int n) {
        const std::string disk =
            "AttributeBegin\nAttribute \"light\" \"integer samples\" [" + std::to_string(n) +
            "]\nAttribute \"light\" \"string units\" \"radiance\" AreaLightSource \"halfdark\" 7\nSurface \"constant\"\n"
            "Color 0 0 0\nTranslate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\nAttributeEnd\nIlluminate 7 1\n";
        return Scene(scene(disk, "\"byhandle\""), under(Hider::Hidden)).estimate(kView, samples(6000));
    };
    const auto one = with(1), nine = with(9);
    expectMean(one, 4 * .49 / 4.49, .03, "one sample");
    expectMean(nine, 4 * .49 / 4.49, .015, "nine samples");
    EXPECT_LT(nine.se(), one.se() * .5); // a third, but for the order of sequences
}

TEST(LightHandles, LoopsByHand) {
    writeLights();
    const std::string lights = flat(1, 1, 2, category("a")) + flat(2, 4, 3, category("b")) + flat(3, 16, 5, category("a,b"));
    const struct {
        const char* body;
        float want;
    } cases[] = {{"shader l[] = getlights(); Ci = arraylength(l);", 3},
                 {"shader l[] = getlights(\"category\", \"a\"); Ci = arraylength(l);", 2},
                 {"shader l[] = getlights(\"category\", \"a&-b\"); Ci = arraylength(l);", 1},
                 {"shader l[] = getlights(\"category\", \"none\"); Ci = arraylength(l);", 0},
                 {"vector D; color C; shader l[] = getlights(); float i; for (i = 0; i < arraylength(l); i += 1) { "
                  "l[i]->light(D, C); Ci += C; }",
                  21},
                 {"vector D; color C; shader l[] = getlights(\"category\", \"a\"); uniform float n = arraylength(l), i; for (i = "
                  "0; i < n; i += 1) "
                  "{ l[i]->light(D, C); Ci += C * (vector \"world\" (0, 1, 0) . normalize(-D)); }",
                  17},
                 {"vector D; color C; getlight(\"2\")->light(D, C); Ci = length(D);", 3},
                 {"vector D = 7; color C = 5; shader s = getlight(\"9\"); s->light(D, C); Ci = C;", 5},
                 {"shader s = getlight(\"3\"); Ci = s->h;", 5},
                 {"float v = 0; shader s = getlight(\"2\"); Ci = 10 * getvar(s, \"c\", v); Ci += v;", 14},
                 {"float v = 3; shader s = getlight(\"2\"); Ci = 10 * getvar(s, \"nothing\", v); Ci += v;", 3},
                 {"illuminance(P) Ci += islightcategory(\"a\") * Cl;", 17},
                 {"illuminance(P) Ci += islightcategory(\"a&b\") * Cl;", 16}};
    for (const auto& c : cases) {
        surfaceOf("byhand", std::string("    ") + c.body);
        expectEverywhere(scene(lights, "\"byhand\""), Color(c.want), c.body);
    }
}

// The limit of handles: the rest is left out, and said.
TEST(LightHandles, NoMoreThanTheLimit) {
    writeLights();
    std::string lights;
    for (int i = 0; i < limits::kLightHandles + 3; ++i) lights += flat(i + 1, 1);
    surfaceOf("many", "    shader l[] = getlights(); Ci = arraylength(l);");
    Scene s(scene(lights, "\"many\""), under(Hider::Hidden));
    EXPECT_NEAR(s.one(kView).x, limits::kLightHandles, 1e-4);
    EXPECT_NE(s.messages().find("getlights() returns at most"), std::string::npos) << s.messages();
}

// Under path the light that a handle gives has its shadow.
TEST(LightHandles, CastShadows) {
    writeLights();
    surfaceOf("shadowed", "    vector D; color C; shader l[] = getlights(); float i; for (i = 0; i < arraylength(l); i += 1) { "
                          "l[i]->light(D, C); Ci += C; }");
    const std::string roof =
        "AttributeBegin\nSurface \"constant\"\nPolygon \"P\" [-1 1 -1  1 1 -1  1 1 1  -1 1 1]\nAttributeEnd\n";
    Scene s(scene(flat(1, 1) + flat(2, 4, .5f) + roof, "\"shadowed\""), under(Hider::Path));
    EXPECT_NEAR(s.one(kView).x, 4, 1e-5);
}

} // namespace
} // namespace lightloop_test
