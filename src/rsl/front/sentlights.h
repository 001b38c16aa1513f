// Names by which class lights of PRMan, of which the front end makes ordinary ones, and loops over their samples know each other.
#pragma once

namespace alpenglow::rsl {

/// A parameter of lights that send through generateSamples() and have a light() that only says zero: outside of path they light
/// nothing but loops over samples.
inline constexpr char kSentOnly[] = "__sentOnly";
/// The category of these loops, those of directlighting(): all lights but those of a category that none has.
inline constexpr char kSampleLoop[] = "-__sent";

} // namespace alpenglow::rsl
