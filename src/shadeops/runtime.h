// All the code of the runtime, for one lane width.
#pragma once
#include "shadeops/bsdf/all.h"
#include "shadeops/colours.h"
#include "shadeops/geometry.h"
#include "shadeops/gradients.h"
#include "shadeops/lighting.h"
#include "shadeops/mathematics.h"
#include "shadeops/matrices.h"
#include "shadeops/noise.h"
#include "shadeops/splines.h"
#ifndef ALPENGLOW_BITCODE
namespace alpenglow::rsl::AL_NAMESPACE {
inline constexpr int kEntryCount = __COUNTER__ - kFirstEntry;
inline constexpr auto kEntries = collectEntries(std::make_index_sequence<kEntryCount>{});
} // namespace alpenglow::rsl::AL_NAMESPACE
#endif
