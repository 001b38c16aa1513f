#include "world/records.h"
#include "bsdf/sampling.h"
#include <algorithm>
#include <bit>
#include <cmath>

namespace alpenglow::world {

namespace {

constexpr size_t kMostRecords = size_t(1) << 20; ///< for a picture; beyond that hemispheres are sampled exactly, point by point
constexpr float kLeast = 1.5f;                   ///< minimum radius of a record, in pixels

/// Exponent of the smallest power of 2 that is at least 2 x; x > 0 and finite.
int levelOf(float x) { return std::clamp(int(std::bit_cast<uint32_t>(x) >> 23 & 255) - 127 + 2, -100, 100); }

bool earlier(const LightRecord& a, const LightRecord& b) { return a.place < b.place; }

float power(int level) { return std::bit_cast<float>(uint32_t(level + 127) << 23); }

} // namespace

void LightRecord::take(const std::array<Vec3, 3>& axes, int rings, int turns, const std::vector<Color>& seen,
                       const std::vector<float>& way, float pixel, float most) {
    const auto at = [&](int j, int k) { return size_t(j) * size_t(turns) + size_t((k + turns) % turns); };
    light = Color(0);
    turned = moved = {};
    double nearness = 0;
    for (size_t i = 0; i < seen.size(); ++i) {
        light += seen[i];
        if (way[i] < 1e37f) nearness += 1 / double(std::max(way[i], 1e-30f));
    }
    light = light / float(seen.size());
    const auto around = [&](float part, bool along) { // a direction in the plane, or a quarter turn further
        const Vec2 c = unitCircle(part);
        return along ? axes[0] * c.x + axes[1] * c.y : axes[1] * c.x - axes[0] * c.y;
    };
    const auto differs = [&](const Vec3& along, size_t i, size_t other, float share) {
        const float r = std::min(way[i], way[other]);
        if (!(r < 1e37f)) return;
        for (int c = 0; c < 3; ++c) moved[size_t(c)] += along * ((seen[i][c] - seen[other][c]) * share / std::max(r, 1e-30f));
    };
    for (int k = 0; k < turns; ++k) {
        const Vec3 u = around((float(k) + .5f) / float(turns), true), v = around((float(k) + .5f) / float(turns), false),
                   edge = around(float(k) / float(turns), false);
        for (int j = 0; j < rings; ++j) {
            const float inner = float(j) / float(rings), outer = float(j + 1) / float(rings);
            const float middle = (float(j) + .5f) / float(rings);
            const float tangent = std::sqrt(middle / (1 - middle));
            for (int c = 0; c < 3; ++c) turned[size_t(c)] += v * (tangent * seen[at(j, k)][c] / float(seen.size()));
            if (j > 0) differs(u, at(j, k), at(j - 1, k), 2 / float(turns) * std::sqrt(inner) * (1 - inner));
            differs(edge, at(j, k), at(j, k - 1), (std::sqrt(outer) - std::sqrt(inner)) / float(kPi));
        }
    }
    // Radius: where it may change by about its own value, within limits in pixels.
    float r = nearness > 0 ? float(std::min(double(seen.size()) / nearness, 1e30)) : 1e30f;
    for (int c = 0; c < 3; ++c)
        if (const float slope = length(moved[size_t(c)]); slope * r > light[c]) r = light[c] / slope;
    const float least = kLeast * pixel / change;
    if (r < least) // the gradients come from nearer surfaces
        for (Vec3& m : moved) m = m * (r / least);
    distance = std::max(std::min(std::max(r, least), std::max(most, kLeast) * pixel / change), 1e-30f);
}

namespace {

struct Cube {
    int32_t x, y, z, level;
    bool operator==(const Cube&) const = default;
};
struct CubeHash {
    size_t operator()(const Cube& c) const {
        uint64_t h = 0;
        for (const int32_t v : {c.x, c.y, c.z, c.level}) h = (h ^ uint32_t(v)) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
        return size_t(h);
    }
};

/// Neighbour clamping: a surface near one of two neighbours is near the other, so no distance may exceed the other's plus the
/// distance between them (Krivanek 2005). A record whose rays started behind a wall, or missed a touching surface, does not
/// represent its surroundings. New records start at `fresh`, in their order, so that threads change nothing.
void agreeOnDistances(std::vector<LightRecord>& all, size_t fresh) {
    std::unordered_map<Cube, std::vector<uint32_t>, CubeHash> cubes;
    std::vector<int> levels;
    const auto levelAt = [&](const LightRecord& r) { return levelOf(r.change * r.distance); };
    for (size_t i = fresh; i < all.size(); ++i) levels.push_back(levelAt(all[i]));
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    const auto cubeOf = [](const Vec3& p, int level) {
        const float one = power(-level);
        const auto whole = [&](float v) { return int32_t(std::clamp(std::floor(v * one), -1e9f, 1e9f)); };
        return Cube{whole(p.x), whole(p.y), whole(p.z), level};
    };
    const auto enter = [&](size_t i) {
        for (const int level : levels) cubes[cubeOf(all[i].P, level)].push_back(uint32_t(i));
    };
    for (size_t i = 0; i < fresh; ++i) enter(i);
    for (size_t i = fresh; i < all.size(); ++i) {
        LightRecord& r = all[i];
        const float reach = r.change * r.distance;
        const int level = levelAt(r);
        const Cube lo = cubeOf(r.P - Vec3(reach), level), hi = cubeOf(r.P + Vec3(reach), level);
        for (int32_t z = lo.z; z <= hi.z; ++z)
            for (int32_t y = lo.y; y <= hi.y; ++y)
                for (int32_t x = lo.x; x <= hi.x; ++x) {
                    const auto cube = cubes.find({x, y, z, level});
                    if (cube == cubes.end()) continue;
                    for (const uint32_t n : cube->second) {
                        LightRecord& other = all[n];
                        const float apart = length(other.P - r.P);
                        if (other.call != r.call || !(apart < reach)) continue;
                        r.distance = std::min(r.distance, other.distance + apart);
                        other.distance = std::min(other.distance, r.distance + apart);
                    }
                }
        enter(i);
    }
}

} // namespace

size_t LightRecords::CellHash::operator()(const Cell& c) const {
    uint64_t h = 0;
    for (const int32_t v : {c.x, c.y, c.z, c.level}) h = (h ^ uint32_t(v)) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
    return size_t(h);
}

LightRecords::Cell LightRecords::cellOf(const Vec3& p, int level) {
    const float one = power(-level);
    const auto whole = [&](float v) { return int32_t(std::clamp(std::floor(v * one), -1e9f, 1e9f)); };
    return {whole(p.x), whole(p.y), whole(p.z), level};
}

bool LightRecords::find(uint64_t call, const Vec3& P, const Vec3& N, Color& light) const {
    float sum = 0;
    Color all(0);
    for (const int level : levels_) {
        const auto cell = cells_.find(cellOf(P, level));
        if (cell == cells_.end()) continue;
        for (const uint32_t i : cell->second) {
            const LightRecord& r = records_[i];
            if (r.call != call) continue;
            const Vec3 d = P - r.P;
            const float error = length(d) / r.distance + std::sqrt(std::max(0.f, 1 - dot(N, r.N)));
            if (!(error < r.change)) continue;
            // The record is in front of P, where more may be visible
            if (dot(d, N + r.N) < -.02f * r.distance * r.change) continue;
            const float w = 1 / std::max(error, 1e-4f) - 1 / r.change;
            const Vec3 axis = cross(r.N, N);
            Color here;
            for (int c = 0; c < 3; ++c)
                here[c] = std::max(0.f, r.light[c] + dot(axis, r.turned[size_t(c)]) + dot(d, r.moved[size_t(c)]));
            all += here * w;
            sum += w;
        }
    }
    if (!(sum > 0)) return false;
    light = all / sum;
    return true;
}

void LightRecords::add(const LightRecord& r) {
    std::lock_guard lock(mutex_);
    added_.push_back(r);
    const size_t room = kMostRecords - std::min(records_.size(), kMostRecords);
    if (added_.size() < 2 * kMostRecords) return;
    // Only the first in order are kept, regardless of threads, so the others can be dropped now.
    std::nth_element(added_.begin(), added_.begin() + long(room), added_.end(), earlier);
    added_.resize(room);
}

size_t LightRecords::keep() {
    std::lock_guard lock(mutex_);
    std::sort(added_.begin(), added_.end(), earlier);
    const size_t fresh = records_.size();
    const size_t room = kMostRecords - std::min(fresh, kMostRecords);
    records_.insert(records_.end(), added_.begin(), added_.begin() + long(std::min(added_.size(), room)));
    agreeOnDistances(records_, fresh);
    for (size_t i = fresh; i < records_.size(); ++i) {
        const LightRecord& r = records_[i];
        const float reach = r.change * r.distance;
        const int level = levelOf(reach);
        const Cell lo = cellOf(r.P - Vec3(reach), level), hi = cellOf(r.P + Vec3(reach), level);
        for (int32_t z = lo.z; z <= hi.z; ++z)
            for (int32_t y = lo.y; y <= hi.y; ++y)
                for (int32_t x = lo.x; x <= hi.x; ++x) cells_[{x, y, z, level}].push_back(uint32_t(i));
        if (const auto p = std::lower_bound(levels_.begin(), levels_.end(), level); p == levels_.end() || *p != level)
            levels_.insert(p, level);
    }
    added_.clear();
    return records_.size();
}

} // namespace alpenglow::world
