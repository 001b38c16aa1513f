#include "photons/photonmap.h"
#include <cmath>
#include <limits>

namespace alpenglow::photons {

namespace {
constexpr float kSameSide = 0.5f; ///< normals that differ by less than 60 degrees are of one surface

float coordinate(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// The middle of a node's photons, which is its own.
size_t middleOf(size_t begin, size_t end) { return begin + (end - begin) / 2; }
} // namespace

PhotonMap::PhotonMap(std::vector<Photon> from) {
    std::vector<uint32_t> order(from.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = uint32_t(i);
    axis_.resize(from.size());
    build(from, order, 0, order.size());
    photons_.resize(from.size());
    for (size_t i = 0; i < order.size(); ++i) photons_[i] = from[order[i]];
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

/// Whether a photon of this node may be nearer than those that were found, and face the right way. The distance is rounded as
/// those of photons are, each of which is at least as far along each axis, so none that would count is passed over.
bool PhotonMap::mayCount(const Lookup& l, size_t begin, size_t end, const std::vector<Found>& heap, size_t most) const {
    const Bounds& b = bounds_[middleOf(begin, end) / kBoundStep];
    if (heap.size() == most) {
        Vec3 away(0.f);
        for (int k = 0; k < 3; ++k) away[k] = std::max(std::max(b.lo[k] - l.P[k], l.P[k] - b.hi[k]), 0.f);
        if (dot(away, away) >= heap.front().distance2) return false;
    }
    float facing = 0, size = 0;
    for (int k = 0; k < 3; ++k) {
        facing += std::max(float(b.normalLo[k]) * l.N[k], float(b.normalHi[k]) * l.N[k]);
        size += std::fabs(l.N[k]);
    }
    return facing + 1e-3f * size > kSameSide * 127;
}

/// Order among equals is that of emission, so the tree does not depend on how the middle is found.
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

/// The nearest photons that count, one more than are asked for, as a heap with the farthest on top.
void PhotonMap::nearest(const Lookup& l, std::vector<Found>& heap) const {
    const size_t most = size_t(std::clamp(l.estimator, 1, kMostAsked)) + 1;
    const auto nearer = [](const Found& a, const Found& b) {
        return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.at < b.at);
    };
    struct Part {
        size_t begin, end;
        float beyond2;
    }; // squared distance of the plane that must be crossed
    Part waiting[64];
    int depth = 0;
    waiting[depth++] = {0, photons_.size(), 0};
    while (depth > 0) {
        Part part = waiting[--depth];
        while (part.begin < part.end) {
            if (heap.size() == most && part.beyond2 > heap.front().distance2) break;
            if (part.end - part.begin >= kBounded && !mayCount(l, part.begin, part.end, heap, most)) break;
            if (l.visited) ++*l.visited;
            const size_t at = middleOf(part.begin, part.end);
            const Photon& p = photons_[at];
            const Vec3 away = p.P - l.P;
            const float d2 = dot(away, away);
            if ((heap.size() < most || d2 < heap.front().distance2) && p.bounces >= l.minBounces &&
                dot(unpackUnit(p.normal), l.N) > kSameSide && dot(p.direction(), l.N) > 0) {
                if (heap.size() == most) {
                    std::pop_heap(heap.begin(), heap.end(), nearer);
                    heap.pop_back();
                }
                heap.push_back({d2, uint32_t(at)});
                std::push_heap(heap.begin(), heap.end(), nearer);
            }
            const float side = coordinate(l.P, axis_[at]) - coordinate(p.P, axis_[at]);
            const Part below{part.begin, at, 0}, above{at + 1, part.end, 0};
            Part far = side < 0 ? above : below;
            far.beyond2 = side * side;
            if (far.begin < far.end) waiting[depth++] = far;
            part = {side < 0 ? below.begin : above.begin, side < 0 ? below.end : above.end, part.beyond2};
        }
    }
}

PhotonMap::Estimate PhotonMap::estimate(const Lookup& l) const {
    Estimate e;
    if (photons_.empty() || !std::isfinite(dot(l.P, l.P)) || !(dot(l.N, l.N) > 0)) return e;
    thread_local std::vector<Found> heap;
    heap.clear();
    nearest(l, heap);
    if (heap.size() < 2) return e;
    std::sort(heap.begin(), heap.end(), [](const Found& a, const Found& b) {
        return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.at < b.at);
    });
    e.area = float(kPi) * heap.back().distance2;
    for (size_t i = 0; i + 1 < heap.size(); ++i) {
        const Photon& p = photons_[heap[i].at];
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
        // Photons near each other in space are near each other in the tree's order, but not all of them: the whole map is asked.
        d2.clear();
        for (const Photon& p : all) d2.push_back(dot(p.P - all[i].P, p.P - all[i].P));
        std::nth_element(d2.begin(), d2.begin() + n, d2.end());
        far.push_back(std::sqrt(d2[size_t(n)]));
    }
    std::nth_element(far.begin(), far.begin() + long(far.size() / 2), far.end());
    return far[far.size() / 2];
}

} // namespace alpenglow::photons
