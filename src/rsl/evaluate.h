// RSL at one point: `alpenglow eval`, and the value tests of the language.
#pragma once
#include "rsl/compiler.h"
#include "rsl/services_basic.h"

namespace alpenglow::rsl {

/// The values of the predefined variables at the point:
///   u = v = s = t = 0.5, du = dv = 1, dtime = 0, time = 0, ncomps = 3, alpha = 1
///   P = (0,0,0), dPdu = (1,0,0), dPdv = (0,1,0), N = Ng = (0,0,1), dPdtime = 0, I = (0,0,1), E = (0,0,-1) = P - I
///   Cs = Os = Oi = 1, Ci = 0
/// and their derivatives are consistent: dP/du = dPdu, dP/dv = dPdv, du/du = ds/du = dv/dv = dt/dv = 1; I moves with P (E is
/// fixed); everything else is constant. Every named coordinate system is "current".
struct EvaluationPoint {
    /// Part `part` (0 value, then du, dv, duu, duv, dvv) of component `component` of input `name`; false when the name is not
    /// known.
    static bool value(const std::string& name, int component, int part, float& out);
};

/// The result of evaluate().
struct Evaluation {
    bool ok = false;            ///< false: errors were reported
    Type type;                  ///< of the expression; Void when it was a statement
    std::vector<float> numbers; ///< element after element; empty for strings
    std::string text;           ///< formatted: numbers as %.7g separated by spaces, a string as it is
    std::string printed;        ///< by printf()
};

/// A ServiceFn for a kernel, by which the caller answers what this folder cannot, such as maps. Returns false if it does not
/// answer the call and has written nothing.
using AnswerFn = std::function<bool(const CompiledKernel&, int32_t site, int32_t first, uint64_t mask, int32_t lanes,
                                    const float* in, float* out)>;

/// Evaluates `expression` after the statements of `setup` in a surface shader at the point above. The type is the first of float,
/// color, point, vector, normal, matrix, string that the expression can be assigned to. Places in messages refer to the file name
/// "expression".
Evaluation evaluate(ShaderCompiler&, const std::string& setup, const std::string& expression, const KernelOptions&, Diagnostics&,
                    const AnswerFn& answer = {});

/// The batch behind evaluate(): runs a kernel on n copies of the point. out[output][component] of point `at`.
/// False when the kernel suspends. printf() of the first point is appended to `printed` when not null.
bool runAtPoint(const CompiledKernel&, bool mixed, int n, int at, std::vector<std::vector<float>>& out, std::string* printed,
                Diagnostics&, const AnswerFn& answer = {});

/// "%.7g" of each, separated by spaces.
std::string formatNumbers(const std::vector<float>&);

} // namespace alpenglow::rsl
