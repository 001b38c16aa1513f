// A digest of a scene: renders can be parts of one picture only if their digests are equal.
#pragma once
#include "scene/fwd.h"
#include <string>

namespace alpenglow::render {

/// 16 hexadecimal digits over everything in the frame that can change a sample: geometry, names and parameters of shaders,
/// lights, attributes, camera, filter, and `extra`, the caller's own options. Excludes displays, exposure and file positions, and
/// the contents of shader and texture files.
std::string sceneDigest(const scene::Frame&, const std::string& extra);

} // namespace alpenglow::render
