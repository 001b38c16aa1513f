// All the code of the runtime, for one lane width.
#pragma once
#include "shadeops/colours.h"
#include "shadeops/geometry.h"
#include "shadeops/gradients.h"
#include "shadeops/lighting.h"
#include "shadeops/mathematics.h"
#include "shadeops/matrices.h"
#include "shadeops/splines.h"
// The widest bitcode is without the large functions (Shadeop::widest): no kernel with them works on that many points at once.
#if !defined(ALPENGLOW_BITCODE) || ALPENGLOW_LANES <= 32
#include "shadeops/noise.h"
#endif
#if !defined(ALPENGLOW_BITCODE) || ALPENGLOW_LANES <= 16
#include "shadeops/bsdf/all.h"
#endif
#ifndef ALPENGLOW_BITCODE
namespace alpenglow::shadeops::AL_NAMESPACE {
/// All runtime functions of the included headers.
inline constexpr int kEntryCount = __COUNTER__ - kFirstEntry;
inline constexpr auto kEntries = collectEntries(std::make_index_sequence<kEntryCount>{});
} // namespace alpenglow::shadeops::AL_NAMESPACE
#endif
