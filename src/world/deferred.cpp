#include "world/deferred.h"
#include <algorithm>
#include <cmath>
#include <utility>

namespace alpenglow::world {
namespace {

using geometry::Bounds;

/// Distance at which a ray enters a box, at least its own start; negative: not before `end`.
double entry(const accel::Ray& r, const Bounds& b, double end) {
    double from = std::max(0.f, r.tnear), to = end;
    for (int k = 0; k < 3; ++k) {
        const double o = r.org[k], d = r.dir[k];
        if (d == 0) {
            if (!(o >= b.lo[k] && o <= b.hi[k])) return -1;
            continue;
        }
        const double a = (b.lo[k] - o) / d, c = (b.hi[k] - o) / d;
        from = std::max(from, std::min(a, c));
        to = std::min(to, std::max(a, c));
    }
    return from <= to ? from : -1;
}

} // namespace

DeferredBounds::DeferredBounds(std::vector<Bound> bounds, int most)
    : bounds_(std::move(bounds)), most_(size_t(std::max(1, most))) {
    for (Bound& b : bounds_) { // contents have rounded coordinates
        for (int k = 0; k < 3; ++k) {
            const float more = 1e-5f * (std::fabs(b.box.lo[k]) + std::fabs(b.box.hi[k])) + 1e-30f;
            b.box.lo[k] -= more;
            b.box.hi[k] += more;
        }
    }
    if (!bounds_.empty()) build(0, uint32_t(bounds_.size()));
    met_ = std::make_unique<std::atomic<uint8_t>[]>(bounds_.size());
}

void DeferredBounds::build(uint32_t first, uint32_t end) {
    const size_t at = nodes_.size();
    Node node;
    for (uint32_t i = first; i < end; ++i) node.box.add(bounds_[i].box);
    node.first = first;
    node.count = end - first <= 4 ? end - first : 0;
    nodes_.push_back(node);
    if (node.count) return;
    const Vec3 size = node.box.hi - node.box.lo;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t middle = (first + end) / 2;
    const auto place = [&](const Bound& b) { return b.box.lo[axis] + b.box.hi[axis]; };
    std::nth_element(bounds_.begin() + first, bounds_.begin() + middle, bounds_.begin() + end,
                     [&](const Bound& a, const Bound& b) { return place(a) < place(b); });
    build(first, middle);
    nodes_[at].first = uint32_t(nodes_.size());
    build(middle, end);
}

bool DeferredBounds::intersects(const accel::Ray& r, double end) const {
    if (nodes_.empty()) return false;
    end = std::min(end, double(r.tfar));
    std::vector<std::pair<double, uint32_t>> met; // rare: allocates only after a hit
    uint32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const uint32_t at = stack[--depth];
        const Node& n = nodes_[at];
        if (entry(r, n.box, end) < 0) continue;
        if (n.count == 0) {
            stack[depth++] = n.first;
            stack[depth++] = at + 1;
            continue;
        }
        for (uint32_t i = n.first; i < n.first + n.count; ++i)
            if (const double t = entry(r, bounds_[i].box, end); t >= 0) met.emplace_back(t, i);
    }
    if (met.empty()) return false;
    const size_t asked = std::min(met.size(), most_);
    std::partial_sort(met.begin(), met.begin() + std::ptrdiff_t(asked), met.end());
    for (size_t k = 0; k < asked; ++k) met_[met[k].second].store(1, std::memory_order_relaxed);
    return true;
}

std::vector<int> DeferredBounds::met() const {
    std::vector<int> numbers;
    for (size_t i = 0; i < bounds_.size(); ++i)
        if (met_[i].load(std::memory_order_relaxed)) numbers.push_back(bounds_[i].number);
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

} // namespace alpenglow::world
