// Curves (RISpec 3.2, 5.5): what their shape, its bounds and its two kinds of surface share. Object space, double.
//
// A ribbon is C(v) + (2u - 1) h(v) B(v) with the half width h and B across the curve: along dC/dv ^ N, N being the variable "N"
// or what the ribbon faces. A tube is swept by circles of radius h across the curve. v runs along a curve, within a segment it is
// called f.
#pragma once
#include "geometry/bernstein.h"
#include "geometry/shape.h"
#include <algorithm>
#include <mutex>
#include <optional>

namespace alpenglow::geometry {

/// A value along a curve and its first two derivatives by f.
struct Jet {
    Vec3d f, d, dd; ///< value, first and second derivative
};
/// A number with its first and second derivative by v.
struct ScalarJet {
    double f = 0, d = 0, dd = 0; ///< value, first and second derivative
};
/// The product, by the product rule.
Jet cross(const Jet&, const Jet&);
Jet operator*(const ScalarJet&, const Jet&);
/// The sum.
Jet operator+(const Jet&, const Jet&);
/// Unit vectors; of a vanishing one zero.
Jet unit(const Jet&);

/// One segment, prepared for intersection or evaluation.
struct CurveSegment {
    bool linear = false; ///< from P0 to P1; else cubic
    Vec3d p[4]; ///< cubic: Bezier points. Linear: the point before it, its ends, the point behind it (an end again where there is
                ///< none)
    double h[4]; ///< half widths: cubic in Bernstein form; linear: at the ends, [0] and [1]. Not negative
    Vec3d n[4];  ///< the same of the variable "N", where it counts
    Vec3d axis;  ///< tubes: where u is 0, turned from this axis
    /// The largest half width on the segment.
    double widest() const;
};

/// Rotation steps toward the local position before the final one toward the ray.
inline constexpr int kTurnsToRay = 12;

/// The direction that the flat side faces.
struct CurveFacing {
    /// Where `at` is used, and how.
    enum Kind {
        Along, ///< everywhere along `at`
        Point, ///< toward `at`
        Given, ///< CurveSegment::n
        Round  ///< a tube
    } kind = Along;
    Vec3d at;        ///< direction or point, object space
    double side = 1; ///< sign of B along dC/df ^ N
};

/// The position along a segment.
Jet curveAt(const CurveSegment&, double f);
/// (half width) * B of a ribbon.
Jet sideAt(const CurveSegment&, const CurveFacing&, double f);
/// Two unit vectors across a tube, the first where u is 0, and its radius.
void tubeFrame(const CurveSegment&, double f, Jet& first, Jet& second, ScalarJet& radius);
/// u of a point near a tube, 0 to 1: its angle about the position at f, from the first vector of tubeFrame() to the second.
double tubeAngle(const CurveSegment&, double f, const Vec3d& point);
/// The start of a segment, or its end: position, unit direction along the curve, radius.
void tubeEnd(const CurveSegment&, bool end, Vec3d& centre, Vec3d& axis, double& radius);
/// Two unit vectors perpendicular to `along`, for rotation around it. along need not be unit.
void acrossFrame(const Vec3d& along, Vec3d& a, Vec3d& b);

/// A ray, its direction being the third axis of a frame around the segment.
struct CurveRay {
    Vec3d e1, e2, e3;     ///< unit
    Vec3d org;            ///< object space
    double length, shift; ///< of the direction; t of org
    double lo, hi;        ///< t
    /// near: a point of the segment; hits are wanted from lo to hi.
    CurveRay(const Vec3d& o, const Vec3d& d, const Vec3d& near, double lo, double hi);
    /// A direction of object space in the axes of the ray.
    Vec3d turned(const Vec3d& v) const { return {dot(v, e1), dot(v, e2), dot(v, e3)}; }
    /// A point of object space, relative to the origin of the axes.
    Vec3d placed(const Vec3d& p) const { return turned(p - org); }
    /// The ray's parameter at a distance along its axis.
    double t(double z) const { return shift + z / length; }
};
/// A crossing of a ray and a segment.
struct CurveHit {
    double t, s, f; ///< s: ribbons -1..1 across; tubes u
    Vec3d across;   ///< ribbons: B
};
/// Hits with lo < t <= hi of the part from..to of a segment, at most 4, in no order. fromRay: the ribbon faces the ray, facing.at
/// is its direction reversed.
int intersectRibbon(const CurveSegment&, double from, double to, const CurveFacing&, bool fromRay, const CurveRay&,
                    CurveHit out[4]);
/// Without the end caps of tubes. Subdivides until a cone is within a fiftieth of its radius of the part (or 1/1024 of the
/// segment remains), then iterates Newton's method on the swept circle to the last bits. nearest: hits other than the first may
/// be omitted. plain: with the baseline instruction set.
int intersectTube(const CurveSegment&, double from, double to, const CurveRay&, CurveHit out[4], bool nearest = false,
                  bool plain = false);

/// Layout of curves in the arrays of their request.
class CurveSet {
public:
    /// Reports errors; returns false if there is nothing to draw.
    bool take(const ShapeSource&, Diagnostics&);
    /// Number of segments of all curves.
    uint32_t segments() const { return uint32_t(curveOf_.size()); }
    struct Place {
        uint32_t face;         ///< curve of the request
        uint32_t local, count; ///< segment of its curve, and how many it has
    };
    /// Where a segment is in the request.
    Place place(uint32_t segment) const {
        const Row& r = rows_[curveOf_[segment]];
        return {r.face, segment - r.segment, (&r)[1].segment - r.segment};
    }
    /// The segment that contains v of a curve, and the position in it; curves that are not drawn are replaced by the next.
    uint32_t segmentAt(int face, double v, double& f) const;
    /// Without CurveSegment::axis.
    void load(uint32_t segment, CurveSegment& out) const;
    /// CurveSegment::axis, the same for all segments of a curve.
    Vec3d axis(uint32_t segment) const;
    /// Prefetches the data for load().
    void fetch(uint32_t segment) const;
    /// Number of values of a class.
    size_t classCount(scene::Class) const;
    /// Weights at f of a segment; `dv` with respect to v of the complete curve.
    int weights(scene::Class, uint32_t segment, double f, Weight w[16]) const;
    /// Of the request.
    bool linear() const { return linear_; }
    bool periodic() const { return periodic_; }
    /// Whether the same curves of both are drawn, with the same segments.
    bool alike(const CurveSet& o) const {
        const auto same = [](const Row& a, const Row& b) {
            return a.vertex == b.vertex && a.corner == b.corner && a.segment == b.segment && a.face == b.face;
        };
        return linear_ == o.linear_ && periodic_ == o.periodic_ && step_ == o.step_ && !normal_ == !o.normal_ &&
               std::equal(rows_.begin(), rows_.end(), o.rows_.begin(), o.rows_.end(), same);
    }
    /// Curves are flat and have a direction of their own.
    bool hasNormals() const { return normal_ != nullptr; }

private:
    struct Row {
        uint32_t vertex, corner, segment, face;
    };
    struct Widths {
        const float* values = nullptr;
        scene::Class cls = scene::Class::Constant;
    };
    bool layOut(const ShapeSource&, Diagnostics&);
    void takeWidths(const ShapeSource&, Diagnostics&);
    uint32_t vertexOf(const Row&, uint32_t local, uint32_t k) const;
    uint32_t cornerOf(const Row&, uint32_t local, uint32_t k) const;
    uint32_t corners(uint32_t segments) const { return periodic_ ? segments : segments + 1; }
    Vec3d point(uint32_t vertex) const;
    const std::vector<int>* counts_ = nullptr;
    std::vector<float> divided_; ///< points of "Pw"
    const float* P_ = nullptr;
    const float* normal_ = nullptr;
    scene::Class normalClass_ = scene::Class::Varying;
    Widths width_;
    bool linear_ = false, periodic_ = false, bezier_ = false;
    uint32_t step_ = 1;
    double basis_[4][4]; ///< value = (t^3 t^2 t 1) basis_ P
    double toBezier_[4][4];
    size_t vertices_ = 0, varying_ = 0;
    std::vector<Row> rows_;         ///< of drawn curves; one more at the end
    std::vector<uint32_t> curveOf_; ///< row by segment
    std::vector<uint32_t> firstOf_; ///< if simple(): first vertex by segment
    /// Whether the points of a segment are consecutive.
    bool simple() const { return !linear_ && !periodic_; }
};

} // namespace alpenglow::geometry
