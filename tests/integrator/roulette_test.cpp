// Roulette that follows from what the bounces of some paths bring (integrator/bouncetally.h).
#include "integrator/bouncetally.h"
#include "integrator/harness.h"

namespace roulette_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// 100 pairs of samples whose direct light is 0 and 2, so that its variance within a pixel is 2. `later`: of each sample, what
/// the ray after so many bounces brings. Each bounce has as many rays as the one before; throughputs are 1/4.
BounceTally tallyOf(int bounces, float later) {
    BounceTally t;
    t.begin(200);
    for (size_t i = 0; i < 200; ++i) {
        t.add(i, 0, Color(i % 2 ? 2.f : 0.f));
        t.add(i, bounces, Color(later));
        for (int b = 0; b <= bounces; ++b) t.ray(b, Color(.25f), true);
    }
    return t;
}
const std::vector<double> kOnes(100, 1.);

} // namespace

// With E[later^2] = l2 the variance of all is 2 + (1/f - 1) l2 and the time 1 + f: their product is least at
// f = sqrt(l2 / (2 - l2)).
TEST(Roulette, EndsPathsWhereTheirLightIsLittle) {
    const RouletteFactors usual;
    for (const float later : {.1f, .2f, .5f}) {
        const double l2 = double(later) * later, f = std::sqrt(l2 / (2 - l2));
        const RouletteFactors first = rouletteBy(tallyOf(1, later), kOnes);
        EXPECT_NEAR(first.at(1), std::max(f, .25) / .5, 1e-4); // the root of 1/4 is what rays carry on average
        for (int b = 2; b < 8; ++b) EXPECT_EQ(first.at(b), std::min(first.at(1), usual.at(b)));
        EXPECT_TRUE(first.always(0));
        // Two and four stages before: those that bring nothing by themselves are one with the last.
        const RouletteFactors third = rouletteBy(tallyOf(3, later), kOnes);
        EXPECT_NEAR(third.at(1), std::max(std::sqrt(l2 / 3 / (2 - l2)), .25) / .5, 1e-4);
        EXPECT_EQ(third.at(3), third.at(1));
    }
}
TEST(Roulette, StaysWhereLaterLightIsTheNoise) {
    for (const float later : {1.38f, 5.f})
        for (const int bounces : {1, 3, 7}) EXPECT_EQ(rouletteBy(tallyOf(bounces, later), kOnes), RouletteFactors()) << later;
    EXPECT_EQ(rouletteBy(tallyOf(1, 1), kOnes), RouletteFactors());
    BounceTally nothing;
    nothing.begin(200);
    EXPECT_EQ(rouletteBy(nothing, kOnes), RouletteFactors());
}
TEST(Roulette, TallySurvivesWhatIsNotFinite) {
    BounceTally t = tallyOf(1, .2f);
    const BounceTally same = t;
    t.add(3, 1, Color(std::nanf("")));
    t.add(3, 99, Color(0));
    t.ray(-3, Color(INFINITY), false);
    EXPECT_EQ(t.light, same.light);
    EXPECT_EQ(t.roots, same.roots);
}

// A closed ball that emits 1 and reflects a: 1 / (1 - a), whatever the roulette.
TEST(Roulette, AnyFactorsHaveTheSameLight) {
    writeShader("rouletteball",
                "surface rouletteball(float a = .5;) { Oi = 1; Ci = 1 + a * diffuse(faceforward(normalize(N), I)); }\n");
    for (const bool blocks : {true, false})
        for (const float factor : {.3f, .8f, 1.2f}) {
            Settings s;
            s.hider = Hider::Path;
            s.maxDepth = 2000;
            s.blocks = blocks;
            Scene scene("WorldBegin\nSides 2\nSurface \"rouletteball\" \"a\" [.5]\nSphere 1.3 -1.3 1.3 360\nWorldEnd\n", s);
            RouletteFactors r;
            for (int b = 1; b < RouletteFactors::kBounces; ++b) r.factors[b] = b % 2 ? factor : 2 * factor;
            setRoulette(*scene.world, r);
            expectMean(scene.estimate(rayTo({.1f, -.2f, .3f}, {.5f, .3f, 1}), samples(40000, 1'000'000)), 2,
                       nightly() ? .002 : .02, "factor " + std::to_string(factor));
        }
}
TEST(Roulette, BlocksHaveTheBitsOfSinglePoints) {
    writeShader("roulettewall", "surface roulettewall() { normal n = faceforward(normalize(N), I);\n"
                                "Oi = Os; Ci = Oi * (Cs * diffuse(n) + .3 * specular(n, -normalize(I), .2)); }\n");
    std::vector<SampleResult> first;
    for (const int lanes : {16, 8, 4, 0}) { // 0: point by point
        Settings s;
        s.hider = Hider::Path;
        s.blocks = lanes > 0;
        if (lanes) s.lanes = lanes;
        Scene scene(
            "WorldBegin\nSides 2\nLightSource \"pointlight\" 1 \"intensity\" 3 \"from\" [.5 .5 0]\nColor [.7 .5 .6]\n"
            "Surface \"roulettewall\"\nSphere 2 -2 2 360\nTranslate 0 0 1\nOpacity [.5 .7 .6]\nSphere .4 -.4 .4 360\nWorldEnd\n",
            s);
        RouletteFactors r;
        for (int b = 1; b < RouletteFactors::kBounces; ++b) r.factors[b] = .4f + .1f * float(b);
        setRoulette(*scene.world, r);
        std::vector<CameraRay> rays;
        for (int i = 0; i < 600; ++i) {
            CameraRay ray = rayTo({0, 0, 0}, {float(i % 30) / 30 - .48f, float(i / 30) / 30 - .3f, 1});
            ray.px = i % 30, ray.py = i / 30, ray.spread = .001f;
            rays.push_back(ray);
        }
        const std::vector<SampleResult> now = scene.trace(rays);
        if (first.empty()) first = now;
        size_t other = 0;
        for (size_t i = 0; i < now.size(); ++i) other += !(now[i].color == first[i].color);
        EXPECT_EQ(other, 0u) << lanes;
    }
}

} // namespace roulette_test
