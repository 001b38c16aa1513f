// Edits of HierarchicalSubdivisionMesh (PRMan's "vertexedit", "edgeedit", "faceedit"): the cage is refined to the level of the
// deepest edit, and each edit is applied at its level. Refinement does not change the limit surface.
#pragma once
#include "geometry/subdivision.h"

namespace alpenglow::geometry {

/// The cage of a mesh after its hierarchical edits.
struct EditedCage {
    std::shared_ptr<scene::Primitive>
        primitive;                   ///< the request with refined variables, vertex, varying, uniform and face-varying
    CageInput in;                    ///< the refined cage
    std::vector<FaceDomain> domains; ///< by face: its part of a face of the request
};

/// Null primitive: no valid edits; errors are reported.
EditedCage applyEdits(const scene::Primitive&, const CageInput&, Diagnostics&);

} // namespace alpenglow::geometry
