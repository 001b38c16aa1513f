// A uniform variable takes no varying output of another shader: that is said once, with the place of the call.
#include "integrator/floorscene.h"

namespace uniformreceivers_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* const kSays = "is varying and the destination is uniform";

void expectOnce(const std::string& shaders, const std::string& place) {
    Scene s("WorldBegin\nSides 2\n" + shaders + "Patch \"bilinear\" \"P\" [-2 -2 5  2 -2 5  -2 2 5  2 2 5]\nWorldEnd\n",
            withShaders(Hider::Hidden));
    for (const float x : {-.5f, .2f, .7f}) {
        const Color c = s.one(rayTo({x, 0, 0}, {x, 0, 5}));
        EXPECT_EQ(c.x, 3) << place; // what it was
        EXPECT_EQ(c.y, 0) << place; // there is none
    }
    const std::string said = s.messages();
    const size_t first = said.find(kSays);
    EXPECT_NE(first, std::string::npos) << said;
    EXPECT_EQ(said.find(kSays, first + 1), std::string::npos) << said;
    EXPECT_NE(said.find(place), std::string::npos) << said;
}

TEST(UniformReceivers, AreToldOf) {
    writeShader("uniformgives", "surface uniformgives(output varying float x = 0;) { x = u; Ci = 1; Oi = 1; }\n");
    writeShader(
        "uniformtakes",
        "volume uniformtakes() { uniform float k = 3;\n    float found = surface(\"x\", k); Ci = color(k, found, 0); }\n");
    expectOnce("Surface \"uniformgives\"\nAtmosphere \"uniformtakes\"\n", "uniformtakes.sl:2:19");
    writeShader("uniformbumps", "displacement uniformbumps(output varying float h = 0;) { h = u; P += 0 * N; }\n");
    writeShader("uniformasks", "surface uniformasks() { uniform float k = 3;\n\n  float found = displacement(\"h\", k); Ci = "
                               "color(k, found, 0); Oi = 1; }\n");
    expectOnce("Displacement \"uniformbumps\"\nSurface \"uniformasks\"\n", "uniformasks.sl:3:17");
}

} // namespace

} // namespace uniformreceivers_test
