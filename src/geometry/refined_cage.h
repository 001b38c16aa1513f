// A cage that is refined as a whole, level by level, with the values that lie on it. OpenSubdiv has the rules.
#pragma once
#include "geometry/limit_surface.h"
#include "scene/primitive.h"
#include <map>

namespace alpenglow::geometry {

struct RefinedCage {
    SubdivisionCage cage; ///< its lists look at those below
    std::vector<int> corners, vertex;
    std::vector<Vec2> origin, along, across; ///< per face, its square in the (u, v) of the face it came from
    std::vector<scene::Param> values;        ///< numbers of any class but Constant; of face-varying ones one a corner
    std::vector<uint8_t> smooth;             ///< per value: face-varying, smoothed
    std::vector<std::vector<int>> children;  ///< per face of the level before: the faces it became

    void look() { cage.corners = corners, cage.vertex = vertex; }
    /// One level deeper. False: OpenSubdiv cannot take its topology.
    bool refine();
};

} // namespace alpenglow::geometry
