// One function for each request: makes the shape, or reports an error and returns null. The table is below.
#pragma once
#include "geometry/shape.h"

namespace alpenglow::geometry {

/// Make the shape of one kind of primitive, not diced. Null: its numbers are wrong, which is reported, or it is empty.
ShapeRef makeSphere(ShapeSource, Diagnostics&);
ShapeRef makeCone(ShapeSource, Diagnostics&);
ShapeRef makeCylinder(ShapeSource, Diagnostics&);
ShapeRef makeHyperboloid(ShapeSource, Diagnostics&);
ShapeRef makeParaboloid(ShapeSource, Diagnostics&);
ShapeRef makeDisk(ShapeSource, Diagnostics&);
ShapeRef makeTorus(ShapeSource, Diagnostics&);
ShapeRef makePolygon(ShapeSource, Diagnostics&);
ShapeRef makeGeneralPolygon(ShapeSource, Diagnostics&);
ShapeRef makePointsPolygons(ShapeSource, Diagnostics&);
ShapeRef makePointsGeneralPolygons(ShapeSource, Diagnostics&);
ShapeRef makePatch(ShapeSource, Diagnostics&);
ShapeRef makePatchMesh(ShapeSource, Diagnostics&);
ShapeRef makeNuPatch(ShapeSource, Diagnostics&);
ShapeRef makeCurves(ShapeSource, Diagnostics&);
ShapeRef makePoints(ShapeSource, Diagnostics&);
ShapeRef makeSubdivisionMesh(ShapeSource, Diagnostics&);
ShapeRef makeBlobby(ShapeSource, Diagnostics&);

/// A kind of primitive and its factory.
struct Factory {
    const char* kind; ///< scene::Primitive::kind
    /// One of the functions above.
    ShapeRef (*make)(ShapeSource, Diagnostics&);
};
/// Every kind of scene/primitivekinds.h.
inline constexpr Factory kFactories[] = {
    {"Sphere", makeSphere},
    {"Cone", makeCone},
    {"Cylinder", makeCylinder},
    {"Hyperboloid", makeHyperboloid},
    {"Paraboloid", makeParaboloid},
    {"Disk", makeDisk},
    {"Torus", makeTorus},
    {"Polygon", makePolygon},
    {"GeneralPolygon", makeGeneralPolygon},
    {"PointsPolygons", makePointsPolygons},
    {"PointsGeneralPolygons", makePointsGeneralPolygons},
    {"Patch", makePatch},
    {"PatchMesh", makePatchMesh},
    {"NuPatch", makeNuPatch},
    {"Curves", makeCurves},
    {"Points", makePoints},
    {"SubdivisionMesh", makeSubdivisionMesh},
    {"HierarchicalSubdivisionMesh", makeSubdivisionMesh},
    {"Blobby", makeBlobby},
};

} // namespace alpenglow::geometry
