#include "photonmap/photonmap.h"
#include <cmath>
#include <limits>

namespace alpenglow::photonmap {

namespace {
constexpr float kSameSide = 0.5f; ///< normals that differ by less than 60 degrees belong to one surface

float coordinate(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// The median photon of a node, stored in the node itself.
size_t middleOf(size_t begin, size_t end) { return begin + (end - begin) / 2; }
} // namespace

PhotonMap::PhotonMap(std::vector<Photon> from) {
    std::vector<uint32_t> order(from.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = uint32_t(i);
    axis_.resize(from.size());
    build(from, order, 0, order.size());
    photons_.resize(from.size());
    for (size_t i = 0; i < order.size(); ++i) photons_[i] = from[order[i]];
    for (std::vector<float>& p : place_) p.resize(photons_.size());
    directions_.resize(photons_.size());
    for (size_t i = 0; i < photons_.size(); ++i) {
        const Vec3 n = unpackUnit(photons_[i].normal), d = photons_[i].direction();
        for (int k = 0; k < 3; ++k) {
            place_[k][i] = photons_[i].P[k];
            directions_[i].normal[k] = int8_t(std::lround(n[k] * 127));
            directions_[i].from[k] = int8_t(std::lround(d[k] * 127));
        }
    }
    bounds_.resize(photons_.size() / kBoundStep + 1);
    if (!photons_.empty()) bound(0, photons_.size());
}

PhotonMap::Bounds PhotonMap::bound(size_t begin, size_t end) {
    const size_t middle = middleOf(begin, end);
    const auto of = [](const Photon& p) {
        const Vec3 n = unpackUnit(p.normal) * 127.f;
        Bounds b{p.P, p.P, {}, {}};
        for (int k = 0; k < 3; ++k) b.normalLo[k] = int8_t(std::floor(n[k])), b.normalHi[k] = int8_t(std::ceil(n[k]));
        return b;
    };
    Bounds all = of(photons_[middle]);
    const auto add = [&](const Bounds& b) {
        for (int k = 0; k < 3; ++k) {
            all.lo[k] = std::min(all.lo[k], b.lo[k]), all.hi[k] = std::max(all.hi[k], b.hi[k]);
            all.normalLo[k] = std::min(all.normalLo[k], b.normalLo[k]);
            all.normalHi[k] = std::max(all.normalHi[k], b.normalHi[k]);
        }
    };
    if (end - begin < kBounded) {
        for (size_t i = begin; i < end; ++i) add(of(photons_[i]));
        return all;
    }
    if (begin < middle) add(bound(begin, middle));
    if (middle + 1 < end) add(bound(middle + 1, end));
    return bounds_[middle / kBoundStep] = all;
}

/// Whether a photon of this node may be nearer than those found, and on the right side. Rounded like the distances of photons,
/// each of which is at least as far along each axis, so no valid photon is missed.
bool PhotonMap::mayCount(const Lookup& l, size_t begin, size_t end, float within2) const {
    const Bounds& b = bounds_[middleOf(begin, end) / kBoundStep];
    Vec3 away(0.f);
    for (int k = 0; k < 3; ++k) away[k] = std::max(std::max(b.lo[k] - l.P[k], l.P[k] - b.hi[k]), 0.f);
    if (dot(away, away) > within2) return false;
    float facing = 0, size = 0;
    for (int k = 0; k < 3; ++k) {
        facing += std::max(float(b.normalLo[k]) * l.N[k], float(b.normalHi[k]) * l.N[k]);
        size += std::fabs(l.N[k]);
    }
    return facing + 1e-3f * size > kSameSide * 127;
}

/// Ties are ordered by emission, so the tree does not depend on the median algorithm.
void PhotonMap::build(std::vector<Photon>& from, std::vector<uint32_t>& order, size_t begin, size_t end) {
    while (end - begin > 1) {
        Vec3 lo(std::numeric_limits<float>::max()), hi(-std::numeric_limits<float>::max());
        for (size_t i = begin; i < end; ++i)
            for (int k = 0; k < 3; ++k) {
                lo[k] = std::min(lo[k], from[order[i]].P[k]);
                hi[k] = std::max(hi[k], from[order[i]].P[k]);
            }
        const Vec3 size = hi - lo;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const size_t middle = middleOf(begin, end);
        std::nth_element(order.begin() + long(begin), order.begin() + long(middle), order.begin() + long(end),
                         [&](uint32_t a, uint32_t b) {
                             const float x = coordinate(from[a].P, axis), y = coordinate(from[b].P, axis);
                             return x < y || (x == y && a < b);
                         });
        axis_[middle] = uint8_t(axis);
        build(from, order, begin, middle);
        begin = middle + 1;
    }
}

Color PhotonMap::power() const {
    Vec3d sum(0.0);
    for (const Photon& p : photons_) sum += Vec3d(p.power);
    return Color(sum);
}

/// Collects the nearest photons. Holds up to twice as many as needed, so that few are moved.
class PhotonMap::Nearest {
public:
    Nearest(std::vector<Found>& found, size_t most) : found_(found), most_(most) { found_.clear(); }
    float within2() const { return within2_; } ///< squared radius; farther photons are ignored
    void offer(float distance2, size_t at) {
        found_.push_back({distance2, uint32_t(at)});
        if (found_.size() >= 2 * most_ + 32) cut();
    }
    void cut() {
        if (found_.size() <= most_) return;
        std::nth_element(found_.begin(), found_.begin() + long(most_ - 1), found_.end());
        found_.resize(most_);
        within2_ = found_.back().distance2;
    }

private:
    std::vector<Found>& found_;
    const size_t most_;
    float within2_ = std::numeric_limits<float>::infinity();
};

/// Whether a photon is on the right side and requested. Undecided coarse unit vectors are decided by the exact ones.
bool PhotonMap::counts(const Lookup& l, size_t at) const {
    const Photon& p = photons_[at];
    if (p.bounces < l.minBounces) return false;
    constexpr float kStep = 0.0075f; // more than half a step, 1/254, along each of three axes
    const Directions& d = directions_[at];
    float normal = 0, from = 0;
    for (int k = 0; k < 3; ++k) normal += float(d.normal[k]) * l.N[k], from += float(d.from[k]) * l.N[k];
    normal *= 1 / 127.f, from *= 1 / 127.f;
    if (normal < kSameSide - kStep || from < -kStep) return false;
    if (normal > kSameSide + kStep && from > kStep) return true;
    return dot(unpackUnit(p.normal), l.N) > kSameSide && dot(p.direction(), l.N) > 0;
}

/// Tests all photons of a small node.
void PhotonMap::scan(const Lookup& l, size_t begin, size_t end, Nearest& nearest) const {
    float d2[kScanned];
    const size_t n = end - begin;
    const float *x = &place_[0][begin], *y = &place_[1][begin], *z = &place_[2][begin];
    for (size_t i = 0; i < n; ++i) {
        const float dx = x[i] - l.P.x, dy = y[i] - l.P.y, dz = z[i] - l.P.z;
        d2[i] = dx * dx + dy * dy + dz * dz;
    }
    for (size_t i = 0; i < n; ++i)
        if (d2[i] <= nearest.within2() && counts(l, begin + i)) nearest.offer(d2[i], begin + i);
}

/// Finds the nearest valid photons, one more than requested.
void PhotonMap::nearest(const Lookup& l, std::vector<Found>& found) const {
    Nearest nearest(found, size_t(std::clamp(l.estimator, 1, kMostAsked)) + 1);
    struct Part {
        size_t begin, end;
        float beyond2;
    }; // squared distance to the splitting plane
    Part waiting[64];
    int depth = 0;
    waiting[depth++] = {0, photons_.size(), 0};
    while (depth > 0) {
        Part part = waiting[--depth];
        while (part.begin < part.end) {
            const size_t size = part.end - part.begin;
            if (part.beyond2 > nearest.within2()) break;
            if (size >= kBounded && !mayCount(l, part.begin, part.end, nearest.within2())) break;
            if (size < kScanned) {
                if (l.visited) *l.visited += size;
                scan(l, part.begin, part.end, nearest);
                break;
            }
            const size_t at = middleOf(part.begin, part.end);
            if (l.visited) ++*l.visited;
            scan(l, at, at + 1, nearest);
            const int axis = axis_[at];
            const float side = l.P[axis] - place_[axis][at];
            const Part below{part.begin, at, 0}, above{at + 1, part.end, 0};
            Part far = side < 0 ? above : below;
            far.beyond2 = side * side;
            if (far.begin < far.end) waiting[depth++] = far;
            part = {side < 0 ? below.begin : above.begin, side < 0 ? below.end : above.end, part.beyond2};
        }
    }
    nearest.cut();
}

PhotonMap::Estimate PhotonMap::estimate(const Lookup& l) const {
    Estimate e;
    if (photons_.empty() || !std::isfinite(dot(l.P, l.P)) || !(dot(l.N, l.N) > 0)) return e;
    thread_local std::vector<Found> found;
    nearest(l, found);
    if (found.size() < 2) return e;
    std::sort(found.begin(), found.end());
    e.area = float(kPi) * found.back().distance2;
    for (size_t i = 0; i + 1 < found.size(); ++i) {
        const Photon& p = photons_[found[i].at];
        e.power += p.power;
        e.given += p.power * (Color(p.reflected[0], p.reflected[1], p.reflected[2]) / 255.f);
    }
    return e;
}

Color PhotonMap::irradiance(const Lookup& l) const {
    const Estimate e = estimate(l);
    return e.area > 0 ? e.power / e.area : Color(0);
}

Color PhotonMap::radiance(const Lookup& l) const {
    const Estimate e = estimate(l);
    return e.area > 0 ? e.given / (e.area * float(kPi)) : Color(0);
}

float typicalDistance(const PhotonMap& map, int n, int asked) {
    const std::span<const Photon> all = map.photons();
    if (all.size() < size_t(n) + 2) return 0;
    std::vector<float> far;
    const size_t step = std::max<size_t>(1, all.size() / size_t(std::max(asked, 1)));
    std::vector<float> d2;
    for (size_t i = step / 2; i < all.size(); i += step) {
        // Near photons are mostly, but not always, near in the order of the tree: searches the complete map.
        d2.clear();
        for (const Photon& p : all) d2.push_back(dot(p.P - all[i].P, p.P - all[i].P));
        std::nth_element(d2.begin(), d2.begin() + n, d2.end());
        far.push_back(std::sqrt(d2[size_t(n)]));
    }
    std::nth_element(far.begin(), far.begin() + long(far.size() / 2), far.end());
    return far[far.size() / 2];
}

} // namespace alpenglow::photonmap
