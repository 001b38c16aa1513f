// What glass and GGX reflection share: visible facets with the distribution of Trowbridge and Reitz.
#pragma once
#include "bsdf/kinds/facets.h"

namespace alpenglow::bsdf::AL_NAMESPACE {

/// Converts a direction to the space where facets of roughness a and b are isotropic with roughness 1; unit.
AL_INLINE Direction stretched(const Direction& o, vf a, vf b) { return normalize(Direction{o.x * a, o.y * b, o.z}); }
/// A GGX facet: halfway between the viewer o and a direction on the cap above -low (both stretched) around z (Dupuy and Benyoub,
/// "Sampling Visible GGX Normals with Spherical Caps", 2023). low = o.z: all visible facets.
AL_INLINE Direction visibleGgx(const Direction& o, vf low, vf a, vf b, const Pair<vf>& u) {
    const vf z = mad(vf(1) - u.a, low + vf(1), -low), s = rootOf(mad(-z, z, vf(1)));
    const Pair<vf> d = unitCircle(u.b);
    return normalize(Direction{a * mad(s, d.a, o.x), b * mad(s, d.b, o.y), z + o.z});
}

} // namespace alpenglow::bsdf::AL_NAMESPACE
