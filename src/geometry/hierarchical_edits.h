// Edits of HierarchicalSubdivisionMesh (PRMan's "vertexedit", "edgeedit", "faceedit"): the cage is refined to the level of the
// deepest edit, and each edit is made where its level is reached. The limit surface of a refined cage is that of the cage.
#pragma once
#include "geometry/subdivision.h"

namespace alpenglow::geometry {

struct EditedCage {
    std::shared_ptr<scene::Primitive>
        primitive; ///< the request with refined variables, vertex, varying, uniform and face-varying
    CageInput in;
    std::vector<FaceDomain> domains;
};

/// Null primitive: there are no edits, or none that can be made; what is wrong with them is reported.
EditedCage applyEdits(const scene::Primitive&, const CageInput&, Diagnostics&);

} // namespace alpenglow::geometry
