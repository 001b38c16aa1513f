// world/skytable.h: densities add up to one, directions come with the frequency that the density says, and what is known of a sky
// is what integrals say.
#include "base/exact.h"
#include "statistics/chisquare.h"
#include "statistics/nightly.h"
#include "world/skysampler.h"
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace skytable_test {

using namespace alpenglow;
using world::SkySampler;
using world::SkyTable;

namespace {

struct Sky {
    const char* name;
    int width, height;
    std::vector<float> weights;
    std::vector<SkyTable::Refined> refined = {};
};

/// A sky with refined cells at both poles and between, one of them black but for two parts.
Sky refinedSky() {
    std::mt19937 rng(5);
    std::uniform_real_distribution<float> one(0, 1);
    Sky s{"refined cells", 16, 8, {}};
    for (int i = 0; i < 16 * 8; ++i) s.weights.push_back(one(rng));
    for (const auto& [column, row, side] : {std::array{3, 2, 4}, {0, 0, 2}, {15, 7, 8}, {4, 2, 32}}) {
        SkyTable::Refined r{column, row, side, {}};
        for (int i = 0; i < side * side; ++i)
            r.weights.push_back(side == 32 ? (i == 40 || i == 555) * 4e4f : std::exp(6 * one(rng)));
        s.refined.push_back(std::move(r));
    }
    return s;
}

std::vector<Sky> skies() {
    std::mt19937 rng(3);
    std::uniform_real_distribution<float> one(0, 1);
    const auto of = [](const char* name, int w, int h, auto&& value) {
        Sky s{name, w, h, {}};
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) s.weights.push_back(value(x, y));
        return s;
    };
    return {of("even", 16, 8, [](int, int) { return 2.f; }),
            of("noise", 16, 8, [&](int, int) { return std::exp(8 * one(rng)); }),
            of("a sun", 64, 32, [](int x, int y) { return x == 40 && y == 9 ? 1e5f : .1f; }),
            of("a sun alone at the pole", 32, 16, [](int, int y) { return y == 0 ? 5.f : 0.f; }),
            of("black rows and columns", 16, 8, [](int x, int y) { return x % 3 && y % 2 ? 1.f : 0.f; }),
            of("no numbers among them", 16, 8, [](int x, int y) {
                return x == 2 ? NAN : x == 3 ? INFINITY : x == 5 ? -1.f : float(y);
            })};
}

/// Solid angle of a cell, in a way of its own.
double cellOf(const Sky& s, int row) {
    return 2 * kPi / s.width * (std::cos(kPi * row / s.height) - std::cos(kPi * (row + 1) / s.height));
}

} // namespace

TEST(SkyTable, DensitiesOfCells) {
    for (const Sky& s : skies()) {
        const SkyTable table(s.width, s.height, s.weights);
        double total = 0, square = 0, area = 0, sum = 0;
        const auto weight = [&](int x, int y) {
            const float w = s.weights[size_t(y * s.width + x)];
            return std::isfinite(w) && w > 0 ? double(w) : 0;
        };
        for (int y = 0; y < s.height; ++y)
            for (int x = 0; x < s.width; ++x) {
                total += weight(x, y) * cellOf(s, y);
                square += weight(x, y) * weight(x, y) * cellOf(s, y);
                area += cellOf(s, y);
            }
        EXPECT_NEAR(table.integral(), total, 1e-6 * total) << s.name;
        EXPECT_NEAR(table.concentration(), square / area / std::pow(total / area, 2), 1e-6 * table.concentration()) << s.name;
        for (int y = 0; y < s.height; ++y)
            for (int x = 0; x < s.width; ++x) {
                const float pdf = table.pdf(SkyTable::direction(x, y, s.width, s.height, .5f, .5f));
                // Sums of floats from 0 to 1: a cell's share is good to 2^-24 or so.
                EXPECT_NEAR(pdf * cellOf(s, y), weight(x, y) * cellOf(s, y) / total, 3e-7) << s.name << " " << x << " " << y;
                if (weight(x, y) == 0) EXPECT_EQ(pdf, 0) << s.name;
                sum += pdf * cellOf(s, y);
            }
        EXPECT_NEAR(sum, 1, 1e-5) << s.name;
    }
}

TEST(SkyTable, PartsOfRefinedCells) {
    const Sky s = refinedSky();
    const SkyTable table(s.width, s.height, s.weights, s.refined);
    const auto meanOf = [](const SkyTable::Refined& r) {
        double sum = 0;
        for (const float w : r.weights) sum += w;
        return sum / double(r.weights.size());
    };
    double total = 0;
    for (int i = 0; i < s.width * s.height; ++i) {
        double weight = s.weights[size_t(i)];
        for (const SkyTable::Refined& r : s.refined)
            if (r.row * s.width + r.column == i) weight = meanOf(r);
        total += weight * cellOf(s, i / s.width);
    }
    EXPECT_NEAR(table.integral(), total, 1e-6 * total);
    for (const SkyTable::Refined& r : s.refined) {
        const double mean = meanOf(r), part = cellOf(s, r.row) / (r.side * r.side), of = mean * cellOf(s, r.row) / total;
        double all = 0;
        for (const float w : r.weights) all += std::max<double>(w, SkyTable::kLeastPart * mean);
        for (int y = 0; y < r.side; ++y)
            for (int x = 0; x < r.side; ++x) {
                const double weight = std::max<double>(r.weights[size_t(y * r.side + x)], SkyTable::kLeastPart * mean);
                const Vec3 w = SkyTable::direction(r.column, r.row, s.width, s.height, (float(x) + .5f) / float(r.side),
                                                   (float(y) + .5f) / float(r.side));
                // Shares of floats from 0 to 1: those of a cell and of its part are good to 2^-24 or so.
                EXPECT_NEAR(table.pdf(w) * part, of * weight / all, 4e-7) << r.side << ": " << x << " " << y;
            }
    }
}

TEST(SkyTable, FrequenciesOfParts) {
    const Sky s = refinedSky();
    const SkyTable table(s.width, s.height, s.weights, s.refined);
    const int n = teststat::samples(400'000, 4'000'000);
    std::mt19937 rng(unsigned(teststat::seedBase()) + 13);
    std::uniform_real_distribution<float> one(0, 0x1.fffffep-1f);
    std::vector<std::vector<double>> seen;
    for (const SkyTable::Refined& r : s.refined) seen.push_back(std::vector<double>(size_t(r.side * r.side)));
    for (int i = 0; i < n; ++i) {
        Vec3 w;
        float pdf;
        ASSERT_TRUE(table.sample({one(rng), one(rng)}, w, pdf));
        ASSERT_EQ(pdf, table.pdf(w));
        const double turn = std::atan2(double(w.y), double(w.x)) / (2 * kPi), x = (turn < 0 ? turn + 1 : turn) * s.width;
        const double y = std::acos(double(w.z)) / kPi * s.height; // rows are even in the angle, parts in z
        for (size_t k = 0; k < s.refined.size(); ++k) {
            const SkyTable::Refined& r = s.refined[k];
            if (int(x) != r.column || int(y) != r.row) continue;
            const double top = std::cos(kPi * r.row / s.height), end = std::cos(kPi * (r.row + 1) / s.height);
            const int down = std::clamp(int((double(w.z) - top) / (end - top) * r.side), 0, r.side - 1);
            seen[k][size_t(down * r.side + std::clamp(int((x - r.column) * r.side), 0, r.side - 1))]++;
        }
    }
    for (size_t k = 0; k < s.refined.size(); ++k) {
        const SkyTable::Refined& r = s.refined[k];
        for (int i = 0; i < r.side * r.side; ++i) {
            const Vec3 w = SkyTable::direction(r.column, r.row, s.width, s.height, (float(i % r.side) + .5f) / float(r.side),
                                               (float(i / r.side) + .5f) / float(r.side));
            const double expected = n * double(table.pdf(w)) * cellOf(s, r.row) / (r.side * r.side);
            EXPECT_NEAR(seen[k][size_t(i)], expected, 6 * std::sqrt(expected) + 6) << r.side << ": " << i;
        }
    }
}

TEST(SkyTable, FrequenciesAreTheDensities) {
    const int n = teststat::samples(200'000, 2'000'000);
    for (const Sky& s : skies()) {
        const SkyTable table(s.width, s.height, s.weights);
        std::mt19937 rng(unsigned(teststat::seedBase()) + 11);
        std::uniform_real_distribution<float> one(0, 0x1.fffffep-1f);
        // Cells of an evenly cut sphere that are no cells of the table, by z and turn.
        constexpr int kZ = 12, kTurn = 10;
        std::vector<double> seen(kZ * kTurn), expected(kZ * kTurn);
        const auto cell = [&](const Vec3& w) {
            const double turn = std::atan2(double(w.y), double(w.x)) / (2 * kPi);
            return size_t(std::clamp(int((w.z + 1) / 2 * kZ), 0, kZ - 1) * kTurn +
                          std::clamp(int((turn < 0 ? turn + 1 : turn) * kTurn), 0, kTurn - 1));
        };
        for (int i = 0; i < n; ++i) {
            Vec3 w;
            float pdf;
            ASSERT_TRUE(table.sample({one(rng), one(rng)}, w, pdf)) << s.name;
            ASSERT_NEAR(length(w), 1, 1e-6) << s.name;
            ASSERT_EQ(pdf, table.pdf(w)) << s.name;
            ASSERT_GT(pdf, 0) << s.name;
            seen[cell(w)]++;
        }
        const int kFine = nightly() ? 1500 : 700; // the midpoint rule over z and turn, which are even on the sphere
        for (int i = 0; i < kFine; ++i)
            for (int k = 0; k < kFine; ++k) {
                const double z = -1 + 2 * (i + .5) / kFine, away = std::sqrt(1 - z * z), turn = 2 * kPi * (k + .5) / kFine;
                const Vec3 w(float(away * std::cos(turn)), float(away * std::sin(turn)), float(z));
                expected[cell(w)] += n * double(table.pdf(w)) * 4 * kPi / kFine / kFine;
            }
        std::vector<double> a,
            b; // cells that hold enough, and what the quadrature's steps at the edges of bright cells do not decide
        double restA = 0, restB = 0;
        for (size_t i = 0; i < seen.size(); ++i)
            if (expected[i] > 50) a.push_back(seen[i]), b.push_back(expected[i]);
            else restA += seen[i], restB += expected[i];
        for (size_t i = 0; i < a.size(); ++i) // 1 in 700 of a cell's width is the rule's error there; 1 % is far above it
            EXPECT_NEAR(a[i], b[i], 6 * std::sqrt(b[i]) + .01 * b[i]) << s.name << " cell " << i;
        EXPECT_NEAR(restA, restB, 6 * std::sqrt(restB) + 10) << s.name;
    }
}

TEST(SkyTable, BlackSkiesAndEnds) {
    const SkyTable black(8, 4, std::vector<float>(32, 0));
    Vec3 w;
    float pdf;
    EXPECT_FALSE(black.sample({.5f, .5f}, w, pdf));
    EXPECT_EQ(black.pdf({0, 0, 1}), 0);
    for (const Sky& s : skies()) {
        const SkyTable table(s.width, s.height, s.weights);
        for (const float u : {0.f, 0x1p-24f, .5f, 0x1.fffffep-1f})
            for (const float v : {0.f, .5f, 0x1.fffffep-1f}) {
                ASSERT_TRUE(table.sample({u, v}, w, pdf)) << s.name;
                EXPECT_EQ(pdf, table.pdf(w)) << s.name << u << v;
                EXPECT_NEAR(length(w), 1, 1e-6) << s.name;
            }
    }
}

/// A sky of 64 x 32 cells: `bright` in four cells, two of them refined with a dark half, and `dim` elsewhere.
Sky sunnySky(float bright, float dim) {
    Sky s{"a sun", 64, 32, std::vector<float>(64 * 32, dim)};
    for (const int column : {40, 41})
        for (const int row : {9, 10}) {
            s.weights[size_t(row * 64 + column)] = row == 10 ? bright : 0; // replaced where refined
            if (row == 9) s.refined.push_back({column, row, 2, {dim, dim, bright, bright}});
        }
    return s;
}

TEST(SkySampler, BrightDirectionsAreAStratum) {
    const Sky s = sunnySky(1000, 1);
    const SkySampler sky(s.width, s.height, s.weights, s.refined);
    const SkyTable whole(s.width, s.height, s.weights, s.refined);
    EXPECT_EQ(sky.integral(), whole.integral());
    EXPECT_EQ(sky.concentration(), whole.concentration());
    const double mean = (1000 + 1) / 2., bright = mean * cellOf(s, 9) * 2 + 1000 * cellOf(s, 10) * 2,
                 rest = sky.integral() - bright;
    EXPECT_NEAR(bright / sky.integral(), .66, .01);
    EXPECT_EQ(sky.brightChance(), .75f); // the nearest multiple of 1/4
    const auto pdfAt = [&](int column, int row, float t) {
        return sky.pdf(SkyTable::direction(column, row, s.width, s.height, .5f, t));
    };
    EXPECT_NEAR(pdfAt(41, 10, .3f), .75 * 1000 / bright, 1e-5 * 1000 / bright);
    EXPECT_NEAR(pdfAt(20, 5, .3f), .25 / rest, 1e-5 / rest);
    const double least = SkyTable::kLeastPart * mean, parts = (1000 + least) / 2; // mean of the parts, with the least density
    EXPECT_NEAR(pdfAt(40, 9, .75f), .75 * 1000 * (mean / parts) / bright, 1e-5 * 1000 / bright);
    EXPECT_NEAR(pdfAt(40, 9, .25f), .75 * least * (mean / parts) / bright, 1e-5 * 1000 / bright);
    // Of rows of numbers with u.y in n equal steps, exactly three quarters lie in bright cells.
    int found = 0, all = 0;
    const auto isBright = [&](const Vec3& w) {
        const double turn = std::atan2(double(w.y), double(w.x)) / (2 * kPi);
        const int column = int((turn < 0 ? turn + 1 : turn) * s.width), row = int(std::acos(double(w.z)) / kPi * s.height);
        return (column == 40 || column == 41) && (row == 9 || row == 10);
    };
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            Vec3 w;
            float pdf;
            ASSERT_TRUE(sky.sample({(float(x) + .37f) / 16, (float(y) + .61f) / 16}, w, pdf));
            EXPECT_EQ(pdf, sky.pdf(w));
            found += isBright(w);
            ++all;
            ASSERT_TRUE(sky.sampleBright({(float(x) + .37f) / 16, (float(y) + .61f) / 16}, w, pdf));
            EXPECT_TRUE(isBright(w));
        }
    EXPECT_EQ(found, all * 3 / 4);
}

TEST(SkySampler, OneTableWhereNothingIsGained) {
    // An even sky; one lit by its sun alone; one whose sun has little of the light.
    for (const Sky& s : {sunnySky(1, 1), sunnySky(3000, 1e-3f), sunnySky(30, 1)}) {
        const SkySampler sky(s.width, s.height, s.weights, s.refined);
        const SkyTable whole(s.width, s.height, s.weights, s.refined);
        EXPECT_EQ(sky.brightChance(), 0);
        for (const Vec2 u : {Vec2(.1f, .9f), Vec2(.7f, .33f), Vec2(.999f, .5f)}) {
            Vec3 a, b;
            float p = 0, q = 0;
            EXPECT_EQ(sky.sample(u, a, p), whole.sample(u, b, q));
            EXPECT_EQ(a, b);
            EXPECT_EQ(p, q);
        }
    }
    Vec3 w;
    float pdf;
    EXPECT_FALSE(SkySampler(64, 32, sunnySky(1, 1).weights).sampleBright({.5f, .5f}, w, pdf));
    EXPECT_TRUE(SkySampler(64, 32, sunnySky(3000, 1e-3f).weights).sampleBright({.5f, .5f}, w, pdf));
}

} // namespace skytable_test
