// Sets of samples that one pixel sample draws (turns of a light, rays of one trace(), rays of one transmission()) are spread as
// evenly as samples of a pixel are: their error is below that of as many independent numbers, with a single pixel sample too.
#include "harness.h"
#include <gtest/gtest.h>

namespace samplesets_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// Variance over pixels of a scene's value at one point, one sample a pixel; every pixel has numbers of its own.
double varianceOf(const std::string& rib, Hider hider, double* mean) {
    Settings settings;
    settings.hider = hider;
    settings.seed = 5;
    Scene scene(rib, settings);
    const int pixels = 2000;
    std::vector<CameraRay> rays;
    for (int p = 0; p < pixels; ++p) {
        rays.push_back(rayTo({.3f, .2f, -.4f}, {.3f, 0, -.4001f}));
        rays.back().px = p % 50;
        rays.back().py = p / 50;
    }
    double sum = 0, square = 0;
    for (const SampleResult& r : scene.trace(rays)) sum += r.color.x, square += double(r.color.x) * r.color.x;
    *mean = sum / pixels;
    return square / pixels - *mean * *mean;
}

/// Asks that the variance of 16 draws is below `share` of what 16 independent ones have, a sixteenth of that of one draw, and
/// that both have the same mean. A variance from 2,000 values is known to 3 to 6 %.
void expectSpread(const std::function<std::string(int)>& rib, double share, Hider hider, const std::string& what) {
    double one = 0, many = 0;
    const double v1 = varianceOf(rib(1), hider, &one), v16 = varianceOf(rib(16), hider, &many);
    std::printf("%s: variance of 16 draws %.3f of that of independent ones\n", what.c_str(), 16 * v16 / v1);
    EXPECT_GT(v1, 0) << what;
    EXPECT_LT(16 * v16 / v1, share) << what;
    EXPECT_NEAR(many, one, kZ * std::sqrt((v1 + v16) / 2000)) << what;
}

const char* kFloor = "Polygon \"P\" [-9 0 -9  -9 0 9  9 0 9  9 0 -9]\n";

} // namespace

// A square light above the point, nothing in its way: a smooth function of both numbers, of which 16 points, one in each of 16
// strips both ways and of 4 x 4 squares, have well below a quarter of the variance of random ones (the variance inside a 4 x 4
// square of a function with bounded slope is a sixteenth, what varies over more than the slopes adds to it).
TEST(SampleSets, TurnsOfALight) {
    writeShader("setlamp", "light setlamp() { illuminate(P, N, PI / 2) Cl = 1; }\n");
    writeShader("setloop",
                "surface setloop() { Oi = 1; Ci = 0; illuminance(P, normal(0, 1, 0), PI / 2) Ci += Cl * (normalize(L) . "
                "normal(0, 1, 0)); }\n");
    const auto rib = [](int n) {
        return "WorldBegin\nSides 2\nAttributeBegin\nAttribute \"light\" \"int samples\" " + std::to_string(n) +
               " \"string units\" \"radiance\"\nAreaLightSource \"setlamp\" 7\nSurface \"constant\"\nPolygon \"P\" [-1 1 -1  1 1 "
               "-1  1 1 1  -1 1 1]\n"
               "AttributeEnd\nIlluminate 7 1\nSurface \"setloop\"\n" +
               std::string(kFloor) + "WorldEnd\n";
    };
    expectSpread(rib, .25, Hider::Hidden, "hidden");
    expectSpread(rib, .25, Hider::Path, "path");
}

// The rays of one trace() into a world whose light varies evenly with height and side.
TEST(SampleSets, RaysOfOneTrace) {
    writeShader(
        "setshine",
        "surface setshine() { point p = transform(\"world\", P); Oi = 1; Ci = 1 + .5 * xcomp(p) / 50 + .3 * ycomp(p) / 50; }\n");
    const auto rib = [](int n) {
        writeShader("settrace" + std::to_string(n),
                    "surface settrace" + std::to_string(n) +
                        "() { Oi = 1; Ci = trace(P, normal(0, 1, 0), \"distribution\", \"cosine\", \"samplecone\", PI / 2, "
                        "\"samples\", " +
                        std::to_string(n) + "); }\n");
        return "WorldBegin\nSides 2\nSurface \"setshine\"\nSphere 50 -50 50 360\nSurface \"settrace" + std::to_string(n) +
               "\"\n" + kFloor + "WorldEnd\n";
    };
    expectSpread(rib, .25, Hider::Hidden, "trace");
}

// Half of the cone of one transmission() is blocked by an edge: of 4 x 4 squares about four are cut, so about a quarter of the
// variance is left; a half is asked for.
TEST(SampleSets, RaysOfOneTransmission) {
    const auto rib = [](int n) {
        writeShader("setshadow" + std::to_string(n),
                    "surface setshadow" + std::to_string(n) +
                        "() { Oi = 1; Ci = transmission(P, P + vector(0, 1, 0), \"samplecone\", .3, \"samples\", " +
                        std::to_string(n) + "); }\n");
        return "WorldBegin\nSides 2\nSurface \"constant\"\nPolygon \"P\" [.31 .5 -9  .31 .5 9  9 .5 9  9 .5 -9]\nSurface "
               "\"setshadow" +
               std::to_string(n) + "\"\n" + kFloor + "WorldEnd\n";
    };
    expectSpread(rib, .5, Hider::Hidden, "transmission");
}

} // namespace samplesets_test
