// Names that the RSL of the library (rsl/library/classes) shares with loops over the samples of class lights.
#pragma once

namespace alpenglow::rsl {

/// A parameter of lights that send through generateSamples() and have a light() that only says zero: outside of path they light
/// nothing but loops over samples.
inline constexpr char kSentOnly[] = "__sentOnly";
/// The category of these loops, those of directlighting(): all lights but those of a category that none has.
inline constexpr char kSampleLoop[] = "-__sent";

} // namespace alpenglow::rsl
