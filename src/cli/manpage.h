// Manual pages in the language of man(7).
#pragma once
#include "cli/commandtext.h"

namespace alpenglow::cli {

/// Of a command: alpenglow-COMMAND.1. Of "", the program: alpenglow.1, with the commands, exit statuses and environment.
std::string manPage(const ProgramText&, const std::string& command);

/// An environment variable that the program reads, and what it is for.
struct VariableText {
    const char *name, *help; ///< its name; a sentence
};
/// All of them, in the order of the manual.
const std::vector<VariableText>& environmentVariables();

} // namespace alpenglow::cli
