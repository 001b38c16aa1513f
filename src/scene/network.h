// Networks of patterns (PRMan 21 and later, RIS): which parameters of a shader call take outputs of which patterns. A call keeps
// its connections among its parameters, and the patterns that they mean among the co-shaders of the attributes, so that copies of
// either have them as well.
#pragma once
#include "scene/primitive.h"
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::scene {

/// "reference color diffuseColor" ["tex:resultRGB"]: the parameter takes an output of the pattern of that handle.
struct Connection {
    std::string parameter;
    int element = -1; ///< of an array; -1: the parameter is none
    std::string handle, output;
    SourcePlace place;
};

/// The connection as a parameter of its call. No request can give one of that name.
Param connectionParam(const Connection&);
/// What connectionParam() made; nothing for any other parameter.
std::optional<Connection> connectionOf(const Param&);
/// All connections of a call, in the order of its parameters.
std::vector<Connection> connectionsOf(const ShaderCall&);

/// Requests that keep the patterns that their connections named when they were read; later patterns of the same handles do not
/// affect them.
enum class Keeper { Surface, Displacement, Interior, Light };
/// Key of Attributes::coshaders of a pattern that is kept.
std::string keptHandle(Keeper, std::string_view handle);
/// Whether a key of Attributes::coshaders is one: those are no co-shaders that getshaders() gives.
bool isKept(std::string_view key);
/// The handle in the scene that a key stands for.
std::string_view plainHandle(std::string_view key);

} // namespace alpenglow::scene
