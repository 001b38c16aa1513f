// A frame that is also seen by another camera.
#pragma once

namespace alpenglow::scene {

/// Key in Options::values: rays of other cameras than the frame's are sent, so that what lies outside of its picture must be
/// there. No request can set it.
inline constexpr const char* kAnyCamera = "dice:__anycamera";

} // namespace alpenglow::scene
