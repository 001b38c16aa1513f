#include "accel/bvh_refs.h"
#include <algorithm>

namespace alpenglow::accel {

namespace {
constexpr float kLongest = 3.3f;  // largest ratio of length to width
constexpr uint32_t kTogether = 6; // triangles of a grid that stay in one leaf
} // namespace

Ref refOf(uint32_t id, const geometry::Bounds& b) {
    const auto sound = [](float f, float otherwise) { return std::isfinite(f) ? std::clamp(f, -kHuge, kHuge) : otherwise; };
    Ref r;
    r.lo = Four{sound(b.lo.x, -kHuge), sound(b.lo.y, -kHuge), sound(b.lo.z, -kHuge), 0};
    r.hi = Four{sound(b.hi.x, kHuge), sound(b.hi.y, kHuge), sound(b.hi.z, kHuge), 1};
    r.setId(id);
    return r;
}

uint32_t together(const geometry::TriMesh& m, uint32_t from, uint32_t to) {
    uint32_t vertex[Bvh::kLeafVertices], n = 0, t = from;
    for (; t < to && t < from + kTogether; ++t) {
        const uint32_t* corner = &m.index[3 * size_t(t)];
        uint32_t fresh[3], old[3], k = 0, o = 0;
        for (int c = 0; c < 3; ++c) {
            if (std::find(vertex, vertex + n, corner[c]) == vertex + n) fresh[k++] = corner[c];
            else old[o++] = corner[c];
        }
        if ((t > from && k > 1) || n + k > Bvh::kLeafVertices) break;
        if (std::any_of(corner, corner + 3, [&](uint32_t v) { return Bvh::reaches(m.P[v]); })) break;
        if (t > from + 1 && k == 1) { // avoids long strips
            const Vec3 side = m.P[old[0]] - m.P[old[1]], along = m.P[fresh[0]] - m.P[vertex[0]];
            if (dot(along, along) > kLongest * kLongest * dot(side, side)) break;
        }
        for (uint32_t i = 0; i < k; ++i) vertex[n++] = fresh[i];
    }
    return std::max(1u, t - from);
}

uint32_t pair(const geometry::TriMesh& m, uint32_t from, uint32_t to) {
    constexpr double kLarger = 1.3;
    if (from + 2 > to) return 1;
    const uint32_t* corner = &m.index[3 * size_t(from)];
    int shared = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 3; k < 6; ++k) shared += corner[i] == corner[k];
    if (shared != 2) return 1;
    Box box[2];
    for (int i = 0; i < 6; ++i) {
        const Vec3& p = m.P[corner[i]];
        if (Bvh::reaches(p)) return 1;
        box[i / 3].add(Four{p.x, p.y, p.z, 0}, Four{p.x, p.y, p.z, 0});
    }
    Box both = box[0];
    both.add(box[1]);
    return both.halfArea() <= kLarger * std::max(box[0].halfArea(), box[1].halfArea()) ? 2 : 1;
}

} // namespace alpenglow::accel
