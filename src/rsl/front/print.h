// A checked tree as text, for tests and for looking at.
#pragma once
#include "rsl/front/ast.h"

namespace alpenglow::rsl {

/// One expression on one line: "(add:color Cs (cast:color 2))".
std::string print(const Expr&);
/// A statement on one line: "(if (less:bool a b) (= c 1))".
std::string print(const Stmt&);
/// "float f(float x) (block ...)".
std::string print(const Function&);
/// "surface s(uniform float Kd = 1) (block ...)".
std::string print(const Shader&);

} // namespace alpenglow::rsl
