#include "world/emitterfacets.h"
#include <algorithm>

namespace alpenglow::world {

using geometry::Placed;
using geometry::Shape;

namespace {
double areaOf(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return .5 * length(cross(b - a, c - a)); }

/// Whether the facets are exactly the surface; then sampling avoids the parts that are cut away.
bool flat(const Shape& s) {
    for (uint32_t t = 0; t < s.mesh().triangles(); ++t) {
        const geometry::SurfacePoint p = s.evaluateHit(t, 1 / 3., 1 / 3.);
        if (p.displaced || length(p.displacedP - p.P) > 4 * (p.facetError + geometry::roundingError(p.P))) return false;
    }
    return true;
}
} // namespace

Cone normalsOf(const Shape& s) {
    if (s.placed()) return {}; // it may rotate
    if (s.exact()) return s.kind() == "Disk" ? Cone{s.evaluate(0, .5, .5).n, 1} : Cone();
    const uint32_t n = s.mesh().triangles();
    Vec3d sum(0.0);
    for (uint32_t t = 0; t < n; ++t)
        if (const Vec3d k = s.hitNormal(t, 1 / 3., 1 / 3.); dot(k, k) > 0) sum += normalize(k);
    if (!(dot(sum, sum) > 0)) return {};
    const Vec3d axis = normalize(sum);
    double least = 1;
    for (uint32_t t = 0; t < n; ++t)
        if (const Vec3d k = s.hitNormal(t, 1 / 3., 1 / 3.); dot(k, k) > 0) least = std::min(least, dot(normalize(k), axis));
    return {Vec3(axis), float(std::max(least - 1e-6, -1.0))};
}

const Shape& EmitterFacets::base(const Shape& s) {
    const Placed* p = s.placed();
    return !p ? s : p->deforming() ? *p->deforming()->keys()[0] : *p->geometry();
}

bool EmitterFacets::has(const Shape& s) {
    const Shape& b = base(s);
    return b.diced() && b.mesh().triangles() > 0 && !(b.trimmed() && !s.placed() && flat(b));
}

EmitterFacets::EmitterFacets(const Shape& s) : shape_(&s) {
    const Placed* placed = s.placed();
    const geometry::Deforming* deforming = placed ? placed->deforming() : nullptr;
    const geometry::Affine out = placed ? placed->fromGeometry(0) : geometry::Affine();
    const size_t keys = deforming ? deforming->keys().size() : 1;
    const uint32_t n = base(s).mesh().triangles();
    double sum = 0;
    for (uint32_t t = 0; t < n; ++t) {
        for (size_t k = 0; k < keys; ++k) {
            const geometry::TriMesh& m = deforming ? deforming->keys()[k]->mesh() : base(s).mesh();
            Vec3d c[3];
            for (size_t i = 0; i < 3; ++i) {
                c[i] = Vec3d(m.P[m.index[3 * size_t(t) + i]]);
                if (placed) c[i] = out.point(c[i]);
            }
            sum += areaOf(c[0], c[1], c[2]) / double(keys);
        }
        cumulative_.push_back(sum);
    }
}

bool EmitterFacets::place(Vec2 u, float time, geometry::SurfacePoint& point, uint32_t needs) const {
    const double at = double(u.x) * area();
    const size_t t = size_t(std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, at) - cumulative_.begin());
    const double before = t ? cumulative_[t - 1] : 0, width = cumulative_[t] - before;
    // The rest of the number gives the position on the facet; the root makes it uniform over a triangle.
    const double side = std::sqrt(width > 0 ? std::clamp((at - before) / width, 0.0, 1.0) : 0.5);
    const geometry::HitRef hit{uint32_t(t), side * (1 - double(u.y)), side * double(u.y), &point, time};
    if (const Shape& b = base(*shape_); b.trimmed() && !b.keepsHit(hit.prim, hit.b1, hit.b2)) return false;
    shape_->points({&hit, 1}, needs);
    return true;
}

double EmitterFacets::areaAt(uint32_t triangle, float time) const {
    const Placed& placed = *shape_->placed();
    Vec3d c[3];
    if (const geometry::Deforming* deforming = placed.deforming()) {
        deforming->corners(triangle, time, c);
    } else {
        const geometry::TriMesh& m = placed.geometry()->mesh();
        for (size_t i = 0; i < 3; ++i) c[i] = Vec3d(m.P[m.index[3 * size_t(triangle) + i]]);
    }
    const geometry::Affine out = placed.fromGeometry(time);
    return areaOf(out.point(c[0]), out.point(c[1]), out.point(c[2]));
}

double EmitterFacets::density(const geometry::SurfacePoint& p) const {
    if (!shape_->placed()) return 1 / area();
    if (p.facet >= cumulative_.size()) return 0;
    const double now = areaAt(p.facet, p.time);
    return now > 0 ? share(p.facet) / now : 0;
}

} // namespace alpenglow::world
