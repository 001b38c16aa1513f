// Shaders that share a source file: PRMan's compiler wrote one .slo for each of them, so a scene names them as if each had its
// own.
#pragma once
#include "base/diagnostics.h"
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::rsl {

/// The first .sl file of the directories (in order, then by name) whose text declares a shader or class of that name. Text in
/// comments and strings does not count. At most limits::kShaderFilesLooked files of limits::kShaderFileLooked bytes are read.
std::optional<std::string> fileWithShader(const std::string& name, const std::vector<std::string>& directories);

/// Whether a file named .sl is a link to one that is not: words of it would stand in messages. That is an error, which is
/// reported.
bool leadsToNoSource(const std::string& path, Diagnostics&);

/// Whether a text declares a shader or class of that name.
bool declaresShader(const std::string& text, const std::string& name);

/// A shader or class that a text declares.
struct DeclaredShader {
    std::string kind, name; ///< "surface", "class"
};
/// All of them, in the order of the text; what includes and macros bring is not among them.
std::vector<DeclaredShader> shadersDeclared(const std::string& text);

} // namespace alpenglow::rsl
