#include "texture/skydirections.h"
#include "base/exact.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::texture {

namespace {

constexpr int kCellsAround = 128, kCellsDown = 64; ///< cells of equal size: uniform in height and azimuth

Vec3 directionAt(double x, double y) {
    const double z = 1 - 2 * y / kCellsDown, r = std::sqrt(std::max(0.0, 1 - z * z)), turn = 2 * kPi * x / kCellsAround;
    return {float(r * exact::cos(turn)), float(r * exact::sin(turn)), float(z)};
}

size_t cellOf(const Vec3& w) {
    double turn = exact::atan2(double(w.y), double(w.x)) / (2 * kPi);
    if (turn < 0) turn += 1;
    const int column = std::clamp(int(turn * kCellsAround), 0, kCellsAround - 1);
    const int row = std::clamp(int((1 - double(w.z)) / 2 * kCellsDown), 0, kCellsDown - 1);
    return size_t(row * kCellsAround + column);
}

Color lightAt(Handle map, const LatLong& axes, const Vec3& w, float side) {
    LookupOptions colours;
    colours.asLight = true;
    const Vec3 across = std::fabs(w.z) < .9f ? cross(w, Vec3(0, 0, 1)) : cross(w, Vec3(1, 0, 0)), t = across / length(across);
    float v[3] = {};
    environment(map, axes, 0, 3, w, t * side, cross(w, t) * side, colours, v);
    return {v[0], v[1], v[2]};
}

} // namespace

SkyDirections::SkyDirections(Handle map, const LatLong& axes) : map_(map), axes_(axes) {
    std::vector<float> light;
    double all = 0;
    for (int y = 0; y < kCellsDown; ++y)
        for (int x = 0; x < kCellsAround; ++x) {
            const float v = std::max(0.f, luminance(lightAt(map, axes, directionAt(x + .5, y + .5),
                                                            float(std::sqrt(4 * kPi / (kCellsAround * kCellsDown))))));
            light.push_back(std::isfinite(v) ? v : 0);
            all += light.back();
        }
    // A tenth is uniform, because the value at a cell's centre may not be representative.
    double sum = 0;
    for (const float v : light)
        sums_.push_back(float(sum += .9 * (all > 0 ? v / all : 1.0 / double(light.size())) + .1 / double(light.size())));
}

SkyDirections::Direction SkyDirections::at(Vec2 e) const {
    const size_t cell = size_t(
        std::min<ptrdiff_t>(std::upper_bound(sums_.begin(), sums_.end(), e.x) - sums_.begin(), ptrdiff_t(sums_.size()) - 1));
    const float before = cell ? sums_[cell - 1] : 0, chance = sums_[cell] - before;
    const float inside = std::clamp((e.x - before) / chance, 0.f, 1.f); // remainder of the first number
    Direction d;
    d.w = directionAt(double(cell % kCellsAround) + inside, double(cell / kCellsAround) + e.y);
    d.density = chance * float(kCellsAround * kCellsDown / (4 * kPi));
    d.light = map_ ? lightAt(map_, axes_, d.w, 1e-3f) : Color(0);
    return d;
}

SkyDirections::Direction SkyDirections::of(const Vec3& w) const {
    const size_t cell = cellOf(w);
    const float chance = sums_[cell] - (cell ? sums_[cell - 1] : 0);
    return {w, chance * float(kCellsAround * kCellsDown / (4 * kPi)), map_ ? lightAt(map_, axes_, w, 1e-3f) : Color(0)};
}

const SkyDirections& SkyDirectionTables::of(Handle map, const LatLong& axes) const {
    std::lock_guard lock(mutex_);
    auto& t = tables_[map];
    if (!t) t = std::make_unique<SkyDirections>(map, axes);
    return *t;
}

} // namespace alpenglow::texture
