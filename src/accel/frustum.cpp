// Conservative visibility of a part of the picture, by the boxes of the tree.
#include "accel/impl.h"
#include <algorithm>

namespace alpenglow::accel {

namespace {

/// Whether a box is entirely behind a plane, by more than the float error.
bool behind(const Vec3& lo, const Vec3& hi, const Plane& p) {
    constexpr float kRounding = 1e-5f;
    float sum = p.d, size = std::fabs(p.d);
    for (int k = 0; k < 3; ++k) {
        const float part = p.n[k] * (p.n[k] >= 0 ? hi[k] : lo[k]);
        sum += part;
        size += std::fabs(part);
    }
    return sum < -kRounding * size; // false for NaN
}
bool outside(const Vec3& lo, const Vec3& hi, std::span<const Plane> planes) {
    return std::any_of(planes.begin(), planes.end(), [&](const Plane& p) { return behind(lo, hi, p); });
}

} // namespace

bool Bvh::reachesInto(std::span<const geometry::Plane> planes) const {
    if (nodes_.empty()) return false;
    std::vector<uint32_t> open{0};
    while (!open.empty()) {
        const Node& n = nodes_[open.back()];
        open.pop_back();
        for (int k = 0; k < kWidth; ++k) {
            const Child c = n.child[k];
            if (c == kNothing) continue;
            Vec3 lo, hi;
            for (int axis = 0; axis < 3; ++axis) {
                lo[axis] = n.origin[axis] + n.scale[axis] * float(n.q[0][axis][k]);
                hi[axis] = n.origin[axis] + n.scale[axis] * float(n.q[1][axis][k]);
            }
            if (outside(lo, hi, planes)) continue;
            if (c & (kLeaf | kExact)) return true;
            open.push_back(c & kIndex);
        }
    }
    return false;
}

bool Accel::reachesInto(std::span<const Plane> planes) const {
    if (!impl_->direct) return impl_->tree.reachesInto(planes);
    for (size_t i = 0; i < impl_->triangles.size(); ++i) {
        const DirectTriangles::Triangle& t = impl_->triangles[i];
        const auto misses = [&](const Plane& p) { return behind(t.a, t.a, p) && behind(t.b, t.b, p) && behind(t.c, t.c, p); };
        if (std::none_of(planes.begin(), planes.end(), misses)) return true;
    }
    return std::any_of(impl_->balls.begin(), impl_->balls.end(), [&](const Impl::Ball& b) {
        const geometry::Bounds box = impl_->shapes[b.shape]->bounds();
        return !outside(box.lo, box.hi, planes);
    });
}

} // namespace alpenglow::accel
