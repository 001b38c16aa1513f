// The shaders that scenes and commands find by name.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace alpenglow::cli {

/// A shader that was found.
struct ListedShader {
    std::string name, kind, file; ///< kind: "surface", ..., "class"
    std::string doc;              ///< the first sentence of the comment at the top of the file; "" when there is none
    bool hidden = false;          ///< a folder before it has a shader of that name, which is found instead
};

/// Shaders of the .sl files of the folders, in the order of the search, by name within a folder. Nothing is compiled.
std::vector<ListedShader> listShaders(const std::vector<std::string>& folders);
/// A line each, under the name of their folder.
std::string shaderListText(const std::vector<ListedShader>&);
/// The list for programs.
nlohmann::ordered_json shaderListJson(const std::vector<ListedShader>&);

} // namespace alpenglow::cli
