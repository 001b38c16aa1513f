// The shader parameter that gets the number of the face where the primitive has no variable of its name.
#pragma once

namespace alpenglow::shading {

inline constexpr char kFaceIndex[] = "__faceindex";

} // namespace alpenglow::shading
