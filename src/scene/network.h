// Networks of patterns (PRMan 21 and later, RIS): which parameters of a shader call take outputs of which patterns. A call keeps
// its connections (ShaderCall::connections), and the attributes the patterns that they mean among their co-shaders, so that
// copies of either have them as well.
#pragma once
#include "scene/primitive.h"
#include <string>
#include <string_view>

namespace alpenglow::scene {

/// Requests that keep the patterns that their connections named when they were read; later patterns of the same handles do not
/// affect them.
enum class Keeper { Surface, Displacement, Interior, Light };
/// Key of Attributes::coshaders of a pattern that is kept.
std::string keptHandle(Keeper, std::string_view handle);
/// Whether a key of Attributes::coshaders is one: those are no co-shaders that getshaders() gives.
bool isKept(std::string_view key);
/// The handle in the scene that a key stands for.
std::string_view plainHandle(std::string_view key);

} // namespace alpenglow::scene
