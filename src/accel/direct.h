// Tiny scenes without a tree: tests all triangles in float, several at a time; possible hits are then intersected in double.
// Faster than a hierarchy for up to two dozen triangles.
#pragma once
#include "geometry/shape.h"
#include <span>
#include <vector>

namespace alpenglow::accel {

struct Ray;
struct DirectScene;

/// The triangles of a tiny scene.
class DirectTriangles {
public:
    static constexpr size_t kMost = 24; ///< triangles; with more the tree is faster

    /// A triangle, and whose it is.
    struct Triangle {
        Vec3 a, b, c;         ///< corners, camera space
        uint32_t shape, prim; ///< indices of the shape, and of the triangle in it
    };
    /// Adds a triangle; the caller adds at most kMost.
    void add(const Triangle&);
    /// Number of triangles.
    size_t size() const { return size_; }
    /// Triangle i, 0 <= i < size(), in the order of add().
    const Triangle& operator[](size_t i) const { return triangles_[i]; }
    void copyTo(DirectScene&) const; ///< copies all of them, for block searches (accel/directblock.h)

    /// Lower bound of t for the hit on triangle i, in lengths of dir; valid for `candidates`.
    static constexpr size_t kWidest = 16, kRoom = (kMost + kWidest - 1) / kWidest * kWidest;
    using Near = float[kRoom];
    /// Bit i: the ray may hit triangle i between its tnear and tfar. Conservative: bounds are widened by more than the float
    /// error.
    uint32_t candidates(const Ray& r, Near& near) const { return find_(*this, r, near); }
    /// The argument `error` of planeT() for a ray from org.
    double planeError(const Vec3d& org) const {
        return 1e-13 * (double(extent_) + std::fabs(org.x) + std::fabs(org.y) + std::fabs(org.z));
    }
    /// t at the plane of triangle i, in double, and a bound on its error; infinite or NaN in the plane itself.
    double planeT(size_t i, const Vec3d& org, const Vec3d& dir, double error, double& margin) const {
        double inverse = 1 / dot(planes_[i].n, dir), t = (planes_[i].d - dot(planes_[i].n, org)) * inverse;
        margin = std::fabs(inverse) * error + 1e-13 * std::fabs(t);
        return t;
    }

private:
    /// Plane n.p = d, and the two barycentric weights as linear functions of the point, with their slopes. By component, then
    /// triangle.
    struct alignas(64) Rows {
        float n[3][kRoom], d[kRoom], u[3][kRoom], u0[kRoom], v[3][kRoom], v0[kRoom], slope[kRoom];
    };
    Rows rows_{};
    /// Versions for four, eight and sixteen lanes, by processor. All give the same bits.
    using Find = uint32_t (*)(const DirectTriangles&, const Ray&, Near&);
    template <int Lanes> struct Search;
    static uint32_t findFour(const DirectTriangles&, const Ray&, Near&);
    static uint32_t findEight(const DirectTriangles&, const Ray&, Near&);
    static uint32_t findSixteen(const DirectTriangles&, const Ray&, Near&);
    Find find_ = choose();
    static Find choose();
    struct Plane {
        Vec3d n;
        double d;
    };
    std::vector<Triangle> triangles_;
    size_t size_ = 0; ///< of triangles_
    std::vector<Plane> planes_;
    float extent_ = 0; ///< largest 1-norm of a corner
};

} // namespace alpenglow::accel
