#include "geometry/seams.h"
#include <algorithm>
#include <tuple>

namespace alpenglow::geometry {

void Seams::add(TriMesh& mesh, std::vector<uint32_t> vertex, std::vector<Vec3> flat, uint32_t order,
                const std::vector<double>& with) {
    const std::lock_guard lock(mutex_);
    borders_.push_back({&mesh, std::move(vertex), std::move(flat), order, with});
}

void Seams::drop(const TriMesh& mesh) {
    const std::lock_guard lock(mutex_);
    std::erase_if(borders_, [&](const Border& b) { return b.mesh == &mesh; });
}

void Seams::close() {
    std::sort(borders_.begin(), borders_.end(),
              [](const Border& a, const Border& b) { return std::tie(a.with, a.order) < std::tie(b.with, b.order); });
    for (size_t i = 0, j; i < borders_.size(); i = j) {
        for (j = i + 1; j < borders_.size() && borders_[j].with == borders_[i].with;) ++j;
        closeAmong({borders_.data() + i, j - i});
    }
    borders_.clear();
}

void Seams::closeAmong(std::span<Border> all) {
    struct Point {
        Vec3 flat;
        uint32_t border, vertex;
        auto place() const { return std::tie(flat.x, flat.y, flat.z); }
    };
    std::vector<Point> points;
    for (uint32_t b = 0; b < all.size(); ++b)
        for (size_t k = 0; k < all[b].vertex.size(); ++k)
            points.push_back({all[b].flat[k] + Vec3(0.f), b, all[b].vertex[k]}); // -0 is 0
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
        return a.place() != b.place() ? a.place() < b.place() : std::tie(a.border, a.vertex) < std::tie(b.border, b.vertex);
    });
    const auto moved = [&](size_t k) -> Vec3& { return all[points[k].border].mesh->P[points[k].vertex]; };
    for (size_t i = 0, j; i < points.size(); i = j) {
        Vec3d sum(moved(i));
        bool same = true;
        for (j = i + 1; j < points.size() && points[j].place() == points[i].place(); ++j) {
            sum = sum + Vec3d(moved(j));
            same &= moved(j) == moved(i);
        }
        if (same) continue;
        const Vec3 middle(sum / double(j - i));
        for (size_t k = i; k < j; ++k) moved(k) = middle;
    }
}

} // namespace alpenglow::geometry
