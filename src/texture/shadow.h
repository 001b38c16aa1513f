// shadow(): depth maps by percentage-closer filtering (the comparison is filtered, not the depth).
#pragma once
#include "texture/texture.h"

namespace alpenglow::texture {

struct ShadowOptions {
    float swidth = 1, twidth = 1, sblur = 0, tblur = 0; ///< as LookupOptions
    float samples = 16;                                 ///< comparisons spread over the footprint, at most 1024
    float bias = 0; ///< world units; a point is lit when its depth - bias is not behind the map
};

/// The part of the footprint that is in shadow, 0..1, of a point in world space with its changes per pixel. 0 where the map does
/// not look, behind its camera, and without a map or its matrices. The map's depth is camera-space z (ri.md 3.2).
float shadowLookup(Handle, const Vec3d& world, const Vec3d& ddx, const Vec3d& ddy, const ShadowOptions&);

} // namespace alpenglow::texture
