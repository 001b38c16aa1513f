#include "world/skytable.h"
#include "base/exact.h"
#include "scene/filterlink.h"
#include "world/emitterfootprint.h"
#include "world/mutableworld.h"
#include "world/skysampler.h"
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

static float usable(float weight) { return weight > 0 && std::isfinite(weight) ? weight : 0; }

SkyTable::SkyTable(int width, int height, std::vector<float> weights, std::vector<Refined> refined)
    : width_(width), height_(height), density_(std::move(weights)) {
    const size_t w = size_t(width), h = size_t(height);
    for (float& v : density_) v = usable(v);
    for (Refined& r : refined) {
        double sum = 0;
        for (float& v : r.weights) sum += v = usable(v);
        density_[size_t(r.row) * w + size_t(r.column)] = float(sum / double(r.weights.size()));
    }
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
    for (Refined& r : refined) divide(size_t(r.row) * w + size_t(r.column), r);
}

/// Gives a cell of known density the parts of `r`.
void SkyTable::divide(size_t cell, Refined& r) {
    const float density = density_[cell];
    if (!(density > 0)) return;
    const size_t side = size_t(r.side);
    double mean = 0;
    for (const float v : r.weights) mean += double(v) / double(r.weights.size());
    for (float& v : r.weights) v = std::max(v, float(kLeastPart * mean));
    Parts p{r.side, std::vector<float>(side + 1), std::vector<float>(side * (side + 1)), std::vector<float>(side * side)};
    std::vector<double> ofRow(side);
    for (size_t y = 0; y < side; ++y)
        ofRow[y] = accumulate(side, [&](size_t x) { return double(r.weights[y * side + x]); }, &p.columns[y * (side + 1)]);
    accumulate(side, [&](size_t y) { return ofRow[y]; }, p.rows.data());
    for (size_t y = 0; y < side; ++y)
        for (size_t x = 0; x < side; ++x) {
            const float* sums = &p.columns[y * (side + 1) + x];
            const double share = (double(p.rows[y + 1]) - p.rows[y]) * (double(sums[1]) - sums[0]);
            p.density[y * side + x] = float(share * double(side * side) * density);
        }
    parts_.push_back(std::move(p));
    density_[cell] = -float(parts_.size());
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
    if (const float cell = density_[row * size_t(width_) + column]; cell < 0) {
        const Parts& p = parts_[size_t(-1 - cell)];
        float inX, inY;
        const size_t y = interval(p.rows.data(), size_t(p.side), t, inY);
        const size_t x = interval(&p.columns[y * size_t(p.side + 1)], size_t(p.side), s, inX);
        s = (float(x) + inX) / float(p.side);
        t = (float(y) + inY) / float(p.side);
    }
    w = direction(int(column), int(row), width_, height_, s, t);
    density = pdf(w); // rounding may have crossed the edge of the cell
    return density > 0;
}

float SkyTable::pdf(const Vec3& w) const {
    if (!(integral_ > 0)) return 0;
    float s, t;
    kCells.project(w, s, t);
    const int column = std::clamp(int(s * float(width_)), 0, width_ - 1);
    const size_t row = rowOf(double(w.z));
    const float density = density_[row * size_t(width_) + size_t(column)];
    if (density >= 0) return density;
    const Parts& p = parts_[size_t(-1 - density)];
    const double down = (double(w.z) - cosines_[row]) / (cosines_[row + 1] - cosines_[row]);
    const int x = std::clamp(int((s * float(width_) - float(column)) * float(p.side)), 0, p.side - 1);
    const int y = std::clamp(int(down * p.side), 0, p.side - 1);
    return p.density[size_t(y) * size_t(p.side) + size_t(x)];
}

namespace {

/// Cells of tables, and points per cell side. Maps with detail finer than the points are sampled less efficiently, still without
/// bias.
constexpr int kColumns = 512, kRows = 256, kMostColumns = 1024, kPointsOfCell = 2;
/// A sky is sampled as a light if lobe sampling alone would be inefficient. Lobes find the light of half a clear sky, or of one
/// that darkens toward the horizon, with fewer rays.
constexpr double kConcentrated = 4;

/// Which cells have finer ones: at edges of what is bright, such as a sun, whose light would otherwise be sampled as if it filled
/// whole cells. The cell or one next to it has at least kLeastShare of all light, and is kContrast times as bright as another one
/// next to it. At most kMostRefined cells, those with the brightest neighbours; kMostParts parts in all.
constexpr double kLeastShare = 1. / 4096;
constexpr float kContrast = 1.5f;
constexpr size_t kMostRefined = 1024, kMostParts = 65536;
constexpr int kMostSide = 64, kLeastSide = 4;

std::vector<SkyTable::Refined> cellsToRefine(const std::vector<float>& cells, int width, int height) {
    std::vector<double> area; // of a cell, by row
    for (int row = 0; row < height; ++row)
        area.push_back(2 * kPi / width * (exact::cos(kPi * row / height) - exact::cos(kPi * (row + 1) / height)));
    double all = 0;
    for (size_t i = 0; i < cells.size(); ++i) all += double(cells[i]) * area[i / size_t(width)];
    std::vector<std::pair<float, int>> found; // largest share of a neighbour; cell
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            float least = INFINITY, most = 0, share = 0;
            for (int y = std::max(row - 1, 0); y <= std::min(row + 1, height - 1); ++y)
                for (int dx = -1; dx <= 1; ++dx) {
                    const float c = cells[size_t(y * width + (column + dx + width) % width)];
                    least = std::min(least, c);
                    most = std::max(most, c);
                    share = std::max(share, float(double(c) * area[size_t(y)] / all));
                }
            if (share >= kLeastShare && most > kContrast * least) found.push_back({-share, row * width + column});
        }
    std::sort(found.begin(), found.end());
    found.resize(std::min(found.size(), kMostRefined));
    int side = kMostSide;
    while (side > kLeastSide && found.size() * size_t(side * side) > kMostParts) side /= 2;
    std::vector<SkyTable::Refined> refined;
    for (const auto& [share, cell] : found) refined.push_back({cell % width, cell / width, side, {}});
    return refined;
}

/// SkyTable::direction() at points x points places in each of `columns` x `rows` cells from (column, row) on.
class Directions {
public:
    Directions(int width, int height, int column, int row, int columns, int rows, int points) {
        for (int x = 0; x < columns * points; ++x)
            turns_.push_back(
                exact::sinCos(2 * kPi * (column + x / points + double((float(x % points) + .5f) / float(points))) / width));
        for (int y = 0; y < rows * points; ++y) {
            const Vec3 w = SkyTable::direction(0, row + y / points, width, height, 0, (float(y % points) + .5f) / float(points));
            heights_.push_back({double(w.z), std::sqrt(std::max(0.0, 1 - double(w.z) * w.z))});
        }
    }
    Vec3 at(int x, int y) const {
        const auto& [z, away] = heights_[size_t(y)];
        return Vec3(float(away * turns_[size_t(x)].cos), float(away * turns_[size_t(x)].sin), float(z));
    }

private:
    std::vector<exact::SinCos> turns_;
    std::vector<std::pair<double, double>> heights_; ///< z, distance from the axis
};

/// Mean luminance of a sky over `points` per side of each cell.
std::vector<float> luminanceOf(const BoundLight& light, int width, int height, int points, Evaluator& evaluator) {
    std::vector<float> cells(size_t(width) * size_t(height), 0);
    const size_t perCell = size_t(points) * size_t(points);
    const Directions directions(width, height, 0, 0, width, height, points);
    std::vector<ShadePoint> q;
    std::vector<LightValue> v;
    for (int row = 0; row < height; ++row) {
        q.assign(size_t(width) * perCell, {});
        for (size_t i = 0; i < q.size(); ++i) {
            const int column = int(i / perCell), k = int(i % perCell);
            const Vec3 w = directions.at(column * points + k % points, row * points + k / points);
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

/// Sets the weights of a cell: the mean luminance of kPoints x kPoints points of each part.
void measureParts(SkyTable::Refined& r, const BoundLight& light, int width, int height, Evaluator& evaluator) {
    constexpr int kPoints = 2; // per side of a part
    const int each = r.side * kPoints;
    const Directions directions(width, height, r.column, r.row, 1, 1, each);
    std::vector<ShadePoint> q(size_t(each) * size_t(each));
    std::vector<LightValue> v(q.size());
    for (size_t i = 0; i < q.size(); ++i) {
        const Vec3 w = directions.at(int(i) % each, int(i) / each);
        q[i].P = w;
        q[i].N = -w;
    }
    evaluator.light(light, q, v);
    r.weights.assign(size_t(r.side) * size_t(r.side), 0);
    for (size_t i = 0; i < q.size(); ++i) {
        const int x = int(i) % each / kPoints, y = int(i) / each / kPoints;
        const float l = v[i].lit ? luminance(v[i].Cl) : 0;
        if (std::isfinite(l)) r.weights[size_t(y * r.side + x)] += std::max(l, 0.f) / float(kPoints * kPoints);
    }
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

/// Whether a light that asks the surface which it lights only asks which light filters act: they scale light that is known
/// without it. In a table filters with groups act on nothing, so that it has all the light.
bool asksFiltersOnly(const BoundLight& l) {
    const auto isLink = [](const std::string& text) { return scene::FilterLink::of(text).has_value(); };
    const auto& texts = l.instance->parameters.strings;
    const bool linked = std::any_of(texts.begin(), texts.end(), [&](const auto& t) { return isLink(t.second); });
    return std::all_of(l.kernel.sites.begin(), l.kernel.sites.end(), [&](const SiteInfo& s) {
        if (s.kind == SiteKind::LightHandles || (s.photons && s.photons->caustic)) return false;
        if (s.kind != SiteKind::Message) return true;
        const std::string name = s.site->strings.empty() ? "" : s.site->strings[0]; // "": known when the shader runs
        return name.empty() ? linked : isLink(name);
    });
}

} // namespace

void MutableWorld::tabulateSkies(Evaluator& evaluator) {
    for (const int i : skies_) {
        BoundLight& l = lights_[size_t(i)];
        if (l.kind != LightKind::Environment || !l.importance || l.sentCl >= 0) continue;
        if (l.asksSurface && !asksFiltersOnly(l)) continue;
        if (l.kernel.kernel->facts().suspends) continue;
        const bool sampled = settings_.direct && settings_.indirect && !settings_.bsdfOnly && !settings_.lightOnly;
        l.guidable = sampled && !l.channels && !usesFootprint(l);
        const int widest = widestMap(l.kernel, *this);
        const int columns = std::clamp(widest / kPointsOfCell, kColumns, kMostColumns), rows = columns * kRows / kColumns;
        std::vector<float> cells = luminanceOf(l, columns, rows, kPointsOfCell, evaluator);
        std::vector<SkyTable::Refined> refined = cellsToRefine(cells, columns, rows);
        for (SkyTable::Refined& r : refined) measureParts(r, l, columns, rows, evaluator);
        auto table = std::make_shared<SkySampler>(columns, rows, std::move(cells), std::move(refined));
        const bool samplesAll = l.shadowless && table->integral() > 0; // rays of lobes cannot pass what is in the way
        if (!samplesAll && !(table->concentration() > kConcentrated)) continue;
        l.power = float(table->integral() / (2 * kPi)); // between the effect of a uniform sky and of a small sun overhead
        l.sky = std::move(table);
        l.guidable = false;
    }
}

} // namespace alpenglow::world
