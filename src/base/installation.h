// Where the files that belong to the program are. They are found from the folder of the file that this code was loaded from (the
// program, libalpenglow.so, an extension module of Python), so that an installation may be moved. A build folder has the same
// layout (its share/alpenglow/shaders is a link to the sources), except that modules lie in the folder of the program.
//
//   <prefix>/bin/alpenglow                                    build/<preset>/bin/alpenglow, with the modules
//   <prefix>/<lib>/libalpenglow.so                            build/<preset>/lib/libalpenglow.so
//   <prefix>/<lib>/alpenglow/                   the modules
//   <prefix>/<lib>/alpenglow/python/alpenglow/  extension     build/<preset>/python/alpenglow/
//   <prefix>/share/alpenglow/shaders/                         build/<preset>/share/alpenglow/shaders
#pragma once
#include <filesystem>
#include <string>

namespace alpenglow {

/// The file that this code was loaded from, links resolved: the running program, unless the code is in a library that it loaded.
/// Empty when the system does not tell it.
std::filesystem::path codeFile();
/// Its folder; empty when the system does not tell it.
std::filesystem::path codeFolder();

/// The folder of the shaders that ship, for code in `folder`; "" when there is none.
std::string shippedShaders(const std::filesystem::path& folder = codeFolder());

/// A module of the program (libalpenglow_*.so), or another file of their folder, for code in `folder`. When the
/// environment variable `variable` is set, it names the file, and no other is looked for; nullptr: there is none. "" when there
/// is no such file.
std::string moduleFile(const char* name, const char* variable, const std::filesystem::path& folder = codeFolder());

} // namespace alpenglow
