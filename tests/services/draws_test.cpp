// random(): its numbers in loops, functions, lights, and for uniform variables. Closed forms: uniform on [0, 1), independent.
#include "integrator/harness.h"

namespace draws_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2]\n";

std::vector<Color> samples(Scene& s, int n, Vec3 at = {.2f, .3f, 2}) {
    std::vector<CameraRay> rays(size_t(n), rayTo({0, 0, 0}, at));
    for (int i = 0; i < n; ++i) rays[size_t(i)].px = i;
    std::vector<Color> out;
    for (const SampleResult& r : s.trace(rays)) out.push_back(r.color);
    return out;
}

// The mean of n draws has the variance 1 / (12 n): were they one number, it would be 1 / 12.
TEST(Draws, TurnsOfALoopAreIndependent) {
    writeShader("drawsloop", "float one() { return random(); }\nsurface drawsloop() { float a = 0, b = 0, i; color c = 0;"
                             " for (i = 0; i < 16; i += 1) { a += random(); b += one(); c += color random(); } Ci = color(a, b, "
                             "comp(c, 1)) / 16; Oi = 1; }\n");
    Scene s(std::string("WorldBegin\nSurface \"drawsloop\"\n") + kSquare + "WorldEnd\n");
    const int n = 4000;
    double sum[3] = {}, squares[3] = {}, product = 0;
    for (const Color& c : samples(s, n)) {
        for (int k = 0; k < 3; ++k) sum[k] += c[k], squares[k] += double(c[k]) * c[k];
        product += (c[0] - .5) * (c[1] - .5);
    }
    const double variance = 1. / 192;
    for (int k = 0; k < 3; ++k) {
        const double mean = sum[k] / n;
        EXPECT_NEAR(mean, .5, 5 * std::sqrt(variance / n)) << k;                                    // five standard errors
        EXPECT_NEAR(squares[k] / n - mean * mean, variance, 5 * variance * std::sqrt(2. / n)) << k; // of a nearly normal variance
    }
    EXPECT_NEAR(product / n, 0, 5 * variance / std::sqrt(n));
}

// Two lights whose shaders draw at the same place of their text, and the surface that draws at that place too.
TEST(Draws, LightsAndSurfaceDoNotShareNumbers) {
    writeShader("drawslight", "light drawslight() { Cl = random(); }\n");
    writeShader("drawslit", "surface drawslit() { float own = random(); Ci = color(own, comp(ambient(), 0), 0); Oi = 1; }\n");
    Scene s(std::string("WorldBegin\nLightSource \"drawslight\" 1\nSurface \"drawslit\"\n") + kSquare + "WorldEnd\n");
    const int n = 2000;
    double product = 0;
    int equal = 0;
    for (const Color& c : samples(s, n)) {
        product += (c[0] - .5) * (c[1] - .5);
        equal += c[0] == c[1];
    }
    EXPECT_LT(equal, 5);
    EXPECT_NEAR(product / n, 0, 5. / 12 / std::sqrt(n));
}

TEST(Draws, AUniformVariableHasOneNumberAPrimitive) {
    writeShader("drawsuniform",
                "surface drawsuniform() { uniform float a = random(), b = random(); Ci = color(a, b, random()); Oi = 1; }\n");
    Scene s(std::string("WorldBegin\nSurface \"drawsuniform\"\nAttributeBegin\nTranslate -1.5 0 0\n") + kSquare +
            "AttributeEnd\nAttributeBegin\nTranslate 1.5 0 0\n" + kSquare + "AttributeEnd\nWorldEnd\n");
    const auto left = samples(s, 50, {-1.5f, 0, 2}), right = samples(s, 50, {1.5f, .2f, 2});
    for (const Color& c : left) EXPECT_EQ(Color(c[0], c[1], 0), Color(left[0][0], left[0][1], 0));
    for (const Color& c : right) EXPECT_EQ(Color(c[0], c[1], 0), Color(right[0][0], right[0][1], 0));
    EXPECT_NE(left[0][0], right[0][0]);
    EXPECT_NE(left[0][0], left[0][1]);
    EXPECT_NE(left[0][2], left[1][2]);
}

} // namespace

} // namespace draws_test
