// A cage refined uniformly, level by level, with its values. The rules are OpenSubdiv's.
#pragma once
#include "geometry/limit_surface.h"
#include "scene/primitive.h"
#include <map>

namespace alpenglow::geometry {

/// A cage that owns its lists.
struct RefinedCage {
    SubdivisionCage cage;                    ///< its lists look at those below
    std::vector<int> corners, vertex;        ///< per face: how many; per corner
    std::vector<Vec2> origin, along, across; ///< per face: its square in the (u, v) of the original face
    std::vector<scene::Param> values;        ///< numbers of any class but Constant; of face-varying ones one a corner
    std::vector<uint8_t> smooth;             ///< per value: face-varying, smoothed
    std::vector<std::vector<int>> children;  ///< per face of the level before: the faces it became

    /// Points the cage to the lists; after every change of these.
    void look() { cage.corners = corners, cage.vertex = vertex; }
    /// Refines by one level. Returns false if OpenSubdiv rejects its topology.
    bool refine();
};

} // namespace alpenglow::geometry
