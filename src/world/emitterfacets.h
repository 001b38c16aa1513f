// Diced emitters: rays hit their facets, so light samples and photons start there, too. A point of the undiced surface can lie
// behind a facet, which would block its light.
#pragma once
#include "geometry/placed.h"
#include "world/lightchooser.h"

namespace alpenglow::world {

/// Where rays hit a point of an emitter: on its facet if it is diced.
inline const Vec3& intersectsAt(const geometry::SurfacePoint& p) { return p.facet != geometry::kNone ? p.displacedP : p.P; }
/// The normal of the surface there, unit.
inline const Vec3& intersectsNormal(const geometry::SurfacePoint& p) { return p.facet != geometry::kNone ? p.displacedN : p.n; }
/// Origin of a ray along dir, or end of a ray against dir: offset from the surface that rays hit.
inline Vec3 leavesFrom(const geometry::SurfacePoint& p, const Vec3& dir) {
    if (p.facet == geometry::kNone) return geometry::offsetOrigin(p, dir);
    return geometry::offsetOrigin(p.displacedP, p.displacedN, p.facetError, dir);
}

/// Bound of the normals of a shape's facets. Call after dicing.
Cone normalsOf(const geometry::Shape&);

/// Uniform samples on the facets of a shape; for moving shapes at shutter open, for deforming shapes by the mean over the keys.
class EmitterFacets {
public:
    /// The shape whose triangles rays hit, at its first time.
    static const geometry::Shape& base(const geometry::Shape&);
    /// Whether samples must lie on facets. Call after dicing.
    static bool has(const geometry::Shape&);
    explicit EmitterFacets(const geometry::Shape&);
    /// Camera space.
    double area() const { return cumulative_.empty() ? 0 : cumulative_.back(); }
    /// Samples a point by a pair of numbers. Returns false if it is cut away.
    bool place(Vec2 u, float time, geometry::SurfacePoint&, uint32_t needs) const;
    /// Density of place() per unit of area, at the time of the point.
    double density(const geometry::SurfacePoint&) const;

private:
    double areaAt(uint32_t triangle, float time) const;
    double share(uint32_t t) const { return (cumulative_[t] - (t ? cumulative_[t - 1] : 0)) / area(); }

    const geometry::Shape* shape_;
    std::vector<double> cumulative_; ///< cumulative areas, by triangle
};

} // namespace alpenglow::world
