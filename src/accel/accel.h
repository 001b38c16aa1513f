// Rays against shapes.
//
// Results do not depend on threads, ray order or who else is asked, on the processor or on how the tree was built: the tree
// (tree.h) only proposes candidates and overlooks none, each candidate's t and parameters are computed in double from the shape,
// and equal distances go to the lower (shape, primitive).
//
// Two levels: a shape that is geometry::Placed has a tree of its own in the space of its geometry, one for all places of that
// geometry; parts of it are leaves of the tree of all. A ray that comes to it is taken there in double, by the place at the ray's
// time; t stays what it is. What deforms has leaves whose triangles stand where they are at the ray's time.
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

inline constexpr uint32_t kNone = geometry::kNone;

/// Kinds of rays, for Ray::mask and the shapes' visibility.
enum Visibility : uint32_t { kCamera = 1, kDiffuse = 2, kSpecular = 4, kTransmission = 8, kAll = 0xffffffffu };

/// From where a ray meets surfaces with Sides 1; those with two sides it meets from both.
enum class Sides : uint8_t { Front, Back, Both };

/// Camera space. dir need not be unit; t counts in its lengths.
struct Ray {
    Vec3 org, dir;
    float tnear = 0;                                    ///< hits have t > tnear ...
    float tfar = 1e38f;                                 ///< ... and t < tfar
    float time = 0;                                     ///< of the shutter, 0 to 1
    uint32_t mask = kAll;                               ///< meets shapes whose visibility shares a bit
    uint32_t excludeShape = kNone, excludePrim = kNone; ///< a surface to pass through: one primitive; prim kNone: the whole shape
    /// Hit::distance of the excluded primitive, for a ray that goes on behind it: of what lies at one distance it has met those
    /// that come first in the order of shapes and primitives, and neighbours in the mesh, whose edge or corner it went through.
    /// Negative: it begins.
    double passed = -1;
    Sides sides = Sides::Front;
    const uint8_t* only = nullptr; ///< by shape: 0 is passed through; null: all are considered
    float level = 0.5f;            ///< meets shapes within whose levels it lies: setLevels()
};

/// What evaluateHit of the shape needs. shape == kNone: nothing was met.
struct Hit {
    float t = 0;
    uint32_t shape = kNone; ///< index into the vector the Accel was built from: the placement
    uint32_t prim = 0;
    float time = 0; ///< the ray's
    double b1 = 0, b2 = 0;
    double distance = 0; ///< t before it was rounded
    bool valid() const { return shape != kNone; }
};

using geometry::Plane;
struct DirectRays;

class Accel {
public:
    /// shapes must have been diced (geometry/dice.h); the Accel keeps them. visibility: a mask a shape, or empty for kAll.
    /// quick: Building::Quick, for frames of which few rays a facet are sent.
    /// Throws std::bad_alloc when memory is short. Other failures are reported: sound() is then false, and nothing will be met.
    Accel(std::vector<geometry::ShapeRef> shapes, std::vector<uint32_t> visibility, Diagnostics&, bool quick = false);
    ~Accel();
    bool sound() const;
    Accel(const Accel&) = delete;
    Accel& operator=(const Accel&) = delete;

    /// By shape the part of all rays that meet it: those whose level is at least `from` and below `to`. Before any ray is sent.
    struct Levels {
        float from = 0, to = 1;
    };
    void setLevels(std::vector<Levels>);

    /// Of shapes that are parts of solids (scene/solids.h) rays meet from now on only what bounds the whole. Before any ray is
    /// sent.
    void makeSolids(Diagnostics&);
    bool hasSolids() const;
    /// False: at this point of its surface (camera space) a shape bounds no whole, but lies inside of one or was taken away.
    bool keeps(uint32_t shape, const Vec3& point, const Vec3& normal, float time) const;

    /// Nearest hit. False, and hit.shape == kNone, when there is none or the ray is not finite. Thread safe.
    bool intersect(const Ray&, Hit& hit) const;
    /// Whether anything is met. Thread safe.
    bool occluded(const Ray&) const;
    /// The same for arrays; rays and results have equal length. stop: once it is set they return within some milliseconds,
    /// however many shapes a ray meets; results are void then, and those that have not been found stay what they were.
    void intersect(std::span<const Ray>, std::span<Hit>, const StopFlag* stop = nullptr) const;
    void occluded(std::span<const Ray>, std::span<uint8_t>, const StopFlag* stop = nullptr) const;

    /// intersect() for rays of which those one behind the other go about the same way, as those of a camera do: the same hits.
    void intersectTogether(std::span<const Ray>, std::span<Hit>, const StopFlag* stop = nullptr) const;

    /// Whether rays may be given in rows (directblock.h): the scene is small. Then the same for those of 16 rays whose bit is
    /// set, which begin (Ray::passed), and consider all shapes of their mask from both sides; see takesRows(Sides). time: of the
    /// shutter, by ray. Results of the others stay what they were.
    bool takesRows() const;
    bool takesRows(Sides) const; ///< of rays that say so
    void intersect(const DirectRays&, uint32_t rays, const float* time, Hit* hits) const;
    void occluded(const DirectRays&, uint32_t rays, const float* time, uint8_t* met) const;

    /// False: no point that a ray can meet, at any time of the shutter, lies in all of the half-spaces. True says nothing.
    bool reachesInto(std::span<const Plane>) const;

    const std::vector<geometry::ShapeRef>& shapes() const;
    /// The point of a hit, where it is at the hit's time.
    geometry::SurfacePoint point(const Hit& h) const {
        geometry::SurfacePoint p;
        point(h, p);
        return p;
    }
    void point(const Hit& h, geometry::SurfacePoint& out, uint32_t needs = geometry::kNeedAll) const {
        const geometry::HitRef at{h.prim, h.b1, h.b2, &out, h.time};
        shapes()[h.shape]->points({&at, 1}, needs);
    }
    /// Encloses everything.
    geometry::Bounds bounds() const;

    struct Impl; ///< accel/impl.h

private:
    std::unique_ptr<Impl> impl_;
};

/// Meeting a triangle in double: false when the line is parallel to it or the triangle has no area. b1, b2 are clamped to the
/// triangle, for candidates that are known to be hits; `outside` says by how much they had to be. wanted(t): false ends it early.
template <class Wanted>
[[gnu::always_inline]] inline bool meetTriangle(const Vec3d& org, const Vec3d& d, const Vec3d& fa, const Vec3d& fb,
                                                const Vec3d& fc, double& t, double& b1, double& b2, double& outside,
                                                Wanted wanted) {
    // Float coordinates subtract exactly or nearly so in double: the plane test keeps the side of an origin one float step away.
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
inline bool meetTriangle(const Vec3d& org, const Vec3d& d, const Vec3d& a, const Vec3d& b, const Vec3d& c, double& t, double& b1,
                         double& b2, double& outside) {
    return meetTriangle(org, d, a, b, c, t, b1, b2, outside, [](double) { return true; });
}
inline bool meetTriangle(const Vec3& org, const Vec3& dir, const Vec3& a, const Vec3& b, const Vec3& c, double& t, double& b1,
                         double& b2, double& outside) {
    return meetTriangle(Vec3d(org), Vec3d(dir), Vec3d(a), Vec3d(b), Vec3d(c), t, b1, b2, outside);
}

} // namespace alpenglow::accel
