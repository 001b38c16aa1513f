// outputchannel() of lights and atmospheres under conditions: where the call is not reached, what others gave to the output
// stays.
#include "integrator/floorscene.h"

namespace givenchannels_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

using Floats = std::vector<float>;

/// The outputs at x = -1 and at x = 1 of the floor, in one batch.
std::vector<Floats> sides(const std::string& rib, Hider h, const std::vector<std::string>& outputs) {
    Settings set = under(h);
    set.outputs = outputs;
    Scene s(inWorld(rib + kFloor), set);
    EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
    std::vector<Floats> all;
    for (const auto& r : s.trace(std::vector<CameraRay>{rayTo({-1, 2, 0}, {-1, 0, 0}), rayTo({1, 2, 0}, {1, 0, 0})}))
        all.push_back(r.aovs);
    return all;
}

void writeTellers() {
    writeShader(
        "tellsall",
        "light tellsall(float by = 5;) { illuminate(point \"world\" (0, 20, 0)) { Cl = 1; outputchannel(\"told\", by); } }\n");
    writeShader("tellsright", R"(light tellsright(float by = 7;) {
    illuminate(point "world" (0, 20, 0)) { Cl = 1; if (xcomp(transform("world", Ps)) > 0) outputchannel("told", by); }
}
)");
    writeShader("tellsincone", R"(light tellsincone(float by = 7;) {
    illuminate(point "world" (1, 2, 0), vector "world" (0, -1, 0), .3) { Cl = 1; outputchannel("told", by); }
}
)");
}

std::string teller(const char* shader, int handle, float by) {
    return std::string("LightSource \"") + shader + "\" " + std::to_string(handle) + " \"by\" " + std::to_string(by) + "\n";
}

TEST(GivenChannels, OfLightsUnderConditions) {
    writeTellers();
    const struct {
        std::string lights;
        float left, right;
    } cases[] = {{teller("tellsall", 1, 5) + teller("tellsright", 2, 7), 5, 7},
                 {teller("tellsright", 1, 7) + teller("tellsall", 2, 5), 5, 5},
                 {teller("tellsall", 1, 5) + teller("tellsright", 2, 0), 5, 0}, // a zero is a value
                 {teller("tellsall", 1, 5) + teller("tellsincone", 2, 7), 5, 7},
                 {teller("tellsright", 1, 7), 0, 7}};
    for (const auto& c : cases)
        for (Hider h : {Hider::Hidden, Hider::Path})
            for (const char* surface : {"Surface \"matte\"\n", "Surface \"tellloop\"\n"}) {
                writeShader("tellloop", "surface tellloop() { color c = 0; illuminance(P) c += Cl; Ci = c; Oi = 1; }\n");
                const auto got = sides(c.lights + surface, h, {"told"});
                EXPECT_EQ(got, (std::vector<Floats>{{c.left}, {c.right}})) << c.lights << surface << int(h);
            }
}

TEST(GivenChannels, ArraysAndColours) {
    writeShader("tellsmuch", R"(light tellsmuch(float by = 1, side = 0; color tint = 1;) {
    float list[2] = {by, by + 1};
    illuminate(point "world" (0, 20, 0)) {
        Cl = 1;
        if (side * xcomp(transform("world", Ps)) >= 0) { outputchannel("list", list); outputchannel("tint", tint); }
    }
}
)");
    const std::string lights = "LightSource \"tellsmuch\" 1 \"by\" 3 \"tint\" [1 2 3]\nLightSource \"tellsmuch\" 2 \"by\" 8 "
                               "\"side\" 1 \"tint\" [4 0 6]\n";
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        EXPECT_EQ(sides(lights + "Surface \"matte\"\n", h, {"list", "tint"}),
                  (std::vector<Floats>{{3, 4, 1, 2, 3}, {8, 9, 4, 0, 6}}));
        EXPECT_EQ(sides(lights + "Surface \"matte\"\n", h, {"list[1]"}), (std::vector<Floats>{{4}, {9}}));
    }
}

// The same of an atmosphere, and of both at points of the same batch.
TEST(GivenChannels, OfAtmospheres) {
    writeShader("tellsleft", R"(light tellsleft(float by = 5;) {
    illuminate(point "world" (0, 20, 0)) { Cl = 1; if (xcomp(transform("world", Ps)) < 0) outputchannel("told", by); }
}
)");
    writeShader("airtells", "volume airtells(float by = 9;) { if (xcomp(transform(\"world\", P)) > 0) outputchannel(\"told\", "
                            "by); Ci = Ci; Oi = Oi; }\n");
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        EXPECT_EQ(sides("Atmosphere \"airtells\"\n" + teller("tellsleft", 1, 5) + "Surface \"matte\"\n", h, {"told"}),
                  (std::vector<Floats>{{5}, {9}}));
        EXPECT_EQ(sides("Atmosphere \"airtells\"\nSurface \"matte\"\n", h, {"told"}), (std::vector<Floats>{{0}, {9}}));
    }
}

} // namespace

} // namespace givenchannels_test
