// A shader over arrays of points, without a scene.
#pragma once
#include "base/diagnostics.h"
#include "rsl/compiler.h"
#include <map>
#include <string>
#include <vector>

namespace alpenglow::python {

/// Numbers for every point, or one value for all.
struct PointRows {
    std::vector<float> numbers; ///< point after point, `width` each; of one value `width`
    int width = 1;              ///< numbers of one value
    bool each = false;          ///< a value for each point
};

/// What to run a shader on.
struct ShadeRequest {
    size_t points = 0;                           ///< number of points
    std::map<std::string, PointRows> variables;  ///< predefined ones: "P", "N", "u", "dPdu" ...
    std::map<std::string, PointRows> parameters; ///< of the shader, numbers
    std::map<std::string, std::string> strings;  ///< parameters that are strings
    std::vector<std::string> outputs;            ///< empty: what the kind of shader gives
    std::vector<std::string> searchPaths;        ///< for maps
    int lanes = 16;                              ///< of the kernel: 4, 8 or 16; results do not depend on it
    bool allowExec = false;                      ///< shaders may run programs
};

/// One output of the shader at all points.
struct ShadeOutput {
    std::string name;           ///< of the output variable
    int width = 1;              ///< numbers of a value
    std::vector<float> numbers; ///< point after point
};

/// Runs the shader at all points. What is not given is as at the points of `alpenglow shade --patch`: u = v = s = t = 0.5 (s is u
/// and t is v where these are given), P = (u, v, 0), dPdu = (1, 0, 0), dPdv = (0, 1, 0), N = Ng = (0, 0, 1), E = (0.5, 0.5, 1),
/// I = P - E, Cs = Os = Oi = 1, du = dv = 1, time 0; derivatives are those of this plane, of P those that dPdu and dPdv give, and
/// of a parameter with values for each point 0. There are no lights and nothing for rays to meet; every space is "current".
/// Nothing: an error was reported. For any thread.
std::vector<ShadeOutput> shadeArrays(rsl::ShaderCompiler&, std::shared_ptr<const rsl::CompiledShader>, const ShadeRequest&,
                                     Diagnostics&);

} // namespace alpenglow::python
