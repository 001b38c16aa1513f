// Name of the shader parameter that receives the face number, unless the primitive has a variable of this name.
#pragma once

namespace alpenglow::shading {

inline constexpr char kFaceIndex[] = "__faceindex"; ///< name of the variable with the number of a face (docs/ptex.md)

} // namespace alpenglow::shading
