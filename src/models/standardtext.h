// The text of shaders/standard.sl taken apart, so that other surfaces can be made of it whose parameters are worked out.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::models {

/// A parameter of the shader.
struct StandardParameter {
    std::string type;  ///< "varying float", "string": as declared
    std::string name;  ///< as in the text
    std::string array; ///< "[2]", or ""
    std::string value; ///< the default, as text
    /// "float", "color", "normal", "string": without varying and uniform.
    std::string plainType() const;
};

/// The text in parts.
struct StandardText {
    std::vector<std::string> includes;         ///< lines
    std::vector<StandardParameter> parameters; ///< in their order
    std::string body;                          ///< between the braces
};

/// Nothing: the text has another form than `surface standard(TYPE NAME = VALUE, NAME = VALUE; ...) { ... }`.
std::optional<StandardText> takeApart(const std::string& standard);

} // namespace alpenglow::models
