// Do two ways of making one picture agree? Four statistics on the tiles of the picture (docs/proof.md): the image's mean finds a
// small bias everywhere, the sum of z^2 many small local ones, the largest |z| one local one, and Kolmogorov-Smirnov a wrong
// distribution of the tiles' p-values, which is also what broken standard errors look like.
#pragma once
#include "statistics/chisquare.h"
#include "statistics/nightly.h"
#include <fstream>
#include <functional>
#include <span>
#include <string>

namespace alpenglow::teststat {

inline constexpr double kAlphaKs = 1e-4;  ///< of Kolmogorov-Smirnov
inline constexpr double kPower99 = 2.326; ///< one-sided normal: beyond the threshold by this much, 99 of 100 are rejected

/// P(|normal| >= |z|).
inline double normalP(double z) { return std::erfc(std::fabs(z) / std::sqrt(2.0)); }
/// p-value of the smallest of n independent p-values (Sidak), exact for small ones: 1 - (1 - p)^n.
inline double sidakP(double p, int n) { return -std::expm1(n * std::log1p(-std::min(p, 1 - 1e-16))); }

/// P(sqrt(n) D >= lambda) for Kolmogorov's statistic, n large: 2 sum (-1)^(k-1) exp(-2 k^2 lambda^2); below 0.5 the other series.
inline double kolmogorovQ(double lambda) {
    if (lambda <= 0) return 1;
    if (lambda < 0.5) {
        const double pi = 3.14159265358979323846;
        double p = 0;
        for (int k = 1; k < 20; k += 2) p += std::exp(-k * k * pi * pi / (8 * lambda * lambda));
        return 1 - std::sqrt(2 * pi) / lambda * p;
    }
    double q = 0;
    for (int k = 1; k < 50; ++k) q += (k % 2 ? 2 : -2) * std::exp(-2.0 * k * k * lambda * lambda);
    return std::min(1.0, std::max(0.0, q));
}
/// Whether values are uniform on [0,1]: the two-sided p-value, with Stephens' correction for finite n.
inline double ksUniformP(std::vector<double> v) {
    if (v.empty()) return 1;
    std::sort(v.begin(), v.end());
    double d = 0, n = double(v.size());
    for (size_t i = 0; i < v.size(); ++i) d = std::max({d, double(i + 1) / n - v[i], v[i] - double(i) / n});
    return kolmogorovQ(d * (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)));
}

/// What is known of one tile (or of one randomisation): mean, its standard error, effective number of samples (sum x)^2 / sum
/// x^2.
struct TileMean {
    double mean = 0, se = 0, effective = 0;
};

struct Agreement {
    double a = 0, b = 0, se = 0; ///< the images' means and the standard error of their difference
    double imageP = 1, sumP = 1, largestP = 1, ksP = 1;
    int used = 0;             ///< tiles with noise; the others must be equal
    double worstExact = 0;    ///< largest difference of tiles without noise
    double effective = 1e300; ///< the least over both images, all tiles together
    double finds = 0;         ///< the least relative bias of the whole image that is rejected in 99 of 100 runs
    double findsLocal = 0;    ///< the same for a bias in one tile, median tile
    bool ok(int tests = 1) const {
        auto above = [&](double p, double alpha) { return sidakP(p, tests) > alpha; };
        return above(imageP, kAlpha) && above(sumP, kAlpha) && above(largestP, kAlpha) && above(ksP, kAlphaKs) &&
               worstExact <= 1e-6;
    }
    std::string text() const {
        char t[320];
        std::snprintf(
            t, sizeof t,
            "means %.6f and %.6f, se of the difference %.6f (p %.3g), sum z^2 p %.3g, largest z p %.3g, KS p %.3g, %d tiles; "
            "finds %.2f %% of the image, %.1f %% of a tile",
            a, b, se, imageP, sumP, largestP, ksP, used, 100 * finds, 100 * findsLocal);
        return t;
    }
};

/// Tiles are of equal size and independent; a tile's mean is normal (effective numbers are checked by the caller).
inline Agreement compareTiles(std::span<const TileMean> a, std::span<const TileMean> b) {
    Agreement r;
    double variance = 0, sum = 0, most = 0;
    std::vector<double> p, local;
    for (size_t i = 0; i < a.size(); ++i) {
        double d = a[i].mean - b[i].mean, v = a[i].se * a[i].se + b[i].se * b[i].se;
        r.a += a[i].mean / double(a.size());
        r.b += b[i].mean / double(a.size());
        variance += v;
        if (!(v > 1e-16)) {
            r.worstExact = std::max(r.worstExact, std::fabs(d));
            continue;
        }
        double z = d / std::sqrt(v);
        sum += z * z;
        most = std::max(most, std::fabs(z));
        p.push_back(normalP(z));
        local.push_back(std::sqrt(v) / std::max(1e-300, std::fabs(b[i].mean)));
    }
    r.used = int(p.size());
    r.se = std::sqrt(variance) / double(a.size());
    if (r.used == 0) return r;
    r.imageP = normalP((r.a - r.b) / r.se);
    r.sumP = gammaQ(r.used / 2.0, sum / 2);
    r.largestP = sidakP(normalP(most), r.used);
    r.ksP = ksUniformP(p);
    r.finds = (kZ + kPower99) * r.se / std::max(1e-300, std::fabs(r.b));
    std::nth_element(local.begin(), local.begin() + r.used / 2, local.end());
    double zSidak = std::sqrt(2 * std::log(2 * r.used / kAlpha)); // from above
    r.findsLocal = (zSidak + kPower99) * local[size_t(r.used / 2)];
    for (auto side : {a, b}) {
        double e = 0;
        for (const TileMean& t : side) e += t.effective;
        r.effective = std::min(r.effective, e);
    }
    return r;
}

/// Keeps a p-value of a night in the file that ALPENGLOW_PVALUES names, one "name p" a line: over a month they must be uniform.
inline void keepP(const std::string& name, double p) {
    if (const char* file = std::getenv("ALPENGLOW_PVALUES")) std::ofstream(file, std::ios::app) << p << " " << name << "\n";
}

} // namespace alpenglow::teststat
