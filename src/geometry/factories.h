// One function for each request: makes the shape, or reports an error and returns null. The table is below.
#pragma once
#include "geometry/shape.h"

namespace alpenglow::geometry {

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

struct Factory {
    const char* kind; ///< scene::Primitive::kind
    ShapeRef (*make)(ShapeSource, Diagnostics&);
};
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
