// The caustic guide of a frame under path: learned from photons before the first sample (docs/light.md). Inside render/.
#pragma once
#include "render/rendering.h"

namespace alpenglow::render {

/// Lets paths of the job's world aim at mirrors and glass that light comes from, where its options do not forbid it and photons
/// find such light: the same for all parts, samples and threads of a picture. False: stopped.
bool learnCaustics(Job&);

} // namespace alpenglow::render
