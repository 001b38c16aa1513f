#include "bsdf/albedoinversion.h"
#include "base/exact.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace alpenglow::bsdf {

namespace {

constexpr int kSteps = 256; ///< entries of the table
constexpr double kPiD = 3.14159265358979323846;

/// Gauss-Legendre nodes and weights on [0, 1], by Newton's method on the polynomial.
struct Gauss {
    static constexpr int kCount = 16;
    std::array<double, kCount> at{}, weight{};
    Gauss() {
        for (int i = 0; i < kCount; ++i) {
            double x = -exact::cos(kPiD * (i + 0.75) / (kCount + 0.5)), slope = 1;
            for (int round = 0; round < 20; ++round) {
                double p0 = 1, p1 = x;
                for (int n = 2; n <= kCount; ++n) {
                    const double p2 = ((2 * n - 1) * x * p1 - (n - 1) * p0) / n;
                    p0 = p1, p1 = p2;
                }
                slope = kCount * (x * p1 - p0) / (x * x - 1);
                x -= p1 / slope;
            }
            at[size_t(i)] = 0.5 * (x + 1);
            weight[size_t(i)] = 1 / ((1 - x * x) * slope * slope);
        }
    }
};

} // namespace

double fresnelInside(double cosine, double index) {
    const double sine2 = index * index * (1 - cosine * cosine);
    if (!(sine2 < 1)) return 1;
    const double outside = std::sqrt(1 - sine2);
    const double s = (index * cosine - outside) / (index * cosine + outside);
    const double p = (cosine - index * outside) / (cosine + index * outside);
    return 0.5 * (s * s + p * p);
}

AlbedoInversion::AlbedoInversion(double index) : index_(index) {
    const Gauss g;
    // Integrates both sides of the critical angle separately; above it, substitutes a square for the root in the reflectance.
    const double critical = index > 1 ? std::sqrt(1 - 1 / (index * index)) : 0;
    for (int i = 0; i < Gauss::kCount; ++i) {
        if (critical > 0) nodes_.push_back({critical * g.at[size_t(i)], critical * g.weight[size_t(i)], 1, 0});
        const double x = g.at[size_t(i)], c = critical + (1 - critical) * x * x;
        nodes_.push_back({c, (1 - critical) * 2 * x * g.weight[size_t(i)], fresnelInside(c, index), 0});
    }
    double flux = 0;
    for (Node& n : nodes_) {
        n.entering = 1 - n.inside;
        flux += 2 * kPiD * n.weight * n.entering * n.cosine;
        first_ += 2 * n.weight * n.inside * n.cosine;
        second_ += 3 * n.weight * n.inside * n.cosine * n.cosine;
    }
    for (Node& n : nodes_) n.entering /= flux;
    for (int i = 0; i <= kSteps; ++i) {
        const double root = double(i) / kSteps;
        table_.push_back(i == 0 ? 1 : solve(1 - root * root));
    }
}

double AlbedoInversion::solve(double albedo) const {
    const size_t n = nodes_.size();
    std::vector<double> h(n, 1), up(n, 0), down(n), next(n);
    const double root = std::sqrt(std::max(0.0, 1 - albedo));
    for (int round = 0; round < 500; ++round) { // 1 / H(m) = sqrt(1 - albedo) + albedo / 2 int m' H(m') / (m + m') dm'
        double change = 0;
        for (size_t i = 0; i < n; ++i) {
            double sum = root;
            for (size_t k = 0; k < n; ++k)
                sum += 0.5 * albedo * nodes_[k].weight * nodes_[k].cosine * h[k] / (nodes_[i].cosine + nodes_[k].cosine);
            next[i] = 1 / sum;
            change = std::max(change, std::fabs(next[i] - h[i]));
        }
        for (size_t i = 0; i < n; ++i) h[i] = 0.5 * (h[i] + next[i]); // plain iteration oscillates around the solution
        if (change < 1e-12) break;
    }
    for (int round = 0; round < 2000; ++round) { // up(m) = albedo / 2 H(m) int H(m') m' / (m + m') down(m') dm'
        double change = 0;
        for (size_t i = 0; i < n; ++i) down[i] = nodes_[i].entering + nodes_[i].inside * up[i];
        for (size_t i = 0; i < n; ++i) {
            double sum = 0;
            for (size_t k = 0; k < n; ++k)
                sum += nodes_[k].weight * h[k] * nodes_[k].cosine / (nodes_[i].cosine + nodes_[k].cosine) * down[k];
            next[i] = 0.5 * albedo * h[i] * sum;
            change = std::max(change, std::fabs(next[i] - up[i]));
        }
        up = next;
        if (change < 1e-9) break;
    }
    double out = 0;
    for (size_t i = 0; i < n; ++i) out += 2 * kPiD * nodes_[i].weight * nodes_[i].cosine * (1 - nodes_[i].inside) * up[i];
    return out;
}

double AlbedoInversion::reflectance(double albedo) const {
    const double at = std::sqrt(std::clamp(1 - albedo, 0.0, 1.0)) * kSteps;
    const int i = std::min(int(at), kSteps - 1);
    return table_[size_t(i)] + (at - i) * (table_[size_t(i) + 1] - table_[size_t(i)]);
}

double AlbedoInversion::albedo(double reflectance) const {
    if (!(reflectance > 0)) return 0;
    const auto below = std::partition_point(table_.begin(), table_.end(), [&](double r) { return r > reflectance; });
    if (below == table_.begin()) return 1;
    const size_t i = size_t(below - table_.begin()) - 1;
    const double a = table_[i], b = i + 1 < table_.size() ? table_[i + 1] : 0;
    const double root = (double(i) + (a > b ? (a - reflectance) / (a - b) : 0)) / kSteps;
    return std::max(0.0, 1 - root * root);
}

} // namespace alpenglow::bsdf
