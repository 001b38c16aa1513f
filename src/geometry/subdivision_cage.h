// What SubdivisionMesh says: faces, tags and their arguments, checked (RISpec 3.2, 5.3).
#pragma once
#include "geometry/limit_surface.h"
#include "scene/primitive.h"
#include <vector>

namespace alpenglow::geometry {

/// A cage with what it keeps of the request. Faces that cannot be subdivided are left out; what is left keeps its place among the
/// values.
struct CageInput {
    SubdivisionCage cage;
    std::vector<int> corners, vertex; ///< what the cage looks at, where faces were left out; else the request's own lists
    std::vector<uint32_t> faceOf;     ///< per face its place in the request; empty: the same
    std::vector<uint32_t> cornerOf;   ///< per corner the same
    size_t requestFaces = 0, requestCorners = 0;
    bool faceVaryingLinear = true; ///< facevarying variables; facevertex ones are always smooth
};

/// One tag of the request with its arguments.
struct SubdivisionTag {
    std::string name;
    std::span<const float> ints, floats; ///< integers as the request keeps them
    std::span<const std::string> strings;
};
/// The tags of a request. False: their counts do not fit, which is reported.
bool subdivisionTags(const scene::Primitive&, Diagnostics&, std::vector<SubdivisionTag>&);

/// False: there is nothing to draw; reported. Edits of the hierarchical form are not looked at.
bool readCage(const scene::Primitive&, Diagnostics&, CageInput&);

/// A number that stands for an index: -1 when it is none of [0, count).
int indexFrom(float number, size_t count);

} // namespace alpenglow::geometry
