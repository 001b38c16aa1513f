// That a parameter takes an output of a co-shader (networks of patterns, scene/network.h): what the callers of the compiler say
// by KernelOptions::connections and CoShader::connections.
#pragma once
#include <compare>
#include <map>
#include <string>

namespace alpenglow::rsl {

/// The parameter that takes it, or one element of it.
struct ConnectionPlace {
    std::string parameter;
    int element = -1; ///< -1: it is no array
    auto operator<=>(const ConnectionPlace&) const = default;
};

/// What gives the value of a connected parameter.
struct Connected {
    std::string handle;  ///< of the co-shader
    std::string output;  ///< its parameter
    bool member = false; ///< of a struct: no warning if the co-shader lacks the output
    bool operator==(const Connected&) const = default;
};

using Connections = std::map<ConnectionPlace, Connected>; ///< by place: which output is connected

} // namespace alpenglow::rsl
