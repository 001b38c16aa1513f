// Everything that a shader declares, as text and as JSON, for `alpenglow info` and other tools.
#pragma once
#include "rsl/compiler.h"
#include "rsl/front/inspect.h"
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace alpenglow::cli {

/// The default value of a parameter.
struct DefaultDescription {
    bool there = false;
    bool null = false;          ///< of a handle: no shader
    bool named = false;         ///< it is computed from other parameters; the value is that of their defaults
    bool computed = false;      ///< it depends on what only a scene knows; there is no value then
    std::string written;        ///< as the shader has it; "" for what stands in no text (members of structures)
    std::string space;          ///< in which it is written: "hsv", "shader"; or ""
    std::vector<float> inSpace; ///< the numbers as written in that space
    rsl::ParameterValue value;  ///< colours in rgb; what is written in a space of points stays in it
};

/// One parameter.
struct ParameterDescription {
    std::string name, type, storage; ///< "float[3]", "shader[]"; "uniform"
    bool output = false, open = false;
    int array = 0; ///< 0: none; of open ones the length of their default
    DefaultDescription byDefault;
};

/// What the compiler found out about one kind of shader that a class can be, or about the one that a shader is.
struct KindDescription {
    std::string kind; ///< "surface"
    std::vector<std::string> writes, direct;
    bool indirectApart = false; ///< rsl::kPairApart
    bool compiled = false, affine = true, suspends = false, lightLoops = false, ambient = false;
    std::string whyNot;
};

/// A member variable of a class.
struct MemberDescription {
    std::string type, name, storage;
    bool isPublic = false, constant = false;
};

/// A method of a class.
struct MethodDescription {
    std::string signature, name;
    bool isPublic = false;
    bool entry = false; ///< the renderer calls it
};

/// A shader or class.
struct ShaderDescription {
    std::string name, file;
    bool object = false;                 ///< a class
    std::vector<std::string> categories; ///< of __category
    std::vector<ParameterDescription> parameters;
    std::vector<MemberDescription> members;
    std::vector<MethodDescription> methods;
    std::vector<rsl::StructSummary> structs;
    std::vector<std::pair<std::string, std::string>> annotations;
    std::vector<std::shared_ptr<const rsl::Plugin>> plugins;
    std::vector<KindDescription> kinds; ///< at least one; of a class all that its methods make it
};

/// Describes a shader. If it cannot be compiled, that is reported, and the description has what is known.
ShaderDescription describe(rsl::ShaderCompiler&, const std::shared_ptr<const rsl::CompiledShader>&, Diagnostics&);

/// The description for programs and for people.
nlohmann::ordered_json descriptionJson(const ShaderDescription&);
std::string descriptionText(const ShaderDescription&);

} // namespace alpenglow::cli
