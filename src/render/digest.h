// A digest of a scene: two renders are parts of one picture only when theirs are equal.
#pragma once
#include "scene/fwd.h"
#include <string>

namespace alpenglow::render {

/// 16 hexadecimal digits over all of the frame that can change a sample: geometry, shaders' names and parameters, lights,
/// attributes, camera, filter, and `extra`, where the caller puts its own options. Displays, exposure and places in files do not
/// count. The text of shaders and textures is not looked at.
std::string sceneDigest(const scene::Frame&, const std::string& extra);

} // namespace alpenglow::render
