// SubdivisionMesh scheme nverts verts tags; HierarchicalSubdivisionMesh, the same with edits.
#include "geometry/factories.h"
#include "geometry/hierarchical_edits.h"

namespace alpenglow::geometry {

ShapeRef makeSubdivisionMesh(ShapeSource s, Diagnostics& diag) {
    CageInput in;
    if (!readCage(*s.primitive, diag, in)) return nullptr;
    std::vector<FaceDomain> domains;
    if (s.primitive->kind == "HierarchicalSubdivisionMesh")
        if (EditedCage edited = applyEdits(*s.primitive, in, diag); edited.primitive) {
            s.primitive = std::move(edited.primitive);
            in = std::move(edited.in);
            domains = std::move(edited.domains);
        }
    auto shape = std::make_shared<Subdivision>(std::move(s), std::move(in), std::move(domains), diag);
    return shape->empty() ? nullptr : shape;
}

} // namespace alpenglow::geometry
