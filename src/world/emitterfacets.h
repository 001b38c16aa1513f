// Emitters whose surface is diced: rays meet their facets, so light samples and photons begin there too. A point of the surface
// itself may lie behind a facet, which then stands in the way of its own light.
#pragma once
#include "geometry/placed.h"
#include "world/lightchooser.h"

namespace alpenglow::transport {

/// Where rays meet a point of an emitter, and the normal there: of a diced surface on its facet.
inline const Vec3& meetsAt(const geometry::SurfacePoint& p) { return p.facet != geometry::kNone ? p.displacedP : p.P; }
inline const Vec3& meetsNormal(const geometry::SurfacePoint& p) { return p.facet != geometry::kNone ? p.displacedN : p.n; }
/// Where a ray along dir leaves it, or a way against dir ends: off what rays meet.
inline Vec3 leavesFrom(const geometry::SurfacePoint& p, const Vec3& dir) {
    if (p.facet == geometry::kNone) return geometry::offsetOrigin(p, dir);
    return geometry::offsetOrigin(p.displacedP, p.displacedN, p.facetError, dir);
}

/// The normals of what rays meet of a shape. Once it is diced.
Cone normalsOf(const geometry::Shape&);

/// Points of the facets of a shape, even over their area: of what moves when the shutter opens, of what deforms over the mean of
/// its keys.
class EmitterFacets {
public:
    /// The shape whose triangles rays meet, at its first time.
    static const geometry::Shape& base(const geometry::Shape&);
    /// Whether samples are to lie on facets. Once the shape is diced.
    static bool has(const geometry::Shape&);
    explicit EmitterFacets(const geometry::Shape&);
    /// Camera space.
    double area() const { return cumulative_.empty() ? 0 : cumulative_.back(); }
    /// The point for a pair of numbers. False: it is cut away.
    bool place(Vec2 u, float time, geometry::SurfacePoint&, uint32_t needs) const;
    /// Density per unit of area, at the time of the point, with which place() gives it.
    double density(const geometry::SurfacePoint&) const;

private:
    double areaAt(uint32_t triangle, float time) const;
    double share(uint32_t t) const { return (cumulative_[t] - (t ? cumulative_[t - 1] : 0)) / area(); }

    const geometry::Shape* shape_;
    std::vector<double> cumulative_; ///< areas, by triangle
};

} // namespace alpenglow::transport
