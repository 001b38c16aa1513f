// Deep copies. Each shader gets its own of every unchecked function, in which the predefined variables are its own symbols.
#pragma once
#include "rsl/front/ast.h"

namespace alpenglow::rsl::front {

/// `rename`: calls of the first name become calls of the second; both may be empty.
std::unique_ptr<Function> clone(const Function&, const std::pair<std::string, std::string>& rename);
/// With its nested functions and all its symbols.
std::unique_ptr<Shader> clone(const Shader&);
/// A checked program, with errors or without: calls in the copy are bound to the functions of the copy.
std::unique_ptr<Program> clone(const Program&);
/// Checked expressions too: what they are bound to stays the same.
ExprPtr clone(const Expr&);

} // namespace alpenglow::rsl::front
