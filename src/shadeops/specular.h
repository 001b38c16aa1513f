// The convention of specular(), in one place: its RSL form (shadeops/lighting.h) and its lobe (transport/) both read it.
#pragma once

namespace alpenglow {

/// The exponent of specular() and specularbrdf() is this number over the roughness. Fitted on pictures of the nineties (docs/gallery.md):
/// 1 / roughness, as RISpec prints it, leaves a tenth of the error of 8 / roughness.
inline constexpr float kSpecularExponent = 1;

} // namespace alpenglow
