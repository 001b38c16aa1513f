// Scripts that complete the words of the command line in shells.
#pragma once
#include "cli/commandtext.h"

namespace alpenglow::cli {

/// For "bash", "zsh" or "fish"; "" for others.
std::string completion(const ProgramText&, const std::string& shell);

/// The script of one shell.
std::string bashCompletion(const ProgramText&);
std::string zshCompletion(const ProgramText&);
std::string fishCompletion(const ProgramText&);

} // namespace alpenglow::cli
