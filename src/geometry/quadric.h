// Shared by the seven quadrics: a profile curve (a(v), b(v), z(v)) in object space, rotated about z by theta = u thetamax (RISpec
// 3.2, 5.4): P = (a cos - b sin, a sin + b cos, z). Only the hyperboloid has b != 0.
#pragma once
#include "geometry/parametric.h"
#include "geometry/quadricform.h"
#include <optional>

namespace alpenglow::geometry {

/// The profile and its first two derivatives by v.
struct Profile {
    Vec3d p, d, dd; ///< object space
};

/// x^2 + y^2 + zz z^2 + z1 z + c = 0; or the plane z = height.
struct Implicit {
    bool plane = false;
    double height = 0;
    double zz = 0, z1 = 0, c = 0;
};

/// What the seven shapes share: intersection of the swept profile and its derivatives.
class Quadric : public Parametric {
public:
    /// thetaMaxDegrees: sweep about z, negative: the other way.
    Quadric(ShapeSource, double thetaMaxDegrees, Diagnostics&);
    using Shape::exactHits;
    int exactHits(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted,
                  ExactHit out[4]) const override;
    Bounds bounds() const override;
    /// Of exactHits(); none where a perspective distorts the surface.
    virtual std::optional<QuadricForm> form() const;

protected:
    /// Call when the derived object is complete: computes the error bound and primitive variables.
    void finish(Diagnostics&);
    virtual Profile profile(double v) const = 0;
    /// +1, -1: the complete profile is on that side of the x axis (y = 0); 0: use profile().
    virtual int profileSide() const { return 0; }
    virtual Implicit implicit() const = 0;
    /// Whether all of implicit() belongs to the surface after a full turn.
    virtual bool wholeProfile() const { return false; }
    /// v of an object-space point on the unswept surface; the caller clips values outside 0..1.
    virtual double vOf(const Vec3d& p) const = 0;
    /// Object-space roots of the line; the default solves implicit().
    virtual int roots(const Vec3d& o, const Vec3d& d, double t[4]) const;
    /// The second candidate if v is not unique.
    virtual std::optional<double> secondV(const Vec3d&) const { return {}; }

    /// u and v of an object-space point; false: that is cut away.
    bool accept(const Vec3d& p, double v, ExactHit& hit) const;
    /// Whether nothing of implicit() is cut away. Call after finish().
    bool whole() const { return whole_; }
    const Matrix& toObject() const { return toObject_; }

    LocalPoint cameraPoint(double u, double v) const override;
    Vec3d cameraPosition(double u, double v) const override;
    bool edgeCurve(int side, int cell, double from, double to, EdgeCurve&) const override;
    bool needsDicing() const override { return false; }
    bool closedU() const override { return fullTurn_; }
    size_t classCount(scene::Class) const override;
    int weights(scene::Class, const SurfacePoint&, Weight w[16]) const override;

private:
    double thetaMax_ = 0;   ///< radians, -2 pi .. 2 pi
    bool affine_ = true;    ///< toObject_ has no perspective
    bool mirrored_ = false; ///< toCamera() swaps handedness
    bool fullTurn_ = false;
    bool whole_ = false;                    ///< nothing of implicit() is cut away
    bool offAxis_ = false;                  ///< some b(v) != 0
    double radius_ = 0, zLo_ = 0, zHi_ = 0; ///< bounding cylinder of the profile
    Matrix toObject_;
};

/// A number of the request, 0 when missing or not finite; ok is cleared then.
double quadricNumber(const scene::Primitive&, size_t index, bool& ok);
/// Reports that the primitive has no surface and is not drawn.
void reportDegenerate(const scene::Primitive&, Diagnostics&, const std::string& why);

} // namespace alpenglow::geometry
