// Footprints under transport: what a texture's filter sees after camera rays and after bounces. A checker of single texels on a
// large wall has the mean 1/2; a lookup that is wide enough gives it in every single sample, one that is not gives 0 or 1.
#include "display/imageio.h"
#include "integrator/floorscene.h"

namespace footprint_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

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
    return "AttributeBegin\nSurface \"checkerwall\"\nPatch \"bilinear\" \"P\" [-50 -50 100  50 -50 100  -50 50 100  50 50 "
           "100]\nAttributeEnd\n";
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
            CameraRay r = rayTo({float(texel(i % 8 + 100)), float(texel(120 + i / 8)), 1},
                                {float(texel(i % 8 + 100)), float(texel(120 + i / 8)), 0});
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
    Scene s("WorldBegin\nSides 2\n" + wall() +
                "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\nPolygon \"P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]\nWorldEnd\n",
            set);
    CameraRay r = rayTo({.3f, .2f, 1}, {0, 0, 0});
    r.spread = 1e-6f;
    int others = 0;
    for (int i = 0; i < 400; ++i) {
        r.px = i;
        float v = s.one(r).x; // 0: the ray went past the wall
        others += v != 0 && std::fabs(v - .5f) > .03f;
    }
    EXPECT_EQ(others, 0);
    // Square of half side 50 at distance 100 seen by a parallel element: F = 4 / (2 pi) 2 (a / sqrt(1 + a^2)) atan(a / sqrt(1 +
    // a^2)), a = 1/2.
    double a = .5, q = a / std::sqrt(1 + a * a), factor = 4 / (2 * kPi) * 2 * q * std::atan(q);
    expectMean(s.estimate(r, samples(20000)), .5 * factor, .02, "shape factor");
}

// A matte floor under a square emitter of half side a at height 2, whose radiance depends on how wide it is seen.
Scene underSquare(const std::string& light, double a, const std::string& surface, bool lightOnly, bool bsdfOnly) {
    Settings set = under(Hider::Path);
    set.lightOnly = lightOnly;
    set.bsdfOnly = bsdfOnly;
    const auto corner = [&](int x, int z) { return std::to_string(a * x) + " 2 " + std::to_string(a * z) + " "; };
    return Scene(inWorld("AttributeBegin\nAreaLightSource \"" + light +
                         "\" 7\nSurface \"constant\"\nColor 0 0 0\nPatch \"bilinear\" \"P\" [" + corner(-1, -1) + corner(1, -1) +
                         corner(-1, 1) + corner(1, 1) + "]\nAttributeEnd\nIlluminate 7 1\nSurface \"" + surface + "\"\n" +
                         kFloor),
                 set);
}
void writeEmitters() {
    writeShader("seenwide", "light seenwide() { illuminate(P) Cl = 3 * du; }\n");
    writeShader("seenfine",
                "light seenfine() { illuminate(P) Cl = 3 * abs(float texture(\"" + checker() + "\", 50 * s, 50 * t) - .5); }\n");
    writeShader("widematte", "surface widematte() { Oi = 1; Ci = diffuse(normalize(N)); }\n");
    writeShader("wideboth",
                "surface wideboth() { normal n = normalize(N); Oi = 1; Ci = .5 * diffuse(n) + specular(n, vector(n), .4); }\n");
    writeShader("widewaits", R"(surface widewaits() {
    color c = trace(P, vector(normalize(N)), "distribution", "cosine", "samplecone", 1, "samplearealights", 1);
    Oi = 1;
    if (comp(c, 0) > -1) Ci = c;
}
)");
    writeShader("wideloop", "surface wideloop() { normal n = normalize(N); Oi = 1; Ci = 0; illuminance(P, n, PI / 2) Ci += Cl * "
                            "(normalize(L) . n); }\n");
}

// A small emitter over a point that a ray of no width finds: a ray of half angle .35 sees it 2 * .35 * 2 wide, in u over its
// side.
TEST(Footprint, OfALightSample) {
    writeEmitters();
    const double a = .05, want = 3 * (2 * .35 * 2) / (2 * a) * (4 * a * a) / (kPi * 4);
    for (const char* surface : {"widematte", "wideloop"})
        EXPECT_NEAR(underSquare("seenwide", a, surface, true, false).estimate(kView, 2000).mean(), want, 1e-3 * want)
            << surface; // its corners: 1e-3 off
}

// Light samples and rays of the lobes estimate one function, whatever the emitter makes of its footprint; so does a loop, as
// diffuse().
TEST(Footprint, EmittersLookTheSameToLightSamplesAndRays) {
    writeEmitters();
    for (const char* light : {"seenwide", "seenfine"}) {
        Moments matte;
        for (const char* surface : {"widematte", "wideboth", "widewaits"}) {
            const Moments both = underSquare(light, 1, surface, false, false).estimate(kView, 20000);
            const Moments samples = underSquare(light, 1, surface, true, false).estimate(kView, 20000);
            const Moments rays = underSquare(light, 1, surface, false, true).estimate(kView, 40000);
            if (!matte.n) matte = samples;
            EXPECT_GT(rays.mean(), 0) << light << " " << surface;
            for (const Moments* m : {&both, &samples})
                EXPECT_LE(std::fabs(m->mean() - rays.mean()), kZ * std::hypot(m->se(), rays.se()) + 1e-4 * rays.mean())
                    << light << " " << surface;
        }
        const Moments loop = underSquare(light, 1, "wideloop", false, false).estimate(kView, 20000);
        EXPECT_LE(std::fabs(loop.mean() - matte.mean()), kZ * std::hypot(loop.se(), matte.se()) + 1e-4 * matte.mean())
            << light << " loop";
    }
}

} // namespace

} // namespace footprint_test
