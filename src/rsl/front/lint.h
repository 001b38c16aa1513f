// Warnings that only who writes a shader wants to see (`compile -W`, the language server): a renderer that loads a shader from
// 1995 keeps quiet about them.
#pragma once
#include "rsl/front/lexer.h"
#include "rsl/front/source.h"
#include <string>
#include <unordered_set>
#include <vector>

namespace alpenglow::rsl::front {

/// Looks through a checked program and warns about parameters and variables of the main file that nothing uses, variables that
/// are read before they have a value, uniform variables that are changed where a varying condition holds, and what lint_calls.h
/// knows. Trees with errors in them are looked at as far as they go; names in text that could not be read, `skipped`, count as
/// used.
void lint(const Program&, const std::vector<Token>&, const std::unordered_set<std::string>& skipped, SourceSet&);

} // namespace alpenglow::rsl::front
