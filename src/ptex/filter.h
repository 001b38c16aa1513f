// Lookups in Ptex files, filtered across the edges of faces.
#pragma once
#include "ptex/ptexfile.h"

namespace alpenglow::ptex {

/// The filter over the footprint.
enum class Kernel : uint8_t { Gaussian, Triangle, Box, Point };

/// One lookup.
struct Query {
    uint32_t face = 0;                ///< index
    float u = 0, v = 0;               ///< 0 to 1 within the face
    float wu = 0, wv = 0;             ///< how wide the footprint is along u and v
    int channel = 0, count = 3;       ///< channels that are read, from this one on
    float fill = 0;                   ///< of those that the file does not have
    Kernel kernel = Kernel::Gaussian; ///< of the lookup
};

/// Writes Query::count numbers. Returns false, with zeros, if there is no such face. Thread safe; the same bits for any caller.
/// If two ways lead around a corner, each counts half; if a face has no neighbour, the file's border mode applies.
bool lookup(const Texture&, const Query&, float* out);

} // namespace alpenglow::ptex
