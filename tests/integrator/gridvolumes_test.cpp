// Volumes whose extinction is a grid (shaders/ris/PxrVolumeGrid.sl; docs/ris.md): closed forms. Stacks of pictures stand for
// grids of OpenVDB, which the same shadeop reads.
#include "integrator/harness.h"
#include "integrator/maps.h"

namespace gridvolumes_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// Slices of 4 x 4 pixels: slice k holds k + 1 in "r", 2 everywhere in "g".
std::string slices() {
    for (int k = 0; k < 4; ++k)
        writeMap("grid00" + std::to_string(k) + ".exr", 4, 4, [&](int, int, int c) {
            return c == 0 ? float(k + 1) : c == 1 ? 2.f : 0.f;
        });
    return shaderFolder() + "/grid%03d.exr";
}
/// A box from z = 2 to 4, and what lies behind and beside it.
Scene inside(const std::string& interior, const std::string& grid, const std::string& beside = "") {
    Settings set;
    set.hider = Hider::Path;
    return Scene(
        "WorldBegin\n" + beside + "AttributeBegin\nTranslate 0 0 3\nBxdf \"PxrVolume\" \"v\" " + interior +
            "\nVolume \"blobbydso:impl_openvdb\" [-1 1 -1 1 -1 1] [0 0 0] \"constant string[2] blobbydso:stringargs\" [\"" +
            slices() + "\" \"" + grid + "\"] \"varying float r\" []\nAttributeEnd\nWorldEnd\n",
        set);
}
const char* kWall = "AttributeBegin\nSurface \"constant\"\nPolygon \"P\" [-9 9 6  9 9 6  9 -9 6  -9 -9 6]\nAttributeEnd\n";

TEST(GridVolumes, LightIsLostByTheGrid) {
    // Values go linearly from the middle of a slice, of .5, to that of the next: their mean over the box is 2.5.
    for (const auto& [grid, mean] : {std::pair{"g", 2.}, {"r", 2.5}}) {
        Scene s = inside(
            "\"color diffuseColor\" [0 0 0] \"float densityFloat\" .25 \"color densityColor\" [1 2 0] \"float stepSize\" .02",
            grid, kWall);
        const Moments m = s.estimate(rayTo({0, 0, 0}, {0, 0, 1}), samples(400));
        EXPECT_NEAR(m.mean(0), std::exp(-.25 * mean * 2), 2e-4) << grid;
        EXPECT_NEAR(m.mean(1), std::exp(-.5 * mean * 2), 2e-4) << grid;
        EXPECT_NEAR(m.mean(2), 1, 1e-6) << grid;
        // Half way through, obliquely: from the middle of a side to that of the back, sqrt(2) of way.
        const Moments side = s.estimate(rayTo({-2, 0, 2}, {-1, 0, 3}), samples(400));
        EXPECT_NEAR(side.mean(0), std::exp(-.25 * (mean == 2 ? 2 : 3.4375) * std::sqrt(2)), 2e-4) << grid;
    }
}

TEST(GridVolumes, ItGlowsAndScattersOnce) {
    // Of emission e per extinction: e (1 - exp(-s w)).
    Scene glowing = inside(
        "\"color diffuseColor\" [0 0 0] \"color emitColor\" [.5 0 0] \"float densityFloat\" .25 \"float stepSize\" .02", "g");
    EXPECT_NEAR(glowing.estimate(rayTo({0, 0, 0}, {0, 0, 1}), samples(400)).mean(), .5 * (1 - std::exp(-1.)), 5e-4);
    // Light from +x, 1 through the fog: exp(-s) of it is left at x = 0; a quarter of what illuminance counts is scattered each
    // way.
    const std::string sun = "LightSource \"distantlight\" \"sun\" \"point from\" [1 0 0] \"point to\" [0 0 0]\n";
    const double s = .5, through = 1 - std::exp(-2 * s);
    for (const double g : {0., .5}) {
        Scene lit =
            inside("\"float densityFloat\" .25 \"float stepSize\" .02 \"float anisotropy\" " + std::to_string(g), "g", sun);
        const double phase = (1 - g * g) / (4 * std::pow(1 + g * g, 1.5)); // at a right angle
        EXPECT_NEAR(lit.estimate(rayTo({0, 0, 0}, {0, 0, 1}), samples(400)).mean(), phase * through * std::exp(-s), 5e-4) << g;
    }
    // A lamp at (3, 0, 3): at each depth z its distance d, the way w to the side x = 1 and the exp(-s w) that it leaves.
    Scene lamp = inside("\"float densityFloat\" .25 \"float stepSize\" .02", "g",
                        "LightSource \"pointlight\" \"lamp\" \"point from\" [3 0 3] \"float intensity\" 10\n");
    double want = 0;
    constexpr int kParts = 1000;
    for (int i = 0; i < kParts; ++i) {
        const double z = 2 * (i + .5) / kParts, d2 = 9 + (z - 1) * (z - 1), w = std::sqrt(d2) / 3;
        want += 2. / kParts * s * std::exp(-s * z) * 10 / d2 / 4 * std::exp(-s * w);
    }
    EXPECT_NEAR(lamp.estimate(rayTo({0, 0, 0}, {0, 0, 1}), samples(400)).mean(), want, .003 * want);
}

} // namespace
} // namespace gridvolumes_test
