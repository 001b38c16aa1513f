// Warnings that only those who write a shader want to see (`compile -W`, the language server): a renderer that loads a shader
// from 1995 reports none of them.
#pragma once
#include "rsl/front/lexer.h"
#include "rsl/front/source.h"
#include <string>
#include <unordered_set>
#include <vector>

namespace alpenglow::rsl::front {

/// Warns about a checked program, before lowerStructs(): parameters, variables and members of structures of the main file that
/// nothing uses, and what lint_flow.h and lint_calls.h describe. Trees with errors in them are read as far as they go. Names in
/// text that could not be read, `skipped`, count as used; unused members are reported only where there are no errors.
void lint(const Program&, const std::vector<Token>&, const std::unordered_set<std::string>& skipped, SourceSet&);

} // namespace alpenglow::rsl::front
