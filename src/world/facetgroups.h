// Light samples on meshes and diced shapes by what the lit point sees of them: facets are grouped by place and direction, and a
// group is chosen by its area, distance and cosine. Half of the samples of a closed mesh would face away otherwise.
#pragma once
#include "geometry/shape.h"
#include "world/names.h"
#include <array>
#include <vector>

namespace alpenglow::world {

/// The groups of one shape.
class FacetGroups {
public:
    /// Whether a shape has facets to be grouped: a mesh, or a diced shape, that does not move. Call after dicing.
    static bool has(const geometry::Shape&);
    /// bothSides: light of either side may be seen, as through a transparent surface or in a solid.
    FacetGroups(const geometry::Shape&, bool bothSides);
    /// Which side light leaves from: 1: that of the normal, -1: the opposite one, 0: both.
    void shinesTo(int side);
    /// Samples a point for a lit one by a pair of numbers in [0, 1); returns its density().
    double place(const Vec3& from, Vec2 u, float time, geometry::SurfacePoint&, uint32_t needs) const;
    /// Density of place() per unit of area; 0: not a point of this shape.
    double density(const geometry::SurfacePoint&, const Vec3& from) const;

private:
    static constexpr int kGroups = 32;
    using Row = std::array<float, kGroups>;
    struct Builder;
    /// Weights of the groups as seen from a point; returns their sum.
    float weigh(const Vec3& from, Row& weights) const;
    double densityOf(size_t group, const Row& weights, float sum) const;

    const geometry::Shape* shape_;
    bool bothSides_, closed_ = false;
    float outward_ = 1;                   ///< closed_: the side of the normal, or -1, that is outside
    float side_ = 1;                      ///< normals times this are the directions in which light leaves
    bool either_ = true;                  ///< light leaves in the opposite directions, too
    float floor_ = 0;                     ///< what a group gets that cannot be seen by these rules
    Row centre_[3] = {}, normal_[3] = {}; ///< means of the groups
    Row radius2_ = {}, spread_ = {};      ///< squared radius of the centres; sine of the angle between normals and their mean
    Row area_ = {};
    std::vector<uint8_t> groupOf_;   ///< by facet
    std::vector<uint32_t> order_;    ///< facets, group after group and strip after strip
    std::vector<double> cumulative_; ///< area of the facets of a strip up to and including each, in the order of order_
    /// A part of a group across its first coordinate, whose facets follow each other in the second: the two numbers of a sample
    /// choose strip and facet, so that sets of samples cover a group evenly.
    struct Strip {
        size_t first, end; ///< in order_
        double until;      ///< area of the group's strips up to and including this one
    };
    std::vector<Strip> strips_;
    std::array<size_t, kGroups + 1> firstStrip_ = {};
};

} // namespace alpenglow::world
