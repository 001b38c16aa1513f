// The statistics that judge estimators, judged themselves: closed forms, rate of false alarms, power.
#include "statistics/agreement.h"
#include <gtest/gtest.h>
#include <random>

namespace agreement_test {

using namespace alpenglow::teststat;

namespace {

// 64 tiles of mean 1; every tile's mean has the given standard error on both sides. `bias` is added to the tiles of b it is asked
// for.
Agreement simulate(std::mt19937_64& g, double se, double bias, int biased, double claim = 1) {
    std::normal_distribution<double> n;
    std::vector<TileMean> a, b;
    for (int i = 0; i < 64; ++i) {
        a.push_back({1 + se * n(g), se * claim, 1e4});
        b.push_back({1 + se * n(g) + (i < biased ? bias : 0), se * claim, 1e4});
    }
    return compareTiles(a, b);
}

} // namespace

// Tables of Kolmogorov's distribution: the two-sided limits at 5 % and 1 % are 1.3581 and 1.6276. Both series meet.
TEST(Agreement, KolmogorovClosedForms) {
    EXPECT_NEAR(kolmogorovQ(1.3581), 0.05, 2e-5);
    EXPECT_NEAR(kolmogorovQ(1.6276), 0.01, 5e-6);
    EXPECT_NEAR(kolmogorovQ(0.5 - 1e-9), kolmogorovQ(0.5 + 1e-9), 1e-8);
    EXPECT_NEAR(kolmogorovQ(0.1), 1, 1e-12);
    // n values at (i + 1/2) / n have D = 1 / (2 n): nothing to object to. All values below 1/2: D = 1/2.
    std::vector<double> even, low;
    for (int i = 0; i < 100; ++i) even.push_back((i + 0.5) / 100), low.push_back((i + 0.5) / 200);
    EXPECT_GT(ksUniformP(even), 0.999);
    EXPECT_LT(ksUniformP(low), 1e-10);
}
TEST(Agreement, SidakOfSmallNumbers) {
    EXPECT_NEAR(sidakP(1e-12, 64) / 64e-12, 1, 1e-9);
    EXPECT_NEAR(sidakP(0.5, 2), 0.75, 1e-15);
    EXPECT_NEAR(normalP(4.753), 2.0e-6, 1e-8);
}
// p-values of equal pictures are uniform (largest, sum, image; KS itself to its own approximation), and nothing is rejected.
TEST(Agreement, NoFalseAlarms) {
    std::mt19937_64 g(3);
    std::vector<double> image, sum, largest, ks;
    for (int r = 0; r < 2000; ++r) {
        Agreement a = simulate(g, 0.01, 0, 0);
        EXPECT_TRUE(a.ok()) << a.text();
        image.push_back(a.imageP);
        sum.push_back(a.sumP);
        largest.push_back(a.largestP);
        ks.push_back(a.ksP);
    }
    for (auto& v : {image, sum, largest}) EXPECT_GT(ksUniformP(v), 1e-3);
    EXPECT_GT(ksUniformP(ks), 1e-6);
}
// Power: a bias of the size that `finds` and `findsLocal` name is rejected at least 96 of 100 times (99 less 3 deviations of 100
// draws).
TEST(Agreement, Power) {
    std::mt19937_64 g(4);
    int image = 0, local = 0, tooSmall = 0, spread = 0;
    for (int r = 0; r < 100; ++r) {
        Agreement a = simulate(g, 0.01, 0, 0);
        image += !simulate(g, 0.01, a.finds, 64).ok();
        local += !simulate(g, 0.01, a.findsLocal, 1).ok();
        spread += !simulate(g, 0.01, 0.03, 32).ok();    // 2.1 deviations in half of the tiles: the sum of squares
        tooSmall += !simulate(g, 0.01, 0, 0, 0.6).ok(); // standard errors that claim 0.6 of the truth
    }
    EXPECT_GE(image, 96);
    EXPECT_GE(local, 96);
    EXPECT_GE(spread, 96);
    EXPECT_GE(tooSmall, 90);
}
// The p-values of many nights (docs/proof.md), kept by ALPENGLOW_PVALUES, are uniform. Finds broken statistics and small
// common bias.
TEST(Agreement, KeptPValuesAreUniform) {
    const char* file = std::getenv("ALPENGLOW_PVALUES");
    if (!nightly() || !file) GTEST_SKIP() << "nightly, with ALPENGLOW_PVALUES";
    std::vector<double> p;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) p.push_back(std::strtod(line.c_str(), nullptr));
    if (p.size() < 500) GTEST_SKIP() << p.size() << " p-values kept; 500 are needed";
    EXPECT_GT(ksUniformP(p), 1e-3) << p.size() << " p-values";
}

} // namespace agreement_test
