// gather with "send:surface:NAME": values for parameters of the surfaces that its rays meet.
#include "integrator/gatherscene.h"

namespace gathersends_test {

using namespace alpenglow;
using namespace alpenglow::transport;
using namespace alpenglow::transport::testing;
using namespace alpenglow::transport::gatherscene;

namespace {

Moments of(const std::string& surface, const std::string& scene, Hider h = Hider::Path, int n = 1) {
    Scene s(world(kSeen + surface + scene), withShaders(h));
    return s.estimate(kNear, n);
}

// A surface has the values that a ray was sent with for its parameters, each ray its own, whatever primitives say of them; behind
// what is not opaque too. The camera, and other rays, see those of the scene.
TEST(GatherSends, ToParameters) {
    writeShader(
        "hears",
        "surface hears(float level = 9; color tint = color(1, .5, .25); point at = 0; float other = 7;) {\n"
        "    point p = transform(\"world\", at); Oi = Os; Ci = Oi * level * tint + color(0, 0, ycomp(p)) + other - 7; }\n");
    const auto scene = [](const char* colour) {
        return std::string("AttributeBegin Surface \"hears\" ") + colour +
               " Sphere 2 -2 2 360 \"constant float level\" .25 AttributeEnd\n";
    };
    const std::string sent = "gather(\"\", P, up, PI / 2, 64, \"surface:Ci\", c, \"send:surface:level\", 2 * g + 1, "
                             "\"send:surface:tint\", color(g, 1, 0), \"send:surface:at\", point \"world\" (0, .5, 0), "
                             "\"send:surface:none\", 3) { sum += c / 64; hits += 1; }";
    for (const Hider h : kAll) {
        const Moments m = of(runs("gsend", "g = .5; " + sent, "color(sum[0], sum[1], sum[2])"), kSmall + scene(""), h);
        EXPECT_NEAR(m.mean(0), 1, 1e-5) << int(h); // level 2, tint (.5, 1, 0)
        EXPECT_NEAR(m.mean(1), 2, 1e-5) << int(h);
        EXPECT_NEAR(m.mean(2), .5, 1e-5) << int(h);
        const Moments plain = of(runs("gplain",
                                      "gather(\"\", P, up, PI / 2, 64, \"surface:Ci\", c) sum += c / 64;" + sent + "sum = 0;" +
                                          "gather(\"\", P, up, PI / 2, 64, \"surface:Ci\", c) sum += c / 64;",
                                      "sum"),
                                 kSmall + scene(""), h);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(plain.mean(k), .25 / (1 << k), 1e-5) << int(h) << ' ' << k;
        // Two balls, the inner one half transparent: half of each.
        const Moments two =
            of(runs("gtwo",
                    "g = 0; gather(\"\", P, up, PI / 2, 64, \"surface:Ci\", c, \"send:surface:level\", 4, "
                    "\"send:surface:tint\", color(1)) sum += c / 64;",
                    "sum"),
               kSmall + scene("Opacity .5 .5 .5") + "AttributeBegin Surface \"hears\" Sphere 3 -3 3 360 AttributeEnd\n", h);
        EXPECT_NEAR(two.mean(0), 4, 1e-5) << int(h);
    }
}

} // namespace

} // namespace gathersends_test
