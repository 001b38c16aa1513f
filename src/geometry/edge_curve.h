// Edges of surfaces as separate data. The cuts of an edge depend on this data, the camera and ShadingRate only, and are dyadic:
// surfaces with a common edge are cut at the same points, bit by bit, in any primitives and directions.
#pragma once
#include "geometry/dice.h"
#include <array>
#include <span>
#include <vector>

namespace alpenglow::geometry {

/// A curve over 0..1 in camera space. Its data is rounded to single precision, like corners of polygons, and evaluated from its
/// first end, so that at(t) in one direction and at(1 - t) in the other have the same bits for dyadic t.
class EdgeCurve {
public:
    /// The straight edge between two corners, camera space.
    static EdgeCurve line(const Vec3d& from, const Vec3d& to);
    /// Rational Bezier of any degree from 1 to limits::kNurbsOrder - 1: x, y and z times the weight, and the weight.
    static EdgeCurve bezier(std::span<const std::array<double, 4>>);
    /// centre + x cos(t sweep) + y sin(t sweep), sweep in radians. Direction is preserved.
    static EdgeCurve arc(const Vec3d& centre, const Vec3d& x, const Vec3d& y, double sweep);

    /// Point at t, 0 to 1, camera space.
    Vec3d at(double t) const { return along(reversed_ ? 1 - t : t); }
    /// The same from the first end, optionally with the first two derivatives.
    Vec3d along(double c, Vec3d* slope = nullptr, Vec3d* bend = nullptr) const;
    /// It is a line.
    bool straight() const { return kind_ == Kind::Line; }
    /// All of it is one point.
    bool collapsed() const { return collapsed_; }
    /// Minimum number of segments that keep its two sides apart: 1, or more if it turns around.
    double fewest() const { return fewest_; }
    /// It is evaluated from its other end.
    bool reversed() const { return reversed_; }

private:
    Vec3d bezierAt(double c, Vec3d* slope, Vec3d* bend) const;
    enum class Kind { Line, Bezier, Arc } kind_ = Kind::Line;
    bool reversed_ = false, collapsed_ = false, rational_ = false;
    double fewest_ = 1, sweep_ = 0;
    Vec3d a_, b_, c_;                           ///< ends of a line; centre and axes of an arc
    std::vector<std::array<double, 4>> points_; ///< of a Bezier curve, in the order in which it is evaluated
};

/// Where an edge is cut.
class EdgeCuts {
public:
    /// curves: the edge at each of its times. displaced: into micropolygons; else as finely as it bends.
    EdgeCuts(std::span<const EdgeCurve> curves, const DiceCamera&, double micropolygon, double deviation, bool displaced);
    /// For a part between dyadic positions: number of equal segments, a power of two; 0: its halves are cut separately.
    int segments(double t0, double t1) const;
    /// Increasing, from 0 to 1.
    std::vector<double> places() const;
    /// Segments longer by this factor. Edges that other primitives may share keep theirs.
    void coarsen(double by) { coarse_ *= by; }

private:
    double need(double t0, double t1) const;
    template <class Visit> bool walk(double t0, double t1, Visit&) const;
    std::span<const EdgeCurve> curves_;
    const DiceCamera& camera_;
    double edge_, deviation_, coarse_ = 1;
    bool displaced_;
};

} // namespace alpenglow::geometry
