// Text of RIB that the program writes itself.
#pragma once
#include <string>

namespace alpenglow::cli {

/// A RIB string: in quotes, with a backslash before each quote and backslash.
inline std::string ribString(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + "\"";
}

} // namespace alpenglow::cli
