// The shaders of a frame with their parameters, and frames in which some of these are others.
#pragma once
#include "scene/fwd.h"
#include "scene/primitive.h"
#include <map>
#include <optional>

namespace alpenglow::view {

/// A shader call of a frame; calls that primitives share are one.
struct ShaderUse {
    std::string role; ///< "surface", "displacement", "atmosphere", "interior", "exterior", "coshader", "light", "imager"
    scene::ShaderRef call;
    size_t primitives = 0; ///< that have it
    std::string handle;    ///< of a light or a co-shader
    bool area = false;     ///< a light of AreaLightSource
};

/// In the order of the scene; the first `most` of them.
std::vector<ShaderUse> shadersOf(const scene::Frame&, size_t most);

/// By index in shadersOf(): parameters that replace those of the call.
using ParameterChanges = std::map<size_t, scene::ParamList>;
/// The frame with these changes; unchanged parts are shared.
std::shared_ptr<const scene::Frame> changed(const std::shared_ptr<const scene::Frame>&, const std::vector<ShaderUse>&,
                                            const ParameterChanges&);

} // namespace alpenglow::view
