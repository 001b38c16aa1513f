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
    bool there = false;         ///< the parameter has a default
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
    std::string name, type, storage;   ///< "float[3]", "shader[]"; "uniform"
    bool output = false, open = false; ///< declared output; an array of open length
    int array = 0;                     ///< 0: none; of open ones the length of their default
    DefaultDescription byDefault;      ///< the default value
};

/// What the compiler found out about one kind of shader that a class can be, or about the one that a shader is.
struct KindDescription {
    std::string kind; ///< "surface"
    /// Predefined variables that it writes; texts of the lobe calls that stay direct under path.
    std::vector<std::string> writes, direct;
    bool indirectApart = false; ///< rsl::kPairApart
    /// As `alpenglow info` prints them.
    bool compiled = false, affine = true, suspends = false, lightLoops = false, ambient = false;
    std::string whyNot; ///< why it is not affine, or does not compile; ""
};

/// A member variable of a class.
struct MemberDescription {
    std::string type, name, storage;         ///< storage: "uniform", "varying", or ""
    bool isPublic = false, constant = false; ///< declared public; declared constant
};

/// A method of a class.
struct MethodDescription {
    std::string signature, name; ///< as declared; its name alone
    bool isPublic = false;       ///< declared public
    bool entry = false;          ///< the renderer calls it
};

/// A shader or class.
struct ShaderDescription {
    std::string name, file;                                       ///< of the shader; of its text or compiled form
    bool object = false;                                          ///< a class
    std::vector<std::string> categories;                          ///< of __category
    std::vector<ParameterDescription> parameters;                 ///< in the order of the declaration
    std::vector<MemberDescription> members;                       ///< of a class
    std::vector<MethodDescription> methods;                       ///< of a class
    std::vector<rsl::StructSummary> structs;                      ///< declared in the file
    std::vector<std::pair<std::string, std::string>> annotations; ///< keys and values
    std::vector<std::shared_ptr<const rsl::Plugin>> plugins;      ///< from which it calls functions
    std::vector<KindDescription> kinds;                           ///< at least one; of a class all that its methods make it
};

/// Describes a shader. If it cannot be compiled, that is reported, and the description has what is known.
ShaderDescription describe(rsl::ShaderCompiler&, const std::shared_ptr<const rsl::CompiledShader>&, Diagnostics&);

/// The description for programs and for people.
nlohmann::ordered_json descriptionJson(const ShaderDescription&);
/// The same as text.
std::string descriptionText(const ShaderDescription&);

} // namespace alpenglow::cli
