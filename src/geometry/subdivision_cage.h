// Reads SubdivisionMesh: faces, tags and their arguments, validated (RISpec 3.2, 5.3).
#pragma once
#include "geometry/limit_surface.h"
#include "scene/primitive.h"
#include <vector>

namespace alpenglow::geometry {

/// A cage and its relation to the request. Faces that cannot be subdivided are removed; the others keep the indices of their
/// values.
struct CageInput {
    SubdivisionCage cage;
    std::vector<int> corners, vertex;            ///< used by the cage if faces were removed; else the request's own lists
    std::vector<uint32_t> faceOf;                ///< per face: index in the request; empty: the same
    std::vector<uint32_t> cornerOf;              ///< per corner the same
    size_t requestFaces = 0, requestCorners = 0; ///< numbers of the request
    bool faceVaryingLinear = true;               ///< facevarying variables; facevertex ones are always smooth
};

/// One tag of the request with its arguments.
struct SubdivisionTag {
    std::string name;                     ///< "crease", "hole", ...
    std::span<const float> ints, floats;  ///< integers are stored as floats
    std::span<const std::string> strings; ///< of the tag
};
/// The tags of a request. Returns false if their counts do not match, which is reported.
bool subdivisionTags(const scene::Primitive&, Diagnostics&, std::vector<SubdivisionTag>&);

/// Returns false if there is nothing to draw, which is reported. Ignores edits of the hierarchical form.
bool readCage(const scene::Primitive&, Diagnostics&, CageInput&);

/// Converts a number to an index: -1 unless it is in [0, count).
int indexFrom(float number, size_t count);

} // namespace alpenglow::geometry
