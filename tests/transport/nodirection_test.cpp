// Rays that published shaders send: without a direction, as refract() gives at total reflection, and for what lies behind an
// atmosphere.
#include "transport/floorscene.h"

namespace nodirection_test {

using namespace alpenglow;
using namespace alpenglow::transport;
using namespace alpenglow::transport::testing;

namespace {

constexpr Hider kAll[] = {Hider::Hidden, Hider::Raytrace, Hider::Path};
const std::string kCard = "AttributeBegin\nSurface \"constant\" Color 1 .5 .25 Translate 0 2 0\n"
                          "Polygon \"P\" [-9 0 -9  -9 0 9  9 0 9  9 0 -9]\nAttributeEnd\n";

Color shown(const std::string& name, const std::string& body, Hider h, const std::string& around = "") {
    writeShader(name, "surface " + name +
                          "() { vector none = refract(normalize(vector(1, 0.01, 0)), normal(0, -1, 0), 1.5), up = " +
                          "vector \"world\" (0, 1, 0); color c = 0; float d = 0; Ci = 0; Oi = 1; " + body + " }\n");
    Scene s(world("Attribute \"visibility\" \"int trace\" 1\n" + around + kCard + "Surface \"" + name + "\"\n" + kFloor),
            withShaders(h));
    return s.one(kView);
}

} // namespace

// The card is above the floor, along N.
TEST(NoDirection, TraceOfNowhereIsBlack) {
    for (const Hider h : kAll) {
        EXPECT_EQ(shown("nd_up", "Ci = trace(P, up);", h), Color(1, .5f, .25f)) << int(h);
        EXPECT_EQ(shown("nd_zero", "Ci = trace(P, vector 0);", h), Color(0)) << int(h);
        EXPECT_EQ(shown("nd_refract", "Ci = trace(P, none);", h), Color(0)) << int(h);
        EXPECT_EQ(shown("nd_sky", "Ci = trace(P, none);", h, "LightSource \"envlight\" \"sky\" \"intensity\" 1\n"), Color(0))
            << int(h);
        // A shader that waits for the ray, and what it is told.
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
