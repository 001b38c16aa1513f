#include "render/adaptive.h"
#include "base/exact.h"
#include "render/noise.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::render {

namespace {

/// The neighbourhood x0 <= x <= x1, y0 <= y <= y1 of a pixel.
struct About {
    int x0, x1, y0, y1;
    About(int x, int y, int width, int height, int radius)
        : x0(std::max(0, x - radius)), x1(std::min(width - 1, x + radius)), y0(std::max(0, y - radius)),
          y1(std::min(height - 1, y + radius)) {}
    int pixels() const { return (x1 - x0 + 1) * (y1 - y0 + 1); }
};

/// Integers by pixel: a value left out of a sum leaves no trace in its rounding.
struct Grid {
    int width, height;
    std::vector<int64_t> values;
    int64_t& at(int x, int y) { return values[size_t(y) * size_t(width) + size_t(x)]; }
    /// Sums along rows, over `radius` pixels on each side.
    Grid rows(int radius) {
        Grid r{width, height, std::vector<int64_t>(values.size())};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const About a(x, y, width, height, radius);
                for (int i = a.x0; i <= a.x1; ++i) r.at(x, y) += at(i, y);
            }
        return r;
    }
};

constexpr double kUnit = 0x1p-24; ///< of squared relative errors, and of wanted rates
constexpr double kMost = 0x1p10;  ///< limit of both: sums of 2^28 pixels fit into 64 bits
int64_t fixedNumber(double v) { return int64_t(std::min(v, kMost) / kUnit + 0.5); }

/// r^2 of each pixel, clamped to kMost, which is more noise than any picture has.
Grid squaredErrors(const Film& film) {
    const Window& w = film.window();
    Grid g{w.width(), w.height(), {}};
    g.values.reserve(w.pixels());
    for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) {
            const double r = relativeReplicaError(replicaError(film, x, y));
            g.values.push_back(fixedNumber(r * r));
        }
    return g;
}

/// r^(2/3), with r^2 the mean over the neighbours of each pixel, without the pixel itself.
Grid wantedRates(const Film& film) {
    Grid own = squaredErrors(film), rows = own.rows(kRateRadius), wanted{own.width, own.height, {}};
    wanted.values.reserve(own.values.size());
    for (int y = 0; y < own.height; ++y)
        for (int x = 0; x < own.width; ++x) {
            const About a(x, y, own.width, own.height, kRateRadius);
            int64_t sum = -own.at(x, y);
            for (int j = a.y0; j <= a.y1; ++j) sum += rows.at(x, j);
            const double mean = sum > 0 ? double(sum) * kUnit / (a.pixels() - 1) : 0;
            wanted.values.push_back(mean > 0 ? std::max<int64_t>(1, fixedNumber(exact::pow(mean, 1.0 / 3))) : 0);
        }
    return wanted;
}

double nearestPower(double rate) {
    double p = kLeastRate;
    while (p < kGreatestRate && rate > p * 1.4142135623730951) p *= 2;
    return p;
}

} // namespace

std::vector<uint16_t> ratesOf(const Film& film) {
    Grid wanted = wantedRates(film), noisy = wanted;
    int64_t sum = 0, count = 0;
    for (int64_t& v : noisy.values) {
        sum += v;
        count += v = v > 0;
    }
    // The normalisation of a pixel's rate is the mean over those pixels that its own value does not affect.
    Grid near = wanted.rows(kRateRadius), nearNoisy = noisy.rows(kRateRadius);
    std::vector<uint16_t> rates;
    rates.reserve(wanted.values.size());
    for (int y = 0; y < wanted.height; ++y)
        for (int x = 0; x < wanted.width; ++x) {
            const About a(x, y, wanted.width, wanted.height, kRateRadius);
            int64_t others = sum, of = count;
            for (int j = a.y0; j <= a.y1; ++j) {
                others -= near.at(x, j);
                of -= nearNoisy.at(x, j);
            }
            const double rate = others > 0 ? double(wanted.at(x, y)) * double(of) / double(others) : 1;
            rates.push_back(uint16_t(Spread::kOne * nearestPower(rate)));
        }
    return rates;
}

} // namespace alpenglow::render
