// MaterialX 1.38: a material as a surface shader in RSL: the text of shaders/standard.sl whose parameters are worked out by the
// material's graph. Surfaces of the nodes standard_surface, gltf_pbr and UsdPreviewSurface. Source: MaterialX specification 1.38,
// standard nodes and physically based shading nodes (materialx.org).
#pragma once
#include "base/diagnostics.h"
#include "models/model.h"
#include <functional>
#include <string>

namespace alpenglow::models {

/// A picture that a material reads.
struct MaterialxMap {
    std::string file; ///< a path that was found
    bool colour;      ///< sRGB that becomes light; else numbers
    Wrap u, v;        ///< where u or v are outside 0 to 1
};
/// The name that shaders shall use for a picture; "" after an error that was reported.
using MaterialxMaps = std::function<std::string(const MaterialxMap&)>;

/// What a shader is made of.
struct MaterialxOptions {
    std::string file;     ///< the .mtlx file
    std::string material; ///< its name in the file; "" the first
    std::string shader;   ///< the name of the surface shader
    std::string standard; ///< the text of standard.sl
};

/// The text of a surface shader; "" after an error that was reported. What could not be said goes to the diagnostics.
std::string materialxShader(const MaterialxOptions&, const MaterialxMaps&, Diagnostics&);

} // namespace alpenglow::models
