// Values that shaders query from each other: parameters, primitive variables, attributes.
#pragma once
#include "world/information.h"

namespace alpenglow::world {

/// A queried value: of a parameter, a primitive variable or an attribute.
struct ShaderValue {
    /// Type of an element; none: numbers or strings for a variable of that size.
    std::optional<rsl::ir::Kind> kind;
    int elements = 0;               ///< 0: not an array. Unused if the kind is unknown
    bool varying = false;           ///< does not fit a uniform variable
    std::vector<float> numbers;     ///< element after element
    std::vector<std::string> texts; ///< of strings
    ShaderValue() = default;
    /// Uniform.
    explicit ShaderValue(const Information&);
    /// For a type of the shading language; no value yet.
    explicit ShaderValue(const shadeops::Type& type, int length) : kind(kindOf(type.base)), elements(type.array ? length : 0) {}
    static rsl::ir::Kind kindOf(shadeops::Base);
};

/// A parameter of a shader as set by the scene; nothing if it has none of that name.
std::optional<ShaderValue> shaderParameter(const ShaderInstance&, const std::string& parameter);
/// A primitive variable at a point of the shape; nothing if it has none of that name.
std::optional<ShaderValue> primitiveVariable(const geometry::Shape&, const geometry::SurfacePoint&, const std::string& name);

} // namespace alpenglow::world
