// Names of other renderers' programs under which this one is called, by a link of that name, and the flags of their tools.
#pragma once
#include "cli/oldflags.h"
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::cli {

/// A program that this one replaces.
struct OldName {
    std::string_view name;    ///< "txmake"
    std::string_view command; ///< "maketx", or a subcommand with its first argument: "ptc brick"; "": not done
    std::string_view instead; ///< of what is not done: what to use here; else a note, or ""
};

/// All of them, in the order of the manual.
std::span<const OldName> oldNames();

/// The entry of a program's own name, "/opt/bin/txmake" or "txmake.exe". Null: it is none of them.
const OldName* oldNameOf(const char* program);

/// Flags of the tools that a subcommand replaces: "maketx", "compile", "info", "rib", "ptc". Empty for others.
std::span<const OldFlag> toolFlags(std::string_view command);

/// For `alpenglow render -catrib` and renderdl's -cat, and what catrib takes from the environment (RIFORMAT, RICOMPRESSION,
/// RISERVER): `arguments` as those of `rib`. name: the program's own entry, may be null. Others stay as they are.
void takeCatrib(std::vector<std::string>& arguments, const OldName* name);

/// The tables for docs/options.md.
std::string oldNamesPage();

} // namespace alpenglow::cli
