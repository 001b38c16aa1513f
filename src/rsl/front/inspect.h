// A program as far as it can be understood, for tools that look at shaders while they are written.
#pragma once
#include "rsl/front/ast.h"

namespace alpenglow::rsl {

/// As compileText(), but returns the tree even after errors: never null. A tree with errors in it has
/// calls without a callee and expressions without a type; it is for reading, not for compiling.
std::unique_ptr<Program> inspectText(const std::string& text, const std::string& name, const FrontOptions&, Diagnostics&);

} // namespace alpenglow::rsl
