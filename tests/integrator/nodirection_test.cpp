// Rays that published shaders send: without a direction, as refract() gives at total reflection, and for what lies behind an
// atmosphere.
#include "integrator/floorscene.h"

namespace nodirection_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

constexpr Hider kAll[] = {Hider::Hidden, Hider::Raytrace, Hider::Path};
const std::string kCard = "AttributeBegin\nSurface \"constant\" Color 1 .5 .25 Translate 0 2 0\n"
                          "Polygon \"P\" [-9 0 -9  -9 0 9  9 0 9  9 0 -9]\nAttributeEnd\n";

Color shown(const std::string& name, const std::string& body, Hider h, const std::string& around = "") {
    writeShader(name, "surface " + name +
                          "() { vector none = refract(normalize(vector(1, 0.01, 0)), normal(0, -1, 0), 1.5), up = " +
                          "vector \"world\" (0, 1, 0); color c = 0; float d = 0; Ci = 0; Oi = 1; " + body + " }\n");
    Scene s(inWorld("Attribute \"visibility\" \"int trace\" 1\n" + around + kCard + "Surface \"" + name + "\"\n" + kFloor),
            withShaders(h));
    return s.one(kView);
}

} // namespace

// A direction has no length: 1e38 is as good as 1, and so is 1e-35. Squares of both are no floats.
TEST(NoDirection, NoLengthIsTooLongOrTooShort) {
    const std::string bodies[] = {
        "Ci = trace(P, way);",
        "c = trace(P, way, d); Ci = c + (d > 2 ? 1 : 0);",
        "gather(\"illuminance\", P, way, 0.01, 4, \"surface:Ci\", c) Ci += c / 4;",
        "Ci = occlusion(P, normal way, 16);",
        "Ci = indirectdiffuse(P, normal way, 16);",
        "illuminance(P, normal way, .8) Ci += Cl * color(1, 2, 3);",
        "N = normal way; gather(\"illuminance\", P, normal way, 0.5, 4, \"surface:Ci\", c) Ci += c / 4;",
    };
    int n = 0;
    // The card is beside the normal, the light nearer to the way than to the normal.
    const std::string beside = "AttributeBegin\nSurface \"constant\" Color 1 .5 .25 Translate 0 2 0\n"
                               "Polygon \"P\" [.8 0 -9  .8 0 9  9 0 9  9 0 -9]\nAttributeEnd\n";
    for (const std::string& body : bodies) {
        const std::string name = "nd_long" + std::to_string(n++);
        writeShader(name, "surface " + name +
                              "(float size = 1) { color c = 0; float d = 0; Ci = 0; Oi = 1; vector way = size * "
                              "vector \"world\" (.5, 1, .5); " +
                              body + " }\n");
        for (const Hider h : kAll) {
            const auto of = [&](const char* size) {
                Scene s(inWorld("Attribute \"visibility\" \"int trace\" 1 \"int diffuse\" 1\nLightSource \"distantlight\" 1 "
                                "\"from\" [.3 1 1.5] \"to\" [0 0 0]\n" +
                                beside + "Surface \"" + name + "\" \"size\" [" + size + "]\n" + kFloor),
                        withShaders(h));
                return s.one(kView);
            };
            const Color one = of("1");
            EXPECT_GT(maxComponent(one), .1f) << body << int(h);
            for (const char* size : {"1e38", "1e-35"}) {
                const Color c = of(size);
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], one[k], 1e-4f) << body << size << int(h);
            }
        }
    }
}

// The card is above the floor, along N.
TEST(NoDirection, TraceOfNowhereIsBlack) {
    for (const Hider h : kAll) {
        EXPECT_EQ(shown("nd_up", "Ci = trace(P, up);", h), Color(1, .5f, .25f)) << int(h);
        EXPECT_EQ(shown("nd_zero", "Ci = trace(P, vector 0);", h), Color(0)) << int(h);
        EXPECT_EQ(shown("nd_refract", "Ci = trace(P, none);", h), Color(0)) << int(h);
        EXPECT_EQ(shown("nd_sky", "Ci = trace(P, none);", h, "LightSource \"envlight\" \"sky\" \"intensity\" 1\n"), Color(0))
            << int(h);
        // A shader that waits for the ray, and what it is given.
        const Color waits =
            shown("nd_waits", "c = trace(P, none, d); Ci = color(comp(c, 0) > 0.1 ? 1 : 0.5, d > 1e30 ? 1 : 0, 1);", h);
        EXPECT_EQ(waits, Color(.5f, 1, 1)) << int(h);
    }
}

TEST(NoDirection, GatherMissesThere) {
    for (const Hider h : kAll)
        EXPECT_EQ(
            shown("nd_gather", "gather(\"illuminance\", P, none, 0, 1, \"surface:Ci\", c) Ci = c; else Ci = color(0, 0, 1);", h),
            Color(0, 0, 1))
            << int(h);
}

// volume:Ci is what comes through the air, that of the surface where there is none: fog of which 2 units let through e^-1.
TEST(NoDirection, GatherBehindTheAir) {
    const std::string loop = "gather(\"illuminance\", P, up, 0, 1, \"volume:Ci\", c) Ci = c;";
    for (const Hider h : kAll) {
        EXPECT_EQ(shown("nd_volume", loop, h), Color(1, .5f, .25f)) << int(h);
        const Color fog = shown("nd_fog", loop, h, "Atmosphere \"fog\" \"distance\" 2 \"background\" [0 0 0]\n");
        // The fog between eye and floor takes its part, too: the eye is sqrt(.89) away.
        const float through = float(std::exp(-1.) * std::exp(-std::sqrt(.89) / 2));
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(fog[k], through / float(1 << k), 2e-4f) << int(h);
        EXPECT_EQ(shown("nd_opacity", "gather(\"illuminance\", P, up, 0, 1, \"volume:Oi\", c) Ci = c;", h), Color(1)) << int(h);
    }
}

} // namespace nodirection_test
