// Lamps of a few triangles, near by: points that are even in the solid angle which they fill.
#pragma once
#include "geometry/shape.h"
#include "lanes/blocks.h"
#include <array>

namespace alpenglow::transport {

class TriangleLamp {
public:
    static constexpr size_t kMost = 4;
    /// Whether the triangles that rays meet of a shape are so few. Once it is diced.
    static bool has(const geometry::Shape&);
    explicit TriangleLamp(const geometry::Shape&);

    /// The triangles as seen from a point: the solid angle of each, and of all.
    struct Seen {
        std::array<double, kMost> angle{};
        double total = 0;
    };
    /// False: they are so far away that points even in area are as good, or a triangle fills so much of what can be seen that
    /// its angles say too little.
    bool see(const Vec3& from, Seen&) const;
    /// The point for a pair of numbers: a triangle of the mesh and the place on it.
    geometry::HitRef place(const Vec3& from, const Seen&, Vec2 u) const;
    /// Whether each of its points is that of a flat triangle with a normal of its own: what FlatEmitter holds.
    static bool flat(const geometry::Shape&);
    /// Of a flat one.
    FlatEmitter inBlocks(const geometry::Shape&) const;

private:
    std::vector<std::array<Vec3d, 3>> triangles_;
    Vec3d centre_;
    double radius2_ = 0; ///< of a ball about all, squared
};

} // namespace alpenglow::transport
