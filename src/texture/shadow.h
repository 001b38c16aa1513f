// shadow(): depth maps by percentage-closer filtering (the comparison is filtered, not the depth; Reeves, Salesin, Cook 1987).
#pragma once
#include "texture/texture.h"
#include <array>

namespace alpenglow::texture {

/// Parameters of one call.
struct ShadowOptions {
    float swidth = 1, twidth = 1, sblur = 0, tblur = 0; ///< as LookupOptions
    float samples = 16;                                 ///< comparisons spread over the footprint or the source, at most 1024
    /// World units: a point is lit if its depth minus bias is not behind the map. The comparisons of a lookup distribute their
    /// biases uniformly between the two.
    float bias0 = 0, bias1 = 0;
    /// Corners of an area light about the eye of the map, in world space and in order around it: its points are looked at one by
    /// one, through the surfaces that the map shows.
    std::optional<std::array<Vec3d, 4>> source;
    float gapbias = 0; ///< for source: minimum thickness of surfaces in the map, world units
};

/// About the smallest and the largest depth of surfaces in a map, in its units, from 64 by 64 of its texels; nothing for a map
/// without surfaces, a deep map and one with faces.
std::optional<std::pair<float, float>> depthsOf(const Texture&);

/// Shadowed fraction of the footprint, 0..1, for a point in world space with its differences between pixels. 0 outside of the
/// map, behind its camera, and without a map or its matrices. The map's depth is z in camera space. For a map with faces, uses
/// the face nearest to the point. Deep maps return opacity by channel; others the same for all.
Color shadowLookup(Handle, const Vec3d& world, const Vec3d& ddx, const Vec3d& ddy, const ShadowOptions&);
/// The same over the box that four points, in any order, span on the map, at the mean of their depths.
Color shadowLookupQuad(Handle, const Vec3d world[4], const ShadowOptions&);

} // namespace alpenglow::texture
