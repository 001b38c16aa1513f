#include "geometry/piece_grid.h"
#include <opensubdiv/bfr/tessellation.h>

namespace alpenglow::geometry {

PieceGrid PieceGrid::make(const int* rates, int edges) {
    namespace Bfr = OpenSubdiv::Bfr;
    const Bfr::Parameterization shape(edges == 3 ? OpenSubdiv::Sdc::SCHEME_LOOP : OpenSubdiv::Sdc::SCHEME_CATMARK, edges);
    const Bfr::Tessellation t(shape, edges, rates);
    PieceGrid g;
    g.border = t.GetNumBoundaryCoords();
    std::vector<float> uv(2 * size_t(t.GetNumCoords()));
    t.GetCoords(uv.data());
    for (size_t i = 0; i < uv.size(); i += 2) g.param.push_back({uv[i], uv[i + 1]});
    std::vector<int> facets(3 * size_t(t.GetNumFacets()));
    t.GetFacets(facets.data());
    g.facet.assign(facets.begin(), facets.end());
    return g;
}

} // namespace alpenglow::geometry
