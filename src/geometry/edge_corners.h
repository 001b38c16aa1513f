// Corners of displaced primitives that lie within a straight edge of another one: it is cut there, so that one long edge
// meets several short ones at the same points to the bit.
#pragma once
#include "base/vec.h"
#include <map>
#include <span>
#include <vector>

namespace alpenglow::geometry {

class EdgeCorners {
public:
    /// A corner on an edge: where along it, from 0 to 1, and the corner.
    struct On {
        double t;
        Vec3 P;
    };
    /// with: DiceOptions::seamWith of whose corners these are.
    void add(const std::vector<double>& with, std::span<const Vec3> corners);
    /// After the last add().
    void finish();
    /// Those strictly within the edge from a to b, by place, as far as rounding lets tell; places 2^-18 apart or less count
    /// as one. Thread safe.
    std::vector<On> within(const std::vector<double>& with, const Vec3d& a, const Vec3d& b) const;

private:
    using Points = std::vector<Vec3>; ///< a tree: the middle of each part divides it by an axis, the first by x
    static void divide(std::span<Vec3>, int axis);
    static void collect(std::span<const Vec3>, int axis, const Vec3& lo, const Vec3& hi, std::vector<Vec3>& out);
    std::map<std::vector<double>, Points> points_;
};

} // namespace alpenglow::geometry
