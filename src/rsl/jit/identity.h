// Which build of the program and of the code generator this is.
#pragma once
#include <string>

namespace alpenglow::rsl::jit {

/// The GNU build id of an ELF file in hexadecimal digits; "" when it has none or cannot be read.
std::string buildIdOfFile(const std::string& path);
/// The file of this code (the program, or libalpenglow.so) and libalpenglow_jit.so as it would be loaded, by their build ids (by
/// size and time of change where a file has none). Part of the key of every kernel in the cache: another build of either makes
/// its own.
const std::string& programIdentity();

} // namespace alpenglow::rsl::jit
