#include "accel/tree_refs.h"
#include <algorithm>

namespace alpenglow::accel {

namespace {
constexpr float kLongest = 3.3f;  // times as long as wide are they at most
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
    uint32_t vertex[Tree::kLeafVertices], n = 0, t = from;
    for (; t < to && t < from + kTogether; ++t) {
        const uint32_t* corner = &m.index[3 * size_t(t)];
        uint32_t fresh[3], old[3], k = 0, o = 0;
        for (int c = 0; c < 3; ++c) {
            if (std::find(vertex, vertex + n, corner[c]) == vertex + n) fresh[k++] = corner[c];
            else old[o++] = corner[c];
        }
        if ((t > from && k > 1) || n + k > Tree::kLeafVertices) break;
        if (std::any_of(corner, corner + 3, [&](uint32_t v) { return Tree::reaches(m.P[v]); })) break;
        if (t > from + 1 && k == 1) { // not where a long strip comes of it
            const Vec3 side = m.P[old[0]] - m.P[old[1]], along = m.P[fresh[0]] - m.P[vertex[0]];
            if (dot(along, along) > kLongest * kLongest * dot(side, side)) break;
        }
        for (uint32_t i = 0; i < k; ++i) vertex[n++] = fresh[i];
    }
    return std::max(1u, t - from);
}

} // namespace alpenglow::accel
