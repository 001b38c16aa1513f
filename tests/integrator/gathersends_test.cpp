// gather with "send:surface:NAME": values for parameters of the surfaces that its rays meet.
#include "integrator/gatherscene.h"

namespace gathersends_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;
using namespace alpenglow::integrator::gatherscene;

namespace {

Moments of(const std::string& surface, const std::string& scene, Hider h = Hider::Path, int n = 1) {
    Scene s(inWorld(kSeen + surface + scene), withShaders(h));
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

// Every type goes to parameters of that type, arrays element by element; a text is another one at each point. What is not sent,
// or does not fit, stays as the scene has it. A parameter that is asked for is what was sent.
TEST(GatherSends, EveryType) {
    writeShader("hearsall",
                "surface hearsall(float level = 9; string who = \"none\"; string two[2] = {\"x\", \"y\"}; matrix m = 1;\n"
                "                 float w[3] = {1, 2, 3}; color tints[] = {color(9)}; normal side = 0; vector way = 0;) {\n"
                "    float texts = 0, n = arraylength(tints);\n"
                "    if (who == \"me\") texts += 1; if (who == \"you\") texts += 2;\n"
                "    if (two[0] == \"b\") texts += 10; if (two[1] == \"y\") texts += 20;\n"
                "    color last = tints[n - 1]; Oi = Os;\n"
                "    Ci = color(texts + 100 * n, comp(m, 3, 0) + 10 * w[0] + 100 * w[1] + 1000 * w[2],\n"
                "               last[0] + 10 * side[1] + 100 * way[2] + 1000 * level); }\n");
    const std::string scene = kSmall + "AttributeBegin Surface \"hearsall\" Sphere 2 -2 2 360 AttributeEnd\n";
    const auto seen = [&](const std::string& pairs, Hider h, const std::string& setup = "") {
        return of(runs("gall", setup + "gather(\"\", P, up, PI / 2, 16, \"surface:Ci\", c" + pairs + ") sum += c / 16;", "sum"),
                  scene, h);
    };
    for (const Hider h : kAll) {
        const Moments none = seen("", h);
        EXPECT_NEAR(none.mean(0), 120, 1e-4) << int(h);
        EXPECT_NEAR(none.mean(1), 3210, 1e-3) << int(h);
        EXPECT_NEAR(none.mean(2), 9009, 1e-3) << int(h);
        const Moments all = seen(
            ", \"send:surface:who\", who, \"send:surface:two\", two, \"send:surface:m\", m, \"send:surface:w\", w,"
            " \"send:surface:tints\", many, \"send:surface:side\", side, \"send:surface:way\", way",
            h,
            "string who = \"me\"; if (u > 2) who = \"you\"; string two[1] = {\"b\"}; matrix m = translate(1, vector(5, 0, 0));"
            "float w[2] = {4, 6}; color many[]; push(many, color(1)); push(many, color(2)); push(many, color(3));"
            "normal side = normal(0, 7, 0); vector way = vector(0, 0, 8);");
        EXPECT_NEAR(all.mean(0), 1 + 10 + 20 + 300, 1e-4) << int(h);
        EXPECT_NEAR(all.mean(1), 5 + 40 + 600 + 3000, 1e-3) << int(h);
        EXPECT_NEAR(all.mean(2), 3 + 70 + 800 + 9000, 1e-3) << int(h);
        // Of another type: not taken.
        const Moments wrong =
            seen(", \"send:surface:who\", 3, \"send:surface:m\", color(2), \"send:surface:tints\", w", h, "float w[2] = {4, 6};");
        EXPECT_NEAR(wrong.mean(0), 120, 1e-4) << int(h);
        EXPECT_NEAR(wrong.mean(1), 3210, 1e-3) << int(h);
        const Moments asked =
            of(runs("gask",
                    "gather(\"\", P, up, PI / 2, 16, \"send:surface:level\", 4, \"surface:level\", f, \"send:surface:who\", "
                    "\"it\", \"surface:who\", text) { sum += color(f, 1, 0) / 16; if (text == \"it\") hits += 1; }",
                    "color(sum[0], hits, 0)"),
               scene, h);
        EXPECT_NEAR(asked.mean(0), 4, 1e-5) << int(h);
        EXPECT_NEAR(asked.mean(1), 16, 1e-5) << int(h);
    }
}

// The displacement and the atmosphere of what is hit, and the light that it is.
TEST(GatherSends, ToOtherShaders) {
    writeShader("displacesent", "displacement displacesent(float k = 1; string s = \"\"; output varying float gives = 0;) {\n"
                                "    gives = 2 * k; if (s == \"sent\") gives += 100; }\n");
    writeShader("hazesent", "volume hazesent(float k = 1; string s = \"\";) { Ci += k; if (s == \"sent\") Ci += 10; }\n");
    writeShader("plainsent", "surface plainsent() { Ci = .5; Oi = 1; }\n");
    const auto seen = [](const std::string& pairs, const std::string& out, const std::string& scene, Hider h) {
        return of(runs("gother", "gather(\"\", P, up, PI / 2, 16, " + pairs + ") sum += (" + out + ") / 16;", "sum"),
                  kSmall + "AttributeBegin " + scene + " Surface \"plainsent\" Sphere 2 -2 2 360 AttributeEnd\n", h)
            .mean(0);
    };
    const std::string displaced = "Displacement \"displacesent\" \"float k\" 3", haze = "Atmosphere \"hazesent\"";
    for (const Hider h : kAll) {
        EXPECT_NEAR(seen("\"displacement:gives\", f", "color(f)", displaced, h), 6, 1e-4) << int(h);
        EXPECT_NEAR(seen("\"displacement:gives\", f, \"send:displacement:k\", 5, \"send:displacement:s\", \"sent\"", "color(f)",
                         displaced, h),
                    110, 1e-4)
            << int(h);
        EXPECT_NEAR(seen("\"surface:Ci\", c", "c", haze, h), 1.5, 1e-4) << int(h);
        for (const char* name : {"volume", "atmosphere"}) {
            const std::string to = std::string("\"send:") + name + ":";
            EXPECT_NEAR(seen("\"surface:Ci\", c, " + to + "k\", 4, " + to + "s\", \"sent\"", "c", haze, h), 14.5, 1e-4) << name;
        }
    }
    // A lamp of radiance k, which is met under "path" only.
    writeShader("lampsent", "light lampsent(float k = 1; color c[2] = {color(1), color(1)};) {\n"
                            "    illuminate(P, N, PI / 2) Cl = k * c[1]; }\n");
    const std::string lamp = "AreaLightSource \"lampsent\" 1 \"float k\" 2 ReverseOrientation";
    const double plain = seen("\"surface:Ci\", c", "c", lamp, Hider::Path);
    const double sent = seen("\"surface:Ci\", c, \"send:light:k\", 6", "c", lamp, Hider::Path);
    EXPECT_NEAR(plain, 2.5, 1e-4);
    EXPECT_NEAR(sent, 6.5, 1e-4);
}

// A name in a variable means what it says: of an output, of a parameter that takes a value, of an argument.
TEST(GatherSends, NamesInVariables) {
    const std::string scene = kSmall + "AttributeBegin Surface \"hearsname\" Sphere 2 -2 2 360 AttributeEnd\n";
    writeShader("hearsname",
                "surface hearsname(float level = 9; output varying float out = 0;) { Oi = 1; Ci = level; out = level + 1; }\n");
    const std::string names =
        "string what = concat(\"surface:\", \"Ci\"), to = \"send:surface:level\", far = \"maxdist\", out = \"surface:out\";";
    for (const Hider h : kAll) {
        const Moments m =
            of(runs("gnames",
                    names + "gather(\"\", P, up, PI / 2, 16, what, c, to, 3, out, f) sum += c / 16 + color(0, f / 16, 0);"
                            "gather(\"\", P, up, PI / 2, 16, far, 1) hits += 1;",
                    "color(sum[0], sum[1], hits)"),
               scene, h);
        EXPECT_NEAR(m.mean(0), 3, 1e-4) << int(h);
        EXPECT_NEAR(m.mean(1), 7, 1e-4) << int(h); // 3, and 4
        EXPECT_NEAR(m.mean(2), 0, 1e-4) << int(h); // the ball is farther away
    }
}

} // namespace

} // namespace gathersends_test
