// Corners of displaced primitives on a straight edge of another one: the edge is cut there, so that one long edge shares points
// with several short ones, bit by bit.
#pragma once
#include "base/vec.h"
#include <map>
#include <span>
#include <vector>

namespace alpenglow::geometry {

/// Collects corners, then finds those on an edge.
class EdgeCorners {
public:
    /// A corner on an edge: where along it, from 0 to 1, and the corner.
    struct On {
        double t; ///< 0 to 1
        Vec3 P;   ///< camera space
    };
    /// with: DiceOptions::seamWith of the corners.
    void add(const std::vector<double>& with, std::span<const Vec3> corners);
    /// After the last add().
    void finish();
    /// The corners strictly within the edge from a to b, by position, within rounding; positions at most 2^-18 apart count as
    /// one. Thread safe.
    std::vector<On> within(const std::vector<double>& with, const Vec3d& a, const Vec3d& b) const;

private:
    using Points = std::vector<Vec3>; ///< a k-d tree: the median of each range divides it, the first by x
    static void divide(std::span<Vec3>, int axis);
    static void collect(std::span<const Vec3>, int axis, const Vec3& lo, const Vec3& hi, std::vector<Vec3>& out);
    std::map<std::vector<double>, Points> points_;
};

} // namespace alpenglow::geometry
