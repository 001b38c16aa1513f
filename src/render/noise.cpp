#include "render/noise.h"
#include "base/exact.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace alpenglow::render {
namespace {

double relative(double se, double mean) { return se / (std::max(mean, 0.0) + kNoiseEps); }

// P(|T| <= t), Abramowitz and Stegun 26.7.3 and 26.7.4: finite sums for whole degrees of freedom.
double studentWithin(double t, int dof) {
    const double theta = exact::atan(t / std::sqrt(double(dof)));
    const auto [s, c] = exact::sinCos(theta);
    if (dof % 2) {
        double term = c, sum = 0;
        for (int k = 1; k <= dof - 2; k += 2) {
            sum += term;
            term *= c * c * (k + 1) / (k + 2);
        }
        return 2 / kPi * (theta + s * sum);
    }
    double term = 1, sum = 0;
    for (int k = 0; k <= dof - 2; k += 2) {
        sum += term;
        term *= c * c * (k + 1) / (k + 2);
    }
    return s * sum;
}

// c4 by its recurrence from Gamma(1/2) and Gamma(1): exact, and needs no library function whose last bit may differ.
double c4(int r) {
    double ratio = r % 2 ? std::sqrt(kPi) / 2 : 1 / std::sqrt(kPi); // Gamma(r/2)/Gamma((r-1)/2) for r = 3 and r = 2
    for (int k = r % 2 ? 3 : 2; k < r; k += 2) ratio *= (k / 2.0) / ((k - 1) / 2.0);
    return std::sqrt(2.0 / (r - 1)) * ratio;
}

} // namespace

double relativeStandardError(double s1, double s2, uint64_t n) {
    if (n < 2) return 0;
    double variance = std::max(0.0, (s2 - s1 * s1 / double(n)) / double(n - 1));
    return relative(std::sqrt(variance / double(n)), s1 / double(n));
}

double relativeStandardError(const Moments& m) { return m.n < 2 ? 0 : relative(std::sqrt(m.variance / m.n), m.s1 / m.n); }

void summarise(std::vector<double>& rse, double* noiseRSE, double* noiseRSE999) {
    *noiseRSE = *noiseRSE999 = 0;
    if (rse.empty()) return;
    double sum = 0;
    for (double v : rse) sum += v;
    *noiseRSE = sum / double(rse.size());
    size_t k = std::min(size_t(std::floor(0.999 * double(rse.size()))), rse.size() - 1);
    std::nth_element(rse.begin(), rse.begin() + long(k), rse.end());
    *noiseRSE999 = rse[k];
}

ReplicaError replicaError(std::span<const double> sums, std::span<const uint32_t> counts) {
    ReplicaError e;
    double sum = 0, n = 0;
    for (size_t r = 0; r < sums.size(); ++r) {
        sum += sums[r];
        n += counts[r];
        e.replicas += counts[r] > 0;
    }
    if (n == 0) return e;
    e.mean = sum / n;
    if (e.replicas < 2) return e;
    double s = 0;
    for (size_t r = 0; r < sums.size(); ++r) {
        double d = (sums[r] - counts[r] * e.mean) / n; // (n_r / n) (m_r - m)
        s += d * d;
    }
    e.se = std::sqrt(s * e.replicas / (e.replicas - 1));
    return e;
}

ReplicaError replicaError(const Film& film, int x, int y) {
    std::array<double, kReplicas> sums;
    std::array<uint32_t, kReplicas> counts;
    for (uint32_t r = 0; r < kReplicas; ++r) film.replica(x, y, r, &sums[r], &counts[r]);
    return replicaError(sums, counts);
}

double relativeReplicaError(const ReplicaError& e) { return e.replicas < 2 ? 0 : relative(e.se / c4(e.replicas), e.mean); }

SurfaceError surfaceError(const Film& film, int x, int y) {
    SurfaceError e;
    double n = 0, h = 0, share = 0;
    std::array<double, kReplicas> away{}, met{};
    for (const LuminanceSums& s : film.luminanceSums(x, y)) {
        const double of = s.samples(), on = s.onSurface(), mean = on > 0 ? s.surfaceY / on : 0;
        const double behind = of > on ? (s.sum() - s.surfaceY) / (of - on) : 0;
        n += of;
        h += on;
        if (on > 0) {
            e.mean += s.scale * of * mean;
            share += s.scale * of;
        }
        for (uint32_t r = 0; r < kReplicas; ++r) {
            away[r] += s.scale * (s.y[r] - mean * s.surfaceCount[r] - behind * (s.count[r] - s.surfaceCount[r]));
            met[r] += s.surfaceCount[r];
        }
    }
    if (h == 0) return e;
    e.coverage = h / n;
    e.mean /= share;
    double square = 0, shares = 0;
    for (uint32_t r = 0; r < kReplicas; ++r) {
        square += away[r] * away[r];
        shares += met[r] / h * (met[r] / h);
        e.replicas += met[r] > 0;
    }
    if (e.replicas >= 2) e.se = std::sqrt(square / (1 - shares)) / h;
    return e;
}

double relativeSurfaceError(const SurfaceError& e) {
    return e.replicas < 2 ? 0 : std::sqrt(e.coverage) * relative(e.se / c4(e.replicas), e.mean);
}

double noiseBound(double sum, double sumOfSquares, int replicas) {
    if (!(sumOfSquares > 0)) return 1;
    const double dof = sum * sum / (2 * (1 - c4(replicas) * c4(replicas)) * sumOfSquares), v = 2 / (9 * dof);
    const double root = 1 - v - 1.6448536269514722 * std::sqrt(v); // 5 % of the normal distribution lie below -1.645
    return root > 0 ? std::max(1.0, 1 / std::sqrt(root * root * root)) : std::numeric_limits<double>::infinity();
}

namespace {

/// Sums of squared errors of pixels.
struct Variances {
    double sum = 0, square = 0, mean = 0;
    int pixels = 0, degrees = 0;
    void add(const ReplicaError& e) {
        if (e.replicas == 0) return;
        const double v = e.se * e.se;
        sum += v;
        square += v * v;
        mean += e.mean;
        ++pixels;
        degrees += e.replicas - 1;
    }
    double dof() const {
        return square > 0 ? std::clamp(3 * sum * sum / square - 2, std::min(1.0, double(degrees)), double(degrees)) : degrees;
    }
};

} // namespace

PooledError windowError(const Film& film, const Window& w) {
    Variances all;
    for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) all.add(replicaError(film, x, y));
    if (all.pixels == 0) return {};
    return {all.mean / all.pixels, std::sqrt(all.sum) / all.pixels, all.dof()};
}

PooledError pixelError(const Film& film, int x, int y, int radius) {
    const Window& w = film.window();
    Variances near;
    const double own = film.count(x, y);
    for (int j = std::max(y - radius, w.y0); j < std::min(y + radius + 1, w.y1); ++j)
        for (int i = std::max(x - radius, w.x0); i < std::min(x + radius + 1, w.x1); ++i) {
            ReplicaError e = replicaError(film, i, j);
            if (own > 0) e.se *= std::sqrt(film.count(i, j) / own); // scaled to the sample count of this pixel
            near.add(e);
        }
    if (near.degrees == 0) return {replicaError(film, x, y).mean, 0, 0};
    return {replicaError(film, x, y).mean, std::sqrt(near.sum / near.degrees), near.dof()};
}

namespace {
double studentOfWhole(double level, int dof) {
    double hi = 1;
    while (studentWithin(hi, dof) < level && hi < 1e12) hi *= 2;
    double lo = 0;
    for (int i = 0; i < 100; ++i) {
        double m = (lo + hi) / 2;
        (studentWithin(m, dof) < level ? lo : hi) = m;
    }
    return hi;
}
} // namespace

double studentQuantile(double level, double dof) {
    const int whole = int(std::clamp(dof, 1.0, 1e6));
    const double a = studentOfWhole(level, whole);
    if (dof == whole || whole == 1'000'000) return a;
    const double share = (1 / dof - 1.0 / whole) / (1.0 / (whole + 1) - 1.0 / whole);
    return a * exact::pow(studentOfWhole(level, whole + 1) / a, share);
}

Interval confidenceInterval(const PooledError& e, double level) {
    if (!(e.dof > 0)) return {e.mean, std::numeric_limits<double>::infinity()};
    return {e.mean, studentQuantile(level, e.dof) * e.se};
}

NoiseFigures noiseFigures(const Film& film) {
    NoiseFigures f;
    const Window& w = film.window();
    std::vector<double> rse;
    rse.reserve(w.pixels());
    double relativeSum = 0, square = 0, surfaceSum = 0, surfaceSquare = 0, area = 0, judged = 0;
    uint32_t most = 0;
    for (int y = w.y0; y < w.y1; ++y)
        for (int x = w.x0; x < w.x1; ++x) {
            Moments m = film.moments(x, y);
            most = std::max(most, m.n);
            rse.push_back(relativeStandardError(m));
            ReplicaError e = replicaError(film, x, y);
            relativeSum += relativeReplicaError(e);
            square += e.se * e.se;
            const SurfaceError s = surfaceError(film, x, y);
            area += s.coverage;
            if (s.replicas < 2) continue;
            judged += s.coverage;
            const double a = s.coverage * relativeSurfaceError(s);
            surfaceSum += a;
            surfaceSquare += a * a;
        }
    if (most >= 2) summarise(rse, &f.noiseRSE, &f.noiseRSE999);
    f.noiseQMC = relativeSum / double(w.pixels());
    f.imageError = std::sqrt(square / double(w.pixels()));
    f.coverage = area / double(w.pixels());
    f.known = judged > 0;
    if (f.known) f.noise = surfaceSum / judged;
    if (f.known) f.noiseAtMost = f.noise * noiseBound(surfaceSum, surfaceSquare);
    return f;
}

double efficiency(double noiseRSE, double renderSec) {
    return noiseRSE > 0 && renderSec > 0 ? 1 / (noiseRSE * noiseRSE * renderSec) : 0;
}

double raysPerMS(uint64_t totalRays, double renderSec) { return renderSec > 0 ? double(totalRays) / renderSec / 1000 : 0; }

} // namespace alpenglow::render
