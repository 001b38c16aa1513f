// Whether a frame is rendered in light or in numbers of its own (docs/colour.md).
#pragma once
#include "base/diagnostics.h"
#include "scene/fwd.h"
#include "scene/primitive.h"

namespace alpenglow::scene {

/// Whether a frame keeps its own numbers: its 8-bit maps are read as they are, and so are its pictures written. Never under path.
/// Under hidden and raytrace an old scene does, told by what it says itself: Exposure, Quantize, or a Display of a type that
/// RenderMan had from the start (file, framebuffer) under a name that is not of a later format (.png .jpg .jpeg .exr).
bool keepsOwnNumbers(const Options&, bool path);

/// Whether colours of 8-bit maps that declare nothing are read as sRGB: Option "texture" "colorspace" "srgb" or "linear"; else,
/// and by "auto", where the frame does not keep its own numbers. Another word is reported.
bool readsMapsAsLight(const Options&, bool path, Diagnostics&);

} // namespace alpenglow::scene
