#include "render/filtersampler.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::render {
namespace {

constexpr int kPieces = 1024; // straight pieces per axis: the error of the density is below 2e-6 of its peak
constexpr int kCells = 256;   // cells per axis of a filter that is no product

// Four-point Gauss-Legendre on [0, 1].
constexpr double kGaussX[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
constexpr double kGaussW[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};

// Position in [0,1] of mass fraction u under the straight density from a to b; stable for a == b.
double invertLinear(double a, double b, double u) {
    double s = a + b;
    if (!(s > 0))
        return u;
    a /= s, b /= s; // now the mass is 1/2
    return std::clamp(u / (a + std::sqrt(std::max(0.0, a * a + (b * b - a * a) * u))), 0.0, 1.0);
}

int find(const std::vector<double>& cdf, size_t first, size_t count, double u) {
    auto b = cdf.begin() + first;
    auto i = std::upper_bound(b, b + count, u) - b;
    return int(std::clamp<long>(long(i) - 1, 0, long(count) - 2));
}

} // namespace

void FilterSampler::Axis::build(const PixelFilter& f, double w) {
    double half = w / 2;
    node.push_back(-half);
    for (int i = 0; i < kPieces; ++i) {
        double a = -half + w * i / kPieces, b = i + 1 == kPieces ? half : -half + w * (i + 1) / kPieces;
        double fa = f.axis(a, w), fb = f.axis(b, w);
        if (fa * fb < 0) {
            double lo = a, hi = b;
            for (int k = 0; k < 60; ++k) {
                double m = (lo + hi) / 2;
                (f.axis(m, w) * fa > 0 ? lo : hi) = m;
            }
            if (lo > a && hi < b)
                node.push_back((lo + hi) / 2);
        }
        node.push_back(b);
    }
    value.resize(node.size());
    cdf.assign(node.size(), 0);
    sign.assign(node.size(), 1);
    for (size_t i = 0; i < node.size(); ++i)
        value[i] = std::fabs(f.axis(std::clamp(node[i], -half, half), w));
    for (size_t i = 0; i + 1 < node.size(); ++i) {
        double len = node[i + 1] - node[i], sum = 0;
        for (int k = 0; k < 4; ++k)
            sum += kGaussW[k] * f.axis(node[i] + len * kGaussX[k], w);
        sum *= len;
        total += sum;
        absolute += std::fabs(sum);
        sign[i] = sum < 0 ? -1 : 1;
        cdf[i + 1] = absolute;
    }
    for (double& c : cdf)
        c /= absolute;
    cdf.back() = 1;
}

double FilterSampler::Axis::invert(double u, int* s) const {
    int i = find(cdf, 0, cdf.size(), u);
    double m = cdf[i + 1] - cdf[i];
    *s = sign[i];
    return node[i] + (node[i + 1] - node[i]) * invertLinear(value[i], value[i + 1], m > 0 ? (u - cdf[i]) / m : 0);
}

double FilterSampler::Axis::density(double t) const {
    if (!(t >= node.front() && t <= node.back()))
        return 0;
    int i = find(node, 0, node.size(), t);
    double len = node[i + 1] - node[i], k = (t - node[i]) / len, s = value[i] + value[i + 1];
    double shape = s > 0 ? 2 * (value[i] + (value[i + 1] - value[i]) * k) / s : 1;
    return (cdf[i + 1] - cdf[i]) / len * shape;
}

void FilterSampler::buildGrid() {
    grid_.n = kCells;
    grid_.mass.assign(size_t(kCells) * kCells, 0);
    grid_.rowCdf.assign(kCells + 1, 0);
    grid_.cellCdf.assign(size_t(kCells) * (kCells + 1), 0);
    double cw = filter_.xw / kCells, ch = filter_.yw / kCells;
    for (int r = 0; r < kCells; ++r) {
        double* cdf = &grid_.cellCdf[size_t(r) * (kCells + 1)];
        for (int c = 0; c < kCells; ++c) {
            double sum = 0, abs = 0;
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i) {
                    double v = filter_(-filter_.xw / 2 + cw * (c + kGaussX[i]), -filter_.yw / 2 + ch * (r + kGaussX[j]));
                    sum += kGaussW[i] * kGaussW[j] * v;
                    abs += kGaussW[i] * kGaussW[j] * std::fabs(v);
                }
            total_ += sum * cw * ch;
            grid_.mass[size_t(r) * kCells + c] = abs * cw * ch;
            cdf[c + 1] = cdf[c] + abs * cw * ch;
        }
        grid_.rowCdf[r + 1] = grid_.rowCdf[r] + cdf[kCells];
        for (int c = 0; c <= kCells; ++c)
            cdf[c] = cdf[kCells] > 0 ? cdf[c] / cdf[kCells] : double(c) / kCells;
    }
    absolute_ = grid_.rowCdf.back();
    for (double& m : grid_.mass)
        m /= absolute_;
    for (double& c : grid_.rowCdf)
        c /= absolute_;
}

FilterSampler::FilterSampler(const PixelFilter& f) : filter_(f) {
    if (f.kind == FilterKind::Box || f.kind == FilterKind::Disk) {
        total_ = absolute_ = f.xw * f.yw * (f.kind == FilterKind::Disk ? kPi / 4 : 1);
    } else if (f.separable()) {
        x_.build(f, f.xw);
        y_.build(f, f.yw);
        total_ = x_.total * y_.total;
        absolute_ = x_.absolute * y_.absolute;
    } else {
        buildGrid();
    }
    if (!(total_ > 1e-6 * absolute_)) {
        degenerate_ = true;
        filter_.kind = FilterKind::Box;
        total_ = absolute_ = f.xw * f.yw;
    }
}

FilterSample FilterSampler::sample(Vec2 u) const {
    double x, y, weight = 1;
    if (filter_.kind == FilterKind::Box) {
        x = (u.x - 0.5) * filter_.xw;
        y = (u.y - 0.5) * filter_.yw;
    } else if (filter_.kind == FilterKind::Disk) {
        double r = 0.5 * std::sqrt(double(u.x)), a = 2 * kPi * u.y;
        x = filter_.xw * r * std::cos(a);
        y = filter_.yw * r * std::sin(a);
    } else if (filter_.separable()) {
        int sx, sy;
        x = x_.invert(u.x, &sx);
        y = y_.invert(u.y, &sy);
        weight = sx * sy * (absolute_ / total_);
        if (std::fabs(std::fabs(weight) - 1) < 1e-12)
            weight = 1; // rounding of the two sums; a filter without negative parts has weight 1 exactly
    } else {
        int r = find(grid_.rowCdf, 0, grid_.rowCdf.size(), u.y);
        double rm = grid_.rowCdf[r + 1] - grid_.rowCdf[r], v = rm > 0 ? (u.y - grid_.rowCdf[r]) / rm : 0.5;
        size_t at = size_t(r) * (grid_.n + 1);
        int c = find(grid_.cellCdf, at, grid_.n + 1, u.x);
        double cm = grid_.cellCdf[at + c + 1] - grid_.cellCdf[at + c], h = cm > 0 ? (u.x - grid_.cellCdf[at + c]) / cm : 0.5;
        x = filter_.xw * ((c + h) / grid_.n - 0.5);
        y = filter_.yw * ((r + v) / grid_.n - 0.5);
        // The density is constant on a cell and the filter is not: the quotient makes the estimate exact all the same.
        double d = grid_.mass[size_t(r) * grid_.n + c] * grid_.n * grid_.n / (filter_.xw * filter_.yw);
        weight = d > 0 ? filter_(x, y) / (d * total_) : 0;
    }
    return {float(x), float(y), float(weight)};
}

double FilterSampler::density(double x, double y) const {
    if (!(std::fabs(x) <= filter_.xw / 2 && std::fabs(y) <= filter_.yw / 2))
        return 0;
    if (filter_.kind == FilterKind::Box || filter_.kind == FilterKind::Disk)
        return filter_(x, y) / total_;
    if (filter_.separable())
        return x_.density(x) * y_.density(y);
    int n = grid_.n, c = std::clamp(int((x / filter_.xw + 0.5) * n), 0, n - 1), r = std::clamp(int((y / filter_.yw + 0.5) * n), 0, n - 1);
    return grid_.mass[size_t(r) * n + c] * n * n / (filter_.xw * filter_.yw);
}

} // namespace alpenglow::render
