// Networks of patterns (scene/network.h): which co-shaders the connections of a shader reach.
#pragma once
#include "scene/network.h"
#include "world/bound.h"

namespace alpenglow::world {

class MutableWorld;

/// Whether parameters of a shader take outputs of patterns.
bool takesOutputs(const ShaderInstance&);

/// Notes a connection of the request that the instance is made from: of the parameter of that name, or of the members of a struct
/// (parameter NAME_x takes output OUTPUT_x). A warning, once, where there is no such parameter.
void connect(ShaderInstance&, const scene::Connection&, Diagnostics&);

/// Adds to the co-shaders of an instance the patterns that it takes outputs of, with those that they take outputs of. A missing
/// shader is reported once.
void addPatterns(MutableWorld&, const ShaderInstance&, const std::map<std::string, scene::ShaderRef>& coshaders,
                 std::vector<std::pair<std::string, scene::ShaderRef>>& to, Diagnostics&);

} // namespace alpenglow::world
