// trace() in sums and products: light in a color, however many numbers it is multiplied by, and a distance in a float.
#include "integrator/floorscene.h"

namespace tracesums_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

TEST(TraceSums, AreLightInAColor) {
    // Inside of a ball that shows (.25, .5, .75) everywhere: every ray brings that.
    const std::string ball = "AttributeBegin Surface \"constant\" Color .25 .5 .75 Sphere 40 -40 40 360 AttributeEnd\n";
    writeShader("tracesums", "surface tracesums(float k = .25; color tint = 2;) { vector up = vector \"world\" (0, 1, 0), aside "
                             "= up + .2 * vector \"world\" (1, 0, 0);\n"
                             "    color sum = k * trace(P, up) + (1 - k) * trace(P, aside);\n    color many = tint * (.5 * "
                             "trace(P, up) + k * trace(P, aside) + k * k * trace(P, up));\n"
                             "    color more = 0; more += k * trace(P, up) + .5 * trace(P, aside) + k * trace(P, aside);\n"
                             "    float far = 2 * trace(P, up) + 0; if (trace(P, up) < 39.9 || 40.1 < trace(P, up)) far = 0; "
                             "color held = clamp(trace(P, up), 0, 1); more += held - trace(P, up); Ci = sum + many + more + 10 * "
                             "(1 - color(step(79.9, far), step(79.9, far), step(far, 80.1))); Oi = 1; }\n");
    for (const Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        Scene s(inWorld("Surface \"tracesums\"\n" + std::string(kFloor) + ball), withShaders(h));
        const Color c = s.one(kView);
        const float of = 1 + 2 * (.5f + .25f + .0625f) + 1;
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], of * .25f * float(k + 1), 1e-4) << "hider " << int(h);
    }
}

} // namespace

} // namespace tracesums_test
