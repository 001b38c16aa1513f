// Messages and figures as bytes, between a process and its copies: numbers are as they lie in memory.
#pragma once
#include "base/diagnostics.h"
#include "render/outcome.h"
#include <string>
#include <string_view>

namespace alpenglow::render {

std::string packed(Diagnostic);
std::string packed(FrameResult);
/// False: the bytes are none of packed().
bool unpack(std::string_view, Diagnostic&);
bool unpack(std::string_view, FrameResult&);

} // namespace alpenglow::render
