// Light-directed sampling at surfaces in media: directions are drawn with the density that it states.
#include "bsdf/sampling.h"
#include "integrator/lightdirected.h"
#include "statistics/agreement.h"
#include <gtest/gtest.h>
#include <random>

namespace lightdirected_test {

using namespace alpenglow;
using namespace alpenglow::integrator;

// T2: 1 over the density has the whole sphere as its mean, and by parts the squares of coordinates a third of it each; beside a
// lobe that is uniform over the sphere.
TEST(LightDirected, DrawsByItsDensity) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform;
    const float lobe = float(.25 / kPi);
    for (const float share : {.1f, .3f, 1.f}) {
        const LightDirected aim{normalize(Vec3(.3f, .8f, -.5f)), share};
        const int n = 200000;
        double sum[4] = {}, square[4] = {};
        for (int i = 0; i < n; ++i) {
            Vec2 u(uniform(random), uniform(random));
            const auto drawn = aim.draw(u);
            const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.f, 1 - z * z)), a = float(2 * kPi) * u.y;
            const Vec3 w = drawn ? *drawn : Vec3(r * std::cos(a), r * std::sin(a), z);
            const double one = 1 / double(aim.density(w, lobe));
            for (int k = 0; k < 4; ++k) {
                const double x = one * (k < 3 ? double(w[k]) * double(w[k]) : 1);
                sum[k] += x, square[k] += x * x;
            }
        }
        for (int k = 0; k < 4; ++k) {
            const double mean = sum[k] / n, se = std::sqrt((square[k] / n - mean * mean) / n);
            EXPECT_NEAR(mean, 4 * kPi / (k < 3 ? 3 : 1), teststat::kZ * se + 1e-5) << share << ", " << k;
        }
    }
    LightDirected none;
    Vec2 u(.25f, .5f);
    EXPECT_FALSE(none.draw(u));
    EXPECT_EQ(none.density({0, 0, 1}, .75f), .75f);
}

} // namespace lightdirected_test
