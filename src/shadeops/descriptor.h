// What a shadeop is: one object that the checker, the code generator, `alpenglow info --shadeops`, the manual and the tests read.
// The code of a runtime shadeop is in the file of its descriptor, that of its section of the 3Delight manual, 6.4.
#pragma once
#include "shadeops/types.h"
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::shadeops {

/// How the IR builder turns a call into IR.
enum class Lowering : uint8_t {
    Runtime,    ///< pure arithmetic in the bitcode runtime; one symbol a signature, instantiated on jets (see Signature::symbol)
    Rsl,        ///< the body is RSL text (Shadeop::rsl), inlined like a user's function
    Special,    ///< the IR builder knows it by name (Du, transform, spline, format, ...)
    Service,    ///< answered by the renderer at once, through KernelCall::service (texture, attribute, printf, ...)
    Request,    ///< answered by rays or lights: affine pair or suspension (trace, transmission, diffuse under path, ...)
    Unavailable ///< type-checks; reported once with its place as not yet available
};

/// How derivatives pass through (docs/design/rsl.md, "Derivatives").
enum class DerivativeRule : uint8_t {
    Jet,      ///< the runtime template is instantiated on Jet1 and Jet2: exact
    Zero,     ///< mathematically zero almost everywhere (floor, cellnoise, step)
    ZeroWarn, ///< results of rays and lights: taken as zero, warned once
    Gradient, ///< textures: the renderer gives the slopes with the value; second derivatives are those of the coordinates
    Inherent  ///< the lowering makes the derivative itself (Rsl and Special)
};

/// What is known of the expected value of a result that is sampled: right at every number of samples, right in the limit, or
/// wrong for the reason in Shadeop::biasReason.
enum class Bias : uint8_t { Unbiased, Consistent, Biased };

/// A parameter of a signature.
struct Parameter {
    Type type;            ///< also the types that convert to it are accepted
    std::string name;     ///< for manuals and messages
    bool output = false;  ///< by reference
    bool uniform = false; ///< must be uniform
};

/// One way to call a shadeop: "float noise(point p; float w)".
struct Signature {
    Type result;                       ///< Void: a statement
    std::vector<Parameter> parameters; ///< in their order; strings included
    bool repeats = false;              ///< the last parameter may be given any number of times ("...")
    bool pairs = false;                ///< token/value pairs may follow ("; ..." pairs)
    /// Runtime: base name of the bitcode functions. `symbol` + "_0", "_1", "_2" are the instantiations on plain lanes, Jet1,
    /// Jet2:
    ///   extern "C" void sym_k(const vf* in, vf* out)
    /// in: the arguments flattened, component after component, each component as its jet parts {v}, {v,du,dv} or
    /// {v,du,dv,duu,duv,dvv}; out: the result (if not void), then the output parameters, flattened the same way.
    /// The matrix m[r][c] is flattened row by row. Strings are interned ids, bit-cast int32 lanes.
    /// Output parameters are among the arguments too: `in` holds the value they had before the call.
    /// A Runtime signature that `repeats` names a function of two arguments, to be folded from the left: min(min(a, b), c).
    std::string symbol;
    std::string text; ///< as written
};

/// A parameter given by a token and a value behind the others.
struct OptionalParameter {
    Type type;                    ///< of the value
    std::string name;             ///< the token
    bool output = false;          ///< the value is a variable that the call sets
    std::string defaultText, doc; ///< text of the default; text of the manual
};

/// "radians(180)" gives "3.141593" under `alpenglow eval`, after the statements of `setup`; or, where `when` says so, in such a
/// scene.
struct Example {
    std::string expression, value, setup = {}, when = {}; ///< RSL; printed result; statements; condition on the scene, in words
};

/// What a shadeop filters over beyond its coordinates: where these go from sample to sample. The compiler adds the differences to
/// the call.
struct Footprint {
    /// What the coordinates are.
    enum class Of : uint8_t {
        Nothing, ///< it does not filter
        Surface, ///< two floats, by default s and t; another form takes four corners of them
        Space    ///< a point or direction
    } of = Of::Nothing;
    size_t first = 0;     ///< the argument where the coordinates begin
    size_t count = 0;     ///< Space: arguments of the form that has a footprint
    bool corners = false; ///< Space: another form takes four corners
    bool marks = false;   ///< Surface: a call without coordinates gets a further argument, 1
};

/// A function of the shading language.
struct Shadeop {
    std::string name;                                ///< as in shaders
    std::vector<Signature> signatures;               ///< in the order in which they are tried
    uint32_t contexts = kAnyContext;                 ///< kinds of shaders that may call it
    Lowering lowering = Lowering::Runtime;           ///< how the compiler translates a call
    DerivativeRule derivative = DerivativeRule::Jet; ///< how a result gets its derivatives
    bool pure = true;                                ///< same arguments, same result, no effect: may be folded, merged, removed
    bool outOfLine = false;                          ///< large (noise): called, not inlined
    int widest = 64;                         ///< the most lanes whose runtime has it: large ones take 30 s to compile at 32 lanes
    Bias bias = Bias::Unbiased;              ///< of its result
    std::string biasReason;                  ///< for the manual; "": unbiased
    std::string section;                     ///< "Mathematics", "Noise", ... as in the 3Delight manual, 6.4
    std::string doc;                         ///< semantics and edge cases
    std::string source;                      ///< what people can look up: a section, a paper; what is our own
    std::vector<Example> examples;           ///< for the manual; tests run them
    std::vector<OptionalParameter> optional; ///< parameters that are named by tokens
    std::vector<Base>
        lastResort;      ///< results that are chosen only if no other converts to the wanted type: the distance of trace()
    Footprint footprint; ///< Lowering::Service
    std::string rsl;     ///< Lowering::Rsl: the functions in RSL; names as in signatures
};

/// All shadeops, sorted by name. Built once, immutable.
std::span<const Shadeop> allShadeops();
/// Null: there is none of that name.
const Shadeop* findShadeop(std::string_view name);

/// Parses "float noise(point p; float w)", "type min(type x, y, ...)" is not accepted here: list generics one by one.
/// "any" as a parameter's type is Base::Void: every type is accepted (printf). "shader" is Base::Shader: a handle is the name of
/// what it stands for. Arrays: "float p[]", "float p[4]", "float[] p", result "color[]". In a parameter list "uniform" and
/// "output" may precede a type; a final "..." sets `repeats`; a final "; pairs" sets `pairs`.
Signature parseSignature(std::string_view text, std::string symbol = {});

/// Evaluates a Runtime shadeop on one point, order 0, with the code that kernels run (compiled into the program at 4 lanes).
/// in/out flattened as for Signature::symbol. False when the symbol is unknown.
bool evaluateRuntime(std::string_view symbol, const float* in, int inCount, float* out, int outCount);

} // namespace alpenglow::shadeops
