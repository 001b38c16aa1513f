// The core that lookup.cpp and environment.cpp share.
#pragma once
#include "texture/texture.h"

namespace alpenglow::texture {

/// "textureformat" of a cube map: six square faces from top to bottom, px nx py ny pz nz; "fovcot" holds 1 / tan(fov / 2).
extern const char* const cubeFormat;
/// "colorspace" of a map of floats that was made of a picture of 8 bits which declares nothing.
inline constexpr const char* kEightBits = "8 bits";
/// "colorspace" of a map whose numbers are light.
inline constexpr const char* kLight = "light";

/// lookup() on one map that has levels, with wrap modes that may differ from the map's own. `slopes`, `curves`: as for
/// lookup(), or null.
void filteredLookup(const Texture&, int first, int count, float s, float t, const Footprint&, const LookupOptions&, Wrap swrap,
                    Wrap twrap, float* out, float* slopes = nullptr, float* curves = nullptr);

/// Lookups in 4, 8 or 16 lanes at a time; null: this processor cannot. All give the same bits.
LookUpLanes lookUpLanes(int lanes);

/// A text attribute; empty when it is not there.
std::string textOf(const display::Image&, const char* key);
/// Colours from sRGB to light; alpha and depth stay.
void toLight(display::Image&);

} // namespace alpenglow::texture
