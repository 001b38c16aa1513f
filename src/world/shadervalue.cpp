#include "world/shadervalue.h"
#include "shading/faceindex.h"
#include <cstdlib>

namespace alpenglow::world {

ShaderValue::ShaderValue(const Information& i) : numbers(i.numbers), texts(i.texts) {}

rsl::ir::Kind ShaderValue::kindOf(shadeops::Base b) {
    using rsl::ir::Kind;
    return b == shadeops::Base::String   ? Kind::String
           : b == shadeops::Base::Matrix ? Kind::Matrix
           : b == shadeops::Base::Float  ? Kind::Float
                                         : Kind::Triple;
}

std::optional<ShaderValue> shaderParameter(const ShaderInstance& shader, const std::string& parameter) {
    for (const rsl::ParameterInfo& p : shader.program->parameters()) {
        if (p.name != parameter) continue;
        const auto& texts = shader.parameters.strings;
        int length = std::max(1, p.type.array);
        if (p.open)
            if (const auto given = texts.find(rsl::lengthParameter(p.name)); given != texts.end())
                length = std::atoi(given->second.c_str());
        ShaderValue t(p.type, length);
        t.varying = p.storage == rsl::Storage::Varying;
        if (p.type.base == shadeops::Base::String) {
            for (int e = 0; e < length; ++e) {
                const auto text = texts.find(p.type.array ? p.name + "[" + std::to_string(e) + "]" : p.name);
                t.texts.push_back(text == texts.end() ? "" : text->second);
            }
        } else if (const auto n = shader.parameters.numbers.find(p.name); n != shader.parameters.numbers.end()) {
            t.numbers = n->second;
        }
        return t;
    }
    return std::nullopt;
}

std::optional<ShaderValue> primitiveVariable(const geometry::Shape& shape, const geometry::SurfacePoint& at,
                                             const std::string& name) {
    using rsl::ir::Kind;
    ShaderValue t;
    if (const int v = shape.findPrimvar(name); v >= 0) {
        const geometry::PrimVar& variable = shape.primvars()[size_t(v)];
        t.varying = variable.cls != scene::Class::Constant && variable.cls != scene::Class::Uniform;
        t.elements = variable.arrayLength;
        if (variable.type == scene::Type::String) {
            t.kind = Kind::String;
            t.texts = {shape.stringValue(v, at)};
            return t;
        }
        t.kind = variable.type == scene::Type::Matrix                                           ? Kind::Matrix
                 : variable.type == scene::Type::Float || variable.type == scene::Type::Integer ? Kind::Float
                                                                                                : Kind::Triple;
        t.numbers.resize(size_t(variable.outWidth()));
        shape.interpolate(v, at, t.numbers.data(), nullptr, nullptr);
        return t;
    }
    // Variables that every primitive has.
    const scene::Attributes& a = shape.attributes();
    const auto triple = [&](const Vec3& v, bool varying) {
        t.kind = Kind::Triple;
        t.varying = varying;
        t.numbers = {v.x, v.y, v.z};
        return t;
    };
    if (name == "P") return triple(at.displaced ? shape.evaluate(at.face, at.u, at.v).P : at.P, true);
    if (name == "N") return triple(at.N, true);
    if (name == "Cs") return triple({a.color.x, a.color.y, a.color.z}, false);
    if (name == "Os") return triple({a.opacity.x, a.opacity.y, a.opacity.z}, false);
    t.kind = Kind::Float;
    if (name == shading::kFaceIndex) {
        t.numbers = {float(at.face)};
        return t;
    }
    if (name != "s" && name != "t" && name != "st") return std::nullopt;
    t.varying = true;
    t.elements = name == "st" ? 2 : 0;
    if (name != "t") t.numbers.push_back(at.s);
    if (name != "s") t.numbers.push_back(at.t);
    return t;
}

} // namespace alpenglow::world
