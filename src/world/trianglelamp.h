// Near emitters of a few triangles: uniform sampling of the solid angle.
#pragma once
#include "geometry/shape.h"
#include "lanes/blocks.h"
#include "world/names.h"
#include <array>

namespace alpenglow::world {

/// An emitter of up to kMost triangles.
class TriangleLamp {
public:
    static constexpr size_t kMost = 4; ///< most triangles
    /// Whether a shape has few enough triangles. Call after dicing.
    static bool has(const geometry::Shape&);
    explicit TriangleLamp(const geometry::Shape&);

    /// Solid angle of each triangle seen from a point, and their sum.
    struct Seen {
        std::array<double, kMost> angle{}; ///< steradians
        double total = 0;                  ///< their sum
    };
    /// Returns false if the triangles are so far away that sampling by area is as good, or if one fills so much of the hemisphere
    /// that its angles are inaccurate.
    bool see(const Vec3& from, Seen&) const;
    /// Samples a point by a pair of numbers: a triangle of the mesh and the position on it.
    geometry::HitRef place(const Vec3& from, const Seen&, Vec2 u) const;
    /// The triangle that a ray from a point meets first; false: none. w: unit.
    bool meet(const Vec3& from, const Vec3& w, geometry::HitRef&) const;
    /// Whether all triangles lie in one plane, so that a ray meets one of them at most.
    bool planar() const;
    /// Whether all points are on flat triangles with one normal each, as FlatEmitter requires.
    static bool flat(const geometry::Shape&);
    /// For a flat shape.
    FlatEmitter inBlocks(const geometry::Shape&) const;

private:
    std::vector<std::array<Vec3d, 3>> triangles_;
    Vec3d centre_;
    double radius2_ = 0; ///< squared radius of a bounding sphere
};

} // namespace alpenglow::world
