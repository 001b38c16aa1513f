// Lights that send along the normal of what they light, as those that PRMan shipped do: shadingnormal(N) with N of the lit
// surface.
#include "integrator/floorscene.h"

namespace lightnormals_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

// L is the normal turned toward the viewer, so that diffuse() has a cosine of 1 on both sides of a surface.
TEST(LightNormals, ShadingNormalInALight) {
    writeShader("alongnormal",
                "#include \"normals.h\"\nlight alongnormal(output float __nonspecular = 1;) {\n"
                "    normal n = shadingnormal(N);\n    illuminate(Ps + n) { Cl = color(1, .5, .25) * length(n); }\n}\n");
    for (const char* turned : {"", "ReverseOrientation\n"}) {
        Scene s(inWorld(std::string("LightSource \"alongnormal\" 1\nSurface \"matte\" \"Ka\" 0\n") + turned + kFloor),
                under(Hider::Hidden));
        const Color c = s.one(kView);
        EXPECT_EQ(s.diagnostics.errors() + s.diagnostics.warnings(), 0) << s.messages();
        EXPECT_NEAR(c.x, 1, 1e-5) << turned;
        EXPECT_NEAR(c.y, .5, 1e-5) << turned;
        EXPECT_NEAR(c.z, .25, 1e-5) << turned;
    }
}

} // namespace

} // namespace lightnormals_test
