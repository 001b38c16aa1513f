// Footprints under transport: what a texture's filter sees after camera rays and after bounces. A checker of single texels on a large
// wall has the mean 1/2; a lookup that is wide enough gives it in every single sample, one that is not gives 0 or 1.
#include "display/imageio.h"
#include "transport/harness.h"

using namespace alpenglow;
using namespace alpenglow::transport;
using namespace alpenglow::transport::testing;

namespace {

constexpr int kTexels = 256;

std::string checker() {
    static const std::string name = [] {
        display::Image m = display::makeImage(kTexels, kTexels, display::defaultChannels(3));
        for (int y = 0; y < kTexels; ++y)
            for (int x = 0; x < kTexels; ++x)
                for (int c = 0; c < 3; ++c) m.pixel(x, y)[c] = float((x + y) & 1);
        m.metadata["wrapmodes"] = "periodic,periodic";
        Diagnostics d;
        display::WriteOptions o;
        o.format = display::Format::Exr;
        o.policy = {shaderFolder(), false, -1};
        EXPECT_TRUE(display::writeImage("checker.exr", m, o, d));
        return shaderFolder() + "/checker.exr";
    }();
    return name;
}

// The wall lies at z = 100 and is 100 wide: a texel is 100 / 256 there.
std::string wall() {
    writeShader("checkerwall", "surface checkerwall() { Oi = 1; Ci = color texture(\"" + checker() + "\", s, t); }\n");
    return "AttributeBegin\nSurface \"checkerwall\"\nPatch \"bilinear\" \"P\" [-50 -50 100  50 -50 100  -50 50 100  50 50 100]\nAttributeEnd\n";
}
CameraRay toward(double x, double y, float spread) {
    CameraRay r = rayTo({0, 0, 0}, {float(x), float(y), 100});
    r.spread = spread;
    return r;
}
// Centre of texel (i, j) on the wall; t runs down the picture.
double texel(int i) { return -50 + 100 * (i + .5) / kTexels; }

TEST(Footprint, CameraRays) {
    Settings set;
    set.hider = Hider::Path;
    Scene s("WorldBegin\nSides 2\n" + wall() + "WorldEnd\n", set);
    int ones = 0, zeros = 0;
    for (int i = 100; i < 108; ++i)
        for (int j = 120; j < 124; ++j) {
            float sharp = s.one(toward(texel(i), texel(j), 1e-6f)).x; // a thousandth of a texel
            EXPECT_TRUE(std::fabs(sharp) < .02f || std::fabs(sharp - 1) < .02f) << sharp;
            (sharp > .5f ? ones : zeros)++;
            EXPECT_NEAR(s.one(toward(texel(i), texel(j), .02f)).x, .5, .02); // half width 2: ten texels
        }
    EXPECT_EQ(ones, zeros);
}

// A perfect mirror at the origin keeps the footprint; a rough lobe widens it by its cone.
TEST(Footprint, Bounces) {
    writeShader("looklobe", R"(surface looklobe(float cone = 0;) {
    Oi = 1;
    Ci = trace(P, vector(0, 0, 1), "distribution", "uniform", "samplecone", cone);
}
)");
    for (float cone : {0.f, .3f}) {
        Settings set;
        set.hider = Hider::Path;
        Scene s("WorldBegin\nSides 2\n" + wall() + "Surface \"looklobe\" \"float cone\" " + std::to_string(cone) +
                    "\nPolygon \"P\" [-60 -60 0  60 -60 0  60 60 0  -60 60 0]\nWorldEnd\n",
                set);
        int sharp = 0, mean = 0;
        const int n = 200;
        for (int i = 0; i < n; ++i) {
            CameraRay r = rayTo({float(texel(i % 8 + 100)), float(texel(120 + i / 8)), 1}, {float(texel(i % 8 + 100)), float(texel(120 + i / 8)), 0});
            r.spread = 1e-6f;
            r.px = i;
            float v = s.one(r).x;
            sharp += std::fabs(v) < .02f || std::fabs(v - 1) < .02f;
            mean += std::fabs(v - .5f) < .03f;
        }
        if (cone == 0) {
            EXPECT_EQ(sharp, n) << "a mirror must not blur";
        } else {
            EXPECT_EQ(mean, n);
        }
    }
}

// After diffuse bounces every lookup gives the mean, and so the floor's light does: its shape factor times 1/2.
TEST(Footprint, DiffuseBounce) {
    Settings set;
    set.hider = Hider::Path;
    Scene s("WorldBegin\nSides 2\n" + wall() + "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\nPolygon \"P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]\nWorldEnd\n", set);
    CameraRay r = rayTo({.3f, .2f, 1}, {0, 0, 0});
    r.spread = 1e-6f;
    int others = 0;
    for (int i = 0; i < 400; ++i) {
        r.px = i;
        float v = s.one(r).x; // 0: the ray went past the wall
        others += v != 0 && std::fabs(v - .5f) > .03f;
    }
    EXPECT_EQ(others, 0);
    // Square of half side 50 at distance 100 seen by a parallel element: F = 4 / (2 pi) 2 (a / sqrt(1 + a^2)) atan(a / sqrt(1 + a^2)), a = 1/2.
    double a = .5, q = a / std::sqrt(1 + a * a), factor = 4 / (2 * kPi) * 2 * q * std::atan(q);
    expectMean(s.estimate(r, samples(20000)), .5 * factor, .02, "shape factor");
}

} // namespace
