// Shared by surfaces over one (u, v) square: derivatives in camera space, sampling, area, dicing, corner variables.
#pragma once
#include "geometry/shape.h"

namespace alpenglow::geometry {

/// A surface point in object space (or camera space, for patches), in double.
struct LocalPoint {
    Vec3d P, Pu, Pv, Puu, Puv, Pvv; ///< and its derivatives by u and v
    Vec3d n, nu, nv;                ///< unit normal along Pu x Pv and its derivatives; defined where the product vanishes too
};

class EdgeCurve;

/// A surface over u and v from 0 to 1.
class Parametric : public Shape {
public:
    using Shape::Shape;
    SurfacePoint evaluate(int /*face*/, double u, double v) const override { return evaluateLocal(0, u, v); }
    double area() const override;
    SurfacePoint sampleArea(double xi1, double xi2) const override { return evaluateLocal(0, xi1, xi2); }
    double sampleDensity(const SurfacePoint&) const override;
    void dice(const DiceOptions&, Diagnostics&) override;

    /// Corners of patches on the border of the surface, for edges with an edgeCurve(), camera space.
    void borderCorners(std::vector<Vec3>& out) const;

protected:
    SurfacePoint evaluateLocal(uint32_t prim, double u, double v) const override;
    /// The surface point in camera space in double, which evaluateLocal rounds.
    virtual LocalPoint cameraPoint(double u, double v) const = 0;
    /// Position only.
    virtual Vec3d cameraPosition(double u, double v) const { return cameraPoint(u, v).P; }
    /// Patches along u and v: dicing lines never cross their borders.
    virtual int patchesU() const { return 1; }
    virtual int patchesV() const { return 1; }
    /// Positions of patch borders along u (0) or v (1), from 0 to 1.
    virtual std::vector<double> borders(int direction) const;
    /// Whether the surface is torn at such a border.
    virtual bool torn(int /*direction*/, double /*border*/) const { return false; }
    /// The edge of a patch on the border of the surface, in the direction of u or v; side 0: v = 0, 1: u = 1, 2: v = 1, 3: u = 0;
    /// cell: index of the patch along it, between `from` and `to`. Returns false if it has no edge curve.
    virtual bool edgeCurve(int /*side*/, int /*cell*/, double /*from*/, double /*to*/, EdgeCurve&) const { return false; }
    /// A box in camera space around the surface between two parameters of each direction within one patch, or (0, 0, 1, 1) around
    /// all of it. Returns false if it is unknown without sampling.
    virtual bool hull(double /*u0*/, double /*v0*/, double /*u1*/, double /*v1*/, Bounds&) const { return false; }
    /// Index of the uniform value at a point.
    virtual int faceAt(double u, double v) const;
    /// Removes trimmed triangles of the mesh; meshParam_ is set.
    virtual void trim(TriMesh&) {}
    virtual bool closedU() const { return false; }
    virtual bool closedV() const { return false; }
    /// Whether the surface is diced even without displacement.
    virtual bool needsDicing() const = 0;
    /// Bilinear weights in a grid of values, nu by nv over the complete square (periodic: nu values span nu cells).
    static int bilinearWeights(double u, double v, int nu, int nv, bool wrapU, bool wrapV, Weight w[16]);

    double pointScale_ = 0; ///< bound on |P| in double computations before cancellation, for the error bound

private:
    struct Dicing; ///< parametric_dice.cpp
    bool diceSeen(const DiceOptions&, class Unseen&, Diagnostics&);
};

/// Derivatives of the unit normal along Pu x Pv from second partials; n must be set.
void normalDerivatives(LocalPoint&);

} // namespace alpenglow::geometry
