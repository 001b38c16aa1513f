// The words of an OSL text. Inside of osl.cpp.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::rsl::front {

/// One word and where it stands.
struct OslWord {
    /// What a word is. Sign: an operator or bracket.
    enum class Kind : uint8_t { Name, Number, String, Sign, Directive };
    Kind kind;                ///< what it is
    std::string text;         ///< as written
    int lines = 0;            ///< that begin between the word before and this
    int line = 0, column = 0; ///< of its first byte, from 1
    bool bound = false;       ///< [[int lockgeom = 0]] follows: the parameter takes a variable of the primitive
};

/// Comments and [[metadata]] left out, but for lockgeom.
std::vector<OslWord> oslWords(std::string_view text);

/// Whether it names a type of a value that RSL has, too.
bool isOslType(std::string_view);

/// Whether a variable of surface shaders has that name and type (of RSL).
bool isRslGlobal(const std::string& name, const std::string& type);

/// Whether RSL means something else by a name, so that a variable cannot have it.
bool isRslWord(const std::string& name);

} // namespace alpenglow::rsl::front
