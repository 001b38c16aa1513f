// Dicing by screen size (docs/design/decisions.md, "Geometry"): how fine, and displacement of what was diced.
#pragma once
#include "base/stopflag.h"
#include "geometry/shape.h"
#include "scene/fwd.h"
#include <functional>

namespace alpenglow::geometry {

/// What dicing must know of the camera: pixels per unit of length.
struct DiceCamera {
    bool perspective = false;
    double pixelsPerUnit = 1; ///< at distance 1 for a perspective camera, anywhere for an orthographic one
    double narrowest = 1;     ///< part of the length of a step along the line of sight that counts at least; 1: all of it
    /// Length in pixels of a step d at p (camera space). By distance, not by depth: what is beside or behind the camera is
    /// seen in mirrors and must not degenerate.
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

struct DiceOptions {
    DiceCamera camera = {};
    const StopFlag* stop = nullptr; ///< set: shapes not yet diced stay as they are, and what is diced is void; null: never
    /// Whether displace is to run for a shape; null: for those with a displacement shader (attributes().displacement).
    std::function<bool(const Shape&)> displaces;
    /// Runs what displaces a shape. Must be thread safe: shapes are diced
    /// at the same time, a shape's runs one after the other. Null: nothing is displaced.
    std::function<void(const Shape&, DiceGrid&)> displace;
    /// How far the shaders of a shape say that they move points (3Delight manual, 6.3), in which space; added to the attribute.
    struct DeclaredBound {
        double radius = 0; ///< 0: they say nothing
        std::string space;
    };
    std::function<DeclaredBound(const Shape&)> declaredBound; ///< null: none says anything
    /// The shape to be diced and what it is at other times: all of them are diced alike, each finely enough for all, and also
    /// those that rays could meet exactly. Empty: a still shape.
    std::span<const ShapeRef> keys;
    /// Where borders of displaced shapes are left, to be closed when all are diced; null: a shape closes its own.
    Seams* seams = nullptr;
    uint32_t seamOrder = 0;               ///< of this shape among all, one apart for each key
    std::vector<double> seamWith;         ///< borders are closed among those for which this is the same: how they move
    const EdgeCorners* corners = nullptr; ///< of all displaced shapes that stand still; null: only a shape's own edges cut it
    /// Nothing but rays of the camera is sent: what they cannot come to is left out. Null: rays may come from everywhere.
    const PictureSides* picture = nullptr;
    /// A primitive that costs more is named in a note.
    double noteSeconds = 1;
    size_t noteBytes = size_t(256) << 20;
    /// From a named space to camera space; null, or false: the space is not known.
    std::function<bool(const Shape&, const std::string& space, Matrix& out)> spaceOf;
};

/// The camera by which a shape is diced: of a displaced one that only camera rays meet, steps count as the eye sees them
/// (Attribute "dice" "rasterorient"), but at least by a quarter, for displacement turns micropolygons towards the eye.
DiceCamera diceCamera(const DiceOptions&, const scene::Attributes&, bool displaced);
/// Edge of a micropolygon in pixels: sqrt(ShadingRate), within limits.
double diceEdge(const scene::Attributes&);
/// GeometricApproximation "flatness": pixels that facets of what is not displaced may stray from the surface, within limits,
/// whatever ShadingRate says; 0: it says nothing.
double diceFlatness(const scene::Attributes&);
/// Whether dicing must displace this shape.
bool isDisplaced(const Shape&, const DiceOptions&);
/// For shapes that are met exactly and have no mesh to displace: a warning, once a kind, where a displacement shader wants to.
void reportNotDisplaced(const Shape&, const DiceOptions&, Diagnostics&);
/// How far displacement moves points of a shape at most, in camera space, as it and its shaders say; -1: they say nothing.
double displacementReach(const Shape&, const DiceOptions&);
/// Runs the hook over all vertices (params: (b1, b2) of each, prim of each by primOf) and writes the displaced positions to
/// mesh.P. Non-finite results stay undisplaced, and what exceeds Attribute "displacementbound" is reported, once a shape.
/// False: something did exceed it.
bool displaceMesh(const Shape&, const DiceOptions&, Diagnostics&, const std::function<SurfacePoint(uint32_t)>& pointOf,
                  const std::function<Vec2(uint32_t)>& stepOf, TriMesh& mesh);

/// Closes the border of a shape's mesh, or leaves it to opt.seams. vertex: on the border; flat: where they were.
void closeSeams(const DiceOptions&, TriMesh&, std::vector<uint32_t> vertex, std::vector<Vec3> flat);

/// Dices every shape that needs it, in parallel.
void diceShapes(const std::vector<ShapeRef>&, const DiceOptions&, Diagnostics&);

} // namespace alpenglow::geometry
