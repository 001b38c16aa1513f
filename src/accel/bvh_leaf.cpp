#include "accel/bvh_leaf.h"
#include <algorithm>

namespace alpenglow::accel {

namespace {

/// Calls visit(mesh, index in mesh, number) for each triangle until it returns false; returns that.
template <class F> bool eachTriangle(const LeafMaker& of, std::span<const Ref> refs, F visit) {
    uint32_t first = 0, end = 0; // numbers of the mesh
    const geometry::TriMesh* mesh = nullptr;
    for (const Ref& ref : refs) {
        const uint32_t from = ref.id(), to = from + ref.many();
        if (from < first || from >= end) {
            uint32_t shape, prim;
            of.tree.find(from, shape, prim);
            mesh = &of.shapes[shape]->mesh();
            first = from - prim;
            end = first + uint32_t(mesh->triangles());
        }
        for (uint32_t id = from; id < to; ++id)
            if (!visit(*mesh, id - first, id)) return false;
    }
    return true;
}

/// A set of vertex indices with the capacity of a leaf, excluding 0xffffffff.
class Corners {
public:
    Corners() { std::fill_n(of_, Bvh::kLeafVertices, 0xffffffffu); }
    /// Returns false if the index is new and there is no space.
    bool add(uint32_t i) {
        bool there = false;
        for (const uint32_t k : of_) there |= k == i;
        if (there) return true;
        if (n_ == Bvh::kLeafVertices) return false;
        of_[n_++] = i;
        return true;
    }

private:
    alignas(16) uint32_t of_[Bvh::kLeafVertices];
    int n_ = 0;
};

/// Returns true if the triangles certainly have few enough corners, by index in one mesh; false if unknown.
bool fewCorners(const LeafMaker& of, std::span<const Ref> refs) {
    Corners corners;
    const geometry::TriMesh* first = nullptr;
    return eachTriangle(of, refs, [&](const geometry::TriMesh& m, uint32_t t, uint32_t) {
        if (first && first != &m) return false;
        first = &m;
        const uint32_t* corner = &m.index[3 * size_t(t)];
        return corners.add(corner[0]) && corners.add(corner[1]) && corners.add(corner[2]);
    });
}

} // namespace

bool LeafMaker::fits(std::span<const Ref> refs) const {
    uint32_t n = 0;
    for (const Ref& r : refs) n += r.many();
    return n <= Bvh::kLeafTriangles && (n <= 2 || fewCorners(*this, refs) || make(refs, nullptr));
}

bool LeafMaker::make(std::span<const Ref> refs, Bvh::Leaf* out) const {
    Vec3 vertex[Bvh::kLeafVertices];
    uint32_t id[Bvh::kLeafTriangles];
    size_t n = 0, t = 0;
    uint64_t corners = 0;
    const bool fit = eachTriangle(*this, refs, [&](const geometry::TriMesh& m, uint32_t number, uint32_t name) {
        for (size_t k = 0; k < 3; ++k) {
            const Vec3& corner = m.P[m.index[3 * size_t(number) + k]];
            const auto same = [&](const Vec3& v) { return std::memcmp(&v, &corner, sizeof v) == 0; };
            const size_t v = size_t(std::find_if(vertex, vertex + n, same) - vertex);
            if (v == n) {
                if (n == Bvh::kLeafVertices) return false;
                vertex[n++] = corner;
            }
            corners |= uint64_t(v) << Bvh::Leaf::cornerAt(t, int(k));
        }
        id[t++] = name;
        return true;
    });
    if (!fit || !out) return fit;
    std::copy_n(id, t, out->id);
    out->corners = corners | uint64_t(t) << 59;
    for (size_t v = 0; v < Bvh::kLeafVertices; ++v)
        for (int a = 0; a < 3; ++a) out->p[a][v] = vertex[std::min(v, n - 1)][a];
    return true;
}

} // namespace alpenglow::accel
