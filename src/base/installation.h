// Where the files that belong to the program are. They are found from the folder of the running program, so that an installation
// may be moved. A build folder has the same layout (its share/alpenglow/shaders is a link to the sources), except that modules
// lie beside the program.
#pragma once
#include <filesystem>
#include <string>

namespace alpenglow {

/// The folder of the running program, links resolved; empty when the system does not tell it.
std::filesystem::path programFolder();

/// The folder of the shaders that ship, for a program in `folder`; "" when there is none.
std::string shippedShaders(const std::filesystem::path& folder = programFolder());

/// A module of the program (libalpenglow_*.so), for a program in `folder`. When the environment variable `variable` is set, it
/// names the file, and no other is looked for. "" when there is no such file.
std::string moduleFile(const char* name, const char* variable, const std::filesystem::path& folder = programFolder());

} // namespace alpenglow
