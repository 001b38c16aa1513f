// The convention of specular(), in one place: its RSL form (shadeops/lighting.h) and its lobe (src/integrator) both read it.
#pragma once

namespace alpenglow::shadeops {

/// The exponent of specular() and specularbrdf() is this number over the roughness: pictures made by BMRT and PRMan follow it
/// (docs/gallery.md). A power of two, so that kSpecularExponent / (kSpecularExponent * r) is 1 / r to the bit.
inline constexpr float kSpecularExponent = 8;
/// As RISpec prints it: Option "shade" "specular" "rispec", or the dialect "rispec". That of specularstd() always.
inline constexpr float kRispecExponent = 1;

} // namespace alpenglow::shadeops
