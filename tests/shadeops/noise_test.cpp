// Properties of the noises (3Delight manual, 6.4.2): range, mean, lattice, period, smoothness, decorrelated channels, spectrum.
#include "jets_runtime.h"
#include "shadeops/descriptor.h"
#include "shadeops/host_runtime.h"
#include <array>
#include <cmath>
#include <complex>
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace noise_test {

using namespace alpenglow::shadeops;

namespace {

std::vector<float> run(const std::string& symbol, const std::vector<float>& in) {
    std::vector<float> out(runtimeShape(symbol).out);
    EXPECT_TRUE(evaluateRuntime(symbol, in.data(), int(in.size()), out.data(), int(out.size()))) << symbol;
    return out;
}

class Noise : public testing::Test {
protected:
    std::mt19937 random{11};
    float draw(float lo, float hi) { return lo + (hi - lo) * std::generate_canonical<float, 24>(random); }
    std::vector<float> point(int n, float lo, float hi) {
        std::vector<float> p(n);
        for (float& x : p) x = draw(lo, hi);
        return p;
    }
};

TEST_F(Noise, RangeMeanAndSpread) {
    for (int n = 1; n <= 4; ++n)
        for (const char* kind : {"noise", "cellnoise"}) {
            const std::string symbol = std::string("al_") + kind + std::to_string(n) + "_t";
            double sum[3] = {}, square[3] = {}, product[3] = {};
            const int count = 40000;
            for (int i = 0; i < count; ++i) {
                const auto v = run(symbol, n == 1 ? point(n, -50000, 50000) : point(n, -500, 500));
                for (int c = 0; c < 3; ++c) {
                    ASSERT_GE(v[c], 0) << symbol;
                    ASSERT_LE(v[c], 1) << symbol;
                    sum[c] += v[c];
                    square[c] += v[c] * v[c];
                    product[c] += v[c] * v[(c + 1) % 3];
                }
            }
            for (int c = 0; c < 3; ++c) {
                const double mean = sum[c] / count, variance = square[c] / count - mean * mean;
                EXPECT_NEAR(mean, 0.5, 0.01) << symbol << " channel " << c;
                EXPECT_GT(std::sqrt(variance), 0.08) << symbol << ": too little contrast";
                const double covariance = product[c] / count - mean * sum[(c + 1) % 3] / count;
                EXPECT_NEAR(covariance / variance, 0, 0.03) << symbol << ": channels correlate";
                if (std::string(kind) == "cellnoise") EXPECT_NEAR(variance, 1.0 / 12, 0.003); // uniform
            }
        }
}

TEST_F(Noise, HalfAtLatticePoints) {
    for (int n = 1; n <= 4; ++n)
        for (int i = 0; i < 200; ++i) {
            auto p = point(n, -1000, 1000);
            for (float& x : p) x = std::floor(x);
            EXPECT_EQ(run("al_noise" + std::to_string(n) + "_f", p)[0], 0.5f);
        }
}

TEST_F(Noise, PeriodicRepeats) {
    for (int n = 1; n <= 4; ++n)
        for (const float period : {1.0f, 2.0f, 3.0f, 7.0f, 64.0f, 256.0f, 1000.0f})
            for (int i = 0; i < 40; ++i) {
                auto p = point(n, -8, 8);
                for (float& x : p) x = std::round(x * 1024) / 1024; // so that adding a period is exact
                auto q = p;
                for (int k = 0; k < n; ++k) q[k] += period * static_cast<float>(static_cast<int>(random() % 5) - 2);
                p.insert(p.end(), n, period);
                q.insert(q.end(), n, period);
                const std::string symbol = "al_pnoise" + std::to_string(n) + "_t";
                EXPECT_EQ(run(symbol, p), run(symbol, q)) << symbol << " period " << period;
            }
}

TEST_F(Noise, PeriodIsRoundedAndAtLeastOne) {
    for (int i = 0; i < 50; ++i) {
        const float x = draw(-20, 20);
        EXPECT_EQ(run("al_pnoise1_f", {x, 3.3f}), run("al_pnoise1_f", {x, 3}));
        EXPECT_EQ(run("al_pnoise1_f", {x, -2}), run("al_pnoise1_f", {x, 1}));
        EXPECT_EQ(run("al_pnoise1_f", {x, 0}), run("al_pnoise1_f", {x, 1}));
    }
}

TEST_F(Noise, CellnoiseIsConstantInCellsAndDiffersBetween) {
    std::set<float> seen;
    for (int x = -20; x < 20; ++x)
        for (int y = -20; y < 20; ++y) {
            const auto a = run("al_cellnoise2_f", {x + 0.1f, y + 0.9f}),
                       b = run("al_cellnoise2_f", {static_cast<float>(x), static_cast<float>(y)});
            EXPECT_EQ(a, b);
            seen.insert(a[0]);
        }
    EXPECT_GT(seen.size(), 1590u); // of 1600, 24 bits: collisions are rare
}

// Value, first and second derivatives (from the jets) have no jump across cell borders.
TEST_F(Noise, SecondDerivativeIsContinuous) {
    for (int n = 1; n <= 4; ++n) {
        const std::string symbol = "al_noise" + std::to_string(n) + "_f";
        for (int i = 0; i < 100; ++i) {
            auto p = point(n, -30, 30);
            const int axis = static_cast<int>(random() % n);
            const float border = std::floor(p[axis]);
            std::array<std::array<float, 6>, 2> side;
            for (int s = 0; s < 2; ++s) {
                std::vector<float> in;
                for (int k = 0; k < n; ++k) {
                    const float x = k == axis ? border + (s ? 1e-4f : -1e-4f) : p[k];
                    const float du = k == axis ? 1.0f : 0.3f, dv = k == axis ? 0.2f : -0.5f;
                    in.insert(in.end(), {x, du, dv, 0, 0, 0});
                }
                ASSERT_TRUE(evaluateRuntimeJet(symbol, 2, in.data(), int(in.size()), side[s].data(), 6));
            }
            for (int k = 0; k < 6; ++k) EXPECT_NEAR(side[0][k], side[1][k], k < 3 ? 2e-3 : 3e-2) << symbol << " part " << k;
        }
    }
}

// No structure along lines: the autocorrelation at two and more cells vanishes, along axes and diagonals.
TEST_F(Noise, NoCorrelationBeyondTheCell) {
    const int directions[][3] = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2},  {2, 2, 0},   {2, -2, 0}, {0, 2, 2},   {2, 2, 2},   {3, -3, 3},
                                 {4, 0, 0}, {8, 0, 0}, {0, 16, 0}, {32, 32, 0}, {64, 0, 0}, {0, 0, 256}, {0, 4096, 0}};
    for (const auto& d : directions) {
        double ab = 0, aa = 0;
        const int count = 30000;
        for (int i = 0; i < count; ++i) {
            const auto p = point(3, -100, 100);
            const double a = run("al_noise3_f", p)[0] - 0.5,
                         b = run("al_noise3_f", {p[0] + d[0], p[1] + d[1], p[2] + d[2]})[0] - 0.5;
            ab += a * b;
            aa += a * a;
        }
        EXPECT_NEAR(ab / aa, 0, 0.03) << d[0] << " " << d[1] << " " << d[2];
    }
}

// Power spectrum of 1-D noise along a slanted line through 3-D: little below 0.1 cycles per unit, little above 2, most between.
TEST_F(Noise, SpectrumIsABand) {
    const int n = 4096;
    const double step = 0.125;
    std::vector<double> x(n);
    for (int i = 0; i < n; ++i) {
        const float t = static_cast<float>(i * step);
        x[i] = run("al_noise3_f", {t * 0.36f + 0.3f, t * 0.48f + 0.7f, t * 0.8f + 0.1f})[0] - 0.5;
    }
    double low = 0, band = 0, high = 0;
    for (int k = 1; k < n / 2; k += 1) {
        std::complex<double> s = 0;
        const double w = 2 * M_PI * k / n;
        const std::complex<double> turn = std::polar(1.0, -w);
        std::complex<double> z = 1;
        for (int i = 0; i < n; ++i, z *= turn) s += x[i] * z;
        const double frequency = k / (n * step), power = std::norm(s);
        (frequency < 0.1 ? low : frequency < 1.5 ? band : high) += power;
    }
    const double all = low + band + high;
    EXPECT_GT(band / all, 0.8);
    EXPECT_LT(high / all, 0.05);
    std::printf("spectrum: below 0.1: %.3f, 0.1..1.5: %.3f, above: %.3f\n", low / all, band / all, high / all);
}

// A cell and its mirror image at the origin have nothing in common.
TEST_F(Noise, NoSymmetryAboutTheOrigin) {
    for (int n = 1; n <= 4; ++n) {
        double even = 0, all = 0;
        for (int i = 0; i < 20000; ++i) {
            auto p = n == 1 ? point(n, 0, 20000) : point(n, 0, 50), q = p;
            for (float& x : q) x = -x;
            const std::string symbol = "al_noise" + std::to_string(n) + "_f";
            const double a = run(symbol, p)[0] - 0.5, b = run(symbol, q)[0] - 0.5;
            even += a * b;
            all += a * a;
        }
        EXPECT_NEAR(even / all, 0, 0.05) << n;
    }
}

TEST_F(Noise, GradientDirectionsAreBalanced) {
    // E[(dn/dx)^2] is the same along the three axes and along a diagonal.
    double axis[3] = {}, diagonal = 0;
    for (int i = 0; i < 30000; ++i) {
        const auto p = point(3, -100, 100);
        for (int k = 0; k < 3; ++k) {
            std::vector<float> in;
            for (int j = 0; j < 3; ++j) in.insert(in.end(), {p[j], j == k ? 1.0f : 0.0f, 0.57735027f});
            float out[3];
            ASSERT_TRUE(evaluateRuntimeJet("al_noise3_f", 1, in.data(), 9, out, 3));
            axis[k] += out[1] * out[1];
            if (k == 0) diagonal += out[2] * out[2];
        }
    }
    EXPECT_NEAR(axis[1] / axis[0], 1, 0.05);
    EXPECT_NEAR(axis[2] / axis[0], 1, 0.05);
    EXPECT_NEAR(diagonal / axis[0], 1, 0.06);
}

TEST_F(Noise, FarAndOddCoordinatesStayInRange) {
    for (const float x : {1e9f, -1e9f, 1e20f, 3e38f, -3e38f, INFINITY, -INFINITY, NAN, 1e-40f, -0.0f})
        for (int n = 1; n <= 4; ++n)
            for (const char* kind : {"al_noise", "al_cellnoise"}) {
                std::vector<float> p(n, x);
                const float v = run(kind + std::to_string(n) + "_f", p)[0];
                EXPECT_GE(v, 0) << x;
                EXPECT_LE(v, 1) << x;
            }
}

} // namespace

} // namespace noise_test
