// Goodness of fit for tests, survival functions computed directly in double (no 1 - cdf).
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace alpenglow::teststat {

/// Q(a, x), the upper regularised incomplete gamma function: series below a + 1, continued fraction (Lentz) above.
inline double gammaQ(double a, double x) {
    if (x <= 0) return 1;
    double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 10000 && term > sum * 1e-17; ++n) sum += term *= x / (a + n);
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int i = 1; i < 10000; ++i) {
        double an = -i * (i - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (std::fabs(d * c - 1) < 1e-15) break;
    }
    return front * h;
}

/// p-value of the chi-square test. Cells are pooled in ascending order of expectation until a pool expects at least 10.
inline double chiSquareP(const std::vector<double>& observed, const std::vector<double>& expected) {
    std::vector<std::pair<double, double>> cells;
    for (size_t i = 0; i < observed.size(); ++i) cells.emplace_back(expected[i], observed[i]);
    std::sort(cells.begin(), cells.end());
    double e = 0, o = 0, x = 0;
    int k = 0;
    for (size_t i = 0; i < cells.size(); ++i) {
        e += cells[i].first;
        o += cells[i].second;
        if (e >= 10 || i + 1 == cells.size()) {
            if (e > 0) {
                x += (o - e) * (o - e) / e;
                ++k;
            } else if (o > 0) {
                return 0;
            }
            e = o = 0;
        }
    }
    return k < 2 ? 1 : gammaQ((k - 1) / 2.0, x / 2);
}

inline constexpr double kAlpha = 2e-6; ///< per test (docs/proof.md)
inline constexpr double kZ = 4.753;    ///< the same, two-sided normal

} // namespace alpenglow::teststat
