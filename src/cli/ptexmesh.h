// Meshes with colours, which maketx makes Ptex files of.
#pragma once
#include "ptex/ptexfile.h"

namespace alpenglow::cli {

/// How a Ptex file is written.
struct PtexOptions {
    int log = 3;                              ///< logarithm of the pixels along a side of a face
    ptex::Number number = ptex::Number::Half; ///< how values are stored
    bool allowWrite = true;                   ///< as OutputPolicy::allowWrite
};

/// Of a PLY file in text: vertices with x, y, z and, or faces with, red, green, blue (numbers of 0 to 1, bytes of 0 to 255);
/// colours of faces fill them, those of vertices go linearly over them. All faces are triangles, or all have four corners; which
/// are adjacent follows from their corners. False: an error was reported.
bool makePtex(const std::string& from, const std::string& to, const PtexOptions&, Diagnostics&);

} // namespace alpenglow::cli
