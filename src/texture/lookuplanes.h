// Many lookups at once: shared by the lanes (texture/lanes/lookup.inc) and their preparation. Plain data, and no header with
// code, because the lanes are compiled for several processors.
#pragma once
#include <cstdint>

namespace alpenglow::texture {

struct LookupOptions;

/// Lookup filters. The first three are defined by their variances; the others are sums over their shapes (texture/kernels.h),
/// which lanes leave to filteredLookup().
enum class Filter { Box, Triangle, Gaussian, Disk, CatmullRom, SeparableCatmullRom, Mitchell, Sinc, Lanczos, Bessel };
inline constexpr int kFilters = int(Filter::Bessel) + 1;
inline constexpr bool hasShape(Filter f) { return int(f) > int(Filter::Gaussian); }

/// Up to sixteen lookups in one map. Each gives the bits of lookup2D().
struct LookupLanes {
    static constexpr int kLanes = 16; ///< lookups of a block
    uint32_t mask = 0; ///< bit i: lane i looks up; the rows of the others are not looked at, and their results stay
    /// As lookup(): position, and its differences along the axes of the screen, in maps.
    alignas(64) float s[kLanes], t[kLanes], dsdx[kLanes], dtdx[kLanes], dsdy[kLanes], dtdy[kLanes];
    alignas(64) float swidth[kLanes], twidth[kLanes], sblur[kLanes], tblur[kLanes], fill[kLanes]; ///< as in LookupOptions
    Filter filter[kLanes];                                                                        ///< shape of the filter
    float squeeze = 0;                ///< as in LookupOptions, of all lanes
    alignas(64) float out[4][kLanes]; ///< channels first, first + 1, ... of each lane of the mask
    /// Sets these options for all lanes.
    void set(const LookupOptions&);
};

/// A level, as lanes see it.
struct LaneLevel {
    const float* numbers;        ///< null: `codes`
    const uint8_t* codes;        ///< null: `numbers`
    const float* tables[4];      ///< values of codes of the requested channels
    int width, height, channels; ///< texels; numbers of a texel
};

/// Positions and weights of the probes of a lookup, by filter, number less one, and probe.
struct LaneProbes {
    static constexpr int kMost = 32; ///< most probes of a lookup
    /// Positions in standard deviations of the filter; the weights of a lookup add up to 1.
    float position[3][kMost][kMost], weight[3][kMost][kMost];
};

/// Common data of the lookups of a batch.
struct LaneJob {
    const LaneLevel* levels;  ///< 0 is the picture
    int last;                 ///< level
    int first, count;         ///< channels, all of them present; 1 to 4
    float width, height;      ///< of level 0
    int swrap, twrap;         ///< Wrap
    float variance[3];        ///< of the filters
    const LaneProbes* probes; ///< the same for all batches
};

using LookUpLanes = void (*)(const LaneJob&, LookupLanes&, float* out); ///< out: 4 floats for each of the 16 lanes

} // namespace alpenglow::texture
