// That a parameter takes an output of a co-shader (networks of patterns, scene/network.h): as the compiler and those who run its
// kernels have agreed on it, in KernelOptions::stringParameters and CoShader::strings.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace alpenglow::rsl {

struct Connected {
    std::string handle;  ///< of the co-shader
    std::string output;  ///< its parameter
    bool member = false; ///< of a struct: no warning if the co-shader lacks the output

    /// Of a parameter, or of one element of it; element -1: it is no array.
    static std::string key(std::string_view parameter, int element = -1);
    static bool isKey(std::string_view);
    static std::optional<Connected> parse(std::string_view text);
    std::string text() const;
};

} // namespace alpenglow::rsl
