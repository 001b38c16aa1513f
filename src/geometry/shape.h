// Interface of primitives: a surface in camera space that can be intersected, evaluated with exact derivatives, sampled, and
// queried for its primitive variables. Space: camera ("current", docs/design/decisions.md), left-handed, unless a comment says
// object. Angles are radians.
#pragma once
#include "base/diagnostics.h"
#include "geometry/bounds.h"
#include "geometry/primvars.h"
#include "scene/primitive.h"
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace alpenglow::geometry {

inline constexpr uint32_t kNone = 0xffffffffu; ///< no shape, or no primitive

/// A surface point with the data for shading. Camera space.
struct SurfacePoint {
    Vec3 P;             ///< position
    Vec3 dPdu, dPdv;    ///< first partials by the surface's own u and v
    Vec3 Puu, Puv, Pvv; ///< second partials
    Vec3 Ng;            ///< orientation * (dPdu ^ dPdv), not normalised; n where that product vanishes
    Vec3 n;             ///< Ng normalised; defined at poles and collapsed edges too
    Vec3 N;             ///< shading normal, unit: the primitive variable "N" (or "Np") if given, else n
    Vec3 dNdu, dNdv;    ///< derivatives of N
    float u = 0, v = 0; ///< 0..1 over the complete primitive; polygons: object x and y (RISpec 3.2, 5.1)
    float s = 0, t = 0, dsdu = 1, dsdv = 0, dtdu = 0, dtdv = 1; ///< texture coordinates, and their derivatives by u and v
    float pError = 0;            ///< bound on the distance from P to the surface that rays hit: rounding plus facets
    float orientation = 1;       ///< +1 or -1: the sign in Ng above
    int face = 0;                ///< index of the uniform value: patch of a mesh, polygon of a polyhedron
    bool displaced = false;      ///< the surface was displaced when it was diced; then all above is the undisplaced surface
    uint32_t facet = kNone;      ///< of a hit on a surface that is diced: the triangle of the mesh; then:
    Vec3 displacedP, displacedN; ///< where rays hit it: point, and unit normal on the side of n
    float facetError = 0;        ///< bound on the distance from displacedP to the facet
    uint32_t prim = 0;           ///< with b1, b2: where interpolate() finds the point again. Triangle of the polygon; else 0
    float time = 0;              ///< of the shutter, 0 to 1
    double b1 = 0, b2 = 0;       ///< barycentric weights of the triangle's 2nd and 3rd corner; parametric surfaces: u and v
};

/// Requested members of a SurfacePoint, as bits. P, n, pError, face, prim, b1, b2, `displaced`, `facet` and their dependents are
/// always set; other members that are not requested may be zero. A shape may set more.
enum PointNeed : uint32_t {
    kNeedN = 1,            ///< N
    kNeedPartials = 2,     ///< dPdu, dPdv, Puu, Puv, Pvv, orientation
    kNeedNormalSlopes = 4, ///< dNdu, dNdv
    kNeedUV = 8,           ///< u, v
    kNeedST = 16,          ///< s, t
    kNeedSTSlopes = 32,    ///< dsdu, dsdv, dtdu, dtdv
    kNeedNg = 64,          ///< Ng
    kNeedAll = 127
};

/// A hit on a shape, and the destination of its surface point.
struct HitRef {
    uint32_t prim = 0;           ///< of the shape
    double b1 = 0, b2 = 0;       ///< accel::Hit
    SurfacePoint* out = nullptr; ///< not null
    float time = 0;              ///< of the shutter, 0 to 1
};

/// Triangles in camera space. P holds one unused point past `vertices` (intersectors read 16 bytes at a time).
struct TriMesh {
    std::vector<Vec3> P;
    std::span<const uint32_t> index; ///< three for each triangle: `made`, or a list owned by the primitive
    std::vector<uint32_t> made;      ///< empty: `index` looks at another list
    uint32_t vertices = 0;
    /// Number of triangles.
    uint32_t triangles() const { return uint32_t(index.size() / 3); }
    /// Ends construction: adds the unused point, and points `index` to `made`.
    void finish() {
        vertices = uint32_t(P.size());
        P.push_back(Vec3(0.f));
        if (!made.empty()) index = made;
    }
    TriMesh() = default;
    TriMesh(TriMesh&&) = default; // a span of `made` stays valid; in a copy it would not
    TriMesh& operator=(TriMesh&&) = default;
};

/// A hit of a ray on an exactly intersected shape.
struct ExactHit {
    double t, u, v; ///< distance in lengths of dir; parameters for evaluateHit()
};

struct DiceOptions;
struct DiceGrid;
class Placed;

/// Direction of shapes without a side of their own (curves and points without "N"): toward each ray, toward the eye at the
/// origin, or perpendicular to the picture plane (orthographic).
enum class Facing { Ray, Eye, Picture };

/// Origin of a shape.
struct ShapeSource {
    scene::PrimitiveRef primitive;   ///< never null
    scene::AttributesRef attributes; ///< never null; those of the instance for instanced primitives (RISpec 3.2)
    Matrix toCamera;                 ///< object to camera
    int instance = -1;               ///< index into Frame::instances
    Facing facing = Facing::Ray;     ///< of flat curves and points
    const class Shape* like =
        nullptr; ///< during construction: the shape at an earlier time, which is cut into the same triangles
};

/// Sign of Ng relative to dPdu ^ dPdv (RISpec 3.2, 4.2). "outside" follows the handedness of the transform, so that the outside
/// of a primitive stays outside; "lh" is +1 (camera space is left-handed) and "rh" is -1, for any transform.
float orientationSign(const scene::Attributes&, const Matrix& toCamera);

/// A primitive, or one instance of it. Immutable once it is diced, so all const functions are thread safe.
class Shape {
public:
    /// Of its origin; dice() completes it.
    explicit Shape(ShapeSource);
    virtual ~Shape() = default;
    Shape(const Shape&) = delete;
    Shape& operator=(const Shape&) = delete;

    /// Of the source.
    const std::string& kind() const { return source_.primitive->kind; }
    const SourcePlace& place() const { return source_.primitive->place; }
    const scene::Attributes& attributes() const { return *source_.attributes; }
    const scene::AttributesRef& attributesRef() const { return source_.attributes; }
    const ShapeSource& source() const { return source_; }
    const Matrix& toCamera() const { return source_.toCamera; }
    /// Orientation sign of parametric surfaces; polygons add the direction of their winding a face (SurfacePoint::orientation).
    float orientation() const { return orientation_; }
    /// Sides 1: only points whose n faces the ray's origin are visible.
    bool oneSided() const { return source_.attributes->sides == 1; }

    // ---- intersection -------------------------------------------------------------------------------------------------------
    /// True: rays meet exactHits(). False: rays meet mesh(), hits are (triangle, b1, b2).
    bool exact() const { return mesh_.vertices == 0; }
    /// In camera space; empty before dice().
    const TriMesh& mesh() const { return mesh_; }
    /// Exact shapes: number of primitives with boxes of their own (curves and points have many); prim of a hit.
    virtual uint32_t exactPrims() const { return 1; }
    /// Encloses all that a ray can hit of one of them.
    virtual Bounds exactBounds(uint32_t /*prim*/) const { return bounds(); }
    /// All points of the line org + t dir on the first primitive, by increasing t, at most 4; any sign of t. Thread safe.
    int exactHits(const Vec3d& org, const Vec3d& dir, ExactHit out[4]) const {
        return exactHits(0, org, dir, -INFINITY, INFINITY, Wanted::All, out);
    }
    /// How many crossings are needed.
    enum class Wanted { All, Nearest, Any };
    /// Those of one primitive with lo < t <= hi only, which is cheaper. Nearest: one is enough; Any: whether there is one, u and
    /// v may stay unset.
    virtual int exactHits(uint32_t /*prim*/, const Vec3d& /*org*/, const Vec3d& /*dir*/, double /*lo*/, double /*hi*/, Wanted,
                          ExactHit[4]) const {
        return 0;
    }
    /// Some triangles are partly cut away: keepsHit() tests points. Thread safe.
    bool trimmed() const { return trimmed_; }
    /// Whether the surface is there; only where trimmed().
    virtual bool keepsHit(uint32_t /*prim*/, double /*b1*/, double /*b2*/) const { return true; }
    /// Encloses everything a ray can hit.
    virtual Bounds bounds() const;

    // ---- evaluation ---------------------------------------------------------------------------------------------------------
    /// Number of faces, the count of uniform values.
    virtual int faces() const { return 1; }
    /// The surface at (u, v). Parametric surfaces use 0..1 over the complete primitive and ignore `face`; for polygons (u, v) are
    /// object x and y (or the fallback frame), and a point outside of the face uses the plane of its nearest triangle.
    virtual SurfacePoint evaluate(int face, double u, double v) const = 0;
    /// The surface at a hit: (prim, b1, b2) from the intersector; exact shapes: (prim, ExactHit::u, v).
    SurfacePoint evaluateHit(uint32_t prim, double b1, double b2) const;
    /// The same, written in place.
    void evaluateHit(uint32_t prim, double b1, double b2, SurfacePoint& out, uint32_t needs = kNeedAll) const;
    /// The same for many hits; meshes fetch the memory of those that follow while they work. needs: PointNeed.
    void points(std::span<const HitRef>, uint32_t needs) const;
    /// Normal of the surface that a ray hits there, with orientation; not normalised. Cheaper than evaluateHit; for Sides.
    Vec3d hitNormal(uint32_t prim, double b1, double b2) const;
    /// Whether rays hit facets of a diced surface rather than the surface itself.
    bool diced() const { return !meshParam_.empty(); }

    // ---- motion and sharing (geometry/placed.h) -----------------------------------------------------------------------------
    /// A shape that stands or moves where another geometry is placed; null: this is its own geometry.
    virtual const Placed* placed() const { return nullptr; }
    /// Object to camera at a time of the shutter.
    virtual Matrix toCameraAt(float /*time*/) const { return source_.toCamera; }
    /// Change of the surface point over the complete shutter, camera space: dPdtime times the shutter.
    virtual Vec3 velocity(const SurfacePoint&) const { return Vec3(0.f); }
    /// sampleArea() at a time of the shutter.
    virtual void sampleAreaAt(double xi1, double xi2, float /*time*/, SurfacePoint& out, uint32_t needs) const {
        sampleArea(xi1, xi2, out, needs);
    }

    // ---- area, and sampling as a light (docs/design/light-transport.md) ------------------------------------------------------
    virtual double area() const = 0;
    /// A point for two numbers of [0,1): parametric surfaces uniform over (u, v), polygons uniform over area.
    virtual SurfacePoint sampleArea(double xi1, double xi2) const = 0;
    /// The same, written in place.
    virtual void sampleArea(double xi1, double xi2, SurfacePoint& out, uint32_t /*needs*/ = kNeedAll) const {
        out = sampleArea(xi1, xi2);
    }
    /// The same for a lit point: shapes that face rays are turned as seen from it.
    virtual void sampleFrom(const Vec3& /*from*/, double xi1, double xi2, SurfacePoint& out, uint32_t needs = kNeedAll) const {
        sampleArea(xi1, xi2, out, needs);
    }
    /// Curves and points without a side of their own that turn to each ray (Facing::Ray).
    virtual bool facesRays() const { return false; }
    /// Density of sampleArea per unit of area at this point: 1 / |dPdu ^ dPdv|, or 1 / area for polygons; 0 where the surface is
    /// degenerate.
    virtual double sampleDensity(const SurfacePoint&) const = 0;
    /// Shapes that face rays are turned differently for each ray: density of sampleFrom() at a point, relative to that of a flat
    /// shape.
    virtual double turnedDensity(const SurfacePoint&, const Vec3& /*from*/) const { return 1; }

    // ---- primitive variables ------------------------------------------------------------------------------------------------
    /// All variables but P, Pz, Pw and N; points, vectors and normals in camera space.
    const std::vector<PrimVar>& primvars() const { return *variables_; }
    /// Index of a variable by name, or -1.
    int findPrimvar(std::string_view name) const;
    /// Value and derivatives by u and v: PrimVar::outWidth() floats each; du and dv may be null.
    virtual void interpolate(int var, const SurfacePoint& at, float* out, float* du, float* dv) const;
    /// Value of a string variable (not interpolated: constant and uniform by face, others the first corner's).
    virtual const std::string& stringValue(int var, const SurfacePoint& at) const;
    /// A variable supplies N.
    bool givesNormals() const { return normal_.param != nullptr; }

    // ---- dicing -------------------------------------------------------------------------------------------------------------
    /// Makes the mesh that rays meet (and displaces it). Called once, before the shape is intersected. Not thread safe for one
    /// shape; different shapes may be diced at the same time.
    virtual void dice(const DiceOptions&, Diagnostics&) {}

protected:
    /// Checks and stores the variables of the request. Faulty ones are reported and left out.
    void takePrimvars(Diagnostics&);
    /// How many values a variable of a class must have.
    virtual size_t classCount(scene::Class) const = 0;
    /// Weights of the values of a class at a point, with derivatives by u and v. Returns how many, at most mostWeights_.
    virtual int weights(scene::Class, const SurfacePoint& at, Weight w[16]) const = 0;
    /// interpolate() for a variable: by weights(), unless a surface has its own rules or more weights.
    virtual void interpolateVariable(const PrimVar&, const SurfacePoint& at, float* out, float* du, float* dv) const;
    /// evaluate() by (prim, b1, b2) of the undiced surface.
    virtual SurfacePoint evaluateLocal(uint32_t prim, double b1, double b2) const = 0;
    /// The same, written in place. needs: PointNeed.
    virtual void evaluateLocal(uint32_t prim, double b1, double b2, SurfacePoint& out, uint32_t /*needs*/) const {
        out = evaluateLocal(prim, b1, b2);
    }
    /// The same for many hits of an undiced surface.
    virtual void localPoints(std::span<const HitRef>, uint32_t needs) const;
    /// No ray reaches the shape, which is in this box: makes a mesh without triangles.
    void leaveOut(const Bounds&);
    /// hitNormal() of exact shapes.
    virtual Vec3d localNormal(uint32_t prim, double b1, double b2) const;
    /// Sets s, t and N from variables (or defaults), and dependents; requires P, u, v, n, partials, dNdu, dNdv.
    void finishPoint(SurfacePoint&, bool parametric) const;

    ShapeSource source_;
    float orientation_ = 1;
    std::vector<PrimVar> primvars_;
    const std::vector<PrimVar>* variables_ = &primvars_; ///< those of primvars()
    int varN_ = -1, varS_ = -1, varT_ = -1, varSt_ = -1;
    PrimVar normal_; ///< "N" or "Np", camera space
    TriMesh mesh_;
    std::vector<Vec2> meshParam_;    ///< diced: (b1, b2) of each vertex on its undiced surface; empty: mesh is the surface
    uint32_t trianglesPerPrim_ = 0;  ///< diced polygons: triangles made from each triangle; 0: all of prim 0
    std::vector<uint32_t> meshPrim_; ///< diced, and not empty: prim of each vertex; a triangle's vertices are of one
    bool displaced_ = false, trimmed_ = false;
    int mostWeights_ = 16; ///< capacity of weights()
};
using ShapeRef = std::shared_ptr<Shape>;

/// Bound on the rounding of a point's coordinates in float.
inline float roundingError(const Vec3& p) {
    // 2^-23 times the 1-norm: twice the error of rounding each coordinate once, so that a double computation rounded at the end
    // stays within it.
    return 1.1920929e-7f * (std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z)) + 1e-37f;
}

/// Origin of a ray that leaves a surface at P along dir: offset from the surface, whose unit normal is n, by the bound on the
/// distance from P to it, on dir's side.
inline Vec3 offsetOrigin(const Vec3& P, const Vec3& n, float error, const Vec3& dir) {
    // The rounded origin has an error of up to half a bound, hence twice the bound.
    float d = 2 * error;
    Vec3 off = n * (dot(dir, n) >= 0 ? d : -d);
    Vec3 o = P + off;
    // Rounds away from the surface: one float up or down, as std::nextafter, whose call costs more than the rest. Signs are
    // unpredictable here, so there is no branch.
    auto step = [](float x, float by) {
        const int32_t bits = std::bit_cast<int32_t>(x), direction = std::bit_cast<int32_t>(by);
        int32_t moved = bits + (((bits ^ direction) >> 31) | 1); // signs agree: one away from 0
        moved = x == 0 ? (direction & INT32_MIN) | 1 : moved;
        const bool goes = bool(int(by != 0) & int(by == by) & int(std::fabs(x) < INFINITY));
        return std::bit_cast<float>(goes ? moved : bits);
    };
    return {step(o.x, off.x), step(o.y, off.y), step(o.z, off.z)};
}
/// The same for a surface point. extra widens the bound (for example if the shader moved P).
inline Vec3 offsetOrigin(const SurfacePoint& p, const Vec3& dir, float extra = 0) {
    return offsetOrigin(p.P, p.n, p.pError + extra, dir);
}

} // namespace alpenglow::geometry
