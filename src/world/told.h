// Values that shaders tell each other: of parameters, of primitive variables, of attributes.
#pragma once
#include "world/information.h"

namespace alpenglow::transport {

/// What somebody is told: the value of a parameter, of a primitive variable, of an attribute.
struct Told {
    /// Of an element; none: as many numbers or texts as there are, for a variable of that size.
    std::optional<rsl::ir::Kind> kind;
    int elements = 0;     ///< 0: no array. Not used where the kind is not known
    bool varying = false; ///< does not fit a uniform variable
    std::vector<float> numbers;
    std::vector<std::string> texts;
    Told() = default;
    explicit Told(const Information&);
    /// Of a type of the shading language, still without a value.
    explicit Told(const rsl::Type& type, int length) : kind(kindOf(type.base)), elements(type.array ? length : 0) {}
    static rsl::ir::Kind kindOf(rsl::Base);
};

/// A parameter of a shader as the scene gave it; nothing when it has none of that name.
std::optional<Told> toldBy(const ShaderInstance&, const std::string& parameter);
/// A primitive variable at a point of the shape; nothing when it has none of that name.
std::optional<Told> primitiveVariable(const geometry::Shape&, const geometry::SurfacePoint&, const std::string& name);

} // namespace alpenglow::transport
