// Ray intersection with shapes.
//
// Results do not depend on threads, order of rays, other rays, processor, or the way the tree was built: the tree (bvh.h) only
// proposes candidates and misses none, t and parameters of each candidate are computed in double from the shape, and ties go to
// the lower (shape, primitive).
//
// Two levels: a geometry::Placed shape has a tree in the space of its geometry, shared by all instances; parts of it are leaves
// of the top-level tree. A ray that reaches one is transformed in double to that space at the ray's time; t is preserved.
// Deforming shapes have leaves whose triangles are interpolated to the ray's time.
#pragma once
#include "base/diagnostics.h"
#include "base/stopflag.h"
#include "geometry/plane.h"
#include "geometry/shape.h"
#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

namespace alpenglow::accel {

inline constexpr uint32_t kNone = geometry::kNone; ///< no shape, or no primitive

/// Kinds of rays, for Ray::mask and visibility of shapes.
enum Visibility : uint32_t { kCamera = 1, kDiffuse = 2, kSpecular = 4, kTransmission = 8, kAll = 0xffffffffu };

/// The side from which a ray hits surfaces with Sides 1; two-sided surfaces are hit from both.
enum class Sides : uint8_t { Front, Back, Both };

/// A ray in camera space. dir need not be unit; t is in units of its length.
struct Ray {
    Vec3 org, dir;                                      ///< camera space
    float tnear = 0;                                    ///< hits have t > tnear ...
    float tfar = 1e38f;                                 ///< ... and t < tfar
    float time = 0;                                     ///< of the shutter, 0 to 1
    uint32_t mask = kAll;                               ///< hits shapes whose visibility shares a bit
    uint32_t excludeShape = kNone, excludePrim = kNone; ///< a surface to ignore: one primitive; prim kNone: the complete shape
    /// Hit::distance of the excluded primitive, for a ray that continues behind it: at equal distance it has passed the surfaces
    /// that come first in the order of shapes and primitives, and neighbours in the mesh whose common edge or corner it hit.
    /// Negative: a new ray.
    double passed = -1;
    Sides sides = Sides::Front;
    const uint8_t* only = nullptr; ///< by shape: 0 is ignored; null: all are considered
    float level = 0.5f;            ///< hits shapes whose interval of levels contains it: setLevels()
};

/// Input for the shape's evaluateHit. shape == kNone: no hit.
struct Hit {
    float t = 0;            ///< distance in lengths of Ray::dir, rounded to float
    uint32_t shape = kNone; ///< index in the shapes of the Accel: the instance
    uint32_t prim = 0;      ///< index of the primitive in the shape
    float time = 0;         ///< of the ray
    double b1 = 0, b2 = 0;  ///< the shape's coordinates of the hit: barycentric weights of a triangle, else its own parameters
    double distance = 0;    ///< t before rounding
    /// Whether something was hit.
    bool valid() const { return shape != kNone; }
};

using geometry::Plane;
struct DirectRays;

/// The acceleration structure over all shapes of a world, and the rules of what counts as a hit. Results do not depend on the
/// tree, the lanes or the order of rays.
class Accel {
public:
    /// shapes must have been diced (geometry/dice.h); the Accel keeps them. visibility: a mask for each shape, or empty for kAll.
    /// quick: Building::Quick, for frames with few rays per facet. Throws std::bad_alloc if memory is short. Other failures are
    /// reported: sound() is then false, and no ray hits anything.
    Accel(std::vector<geometry::ShapeRef> shapes, std::vector<uint32_t> visibility, Diagnostics&, bool quick = false);
    ~Accel();
    /// Whether it could be built.
    bool sound() const;
    Accel(const Accel&) = delete;
    Accel& operator=(const Accel&) = delete;

    /// By shape: levels of the rays that hit it, from `from` (included) to `to` (excluded). Set before tracing.
    struct Levels {
        float from = 0, to = 1;
    };
    /// One for each shape.
    void setLevels(std::vector<Levels>);

    /// Restricts hits on parts of CSG solids (scene/solids.h) to the boundary of the solid. Call before tracing.
    void makeSolids(Diagnostics&);
    /// Whether some shape is a part of a solid, so that keeps() may be false.
    bool hasSolids() const;
    /// Returns false if the shape's surface at this point (camera space) is not part of a solid's boundary.
    bool keeps(uint32_t shape, const Vec3& point, const Vec3& normal, float time) const;

    /// Nearest hit. Returns false, with hit.shape == kNone, without a hit or if the ray is not finite. Thread safe.
    bool intersect(const Ray&, Hit& hit) const;
    /// Whether the ray hits anything. Thread safe.
    bool occluded(const Ray&) const;
    /// The same for arrays; rays and results have equal length. stop: once set, the call returns within some milliseconds,
    /// however many shapes a ray hits; results are then undefined or unchanged.
    void intersect(std::span<const Ray>, std::span<Hit>, const StopFlag* stop = nullptr) const;
    /// occluded() for each ray: 1 or 0.
    void occluded(std::span<const Ray>, std::span<uint8_t>, const StopFlag* stop = nullptr) const;

    /// intersect() for rays of which consecutive ones are coherent, such as camera rays: the same hits.
    void intersectTogether(std::span<const Ray>, std::span<Hit>, const StopFlag* stop = nullptr) const;

    /// Whether rays can be given in rows (directblock.h), i.e. the scene is small. nearest and any hits for those of 16 rays
    /// whose bit is set; these must be new rays (Ray::passed), and consider all shapes of their mask from both sides; see
    /// takesRows(Sides). time: of the shutter, by ray. Results of other rays are unchanged.
    bool takesRows() const;
    bool takesRows(Sides) const; ///< for rays with this value
    /// The searches for a block: fill hits[i], or met[i] with 1 or 0, for each bit i of `rays`. Only while takesRows().
    void intersect(const DirectRays&, uint32_t rays, const float* time, Hit* hits) const;
    void occluded(const DirectRays&, uint32_t rays, const float* time, uint8_t* met) const;

    /// Returns false if no point that a ray can hit, at any time of the shutter, is in all of the half-spaces. True means
    /// unknown.
    bool reachesInto(std::span<const Plane>) const;

    /// As given to the constructor.
    const std::vector<geometry::ShapeRef>& shapes() const;
    /// The surface point of a hit, at the hit's time.
    geometry::SurfacePoint point(const Hit& h) const {
        geometry::SurfacePoint p;
        point(h, p);
        return p;
    }
    /// The same in place; `needs`: geometry::PointNeed, what is to be computed.
    void point(const Hit& h, geometry::SurfacePoint& out, uint32_t needs = geometry::kNeedAll) const {
        const geometry::HitRef at{h.prim, h.b1, h.b2, &out, h.time};
        shapes()[h.shape]->points({&at, 1}, needs);
    }
    /// Bounding box of everything.
    geometry::Bounds bounds() const;

    struct Impl; ///< accel/impl.h

private:
    std::unique_ptr<Impl> impl_;
};

/// Intersects a triangle in double: returns false if the line is parallel to it or the triangle has no area. b1, b2 are clamped
/// to the triangle, for candidates known to be hits; `outside`: by how much. wanted(t): returns false to stop early.
template <class Wanted>
[[gnu::always_inline]] inline bool intersectTriangle(const Vec3d& org, const Vec3d& d, const Vec3d& fa, const Vec3d& fb,
                                                     const Vec3d& fc, double& t, double& b1, double& b2, double& outside,
                                                     Wanted wanted) {
    // Differences of float coordinates are exact or nearly so in double: the plane test is correct for an origin one float step
    // off the plane.
    Vec3d a = fa - org, b = fb - org, c = fc - org;
    Vec3d e1 = b - a, e2 = c - a, n = cross(e1, e2);
    double den = dot(n, d);
    if (!(std::fabs(den) > 0)) return false;
    t = dot(n, a) / den;
    if (!wanted(t)) return false;
    // Moeller-Trumbore weights, relative to corner a.
    Vec3d q = cross(a, d);
    b1 = dot(q, e2) / den;
    b2 = -dot(q, e1) / den;
    if (!std::isfinite(t) || !std::isfinite(b1) || !std::isfinite(b2)) return false;
    outside = std::max({0.0, -b1, -b2, b1 + b2 - 1});
    b1 = std::clamp(b1, 0.0, 1.0);
    b2 = std::clamp(b2, 0.0, 1.0);
    if (b1 + b2 > 1) {
        double s = b1 + b2;
        b1 /= s;
        b2 /= s;
    }
    return true;
}
/// The same for every t.
inline bool intersectTriangle(const Vec3d& org, const Vec3d& d, const Vec3d& a, const Vec3d& b, const Vec3d& c, double& t,
                              double& b1, double& b2, double& outside) {
    return intersectTriangle(org, d, a, b, c, t, b1, b2, outside, [](double) { return true; });
}
/// The same for points in float.
inline bool intersectTriangle(const Vec3& org, const Vec3& dir, const Vec3& a, const Vec3& b, const Vec3& c, double& t,
                              double& b1, double& b2, double& outside) {
    return intersectTriangle(Vec3d(org), Vec3d(dir), Vec3d(a), Vec3d(b), Vec3d(c), t, b1, b2, outside);
}

} // namespace alpenglow::accel
