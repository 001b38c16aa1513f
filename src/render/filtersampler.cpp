#include "render/filtersampler.h"
#include "base/exact.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::render {
namespace {

constexpr int kPieces = 1024; // linear pieces per axis, a power of two: the error of the density is below 2e-6 of its peak
constexpr int kCells = 256;   // cells per axis of a filter that is not separable
constexpr double kBelowOne = 1 - 0x1p-53;

// Four-point Gauss-Legendre on [0, 1].
constexpr double kGaussX[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
constexpr double kGaussW[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};

// Position in [0, 1] with fraction u of the mass below it, for a linear density from a to b; stable for a == b.
double invertLinear(double a, double b, double u) {
    double s = a + b;
    if (!(s > 0)) return u;
    a /= s, b /= s; // then the mass is 1/2
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
            if (lo > a && hi < b) node.push_back((lo + hi) / 2);
        }
        node.push_back(b);
    }
    value.resize(node.size());
    mass.assign(node.size(), 0);
    for (size_t i = 0; i < node.size(); ++i) value[i] = std::fabs(f.axis(std::clamp(node[i], -half, half), w));
    for (size_t i = 0; i + 1 < node.size(); ++i) {
        double len = node[i + 1] - node[i], sum = 0;
        for (int k = 0; k < 4; ++k) sum += kGaussW[k] * f.axis(node[i] + len * kGaussX[k], w);
        sum *= len;
        total += sum;
        absolute += mass[i] = std::fabs(sum);
        Part& p = part[sum < 0];
        p.mass += mass[i];
        p.piece.push_back(int(i));
        p.cdf.push_back(p.mass);
    }
    for (double& m : mass) m /= absolute;
    for (Part& p : part) {
        for (double& c : p.cdf) c /= p.mass > 0 ? p.mass : 1;
        p.mass /= absolute;
        for (int k = 0; k < kPieces && !p.piece.empty(); ++k)
            p.guide.push_back(find(p.cdf, 0, p.cdf.size(), double(k) / kPieces));
    }
    if (part[1].piece.empty()) part[0].mass = 1; // exactly
}

double FilterSampler::Axis::invert(double u, const Part& p) const {
    int k = p.guide[size_t(u * kPieces)]; // find(), with one step on average
    while (k + 2 < int(p.cdf.size()) && p.cdf[size_t(k) + 1] <= u) ++k;
    int i = p.piece[size_t(k)];
    double m = p.cdf[k + 1] - p.cdf[k];
    return node[i] + (node[i + 1] - node[i]) * invertLinear(value[i], value[i + 1], m > 0 ? (u - p.cdf[k]) / m : 0);
}

double FilterSampler::Axis::density(double t) const {
    if (!(t >= node.front() && t <= node.back())) return 0;
    int i = find(node, 0, node.size(), t);
    double len = node[i + 1] - node[i], k = (t - node[i]) / len, s = value[i] + value[i + 1];
    double shape = s > 0 ? 2 * (value[i] + (value[i + 1] - value[i]) * k) / s : 1;
    return mass[i] / len * shape;
}

void FilterSampler::buildGrids() {
    double cw = filter_.xw / kCells, ch = filter_.yw / kCells;
    for (int g = 0; g < 2; ++g) {
        Grid& grid = grid_[g];
        grid.mass.assign(size_t(kCells) * kCells, 0);
        grid.rowCdf.assign(kCells + 1, 0);
        grid.cellCdf.assign(size_t(kCells) * (kCells + 1), 0);
    }
    for (int r = 0; r < kCells; ++r)
        for (int c = 0; c < kCells; ++c)
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i) {
                    double v = filter_(-filter_.xw / 2 + cw * (c + kGaussX[i]), -filter_.yw / 2 + ch * (r + kGaussX[j]));
                    v *= kGaussW[i] * kGaussW[j] * cw * ch;
                    total_ += v;
                    absolute_ += std::fabs(v);
                    grid_[v < 0].mass[size_t(r) * kCells + c] += std::fabs(v);
                }
    for (Grid& grid : grid_) {
        for (int r = 0; r < kCells; ++r) {
            double* cdf = &grid.cellCdf[size_t(r) * (kCells + 1)];
            for (int c = 0; c < kCells; ++c) {
                double& m = grid.mass[size_t(r) * kCells + c];
                m /= absolute_;
                cdf[c + 1] = cdf[c] + m;
            }
            grid.rowCdf[r + 1] = grid.rowCdf[r] + cdf[kCells];
            double row = grid.rowCdf[r + 1] - grid.rowCdf[r];
            for (int c = 0; c <= kCells; ++c) cdf[c] = row > 0 ? cdf[c] / row : double(c) / kCells;
        }
        grid.share = grid.rowCdf.back();
        for (double& c : grid.rowCdf) c /= grid.share > 0 ? grid.share : 1;
    }
    if (grid_[1].share == 0) grid_[0].share = 1; // exactly
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
        buildGrids();
    }
    if (!(total_ > 1e-6 * absolute_)) {
        degenerate_ = true;
        filter_.kind = FilterKind::Box;
        total_ = absolute_ = f.xw * f.yw;
    }
}

std::optional<double> FilterSampler::negativePart() const {
    const bool even = filter_.separable() || filter_.kind == FilterKind::Disk;
    if (even && std::fabs(absolute_ / total_ - 1) < 1e-12) return {};
    return std::max(0.0, (absolute_ / total_ - 1) / 2);
}

FilterSample FilterSampler::sample(Vec2 u) const {
    double x, y, weight = 1;
    if (filter_.kind == FilterKind::Box) {
        x = (u.x - 0.5) * filter_.xw;
        y = (u.y - 0.5) * filter_.yw;
    } else if (filter_.kind == FilterKind::Disk) {
        double r = 0.5 * std::sqrt(double(u.x)), a = 2 * kPi * u.y;
        const auto [sine, cosine] = exact::sinCos(a);
        x = filter_.xw * r * cosine;
        y = filter_.yw * r * sine;
    } else if (filter_.separable()) {
        // The four products of signed parts, positive products first.
        static constexpr int order[4][2] = {{0, 0}, {1, 1}, {0, 1}, {1, 0}};
        double ux = u.x;
        int k = 0;
        for (; k < 3; ++k) {
            double share = x_.part[order[k][0]].mass * y_.part[order[k][1]].mass;
            if (ux < share) break;
            ux -= share;
        }
        // Rounding may put the first number beyond the last stratum with any mass: use the end of that stratum.
        while (k > 0 && x_.part[order[k][0]].mass * y_.part[order[k][1]].mass == 0) --k;
        const Part &px = x_.part[order[k][0]], &py = y_.part[order[k][1]];
        x = x_.invert(std::clamp(ux / (px.mass * py.mass), 0.0, kBelowOne), px);
        y = y_.invert(u.y, py);
        weight = (k < 2 ? 1 : -1) * (absolute_ / total_);
        if (std::fabs(std::fabs(weight) - 1) < 1e-12)
            weight = 1; // rounding of the two sums: without negative parts the weight is exactly 1
    } else {
        int g = u.x < grid_[0].share || grid_[1].share == 0 ? 0 : 1;
        const Grid& grid = grid_[g];
        double ux = std::clamp((u.x - (g ? grid_[0].share : 0)) / grid.share, 0.0, kBelowOne);
        int r = find(grid.rowCdf, 0, grid.rowCdf.size(), u.y);
        double rm = grid.rowCdf[r + 1] - grid.rowCdf[r], v = rm > 0 ? (u.y - grid.rowCdf[r]) / rm : 0.5;
        size_t at = size_t(r) * (kCells + 1);
        int c = find(grid.cellCdf, at, kCells + 1, ux);
        double cm = grid.cellCdf[at + c + 1] - grid.cellCdf[at + c], h = cm > 0 ? (ux - grid.cellCdf[at + c]) / cm : 0.5;
        x = filter_.xw * ((c + h) / kCells - 0.5);
        y = filter_.yw * ((r + v) / kCells - 0.5);
        // The density is constant on a cell and the filter is not: the quotient keeps the estimate exact. In a cell that a zero
        // of f crosses, the part of the other sign has weight 0 here and is sampled by the other grid.
        double d = grid.mass[size_t(r) * kCells + c] * kCells * kCells / (filter_.xw * filter_.yw), f = filter_(x, y);
        weight = d > 0 && (f < 0) == (g == 1) ? f / (d * total_) : 0;
    }
    return {float(x), float(y), float(weight)};
}

double FilterSampler::density(double x, double y) const {
    if (!(std::fabs(x) <= filter_.xw / 2 && std::fabs(y) <= filter_.yw / 2)) return 0;
    if (filter_.kind == FilterKind::Box || filter_.kind == FilterKind::Disk) return filter_(x, y) / total_;
    if (filter_.separable()) return x_.density(x) * y_.density(y);
    int c = std::clamp(int((x / filter_.xw + 0.5) * kCells), 0, kCells - 1);
    int r = std::clamp(int((y / filter_.yw + 0.5) * kCells), 0, kCells - 1);
    size_t i = size_t(r) * kCells + size_t(c);
    return (grid_[0].mass[i] + grid_[1].mass[i]) * kCells * kCells / (filter_.xw * filter_.yw);
}

} // namespace alpenglow::render
