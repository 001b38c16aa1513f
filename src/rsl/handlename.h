// The texts that stand for handles while a shader runs, and what people read instead.
#pragma once
#include <string>

namespace alpenglow::rsl {

/// Before the number of a light, in the handles that getlights() gives; a colon and the handle of its declaration stand behind it.
inline constexpr char kLightHandle[] = "light#";

/// What "%h" and messages call a handle: lights and co-shaders by the handle of their declaration, no shader "<null>" (seed, format()).
inline std::string shownHandle(const std::string& handle) {
    if (handle.empty()) return "<null>";
    if (handle.rfind(kLightHandle, 0) != 0) return handle;
    const size_t colon = handle.find(':');
    return colon == std::string::npos ? handle : handle.substr(colon + 1);
}

} // namespace alpenglow::rsl
