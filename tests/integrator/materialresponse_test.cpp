// Class surfaces of PRMan that know themselves only by how they answer to directions: directlighting() asks the lights,
// indirectspecular() sends the rays that the material wants.
#include "integrator/floorscene.h"

namespace plausible_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

// From 60 degrees above the floor, and one of half the colour straight from above.
const char* kTwoLights = "LightSource \"distantlight\" 1 \"intensity\" 2 \"from\" [0 1 1.7320508] \"to\" [0 0 0]\n"
                         "LightSource \"distantlight\" 2 \"lightcolor\" [.5 .5 .5] \"from\" [0 1 0] \"to\" [0 0 0]\n";

/// Diffuse like a matte of the colour (1, .5, .25), and a "specular" that is the same everywhere: a quarter per steradian over
/// pi.
std::string material(const std::string& methods) {
    return R"(class material(output varying color apart = 0;) {
    shader m_lights[];
    public void prelighting(output color Ci, Oi) { m_lights = getlights(); }
    public void evaluateSamples(string distribution; output __radiancesample samples[]) {
        uniform float i;
        for (i = 0; i < arraylength(samples); i += 1) {
            float cosine = max(0, samples[i]->direction . shadingnormal(N));
            if (distribution == "diffuse") samples[i]->setMaterialResponse(color(1, .5, .25) * cosine / PI, cosine / PI);
            else samples[i]->setMaterialResponse(.25 / PI, .1);
        }
    }
)" + methods +
           "}\n";
}

// The light of two lights at 1/2 and at 1: diffuse is 1.5, the other lobe a quarter of 2 + 1/2.
TEST(Plausible, LightsByTheAnswersOfTheMaterial) {
    writeShader("sums", material("public void lighting(output color Ci, Oi) { Ci = directlighting(this, m_lights); Oi = 1; }\n"));
    writeShader("parts", material(R"(public void lighting(output color Ci, Oi) {
        color d = 0, s = 0;
        __radiancesample samps[];
        directlighting(this, m_lights, "specularresult", s, "diffuseresult", d, "mis", 1, "materialsamples", samps);
        Ci = color(comp(d, 1), comp(s, 1), 0);
        Oi = 1;
    }
)"));
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        const Color sum = Scene(inWorld(kTwoLights + std::string("Surface \"sums\"\n") + kFloor), under(h)).one(kView);
        const Color part = Scene(inWorld(kTwoLights + std::string("Surface \"parts\"\n") + kFloor), under(h)).one(kView);
        const float expected[] = {1.5f + .625f, .75f + .625f, .375f + .625f};
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(sum[k], expected[k], 1e-5) << k;
        EXPECT_NEAR(part[0], .75, 1e-5);
        EXPECT_NEAR(part[1], .625, 1e-5);
    }
}

// Without lighting() the two halves come one after the other, each with its own part; the second finds the first in Ci.
TEST(Plausible, HalvesOfTheLighting) {
    writeShader("halves",
                material("public void diffuselighting(output color Ci, Oi, Ii) { Ci = directlighting(this, m_lights); Oi = 1; }\n"
                         "public void specularlighting(output color Ci, Oi) { Ci = color(comp(Ci, 0), comp(directlighting(this, "
                         "m_lights), 0), 0); }\n"));
    const Color c = Scene(inWorld(kTwoLights + std::string("Surface \"halves\"\n") + kFloor), under(Hider::Hidden)).one(kView);
    EXPECT_NEAR(c[0], 1.5, 1e-5);
    EXPECT_NEAR(c[1], .625, 1e-5);
}

// A card of colour (.5, .25, 1) above the floor, where two of three rays go: one answers 1/2 with density 1/4, one 1/2 with
// density 1.
TEST(Plausible, RaysWhereTheMaterialWantsThem) {
    writeShader("card", "surface card() { Oi = 1; Ci = color(.5, .25, 1); }\n");
    writeShader("mirrors", material(R"(public void generateSamples(string type; output __radiancesample samples[]) {
        resize(samples, 3);
        samples[0]->direction = vector(0, 1, 0);
        samples[0]->setMaterialResponse(.5, .25);
        samples[1]->direction = vector(0, 1, 0);
        samples[1]->setMaterialResponse(.5, 1);
        samples[2]->direction = vector(1, .001, 0);
        samples[2]->setMaterialResponse(9, 1);
    }
    public void lighting(output color Ci, Oi) { Ci = indirectspecular(this, "samplebase", 1); Oi = 1; }
)"));
    const std::string card = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"card\"\nPolygon \"P\" [-9 1 -9  -9 "
                             "1 9  9 1 9  9 1 -9]\nAttributeEnd\n";
    const Color c = Scene(inWorld(card + "Surface \"mirrors\"\n" + kFloor), under(Hider::Raytrace)).one(kView);
    const float each = 2.5f / 3;
    EXPECT_NEAR(c[0], .5 * each, 1e-5);
    EXPECT_NEAR(c[1], .25 * each, 1e-5);
    EXPECT_NEAR(c[2], 1 * each, 1e-5);
}

// "position": where the rays start. Above the card they meet nothing.
TEST(Plausible, IndirectSpecularStartsAtAPosition) {
    writeShader("card", "surface card() { Oi = 1; Ci = color(.5, .25, 1); }\n");
    writeShader("starts", R"(class starts() {
    public void generateSamples(string type; output __radiancesample samples[]) {
        resize(samples, 1);
        samples[0]->direction = vector(0, 1, 0);
        samples[0]->setMaterialResponse(.5, .25);
    }
    public void surface(output color Ci, Oi) {
        Ci = color(comp(indirectspecular(this, "position", P + vector(0, 2, 0)), 0),
                   comp(indirectspecular(this, "position", P + vector(0, .5, 0), "usemotionbias", 1), 1),
                   comp(indirectspecular(this), 2));
        Oi = 1;
    }
})");
    const std::string card = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"card\"\nPolygon \"P\" [-9 1 -9  -9 "
                             "1 9  9 1 9  9 1 -9]\nAttributeEnd\n";
    const Color c = Scene(inWorld(card + "Surface \"starts\"\n" + kFloor), under(Hider::Raytrace)).one(kView);
    EXPECT_EQ(c[0], 0);
    EXPECT_NEAR(c[1], .25 * 2, 1e-5);
    EXPECT_NEAR(c[2], 1 * 2, 1e-5);
}

// Of another shader object, and of some of the lights only: the light at 60 degrees gives 1 (diffuse) and 2 / 4, the other 1/2
// and 1/8.
TEST(Plausible, OtherObjectsAndChosenLights) {
    writeShader("other", material(""));
    writeShader("listing", material(R"(public void lighting(output color Ci, Oi) {
        shader one[1];
        one[0] = getlight("1");
        Ci = color(comp(directlighting(this, one), 0), comp(diffuselighting(this, one), 0),
                   comp(specularlighting(this, m_lights), 0));
        Oi = 1;
    }
)"));
    writeShader("asks", R"(class asks() { public void surface(output color Ci, Oi) {
        shader one[1];
        one[0] = getlight("2");
        shader m = getshader("material");
        color d = 0, s = 0, ud = 0, us = 0;
        color both = directlighting(m, "diffuseresult", d, "specularresult", s, "unshadoweddiffuseresult", ud,
                                    "unshadowedspecularresult", us, "mis", 1, "integrationdomain", "sphere");
        Ci = color(comp(directlighting(m, one), 0), comp(diffuselighting(m, one), 0), comp(specularlighting(m, one), 0));
        color sd = 0, ss = 0, su = 0, sv = 0;
        if (specularlighting(m, "diffuseresult", sd, "specularresult", ss, "unshadoweddiffuseresult", su,
                             "unshadowedspecularresult", sv, "mis", 0, "integrationdomain", "sphere") != ss || sd != d || su != d
            || sv != ss) Ci += 100;
        if (diffuselighting(m, "diffuseresult", sd, "specularresult", ss, "unshadoweddiffuseresult", su,
                            "unshadowedspecularresult", sv, "mis", 0, "integrationdomain", "sphere") != d || ss != s) Ci += 100;
        Ci += 10 * color(comp(both, 0), comp(diffuselighting(m), 0) + comp(d, 0) + comp(ud, 0),
                         comp(specularlighting(m) + s + us, 0));
        Oi = 1;
    } }
)");
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        const Color listed = Scene(inWorld(kTwoLights + std::string("Surface \"listing\"\n") + kFloor), under(h)).one(kView);
        EXPECT_NEAR(listed[0], 1.5, 1e-5);
        EXPECT_NEAR(listed[1], 1, 1e-5);
        EXPECT_NEAR(listed[2], .625, 1e-5);
        const Color asked =
            Scene(inWorld(kTwoLights + std::string("Shader \"other\" \"material\"\nSurface \"asks\"\n") + kFloor), under(h))
                .one(kView);
        EXPECT_NEAR(asked[0], .625 + 10 * 2.125, 1e-4);
        EXPECT_NEAR(asked[1], .5 + 10 * 3 * 1.5, 1e-4);
        EXPECT_NEAR(asked[2], .125 + 10 * 3 * .625, 1e-4);
    }
}

// The rays that another object wants, and those that may not go as far as the card.
TEST(Plausible, RaysWhereAnotherMaterialWantsThem) {
    writeShader("card", "surface card() { Oi = 1; Ci = color(.5, .25, 1); }\n");
    const std::string generates = R"(public void generateSamples(string type; output __radiancesample samples[]) {
        resize(samples, 2);
        samples[0]->direction = vector(0, 1, 0);
        samples[0]->setMaterialResponse(.5, .25);
        samples[1]->direction = vector(1, .001, 0);
        samples[1]->setMaterialResponse(9, 1);
    }
)";
    writeShader("wants", "class wants() {\n" + generates + "}\n");
    writeShader("short", "class short() {\n" + generates + R"(public void surface(output color Ci, Oi) {
        Ci = color(comp(indirectspecular(this, "maxdist", .5), 0),
                   comp(indirectspecular(this, "maxdist", 2, "label", "far", "hitmode", "shader"), 0), 0);
        Oi = 1; } }
)");
    writeShader("sends", R"(class sends() { public void surface(output color Ci, Oi) {
        shader m = getshader("material");
        Ci = indirectspecular(m);
        color close = indirectspecular(m, "bias", .01, "maxdist", .5, "label", "near", "subset", "", "hitmode", "default",
                                       "hitsides", "both", "samplebase", 1, "integrationdomain", "sphere");
        if (comp(close, 0) != 0) Ci = -1;
        color above = indirectspecular(m, "position", P + vector(0, 2, 0), "usemotionbias", 1);
        if (comp(above, 0) != 0) Ci = -2;
        Oi = 1; } }
)");
    const std::string card = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"card\"\nPolygon \"P\" [-9 1 -9  -9 "
                             "1 9  9 1 9  9 1 -9]\nAttributeEnd\n";
    const Color c =
        Scene(inWorld(card + "Shader \"wants\" \"material\"\nSurface \"sends\"\n" + kFloor), under(Hider::Raytrace)).one(kView);
    EXPECT_NEAR(c[0], .5, 1e-5); // 2 / 2 of the card's .5
    EXPECT_NEAR(c[1], .25, 1e-5);
    EXPECT_NEAR(c[2], 1, 1e-5);
    const Color s = Scene(inWorld(card + "Surface \"short\"\n" + kFloor), under(Hider::Raytrace)).one(kView);
    EXPECT_EQ(s[0], 0);
    EXPECT_NEAR(s[1], .5, 1e-5);
}

} // namespace

} // namespace plausible_test
