#include "world/skytable.h"
#include "base/exact.h"
#include "world/emitterfootprint.h"
#include "world/mutableworld.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::world {

namespace {
constexpr texture::LatLong kCells; // z is the pole

/// The interval of a cumulative row that contains u, and the position of u in it, 0 to 1.
size_t interval(const float* first, size_t count, float u, float& within) {
    const float* behind = std::upper_bound(first + 1, first + count, u); // the last interval takes the rest
    size_t i = size_t(behind - first) - 1;
    while (i > 0 && !(first[i + 1] > first[i])) --i; // rounding led to an empty one
    const float width = first[i + 1] - first[i];
    within = width > 0 ? std::clamp((u - first[i]) / width, 0.f, 0x1.fffffep-1f) : .5f;
    return i;
}

/// Normalised cumulative sums of n weights, in count + 1 numbers from 0 to 1; returns the total.
template <class Weight> double accumulate(size_t n, Weight&& weight, float* out) {
    double all = 0, sum = 0;
    for (size_t i = 0; i < n; ++i) all += weight(i);
    for (size_t i = 0; i < n; ++i) {
        out[i] = all > 0 ? float(sum / all) : float(double(i) / double(n));
        sum += weight(i);
    }
    out[n] = 1;
    return all;
}
} // namespace

SkyTable::SkyTable(int width, int height, std::vector<float> weights)
    : width_(width), height_(height), density_(std::move(weights)) {
    const size_t w = size_t(width), h = size_t(height);
    for (float& v : density_)
        if (!(v > 0) || !std::isfinite(v)) v = 0;
    cosines_.resize(h + 1);
    for (size_t r = 0; r <= h; ++r) cosines_[r] = r == 0 ? 1 : r == h ? -1 : exact::cos(kPi * double(r) / double(h));
    columns_.resize(h * (w + 1));
    rows_.resize(h + 1);
    std::vector<double> ofRow(h);
    double square = 0;
    for (size_t r = 0; r < h; ++r) {
        const double cell = 2 * kPi / double(w) * (cosines_[r] - cosines_[r + 1]);
        const float* v = &density_[r * w];
        ofRow[r] = cell * accumulate(w, [&](size_t c) { return double(v[c]); }, &columns_[r * (w + 1)]);
        for (size_t c = 0; c < w; ++c) square += cell * double(v[c]) * v[c];
    }
    integral_ = accumulate(h, [&](size_t r) { return ofRow[r]; }, rows_.data());
    if (!(integral_ > 0)) return;
    concentration_ = square * 4 * kPi / (integral_ * integral_);
    // The density of the rounded sums, which sampling uses, rather than of the weights.
    for (size_t r = 0; r < h; ++r) {
        const double cell = 2 * kPi / double(w) * (cosines_[r] - cosines_[r + 1]), row = double(rows_[r + 1]) - rows_[r];
        for (size_t c = 0; c < w; ++c) {
            const float* sums = &columns_[r * (w + 1) + c];
            density_[r * w + c] = float(row * (double(sums[1]) - sums[0]) / cell);
        }
    }
}

Vec3 SkyTable::direction(int column, int row, int width, int height, float s, float t) {
    const double top = row == 0 ? 1 : exact::cos(kPi * row / height);
    const double end = row + 1 == height ? -1 : exact::cos(kPi * (row + 1) / height);
    const double z = top + (end - top) * double(t), away = std::sqrt(std::max(0.0, 1 - z * z));
    const exact::SinCos round = exact::sinCos(2 * kPi * (column + double(s)) / width);
    return Vec3(float(away * round.cos), float(away * round.sin), float(z));
}

size_t SkyTable::rowOf(double cosine) const {
    const auto below = std::upper_bound(cosines_.begin() + 1, cosines_.end() - 1, cosine, std::greater<>());
    return size_t(below - cosines_.begin()) - 1;
}

bool SkyTable::sample(Vec2 u, Vec3& w, float& density) const {
    if (!(integral_ > 0)) return false;
    float s, t;
    const size_t row = interval(rows_.data(), size_t(height_), u.y, t);
    const size_t column = interval(&columns_[row * size_t(width_ + 1)], size_t(width_), u.x, s);
    w = direction(int(column), int(row), width_, height_, s, t);
    density = pdf(w); // rounding may have crossed the edge of the cell
    return density > 0;
}

float SkyTable::pdf(const Vec3& w) const {
    if (!(integral_ > 0)) return 0;
    float s, t;
    kCells.project(w, s, t);
    const int column = std::clamp(int(s * float(width_)), 0, width_ - 1);
    return density_[rowOf(double(w.z)) * size_t(width_) + size_t(column)];
}

namespace {

/// Cells of tables, and points per cell side. Maps with detail finer than the points are sampled less efficiently, still without
/// bias.
constexpr int kColumns = 512, kRows = 256, kMostColumns = 1024, kPointsOfCell = 2, kCoarse = 32;
/// A sky is sampled as a light if lobe sampling alone would be inefficient. Lobes find the light of half a clear sky, or of one
/// that darkens toward the horizon, with fewer rays.
constexpr double kConcentrated = 4;

/// Mean luminance of a sky over `points` per side of each cell. Empty: some value is not finite.
std::vector<float> luminanceOf(const BoundLight& light, int width, int height, int points, Evaluator& evaluator) {
    std::vector<float> cells(size_t(width) * size_t(height), 0);
    const size_t perCell = size_t(points) * size_t(points);
    std::vector<ShadePoint> q;
    std::vector<LightValue> v;
    for (int row = 0; row < height; ++row) {
        q.assign(size_t(width) * perCell, {});
        for (size_t i = 0; i < q.size(); ++i) {
            const int column = int(i / perCell), k = int(i % perCell);
            const Vec3 w = SkyTable::direction(column, row, width, height, (float(k % points) + .5f) / float(points),
                                               (float(k / points) + .5f) / float(points));
            q[i].P = w;
            q[i].N = -w;
        }
        v.assign(q.size(), {});
        evaluator.light(light, q, v);
        for (size_t i = 0; i < q.size(); ++i) {
            const float l = v[i].lit ? luminance(v[i].Cl) : 0;
            if (std::isfinite(l)) cells[size_t(row) * size_t(width) + i / perCell] += std::max(l, 0.f) / float(perCell);
        }
    }
    return cells;
}

/// Width of the widest map with a constant name that a kernel reads.
int widestMap(const BoundKernel& k, const WorldImpl& world) {
    int widest = 0;
    for (const SiteInfo& s : k.sites) {
        if (!s.map || s.map->computed) continue;
        const texture::Handle map = s.map->map(world, [&]() -> SourcePlace {
            const auto& files = k.kernel->files();
            const auto& at = s.site->place;
            return {at.file >= 0 && size_t(at.file) < files.size() ? files[size_t(at.file)] : "", at.line, at.column};
        });
        if (!map) continue;
        widest = std::max(widest, map->width());
        for (const auto& [face, tile] : map->tiles) widest = std::max(widest, 4 * tile->width());
    }
    return widest;
}

} // namespace

void MutableWorld::tabulateSkies(Evaluator& evaluator) {
    for (const int i : skies_) {
        BoundLight& l = lights_[size_t(i)];
        if (l.kind != LightKind::Environment || !l.importance || l.asksSurface || l.sentCl >= 0) continue;
        if (l.kernel.kernel->facts().suspends) continue;
        const bool sampled = settings_.direct && settings_.indirect && !settings_.bsdfOnly && !settings_.lightOnly;
        l.guidable = sampled && !l.channels && !usesFootprint(l);
        const int widest = widestMap(l.kernel, *this);
        if (widest == 0) { // arithmetic only: most such skies are uniform
            const std::vector<float> few = luminanceOf(l, 2 * kCoarse, kCoarse, 1, evaluator);
            if (std::all_of(few.begin(), few.end(), [&](float v) { return v == few[0]; })) continue;
        }
        const int columns = std::clamp(widest / kPointsOfCell, kColumns, kMostColumns), rows = columns * kRows / kColumns;
        auto table = std::make_shared<SkyTable>(columns, rows, luminanceOf(l, columns, rows, kPointsOfCell, evaluator));
        if (!(table->concentration() > kConcentrated)) continue;
        l.power = float(table->integral() / (2 * kPi)); // between the effect of a uniform sky and of a small sun overhead
        l.sky = std::move(table);
        l.guidable = false;
    }
}

} // namespace alpenglow::world
