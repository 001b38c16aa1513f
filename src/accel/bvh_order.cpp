// Order of the children of nodes. Occlusion rays visit them from last to first, others by distance.
#include "accel/bvh.h"
#include <algorithm>

namespace alpenglow::accel {

namespace {

/// Half the surface area of a child's box.
double halfAreaOf(const Bvh::Node& n, int k) {
    double d[3];
    for (int a = 0; a < 3; ++a) d[a] = double(n.scale[a]) * (n.q[1][a][k] - n.q[0][a][k]);
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

double areaOf(const Bvh::Leaf& f) {
    double sum = 0;
    for (uint32_t t = 0; t < f.size(); ++t) {
        const Vec3d a(f.point(f.vertex(t, 0)));
        sum += 0.5 * length(cross(Vec3d(f.point(f.vertex(t, 1))) - a, Vec3d(f.point(f.vertex(t, 2))) - a));
    }
    return sum;
}

void permute(Bvh::Node& n, const int* order, int many) {
    const Bvh::Node was = n;
    for (int k = 0; k < many; ++k) {
        n.child[k] = was.child[order[k]];
        for (int side = 0; side < 2; ++side)
            for (int a = 0; a < 3; ++a) n.q[side][a][k] = was.q[side][a][order[k]];
    }
}

} // namespace

void Bvh::orderChildren() {
    // By surface area per box area: expected number of hits of a ray through the box. Children of large meshes are similar, and
    // sorting would take a tenth of construction.
    constexpr size_t kMost = 65536;
    if (nodes_.size() > kMost) return;
    std::vector<double> area(nodes_.size());
    for (size_t i = nodes_.size(); i-- > 0;) { // children come after their parents
        Node& n = nodes_[i];
        double much[kWidth] = {};
        int order[kWidth], many = 0;
        for (; many < kWidth && n.child[many] != kNothing; ++many) {
            const Child c = n.child[many];
            const double half = halfAreaOf(n, many), own = !(c & kLeaf) ? area[c]
                                                           : c & kExact ? half
                                                                        : areaOf(leaves_[c & kIndex]);
            area[i] += own;
            much[many] = half > 0 && own >= 0 ? own / half : 0;
            order[many] = many;
        }
        std::stable_sort(order, order + many, [&](int a, int b) { return much[a] < much[b]; });
        permute(n, order, many);
    }
}

} // namespace alpenglow::accel
