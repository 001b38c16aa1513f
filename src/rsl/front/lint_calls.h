// The part of the warnings for those who write shaders (lint.h) that is about the arguments of calls: patterns of printf(), names
// that mean nothing, conditions that are assignments.
#pragma once
#include "rsl/front/lexer.h"
#include "rsl/front/paths.h"
#include "rsl/front/source.h"
#include <vector>

namespace alpenglow::rsl::front {

/// Warns about one expression of a checked program, not about those below it.
void lintCall(const Expr&, SourceSet&);

/// Warns where a uniform variable is to take what a shader of the same file has as varying: surface("x", u).
void lintMessage(const Expr&, const Program&, const Paths&, SourceSet&);

/// Warns about a condition of `if`, `while`, `for` that is an assignment.
void lintCondition(const Expr&, SourceSet&);

/// Warns about the pairs of a gather statement.
void lintPairs(const Stmt&, SourceSet&);

/// Warns about commas that nothing follows, in the main file.
void lintCommas(const std::vector<Token>&, SourceSet&);

} // namespace alpenglow::rsl::front
