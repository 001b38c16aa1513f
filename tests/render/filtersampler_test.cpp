// T1 for the pixel filter: drawn offsets against the filter itself, quadrature done here.
#include "../statistics/chisquare.h"
#include "../statistics/nightly.h"
#include "render/filtersampler.h"
#include <gtest/gtest.h>
#include <random>

namespace filtersampler_test {

using namespace alpenglow;
using namespace alpenglow::render;
using namespace alpenglow::teststat;

namespace {

std::vector<PixelFilter> filters() {
    std::vector<PixelFilter> all;
    for (int k = 0; k < kFilterKinds; ++k)
        for (auto [x, y] : {std::pair{1.0, 1.0}, {4.0, 3.0}, {6.0, 6.0}}) all.push_back({FilterKind(k), x, y});
    return all;
}

std::string name(const PixelFilter& f) {
    return std::string(filterName(f.kind)) + " " + std::to_string(f.xw) + " " + std::to_string(f.yw);
}

constexpr int kGrid = 16, kFine = 16; // cells, and midpoints per cell and axis

// Integral of g(x, y, f(x, y)) over each cell of the support.
template <class G> std::vector<double> cells(const PixelFilter& f, G g) {
    std::vector<double> out(kGrid * kGrid, 0);
    const int n = kGrid * kFine;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            double x = f.xw * ((i + 0.5) / n - 0.5), y = f.yw * ((j + 0.5) / n - 0.5);
            out[size_t(j / kFine * kGrid + i / kFine)] += g(x, y, f(x, y)) * f.xw * f.yw / n / n;
        }
    return out;
}
double sum(const std::vector<double>& v) {
    double s = 0;
    for (double x : v) s += x;
    return s;
}

} // namespace

TEST(FilterSampler, IntegralsAndDensity) {
    for (const PixelFilter& f : filters()) {
        FilterSampler s(f);
        EXPECT_FALSE(s.degenerate()) << name(f);
        double total = 0, absolute = 0, density = 0; // sums over places, all of one area
        const double area = sum(cells(f, [&](double x, double y, double v) {
            total += v;
            absolute += std::fabs(v);
            density += s.density(x, y);
            return 1.0;
        }));
        const double each = area / (double(kGrid) * kGrid * kFine * kFine);
        // the midpoint rule on the edge of a disk is good to about one part in a thousand
        double tolerance = f.kind == FilterKind::Disk ? 2e-3 : 2e-4;
        EXPECT_NEAR(s.integral() / (total * each), 1, tolerance) << name(f);
        EXPECT_NEAR(s.absIntegral() / (absolute * each), 1, tolerance) << name(f);
        EXPECT_NEAR(density * each, 1, tolerance) << name(f);
        EXPECT_EQ(s.density(f.xw, 0), 0);
    }
}

TEST(FilterSampler, DensityIsTheFilter) {
    for (const PixelFilter& f : filters()) {
        FilterSampler s(f);
        double peak = f(0, 0) / s.absIntegral(), worst = 0;
        for (double x = -f.xw / 2; x <= f.xw / 2; x += f.xw / 97)
            for (double y = -f.yw / 2; y <= f.yw / 2; y += f.yw / 89) {
                double d = s.density(x, y), v = std::fabs(f(x, y));
                worst = std::max(worst, std::fabs(d - v / s.absIntegral()) / peak);
                if (v > 1e-12) EXPECT_GT(d, 0) << name(f) << " at " << x << " " << y;
            }
        EXPECT_LT(worst, f.separable() || f.kind == FilterKind::Disk ? 1e-5 : 0.06) << name(f);
    }
}

TEST(FilterSampler, ChiSquare) {
    const int n = samples(50'000, 1'000'000);
    for (const PixelFilter& f : filters()) {
        FilterSampler s(f);
        std::vector<double> expected = cells(f, [&](double, double, double v) { return std::fabs(v) * n; });
        double absolute = sum(expected) / n;
        for (double& e : expected) e /= absolute;
        std::vector<double> hits(kGrid * kGrid, 0);
        std::mt19937_64 g(7 + seedBase());
        std::uniform_real_distribution<float> u(0, 1);
        for (int i = 0; i < n; ++i) {
            FilterSample p = s.sample({std::min(u(g), 0x1.fffffep-1f), std::min(u(g), 0x1.fffffep-1f)});
            ASSERT_LE(std::fabs(p.dx), f.xw / 2 + 1e-6);
            ASSERT_LE(std::fabs(p.dy), f.yw / 2 + 1e-6);
            int cx = std::clamp(int((p.dx / f.xw + 0.5) * kGrid), 0, kGrid - 1),
                cy = std::clamp(int((p.dy / f.yw + 0.5) * kGrid), 0, kGrid - 1);
            hits[size_t(cy * kGrid + cx)]++;
        }
        EXPECT_GE(chiSquareP(hits, expected), kAlpha) << name(f);
    }
}

// E[weight g] is the filtered value: for g = 1, x^2, y^2 and a step, against quadrature of the filter. The draws are a lattice
// of midpoints, so there is no statistics: each place on an axis of u where weight times g jumps misplaces at most half a lattice
// step, which changes a mean by at most |jump| / (2 n), the jump being at most two weights. On u.x such places are the three
// borders between the four signed strata and the step once in each; on u.y there are none, but g is curved.
TEST(FilterSampler, WeightedMeansAreFilteredValues) {
    for (const PixelFilter& f : filters()) {
        FilterSampler s(f);
        double one = 0, xx = 0, yy = 0, step = 0;
        const int n = 300;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                FilterSample p = s.sample({float((i + 0.5) / n), float((j + 0.5) / n)});
                double w = p.weight / double(n) / n;
                one += w, xx += w * p.dx * p.dx, yy += w * p.dy * p.dy, step += w * (p.dx < 0.125 * f.xw);
            }
        double total = 0, exx = 0, eyy = 0, estep = 0;
        cells(f, [&](double x, double y, double v) {
            total += v, exx += v * x * x, eyy += v * y * y, estep += v * (x < 0.125 * f.xw);
            return v;
        });
        double tolerance = 1e-3 + 7 * s.absIntegral() / s.integral() / n;
        EXPECT_NEAR(one, 1, tolerance) << name(f);
        EXPECT_NEAR(xx, exx / total, tolerance * f.xw * f.xw / 4) << name(f);
        EXPECT_NEAR(yy, eyy / total, tolerance * f.yw * f.yw / 4) << name(f);
        EXPECT_NEAR(step, estep / total, tolerance) << name(f);
    }
}

TEST(FilterSampler, WeightIsOneWithoutNegativeParts) {
    for (FilterKind k : {FilterKind::Box, FilterKind::Triangle, FilterKind::Gaussian, FilterKind::BSpline, FilterKind::Disk,
                         FilterKind::BlackmanHarris})
        for (float u : {0.0f, 0.2f, 0.5f, 0x1.fffffep-1f}) {
            FilterSample p = FilterSampler({k, 3, 2}).sample({u, 1 - u > 0.999f ? 0.3f : 1 - u});
            EXPECT_EQ(p.weight, 1.0f) << filterName(k);
        }
    // With negative lobes: plus or minus one size, integral of |f| over integral of f.
    FilterSampler s({FilterKind::SeparableCatmullRom, 4, 4});
    double size = s.absIntegral() / s.integral();
    EXPECT_GT(size, 1.1);
    for (float u = 0.01f; u < 1; u += 0.01f) EXPECT_NEAR(std::fabs(s.sample({u, 0.4f}).weight), size, 1e-6);
    // The sign depends on the first number alone, and the share of negative weights is (1 - T/A) / 2.
    float border = float(0.5 + 0.5 * s.integral() / s.absIntegral());
    for (float u = 0.005f; u < 1; u += 0.01f) {
        EXPECT_GT(s.sample({border - 1e-5f, u}).weight, 0);
        EXPECT_LT(s.sample({border + 1e-5f, u}).weight, 0);
    }
}

// Edge response = the filter's cumulative distribution, in closed form.
TEST(FilterSampler, EdgeResponse) {
    auto response = [](FilterKind k, double w, double t) {
        FilterSampler s({k, w, w});
        const int n = 20000;
        int below = 0;
        for (int i = 0; i < n; ++i) below += s.sample({float((i + 0.5) / n), 0.5f}).dx < t;
        return double(below) / n;
    };
    for (double t : {-0.7, -0.25, 0.0, 0.1, 0.6}) {
        EXPECT_NEAR(response(FilterKind::Box, 2, t), t / 2 + 0.5, 1e-4);
        double h = 1 - std::fabs(t), tri = t < 0 ? h * h / 2 : 1 - h * h / 2;
        EXPECT_NEAR(response(FilterKind::Triangle, 2, t), tri, 1e-4);
        // exp(-2 t^2) cut at +-1: erf(sqrt2 t) / erf(sqrt2)
        double gauss = 0.5 + 0.5 * std::erf(std::sqrt(2.0) * t) / std::erf(std::sqrt(2.0));
        EXPECT_NEAR(response(FilterKind::Gaussian, 2, t), gauss, 1e-4);
    }
}

} // namespace filtersampler_test
