// Area lights with light shaders of their day: outside of path the mean of Cl over the geometry, with no factor but the shader's
// own.
#include "integrator/floorscene.h"

namespace arealights_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// The square from -a to a at height h over the origin, n points a side: the mean of f(L from the light to the origin).
template <class F> double overSquare(double a, double h, F f) {
    const int n = 400;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) sum += f(Vec3d(a * (2 * (i + .5) / n - 1), h, a * (2 * (j + .5) / n - 1)));
    return sum / n / n;
}

/// A matte floor of 1 seen at the origin, under the square of half side 1 at height 2, whose shader has `body`.
Moments under(const std::string& name, const std::string& body, Hider h, const std::string& attributes, int n = 20000) {
    writeShader(name, "light " + name + "(float intensity = 3;) { " + body + " }\n");
    const std::string light =
        "AttributeBegin\n" + attributes + "AreaLightSource \"" + name +
        "\" 7\nSurface \"constant\"\nColor 0 0 0\nPolygon \"P\" [-1 2 -1  1 2 -1  1 2 1  -1 2 1]\nAttributeEnd\nIlluminate 7 1\n";
    Scene s(inWorld(light + "Surface \"matte\" \"Ka\" 0 \"Kd\" 1\n" + kFloor), integrator::testing::under(h));
    EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
    return s.estimate(kView, n);
}

const std::string kSamples = "Attribute \"light\" \"string units\" \"samples\"\n",
                  kRadiance = "Attribute \"light\" \"string units\" \"radiance\"\n";

// A light without falloff: the mean of I cos. It was taken as radiance, and nearly black.
TEST(AreaLights, MeanOfClWithoutFalloff) {
    const double want = 3 * overSquare(1, 2, [](Vec3d p) { return p.y / length(p); });
    for (const char* more : {"", "Attribute \"light\" \"integer nsamples\" [4]\n"}) {
        expectMean(under("plainarea", "illuminate(P) Cl = intensity;", Hider::Hidden, more), want, .01, "hidden");
        expectMean(under("plainarea", "illuminate(P) Cl = intensity;", Hider::Raytrace, more), want, .01, "raytrace");
    }
    expectMean(under("plainarea", "illuminate(P) Cl = intensity;", Hider::Path, kSamples), want, .01, "path, asked for");
}

// One that divides by the squared distance, in a cone about its normal: as it is, averaged.
TEST(AreaLights, ItsOwnFalloff) {
    const double want = 3 * overSquare(1, 2, [](Vec3d p) { return p.y / length(p) / dot(p, p); });
    const std::string body = "illuminate(P, N, PI / 2) Cl = intensity / (L . L);";
    for (const char* sided : {"", "ReverseOrientation\n"}) {
        const Moments m = under("fallsoff", body, Hider::Hidden, sided);
        if (m.mean() > 0) expectMean(m, want, .01, "hidden");
    }
    expectMean(under("fallsoffall", "illuminate(P) Cl = intensity / (L . L);", Hider::Hidden, ""), want, .01, "all directions");
}

// Radiance where it is asked for, and under path: Lambert's formula for a square over the point.
TEST(AreaLights, Radiance) {
    const double want = 3 * 4 / kPi * overSquare(1, 2, [](Vec3d p) { return p.y * p.y / (dot(p, p) * dot(p, p)); });
    expectMean(under("plainarea", "illuminate(P) Cl = intensity;", Hider::Hidden, kRadiance), want, .01, "hidden, asked for");
    expectMean(under("plainarea", "illuminate(P) Cl = intensity;", Hider::Path, ""), want, .01, "path");
}

// Under path one that divides by the squared distance itself has an intensity, which is spread over its surface: I pi / A of
// radiance, so Lambert's formula has the area no more.
TEST(AreaLights, ItsOwnFalloffUnderPath) {
    const double want = 3 * overSquare(1, 2, [](Vec3d p) { return p.y * p.y / (dot(p, p) * dot(p, p)); });
    expectMean(under("fallsoffall", "illuminate(P) Cl = intensity / (L . L);", Hider::Path, ""), want, .004, "path");
}

// An emitter with Sides 1 sends nothing to where its rays pass through it: light samples and rays agree.
TEST(AreaLights, OneSidedFromBehind) {
    writeShader("plainarea", "light plainarea(float intensity = 3;) { illuminate(P) Cl = intensity; }\n");
    double seen[2];
    for (const bool turned : {false, true}) {
        const std::string light = std::string("AttributeBegin\nSides 1\n") + (turned ? "ReverseOrientation\n" : "") +
                                  "AreaLightSource \"plainarea\" 7\nSurface \"constant\"\nColor 0 0 0\nPolygon \"P\" [-1 2 -1  1 "
                                  "2 -1  1 2 1  -1 2 1]\nAttributeEnd\nIlluminate 7 1\n";
        Settings all = integrator::testing::under(Hider::Path), lights = all, rays = all;
        lights.lightOnly = true;
        rays.bsdfOnly = true;
        const std::string rib = inWorld(light + "Surface \"matte\" \"Ka\" 0 \"Kd\" 1\n" + kFloor);
        const Moments a = Scene(rib, all).estimate(kView, 20000), b = Scene(rib, lights).estimate(kView, 20000),
                      c = Scene(rib, rays).estimate(kView, 20000);
        seen[turned] = a.mean();
        for (const Moments* m : {&b, &c}) EXPECT_LE(std::fabs(m->mean() - a.mean()), kZ * std::hypot(m->se(), a.se())) << turned;
    }
    EXPECT_EQ(std::min(seen[0], seen[1]), 0);
    EXPECT_GT(std::max(seen[0], seen[1]), .5);
}

} // namespace

} // namespace arealights_test
