// The core that lookup.cpp and environment.cpp share.
#pragma once
#include "texture/texture.h"

namespace alpenglow::texture {

/// "textureformat" of a cube map: six square faces from top to bottom, px nx py ny pz nz; "fovcot" holds 1 / tan(fov / 2).
extern const char* const cubeFormat;
/// "colorspace" of a float map made from an 8-bit picture without a declared colour space.
inline constexpr const char* kEightBits = "8 bits";
/// "colorspace" of a map with linear light.
inline constexpr const char* kLight = "light";

/// A footprint in texels of level 0: squared widths along the axes of its ellipse, and the unit vector of the longer.
struct Ellipse {
    float major = 0, minor = 0, x = 1, y = 0; ///< in texels squared; (x, y) is the direction of `major`
    float across = 0;                         ///< squared width across its longer side, in maps
};

/// The levels that interpolation at texel size u >= 1 blends: `level`, and of the next the part `next`.
struct LevelBlend {
    int level = 0;
    float next = 0;
};
LevelBlend blendOf(float u, int last);

/// Destination of a lookup: all channels exist. Slopes (ds, dt) and curves may be null.
struct Sums {
    float *out, *ds, *dt, *dss, *dst, *dtt; ///< `count` numbers each: value, and first and second derivatives by s and t
    int first, count;                       ///< channels of the map
    bool asLight;                           ///< linear light instead of the numbers of the file
    /// Adds weight times the map at (s, t), interpolated in and between levels.
    void add(const Texture&, const LevelBlend&, float s, float t, Wrap swrap, Wrap twrap, float weight) const;
};

/// A lookup by a filter that has a shape. kernels.cpp
void shapedLookup(const Texture&, float s, float t, const Ellipse&, Filter, Wrap swrap, Wrap twrap, const Sums&);

/// lookup() on one map that has levels, with wrap modes that may differ from the map's own. `slopes`, `curves`: as for
/// lookup(), or null.
void filteredLookup(const Texture&, int first, int count, float s, float t, const Footprint&, const LookupOptions&, Wrap swrap,
                    Wrap twrap, float* out, float* slopes = nullptr, float* curves = nullptr);

/// Lookups in 4, 8 or 16 lanes; null: not supported by this processor. All give the same bits.
LookUpLanes lookUpLanes(int lanes);

/// A text attribute; empty when it is not there.
std::string textOf(const display::Image&, const char* key);
/// Colours from sRGB to light; alpha and depth stay.
void toLight(display::Image&);

} // namespace alpenglow::texture
