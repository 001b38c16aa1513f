#include "world/surfacetree.h"
#include <algorithm>
#include <climits>

namespace alpenglow::world {

namespace {
constexpr int32_t kNone = INT32_MIN;
}

struct SurfaceTree::Builder {
    SurfaceTree& tree;
    const std::vector<Place>& places; ///< by point
    size_t split;
    int side;
    const std::function<int32_t(const Leaf&)>& make;

    using Ids = std::span<uint32_t>;
    struct Parent {
        Ids ids;
        int32_t made = -1;
    };
    int32_t node(Ids, int level, Parent&);
};

/// Divides a cell while it holds many points. Returns an index as in nodes_.
int32_t SurfaceTree::Builder::node(Ids ids, int level, Parent& around) {
    if (ids.size() <= split || level >= kLevels)
        return -1 - make({ids, around.ids, around.made, side, tree.edge_ / float(1 << level)});
    const int shift = kLevels - 1 - level;
    const auto octant = [&](uint32_t i) {
        const Place& p = places[i];
        return (p.x >> shift & 1) | (p.y >> shift & 1) << 1 | (p.z >> shift & 1) << 2;
    };
    std::stable_sort(ids.begin(), ids.end(), [&](uint32_t a, uint32_t b) { return octant(a) < octant(b); });
    const size_t at = tree.nodes_.size();
    tree.nodes_.resize(at + 8, kNone);
    Parent own{ids};
    size_t first = 0;
    for (uint32_t o = 0; o < 8; ++o) {
        size_t end = first;
        while (end < ids.size() && octant(ids[end]) == o) ++end;
        const int32_t child = node(ids.subspan(first, end - first), level + 1, own);
        tree.nodes_[at + o] = child;
        first = end;
    }
    return int32_t(at / 8);
}

void SurfaceTree::build(std::span<const Point> points, size_t split, size_t fewest,
                        const std::function<int32_t(const Leaf&)>& make) {
    nodes_.clear();
    std::fill_n(roots_, kSides + 1, kNone);
    if (points.empty()) return;
    Vec3 low = points[0].P, high = low;
    for (const Point& p : points)
        for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p.P[k]), high[k] = std::max(high[k], p.P[k]);
    const Vec3 size = high - low;
    edge_ = std::max({size.x, size.y, size.z, 1e-6f * maxComponent(absolute(low)), 1e-30f}) * 1.001f;
    corner_ = (low + high) * .5f - Vec3(edge_ * .5f);
    perSize_ = float(1 << kLevels) / edge_;
    std::vector<Place> places(points.size());
    std::vector<uint32_t> of[kSides + 1];
    for (size_t i = 0; i < points.size(); ++i)
        if (placeOf(points[i].P, places[i])) of[points[i].side].push_back(uint32_t(i));
    for (int s = 1; s <= kSides; ++s) {
        if (of[s].size() < fewest) continue;
        Builder b{*this, places, split, s, make};
        Builder::Parent none;
        roots_[s] = b.node(of[s], 0, none);
    }
}

bool SurfaceTree::placeOf(const Vec3& P, Place& to) const {
    const Vec3 at = (P - corner_) * perSize_;
    constexpr float kEnd = float(1 << kLevels);
    const auto within = [&](float x) { return x >= 0 && x < kEnd; };
    if (!(within(at.x) && within(at.y) && within(at.z))) return false;
    to = {uint32_t(at.x), uint32_t(at.y), uint32_t(at.z)};
    return true;
}

void SurfaceTree::find(std::span<const Point> points, int32_t* cells) const {
    Place place[kTogether];
    uint32_t active[kTogether];
    size_t left = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        const int32_t root = edge_ > 0 ? roots_[points[i].side] : kNone;
        const bool within = root != kNone && placeOf(points[i].P, place[i]);
        cells[i] = within ? root : kNone;
        if (cells[i] >= 0) active[left++] = uint32_t(i);
    }
    for (int shift = kLevels - 1; left > 0; --shift) {
        size_t kept = 0;
        for (size_t k = 0; k < left; ++k) {
            const uint32_t i = active[k];
            const Place& p = place[i];
            cells[i] = nodes_[size_t(cells[i]) * 8 + ((p.x >> shift & 1) | (p.y >> shift & 1) << 1 | (p.z >> shift & 1) << 2)];
            active[kept] = i;
            kept += cells[i] >= 0;
        }
        left = kept;
    }
    for (size_t i = 0; i < points.size(); ++i) cells[i] = cells[i] == kNone ? -1 : -1 - cells[i];
}

int32_t SurfaceTree::find(const Vec3& P, int side) const {
    Place p;
    if (!(edge_ > 0) || roots_[side] == kNone || !placeOf(P, p)) return -1;
    int32_t at = roots_[side];
    for (int shift = kLevels - 1; at >= 0; --shift)
        at = nodes_[size_t(at) * 8 + ((p.x >> shift & 1) | (p.y >> shift & 1) << 1 | (p.z >> shift & 1) << 2)];
    return -1 - at;
}

} // namespace alpenglow::world
