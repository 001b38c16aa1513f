// Serialises messages and figures between a process and its forks: numbers in native byte order.
#pragma once
#include "base/diagnostics.h"
#include "render/outcome.h"
#include <string>
#include <string_view>

namespace alpenglow::render {

/// The bytes of a message or of a frame's figures.
std::string packed(Diagnostic);
std::string packed(FrameResult);
/// Return false if the bytes are not from packed().
bool unpack(std::string_view, Diagnostic&);
bool unpack(std::string_view, FrameResult&);

} // namespace alpenglow::render
