// Words that the tables of options and attributes share.
#pragma once
#include "scene/knownoptions.h"

namespace alpenglow::scene {

using enum Effect;

/// Renderers whose names are accepted without an effect.
inline constexpr std::string_view kPrman = "PRMan", kDelight = "3Delight", kAqsis = "Aqsis", kBmrt = "BMRT",
                                  kSeveral = "several renderers";

} // namespace alpenglow::scene
