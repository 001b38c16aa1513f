// Words that the tables of options and attributes share.
#pragma once
#include "base/knownoptions.h"

namespace alpenglow::known {

/// The values of Effect without a prefix, for the tables.
using enum Effect;

/// Renderers whose names are accepted without an effect.
inline constexpr std::string_view kPrman = "PRMan", kDelight = "3Delight", kAqsis = "Aqsis", kBmrt = "BMRT",
                                  kSeveral = "several renderers";

} // namespace alpenglow::known
