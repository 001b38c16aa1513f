#include "geometry/osd_cage.h"
#include <algorithm>
#include <mutex>
#include <opensubdiv/far/error.h>
#include <opensubdiv/far/topologyDescriptor.h>

namespace alpenglow::geometry {

namespace Osd = OpenSubdiv;

namespace {

Osd::Sdc::SchemeType schemeOf(SubdivisionScheme s) {
    switch (s) {
    case SubdivisionScheme::Loop:
        return Osd::Sdc::SCHEME_LOOP;
    case SubdivisionScheme::Bilinear:
        return Osd::Sdc::SCHEME_BILINEAR;
    default:
        return Osd::Sdc::SCHEME_CATMARK;
    }
}

Osd::Sdc::Options optionsOf(const SubdivisionCage& c) {
    using O = Osd::Sdc::Options;
    using F = SubdivisionCage::FaceVarying;
    O o;
    o.SetVtxBoundaryInterpolation(c.boundary == SubdivisionCage::Boundary::None       ? O::VTX_BOUNDARY_NONE
                                  : c.boundary == SubdivisionCage::Boundary::EdgeOnly ? O::VTX_BOUNDARY_EDGE_ONLY
                                                                                      : O::VTX_BOUNDARY_EDGE_AND_CORNER);
    o.SetFVarLinearInterpolation(c.faceVarying == F::EdgeOnly                 ? O::FVAR_LINEAR_NONE
                                 : c.faceVarying == F::EdgeAndCorner          ? O::FVAR_LINEAR_CORNERS_PLUS1
                                 : c.faceVarying == F::EdgeAndCornerPropagate ? O::FVAR_LINEAR_CORNERS_PLUS2
                                                                              : O::FVAR_LINEAR_BOUNDARIES);
    o.SetCreasingMethod(c.chaikin ? O::CREASE_CHAIKIN : O::CREASE_UNIFORM);
    o.SetTriangleSubdivision(c.smoothTriangles ? O::TRI_SUB_SMOOTH : O::TRI_SUB_CATMARK);
    return o;
}

} // namespace

std::unique_ptr<Osd::Far::TopologyRefiner> makeRefiner(const SubdivisionCage& c,
                                                       const std::vector<LimitSurface::Channel>& channels) {
    static std::once_flag quiet;
    std::call_once(quiet, [] { // callers report errors
        Osd::Far::SetErrorCallback([](Osd::Far::ErrorType, const char*) {});
        Osd::Far::SetWarningCallback([](const char*) {});
    });
    Osd::Far::TopologyDescriptor d;
    d.numVertices = c.vertices;
    d.numFaces = int(c.corners.size());
    d.numVertsPerFace = c.corners.data();
    d.vertIndicesPerFace = c.vertex.data();
    d.numCreases = int(c.creaseSharpness.size());
    d.creaseVertexIndexPairs = c.creaseEnds.data();
    d.creaseWeights = c.creaseSharpness.data();
    d.numCorners = int(c.cornerVertex.size());
    d.cornerVertexIndices = c.cornerVertex.data();
    d.cornerWeights = c.cornerSharpness.data();
    d.numHoles = int(c.holes.size());
    d.holeIndices = c.holes.data();
    std::vector<Osd::Far::TopologyDescriptor::FVarChannel> fvar(channels.size());
    for (size_t k = 0; k < channels.size(); ++k) {
        fvar[k].valueIndices = channels[k].data();
        fvar[k].numValues = channels[k].empty() ? 0 : 1 + *std::max_element(channels[k].begin(), channels[k].end());
    }
    d.numFVarChannels = int(fvar.size());
    d.fvarChannels = fvar.data();
    using Factory = Osd::Far::TopologyRefinerFactory<Osd::Far::TopologyDescriptor>;
    return std::unique_ptr<Osd::Far::TopologyRefiner>(Factory::Create(d, Factory::Options(schemeOf(c.scheme), optionsOf(c))));
}

} // namespace alpenglow::geometry
