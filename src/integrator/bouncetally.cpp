#include "integrator/bouncetally.h"
#include "world/impl.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::integrator {

namespace {
constexpr double kMostLight = 1e6;   ///< luminance that a tally can hold
constexpr double kMostRelative = 30; ///< of a path, in units of the brightness of its pixel: rarer ones say nothing
constexpr double kWorth = .75;       ///< survival above which the usual rule holds
constexpr double kLeast = .25;       ///< least survival up to any bounce: what no pilot path has found must not become rare
constexpr size_t kLast = 3;          ///< the last bounce that a pilot knows enough of; from there on the usual roulette

int placeOf(int bounces) { return std::clamp(bounces, 0, BounceTally::kBounces - 1); }
} // namespace

void BounceTally::begin(size_t samples) {
    *this = {};
    light.assign(samples, Light{});
}

void BounceTally::add(size_t sample, int bounces, const Color& c) {
    const double l = luminance(c);
    if (std::isfinite(l)) light[sample][size_t(placeOf(bounces))] += int64_t(std::clamp(l, -kMostLight, kMostLight) * kUnit);
}

void BounceTally::ray(int bounces, const Color& throughput, bool hit) {
    const size_t b = size_t(placeOf(bounces));
    const double m = std::sqrt(double(std::max({std::fabs(throughput.x), std::fabs(throughput.y), std::fabs(throughput.z)})));
    ++traced[b];
    rays[b] += hit ? kHit : 1;
    if (std::isfinite(m)) roots[b] += int64_t(std::min(m, kMostLight) * kUnit);
}

namespace {

/// Second moments, in units of the squared brightness of the pixel: of light that rays after b or more bounces bring.
struct Moments {
    double whole = 0; ///< variance of a sample within its pixel
    std::array<double, BounceTally::kBounces + 1> from{};
};

Moments momentsOf(const BounceTally& t, std::span<const double> brightness) {
    Moments m;
    for (size_t pair = 0; pair < brightness.size(); ++pair) {
        double sum[2] = {};
        for (size_t k = 0; k < 2; ++k)
            for (size_t b = BounceTally::kBounces; b-- > 0;) {
                sum[k] += double(t.light[2 * pair + k][b]) / BounceTally::kUnit;
                const double x = std::clamp(sum[k] / brightness[pair], -kMostRelative, kMostRelative);
                m.from[b] += x * x / 2;
            }
        const double d = std::clamp((sum[0] - sum[1]) / brightness[pair], -kMostRelative, kMostRelative);
        m.whole += d * d / 2;
    }
    return m;
}

} // namespace

RouletteFactors rouletteBy(const BounceTally& t, std::span<const double> brightness) {
    constexpr size_t n = BounceTally::kBounces;
    const Moments m = momentsOf(t, brightness);
    // With a fraction f[b] of the rays of bounce b the variance is whole + sum (1 / f[b] - 1 / f[b - 1]) from[b] and the time is
    // sum f[b] rays[b]. Their product is least where f[b]^2 is in proportion to (from[b] - from[b + 1]) / rays[b]; what would
    // need more rays later than before is one stage.
    struct Stage {
        double variance, cost;
        size_t end;
    };
    std::vector<Stage> stages;
    for (size_t b = 0; b < n; ++b) {
        const double variance = b == 0 ? std::max(m.whole - m.from[1], 0.) : m.from[b] - m.from[b + 1];
        stages.push_back({variance, double(t.rays[b]), b + 1});
        while (stages.size() > 1) {
            const Stage last = stages.back(), &before = stages[stages.size() - 2];
            if (last.variance * before.cost < before.variance * last.cost) break;
            stages.pop_back();
            stages.back() = {stages.back().variance + last.variance, stages.back().cost + last.cost, last.end};
        }
    }
    RouletteFactors r;
    if (!(stages[0].variance > 0)) return r;
    double survived = 1;
    for (size_t k = 1; k < stages.size() && stages[k].cost > 0; ++k) {
        const size_t b = stages[k - 1].end;
        const double f = std::sqrt(std::max(stages[k].variance, 0.) / stages[k].cost * stages[0].cost / stages[0].variance);
        const double goes = std::max(f, kLeast) / survived;
        if (b > kLast || goes > kWorth) continue;
        survived *= goes;
        const double root = double(t.roots[b]) / BounceTally::kUnit / double(std::max<uint64_t>(t.traced[b], 1));
        if (!(root > 0)) continue;
        // Survivors carry more, so the usual rule would hardly end them later.
        for (size_t later = b; later < n; ++later) r.factors[later] = std::min(r.factors[later], float(goes / root));
    }
    return r;
}

bool mayLearnRoulette(const World& world) {
    const auto& w = static_cast<const WorldImpl&>(world);
    const Settings& s = w.settings_;
    return s.hider == Hider::Path && s.roulette && !s.localRoulette && s.direct && s.indirect && w.lightTraces_ == 0;
}

void setRoulette(const World& world, const RouletteFactors& r) { *static_cast<const WorldImpl&>(world).roulette_ = r; }

} // namespace alpenglow::integrator
