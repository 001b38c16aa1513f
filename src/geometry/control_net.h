// Patches over a rectangular net of control points: bilinear and bicubic, single and meshes, plain and rational.
#pragma once
#include "base/limits.h"
#include "geometry/parametric.h"
#include "geometry/trim.h"
#include <array>

namespace alpenglow::geometry {

/// Weights of the control points that act at one parameter value along one direction, with derivatives by the parameter.
struct BasisSpan {
    int count = 0;                  ///< number of points that act
    int index[limits::kNurbsOrder]; ///< control index along the direction, wrapped
    /// By point: weight, first and second derivative.
    double w[limits::kNurbsOrder], d[limits::kNurbsOrder], dd[limits::kNurbsOrder];
};

/// One direction of a net: how many control points, and which basis joins them.
class NetDirection {
public:
    /// Piecewise linear.
    static NetDirection linear(int n, bool wrap);
    /// Cubic by a basis matrix (RISpec 3.2, 5.2) and step.
    static NetDirection cubic(int n, bool wrap, const scene::Basis&);
    /// B-spline of any order up to limits::kNurbsOrder over the knots, [lo, hi] mapped to 0..1 (RISpec 3.2, 5.2).
    static NetDirection nurbs(int n, int order, std::vector<double> knots, double lo, double hi);

    /// Number of control points.
    int points() const { return n_; }
    /// Pieces that dicing does not cross; also the count of uniform values along the direction.
    int patches() const { return patches_; }
    /// Whether the direction is periodic.
    bool wrap() const { return wrap_; }
    /// Count of varying values: one a patch border.
    int varyings() const { return wrap_ ? patches_ : patches_ + 1; }
    /// The points that act at x, 0 to 1.
    BasisSpan at(double x) const;
    /// Whether no weight is negative, so that the surface is within the convex hull of its control points.
    bool convex() const;
    /// Number of control points that affect a position.
    int width() const { return order_ > 0 ? order_ : width_; }
    /// Borders of patches from 0 to 1: distinct knots of NURBS, otherwise uniform.
    std::vector<double> borders() const;
    /// Whether the multiplicity of a knot separates the two sides.
    bool torn(double border) const;
    /// Bezier points of a patch of a curve by this basis, between two borders; points: by control index.
    template <class Points>
    std::vector<std::array<double, 4>> bezier(int patch, double from, double to, const Points& points) const;
    /// The patch at x, the position of x in it (0..1), and its derivative. NURBS: between knots.
    struct Cell {
        int patch;
        double at, slope; ///< 0 to 1, and its derivative by x
    };
    /// For x from 0 to 1.
    Cell cell(double x) const;

private:
    int n_ = 0, patches_ = 0, step_ = 1, width_ = 2;
    int spanOf(double t) const;
    bool wrap_ = false;
    std::array<std::array<double, 4>, 4> m_{}; ///< rows by power 3..0
    std::vector<double> knots_;
    double lo_ = 0, hi_ = 1;
    int order_ = 0;
};

/// The shape of Patch, PatchMesh and NuPatch (RISpec 3.2, 5.2).
class ControlNet final : public Parametric {
public:
    /// points: camera space, four coordinates each (weight last), u fastest. trim: the visible part, null for all.
    ControlNet(ShapeSource, NetDirection u, NetDirection v, std::vector<std::array<double, 4>> points, Diagnostics&,
               std::shared_ptr<const TrimRegion> trim = nullptr);
    int faces() const override { return u_.patches() * v_.patches(); }
    bool keepsHit(uint32_t prim, double b1, double b2) const override;
    double area() const override;
    SurfacePoint sampleArea(double xi1, double xi2) const override;
    double sampleDensity(const SurfacePoint&) const override;

protected:
    LocalPoint cameraPoint(double u, double v) const override;
    Vec3d cameraPosition(double u, double v) const override;
    bool edgeCurve(int side, int cell, double from, double to, EdgeCurve&) const override;
    bool hull(double u0, double v0, double u1, double v1, Bounds&) const override;
    int patchesU() const override { return u_.patches(); }
    int patchesV() const override { return v_.patches(); }
    std::vector<double> borders(int direction) const override { return (direction == 0 ? u_ : v_).borders(); }
    bool torn(int direction, double border) const override { return (direction == 0 ? u_ : v_).torn(border); }
    int faceAt(double u, double v) const override;
    void trim(TriMesh&) override;
    bool closedU() const override { return closedU_; }
    bool closedV() const override { return closedV_; }
    bool needsDicing() const override { return true; }
    size_t classCount(scene::Class) const override;
    int weights(scene::Class, const SurfacePoint&, Weight w[16]) const override;

private:
    void differentiate(double u, double v, LocalPoint&) const;
    bool sameEdge(bool alongV) const;
    NetDirection u_, v_;
    std::vector<std::array<double, 4>> points_;
    std::shared_ptr<const TrimRegion> trim_;
    std::vector<bool> edge_; ///< by triangle: may intersect the edge of the visible part
    bool rational_ = false, closedU_ = false, closedV_ = false;
    bool convex_ = false; ///< it is within the bounding box of its control points, as is each patch
};

/// The surface of a net. A point of weight 0 is a direction. Returns null, with an error, if the surface reaches infinity.
ShapeRef makeNet(ShapeSource, NetDirection u, NetDirection v, std::vector<std::array<double, 4>> points, Diagnostics&,
                 std::shared_ptr<const TrimRegion> trim = nullptr);

/// Reads "P", "Pw" or "Pz" of nu by nv control points, to camera space; reports and returns false when it cannot.
bool readControlPoints(const ShapeSource&, int nu, int nv, bool wrapU, bool wrapV, Diagnostics&,
                       std::vector<std::array<double, 4>>& out);

} // namespace alpenglow::geometry
