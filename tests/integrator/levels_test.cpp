// Levels of detail that fade: each camera sample, with all that comes of it, sees one of two adjacent levels.
#include "integrator/floorscene.h"

namespace levels_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

std::string pane(const std::string& levels, const std::string& colour) {
    return "AttributeBegin Attribute \"user\" \"float[2] level\" [" + levels + "] Surface \"constant\" Color " + colour +
           " Polygon \"P\" [-9 1 -9  -9 1 9  9 1 9  9 1 -9] AttributeEnd\n";
}

TEST(FadingLevels, EverySampleSeesOne) {
    const std::string panes = pane("0 .75", "1 0 0") + pane("0.75 1", "0 0 1");
    const CameraRay above = rayTo({.3f, 3, -.4f}, {0, 1, 0}), below = rayTo({.3f, .4f, -.4f}, {0, 0, 0});
    writeShader("looksup", "surface looksup() { Oi = 1; vector up = vector \"world\" (0, 1, 0); Ci = trace(P, up) + color(0, 1, "
                           "0) * transmission(P, P + 5 * up); }\n");
    Scene s(inWorld(panes + std::string("Surface \"looksup\" ") + kFloor), withShaders(Hider::Raytrace));
    const int n = samples(4000);
    const Moments seen = s.estimate(above, n), reflected = s.estimate(below, n);
    EXPECT_NEAR(seen.mean(0), .75, 5 * std::sqrt(.75 * .25 / n));
    EXPECT_NEAR(seen.mean(0) + seen.mean(2), 1, 1e-6) << "no sample sees both or none";
    EXPECT_EQ(seen.mean(1), 0);
    // A ray from below sees what the camera would see with the same sample; a shadow ray is always stopped by one of them.
    for (int k = 0; k < 3; ++k) EXPECT_EQ(reflected.mean(k), seen.mean(k)) << k;
    // One level alone covers its part.
    Scene one(inWorld(pane("0 .25", "1 1 1")), withShaders(Hider::Hidden));
    EXPECT_NEAR(one.estimate(above, n).mean(), .25, 5 * std::sqrt(.75 * .25 / n));
}

} // namespace

} // namespace levels_test
