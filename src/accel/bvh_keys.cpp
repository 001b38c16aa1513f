// Trees over several times, and their parts.
#include "accel/bvh_boxes.h"
#include "base/parallel.h"

namespace alpenglow::accel {

/// Stores the vertices of a leaf at all keys, and its boxes at both ends of the shutter: interpolated boxes contain it in
/// between.
void Bvh::followLeaf(size_t leaf, std::span<const geometry::ShapeRef> keys, std::span<const float> times, Box& first, Box& last) {
    const Leaf& f = leaves_[leaf];
    const geometry::TriMesh& mesh = keys[0]->mesh();
    uint32_t which[kLeafVertices] = {};
    bool known[kLeafVertices] = {}, loose = false;
    const auto place = [&](size_t key, uint32_t v) -> const Vec3& { return keys[key]->mesh().P[v]; };
    for (uint32_t t = 0; t < f.size(); ++t)
        for (int c = 0; c < 3; ++c) {
            const uint32_t v = f.vertex(t, c), at = mesh.index[3 * size_t(f.id[t]) + size_t(c)];
            if (!known[v]) known[v] = true, which[v] = at;
            for (size_t k = 0; k < keys.size() && at != which[v]; ++k) loose |= !(place(k, at) == place(k, which[v]));
        }
    for (uint32_t v = 0; v < kLeafVertices; ++v)
        if (!known[v]) which[v] = which[0];
    loose_[leaf] = loose;
    std::vector<Box> box(keys.size());
    for (size_t k = 0; k < keys.size(); ++k) {
        for (uint32_t v = 0; v < kLeafVertices; ++v)
            for (int a = 0; a < 3; ++a) moved_[leaf * keys.size() + k].p[a][v] = place(k, which[v])[a];
        for (uint32_t t = 0; t < f.size(); ++t)
            for (size_t c = 0; c < 3; ++c) {
                const Vec3& p = place(k, mesh.index[3 * size_t(f.id[t]) + c]);
                box[k].add(Four{p.x, p.y, p.z, 0}, Four{p.x, p.y, p.z, 0});
            }
    }
    first = box.front();
    last = box.back();
    const Four none{};
    for (size_t k = 1; k + 1 < keys.size(); ++k) {
        const float w = times[k];
        const Four below = most(first.lo * (1 - w) + last.lo * w - box[k].lo, none),
                   above = most(box[k].hi - first.hi * (1 - w) - last.hi * w, none);
        first.lo -= below, last.lo -= below;
        first.hi += above, last.hi += above;
    }
}

void Bvh::followKeys(std::span<const geometry::ShapeRef> keys, std::span<const float> times) {
    const size_t n = leaves_.size();
    keys_ = keys.size();
    moved_.resize(n * keys.size());
    loose_.resize(n);
    struct Ends {
        Box first, last;
    };
    std::vector<Ends> leaf(n), node(nodes_.size());
    parallelFor(size_t(0), n, [&](size_t i) { followLeaf(i, keys, times, leaf[i].first, leaf[i].last); });
    last_.resize(nodes_.size());
    for (size_t i = nodes_.size(); i-- > 0;) { // children come after their parents
        Box first[kWidth], last[kWidth];
        int count = 0;
        for (; count < kWidth && nodes_[i].child[count] != kNothing; ++count) {
            const Child c = nodes_[i].child[count];
            const Ends& e = c & kLeaf ? leaf[c & kIndex] : node[c];
            first[count] = e.first;
            last[count] = e.last;
            node[i].first.add(e.first);
            node[i].last.add(e.last);
        }
        Node at = nodes_[i];
        for (int side = 0; side < 2; ++side) {
            Node& out = side ? last_[i] : nodes_[i];
            setBoxes(out, side ? node[i].last : node[i].first, {side ? last : first, size_t(count)});
            std::copy_n(at.child, kWidth, out.child);
        }
    }
    for (const geometry::ShapeRef& k : keys)
        for (const Vec3& p : k->mesh().P)
            if (!Bvh::reaches(p)) extent_ = std::max({extent_, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

std::vector<std::pair<Bvh::Child, geometry::Bounds>> Bvh::opened(size_t most) const {
    std::vector<std::pair<Child, geometry::Bounds>> out{{0, bounds_}};
    if (lastNodes()) return out;
    const auto area = [](const geometry::Bounds& b) {
        const Vec3d d = Vec3d(b.hi) - Vec3d(b.lo);
        return d.x * d.y + d.y * d.z + d.z * d.x;
    };
    for (;;) {
        size_t largest = out.size();
        for (size_t i = 0; i < out.size(); ++i)
            if (!(out[i].first & kLeaf) && (largest == out.size() || area(out[i].second) > area(out[largest].second)))
                largest = i;
        if (largest == out.size()) return out;
        const Node& n = nodes_[out[largest].first];
        const long children = std::count_if(n.child, n.child + kWidth, [](Child c) { return c != kNothing; });
        if (out.size() + size_t(children) - 1 > most) return out;
        out.erase(out.begin() + long(largest));
        for (int k = 0; k < kWidth; ++k) {
            if (n.child[k] == kNothing) continue;
            geometry::Bounds b;
            for (int a = 0; a < 3; ++a) {
                const double origin = double(n.origin[a]), scale = double(n.scale[a]);
                b.lo[a] = std::nextafter(float(origin + scale * n.q[0][a][k]), -INFINITY);
                b.hi[a] = std::nextafter(float(origin + scale * n.q[1][a][k]), INFINITY);
            }
            out.emplace_back(n.child[k], b);
        }
    }
}

} // namespace alpenglow::accel
