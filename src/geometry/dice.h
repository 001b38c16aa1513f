// Dicing by screen size (docs/design/decisions.md, "Geometry"): resolution of the grid, and displacement.
#pragma once
#include "base/stopflag.h"
#include "geometry/shape.h"
#include "scene/fwd.h"
#include <functional>

namespace alpenglow::geometry {

/// The camera for dicing: pixels per unit of length.
struct DiceCamera {
    bool perspective = false; ///< else orthographic
    double pixelsPerUnit = 1; ///< at distance 1 for a perspective camera, anywhere for an orthographic one
    double narrowest = 1;     ///< smallest foreshortening of a step along the line of sight; 1: none
    /// Length in pixels of a step d at p (camera space). By distance rather than depth: geometry next to or behind the camera is
    /// visible in mirrors and must not degenerate.
    double pixels(const Vec3d& p, const Vec3d& d) const;
    /// From the frame's options (RISpec 3.2, 4.1.1); unknown projections count as orthographic.
    static DiceCamera from(const scene::Options&);
};

/// Points handed to the displacement hook: a run of vertices of one shape.
struct DiceGrid {
    std::vector<SurfacePoint> points; ///< the undisplaced surface
    std::vector<float> du, dv;        ///< distance in u and v to the neighbouring vertices
    std::vector<Vec3> P;              ///< in: points[i].P; out: displaced
};

class Seams;
class EdgeCorners;
class PictureSides;

/// How shapes are diced. All that it refers to must outlive the dicing.
struct DiceOptions {
    DiceCamera camera = {};         ///< of the frame
    const StopFlag* stop = nullptr; ///< once set, remaining shapes are not diced, and results are void; null: never
    /// Whether displace is to run for a shape; null: for those with a displacement shader (attributes().displacement).
    std::function<bool(const Shape&)> displaces;
    /// Displaces a shape. Must be thread safe: several shapes are diced at once, but one shape's runs are sequential. Null: no
    /// displacement.
    std::function<void(const Shape&, DiceGrid&)> displace;
    /// Displacement declared by shaders (3Delight manual, 6.3) in a space; added to the attribute.
    struct DeclaredBound {
        double radius = 0; ///< 0: not declared
        std::string space;
    };
    std::function<DeclaredBound(const Shape&)> declaredBound; ///< null: none declared
    /// The shape at all its times: all keys are diced alike, finely enough for each, even if exact intersection is possible.
    /// Empty: a static shape.
    std::span<const ShapeRef> keys;
    /// Where borders of displaced shapes are left, to be closed when all are diced; null: a shape closes its own.
    Seams* seams = nullptr;
    uint32_t seamOrder = 0;               ///< of this shape among all, one apart for each key
    std::vector<double> seamWith;         ///< borders are closed among those for which this is the same: how they move
    const EdgeCorners* corners = nullptr; ///< of all displaced static shapes; null: edges are cut by the shape's own corners only
    /// Only camera rays are traced: parts that they cannot reach are omitted. Null: rays may come from everywhere.
    const PictureSides* picture = nullptr;
    /// A primitive that costs more is named in a note.
    double noteSeconds = 1;
    size_t noteBytes = size_t(256) << 20;
    /// Transformation from a named space to camera space; null, or returns false: unknown space.
    std::function<bool(const Shape&, const std::string& space, Matrix& out)> spaceOf;
};

/// The camera for dicing a shape: for a displaced shape that only camera rays hit, steps are foreshortened (Attribute "dice"
/// "rasterorient"), but at least to a quarter, because displacement may turn micropolygons toward the eye.
DiceCamera diceCamera(const DiceOptions&, const scene::Attributes&, bool displaced);
/// Edge of a micropolygon in pixels: sqrt(ShadingRate), within limits.
double diceEdge(const scene::Attributes&);
/// GeometricApproximation "flatness": largest distance in pixels of undisplaced facets from the surface, within limits,
/// regardless of ShadingRate; 0: not set.
double diceFlatness(const scene::Attributes&);
/// Whether dicing must displace this shape.
bool isDisplaced(const Shape&, const DiceOptions&);
/// Warns, once for each kind, if a displacement shader is bound to a shape that is intersected exactly and has no mesh.
void reportNotDisplaced(const Shape&, const DiceOptions&, Diagnostics&);
/// Largest displacement of a shape's points in camera space, as declared; -1: not declared.
double displacementReach(const Shape&, const DiceOptions&);
/// Runs the hook over all vertices (params: (b1, b2) of each, prim of each by primOf) and writes the displaced positions to
/// mesh.P. Non-finite results are not displaced, and exceeding Attribute "displacementbound" is reported once a shape. Returns
/// false if a point exceeded it.
bool displaceMesh(const Shape&, const DiceOptions&, Diagnostics&, const std::function<SurfacePoint(uint32_t)>& pointOf,
                  const std::function<Vec2(uint32_t)>& stepOf, TriMesh& mesh);

/// Closes the border of a shape's mesh, or leaves it to opt.seams. vertex: on the border; flat: where they were.
void closeSeams(const DiceOptions&, TriMesh&, std::vector<uint32_t> vertex, std::vector<Vec3> flat);

/// Dices every shape that needs it, in parallel.
void diceShapes(const std::vector<ShapeRef>&, const DiceOptions&, Diagnostics&);

} // namespace alpenglow::geometry
