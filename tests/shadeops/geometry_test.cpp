// Geometry, matrices, colours, splines, lighting: closed forms.
#include "shadeops/descriptor.h"
#include "shadeops/host_runtime.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

namespace geometry_test {

using namespace alpenglow::shadeops;

namespace {

using Floats = std::vector<float>;

Floats run(const std::string& symbol, const Floats& in) {
    Floats out(runtimeShape(symbol).out);
    EXPECT_TRUE(evaluateRuntime(symbol, in.data(), int(in.size()), out.data(), int(out.size()))) << symbol;
    return out;
}
Floats join(Floats a, const Floats& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}
void near(const Floats& got, const Floats& expected, double tolerance, const char* what) {
    ASSERT_EQ(got.size(), expected.size()) << what;
    for (size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], expected[i], tolerance) << what << " component " << i;
}
const Floats kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

TEST(Geometry, RotationTurnsXTowardYAboutZ) {
    const float quarter = static_cast<float>(M_PI / 2);
    near(run("al_rotatepoint", {1, 0, 0, quarter, 0, 0, 0, 0, 0, 1}), {0, 1, 0}, 1e-6, "point about z");
    near(run("al_rotatepoint", {2, 0, 5, quarter, 1, 0, 0, 1, 0, 3}), {1, 1, 5}, 1e-6, "point about a line beside the origin");
    near(run("al_rotatepoint", {2, 3, 5, 1, 1, 1, 1, 1, 1, 1}), {2, 3, 5}, 0, "no line, no rotation");
    const Floats m = run("al_rotatematrix", join(kIdentity, {quarter, 0, 0, 1}));
    near(run("al_transformpoint", join(m, {1, 0, 0})), {0, 1, 0}, 1e-6, "matrix about z");
}

TEST(Geometry, NewTransformationsApplyFirst) {
    // scale after translate: translate(scale(1, s), t) maps 0 to t * s, as RiScale then RiTranslate.
    const Floats scaled = run("al_scale", join(kIdentity, {2, 3, 4}));
    const Floats both = run("al_translate", join(scaled, {1, 1, 1}));
    near(run("al_transformpoint", join(both, {0, 0, 0})), {2, 3, 4}, 0, "translate then scale");
    near(run("al_transformvector", join(both, {1, 1, 1})), {2, 3, 4}, 0, "vectors do not move");
}

TEST(Geometry, NormalsStayPerpendicular) {
    const Floats m = {1, 0.5f, 0, 0, 0.25f, 2, 0.5f, 0, 0, 0.125f, 3, 0, 1, 2, 3, 1};
    const Floats tangent = run("al_transformvector", join(m, {1, 2, 0})), normal = run("al_transformnormal", join(m, {2, -1, 0}));
    EXPECT_NEAR(tangent[0] * normal[0] + tangent[1] * normal[1] + tangent[2] * normal[2], 0, 1e-6);
}

TEST(Geometry, PointsAreDividedByTheFourthComponent) {
    Floats m = kIdentity; // w = z + 1
    m[11] = 1;
    near(run("al_transformpoint", join(m, {2, 4, 1})), {1, 2, 0.5f}, 0, "projection");
}

TEST(Geometry, InverseAndDeterminant) {
    const Floats m = {2, 1, 0, 0, 0, 3, 1, 0, 1, 0, 4, 0, 5, 6, 7, 1};
    EXPECT_EQ(run("al_determinant", m)[0], 25); // 2 * 12 + 1 * 1: expansion of the upper 3x3
    near(run("al_multiply", join(m, run("al_inverse", m))), kIdentity, 1e-5, "m inverse(m)");
    near(run("al_inverse", Floats(16, 1.0f)), kIdentity, 0, "singular gives the identity");
}

TEST(Geometry, ReflectRefractFresnel) {
    const float s = std::sqrt(0.5f);
    near(run("al_reflect", {s, -s, 0, 0, 1, 0}), {s, s, 0}, 1e-6, "reflect");
    // Snell: sin t = eta sin i
    const float eta = 1 / 1.5f;
    const Floats t = run("al_refract", {s, -s, 0, 0, 1, 0, eta});
    EXPECT_NEAR(t[0], eta * s, 1e-6);
    EXPECT_NEAR(t[0] * t[0] + t[1] * t[1], 1, 1e-6);
    EXPECT_LT(t[1], 0);
    // Normal incidence: ((n - 1) / (n + 1))^2 = 0.04
    Floats f = run("al_fresnel", {0, -1, 0, 0, 1, 0, eta, 0, 0});
    near(f, {0.04f, 0.96f}, 1e-6, "normal incidence");
    // Total reflection beyond the critical angle
    f = run("al_fresnelrt", {s, -s, 0, 0, 1, 0, 1.5f, 0, 0, 0, 0, 0, 0, 0, 0});
    near(f, {1, 0, s, s, 0, 0, 0, 0}, 1e-6, "total reflection");
    // Brewster's angle: the parallel part vanishes, Kr = rs^2 / 2 with rs = (1 - n^2) / (1 + n^2)
    const double n = 1.5, c = 1 / std::sqrt(1 + n * n), sn = n * c, rs = (1 - n * n) / (1 + n * n);
    f = run("al_fresnel", {static_cast<float>(sn), static_cast<float>(-c), 0, 0, 1, 0, eta, 0, 0});
    EXPECT_NEAR(f[0], rs * rs / 2, 1e-6);
}

TEST(Geometry, Ptlined) {
    EXPECT_EQ(run("al_ptlined", {0, 0, 0, 1, 0, 0, 4, 4, 0})[0], 5);
    EXPECT_EQ(run("al_ptlined", {0, 0, 0, 4, 0, 0, 1, -2, 0})[0], 2);
    EXPECT_EQ(run("al_ptlined", {1, 1, 1, 1, 1, 1, 1, 1, 4})[0], 3); // a segment without length
}

TEST(Colours, ThereAndBack) {
    std::mt19937 random(2);
    for (int i = 0; i < 200; ++i) {
        Floats c(3);
        for (float& x : c) x = std::generate_canonical<float, 24>(random);
        for (const char* space : {"hsv", "hsl", "yiq", "xyz"})
            near(run(std::string("al_") + space + "_to_rgb", run(std::string("al_rgb_to_") + space, c)), c, 2e-5, space);
    }
}

TEST(Colours, KnownValues) {
    near(run("al_rgb_to_hsv", {1, 0, 0}), {0, 1, 1}, 0, "red");
    near(run("al_rgb_to_hsv", {0, 1, 0}), {1.0f / 3, 1, 1}, 1e-6, "green");
    near(run("al_rgb_to_hsv", {0.5f, 0.5f, 0.5f}), {0, 0, 0.5f}, 0, "grey");
    near(run("al_rgb_to_hsl", {0, 0, 1}), {2.0f / 3, 1, 0.5f}, 1e-6, "blue");
    near(run("al_hsv_to_rgb", {0.5f, 1, 1}), {0, 1, 1}, 1e-6, "cyan");
    near(run("al_rgb_to_yiq", {1, 1, 1}), {1, 0, 0}, 1e-6, "white has no chroma");
    near(run("al_rgb_to_xyz", {1, 1, 1}), {0.95045593f, 1, 1.08905775f}, 1e-5, "white is D65");
}

TEST(Splines, CurvesThroughKnownPoints) {
    for (const char* basis : {"catmullrom", "linear"}) { // interpolate the middle points
        const std::string s = std::string("al_spline_") + basis + "_f";
        EXPECT_EQ(run(s, {0, 3, 1, 2, 7})[0], 1);
        EXPECT_EQ(run(s, {1, 3, 1, 2, 7})[0], 2);
    }
    EXPECT_FLOAT_EQ(run("al_spline_bezier_f", {0.5f, 0, 1, 2, 3})[0], 1.5f);
    EXPECT_FLOAT_EQ(run("al_spline_bspline_f", {0, 0, 6, 0, 0})[0], 4); // (p + 4 q + r) / 6
    EXPECT_FLOAT_EQ(run("al_spline_hermite_f", {0.5f, 0, 1, 1, 1})[0], 0.5f);
    EXPECT_FLOAT_EQ(run("al_spline_catmullrom_f", {0.5f, 0, 0, 1, 1})[0], 0.5f);
    near(run("al_splinesegment", {0.5f, 4}), {2, 0}, 0, "start of the third of four");
    near(run("al_splinesegment", {1, 4}), {3, 1}, 0, "the end belongs to the last");
    near(run("al_splinesegment", {7, 4}), {3, 1}, 0, "clamped above");
    near(run("al_splinesegment", {-7, 4}), {0, 0}, 0, "clamped below");
}

TEST(Splines, SolveInverts) {
    std::mt19937 random(9);
    for (const char* basis : {"catmullrom", "bspline", "bezier", "linear"})
        for (int i = 0; i < 200; ++i) {
            Floats p = {0, 1, 2, 3};
            for (float& x : p) x += 0.3f * std::generate_canonical<float, 24>(random);
            if (i % 2) std::reverse(p.begin(), p.end());
            const float t = std::generate_canonical<float, 24>(random);
            const float value = run(std::string("al_spline_") + basis + "_f", join({t}, p))[0];
            EXPECT_NEAR(run(std::string("al_splinesolve_") + basis, join({value}, p))[0], t, 1e-5) << basis;
        }
    EXPECT_EQ(run("al_splinesolve_linear", {9, 0, 0, 1, 1})[0], 1); // beyond the segment: its nearer end
    EXPECT_EQ(run("al_splinesolve_linear", {-9, 0, 0, 1, 1})[0], 0);
}

TEST(Filterstep, ClosedForms) {
    for (const char* filter : {"box", "triangle", "gaussian", "catmullrom"}) {
        const std::string s = std::string("al_filterstep_") + filter;
        EXPECT_EQ(run(s, {0.5f, 0, 1})[0], 0.5f) << filter;
        EXPECT_EQ(run(s, {0, 5, 6})[0], 1) << filter;
        EXPECT_EQ(run(s, {0, -6, -5})[0], 0) << filter;
        EXPECT_EQ(run(s, {0, 1, 1})[0], 1) << filter << ", no width";
        EXPECT_EQ(run(s, {0, -1, -1})[0], 0) << filter << ", no width";
        // symmetric: f(d) + f(-d) = 1
        EXPECT_NEAR(run(s, {0, -0.3f, 0.7f})[0] + run(s, {0, -0.7f, 0.3f})[0], 1, 1e-6) << filter;
    }
    EXPECT_NEAR(run("al_filterstep_box", {0, -0.25f, 0.75f})[0], 0.75f, 1e-6);
    EXPECT_NEAR(run("al_filterstep_triangle", {0, 0, 1})[0], 1 - 0.125f, 1e-6); // 1/2 + d - d^2/2 at 1/2
    const double whole = std::erf(std::sqrt(2.0)), half = std::erf(std::sqrt(0.5));
    EXPECT_NEAR(run("al_filterstep_gaussian", {0, 0, 1})[0], 0.5 + 0.5 * half / whole, 1e-6);
    // catmull-rom: integral of 1 - 5/2 x^2 + 3/2 x^3 over [0, 1/2] = 1/2 - 5/48 + 3/128
    EXPECT_NEAR(run("al_filterstep_catmullrom", {0, 0, 1})[0], 0.5 + 0.5 - 5.0 / 48 + 3.0 / 128, 1e-6);
}

TEST(Lighting, SpecularBrdf) {
    // h = n: 1. h at 45 degrees: cos^(8 / roughness), so 1/16 with roughness 1.
    near(run("al_specularbrdf", {0, 0, 2, 0, 0, 1, 0, 0, 1, 0.1f}), {1, 1, 1}, 0, "mirror direction, any length of L");
    near(run("al_specularbrdf", {1, 0, 0, 0, 0, 1, 0, 0, 1, 8}), Floats(3, std::sqrt(0.5f)), 1e-6, "45 degrees");
    near(run("al_specularbrdf", {1, 0, 0, 0, 0, 1, 0, 0, 1, 1}), Floats(3, 1 / 16.f), 1e-6, "45 degrees, exponent 8");
    near(run("al_specularbrdf", {0, 0, -1, 0, 0, 1, 0, 0.6f, -0.8f, 1}), {0, 0, 0}, 0, "behind");
    near(run("al_specularbrdf", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0}), {0, 0, 0}, 0, "no roughness");
}

} // namespace

} // namespace geometry_test
