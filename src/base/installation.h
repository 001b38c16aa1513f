// Locates files of the program relative to the folder of the running program, so that an installation can be moved. A build
// folder has the same layout (its share/alpenglow/shaders is a link to the sources), except that modules are next to the program.
#pragma once
#include <filesystem>
#include <string>

namespace alpenglow {

/// The folder of the running program, with links resolved; empty if unknown.
std::filesystem::path programFolder();

/// The folder of the shipped shaders, for a program in `folder`; "" if there is none.
std::string shippedShaders(const std::filesystem::path& folder = programFolder());

/// A module of the program (libalpenglow_*.so), for a program in `folder`. If the environment variable `variable` is set, only
/// that file is considered. "" if there is no such file.
std::string moduleFile(const char* name, const char* variable, const std::filesystem::path& folder = programFolder());

} // namespace alpenglow
