// Our IR: structured SSA between the checker and LLVM. Values, not variables; regions, not jumps: masks, derivatives and the
// affine proof all become walks over a tree. Printable (print.h) and verified (verify.h).
#pragma once
#include "rsl/front/ast.h"
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace alpenglow::rsl::ir {

/// What a value is made of. Points, vectors, normals and colours are all Triple: spaces were resolved by the builder.
enum class Kind : uint8_t { None, Bool, Float, Triple, Matrix, String, Array };
int components(Kind); ///< Float 1, Triple 3, Matrix 16, String 1 (interned id), Bool 1

/// What an instruction does; behind each op the members of Inst that it uses.
enum class Op : uint8_t {
    // leaves
    Const,       ///< numbers[0..components): the value
    ConstString, ///< text
    Input,       ///< index: Kernel::inputs
    RegionParam, ///< index: position in Region::params
    Result,      ///< args[0] = If, Loop, LightLoop, Runtime, Call, Service or Request instruction with several results; index
    // arithmetic: Float, Triple (component-wise), both operands of one kind
    Add,
    Sub,
    Mul,
    Div, ///< x / 0 = 0 (the language forbids a trap; written down in docs/language.md)
    Neg,
    Splat,    ///< Float to Triple
    Triple,   ///< three Floats
    Extract,  ///< component `index` of a Triple or Matrix
    MatrixOf, ///< sixteen Floats, row by row
    // comparison of Floats, or of Strings (Equal, NotEqual): Bool
    Less,
    LessEqual,
    Equal,
    NotEqual,
    And,
    Or,
    Not,
    Select,  ///< args: Bool, a, b; any kind but Array
    ToFloat, ///< Bool to 0 or 1
    // calls
    Runtime, ///< symbol = Signature::symbol of a pure shadeop; args flattened by type; results by `Result`, or itself when single
    Function, ///< a user function that is not inlined: regions[0]: params, yields = results. text: its name. At the front of the
    ///< kernel, behind the leaves and the functions it calls; its body uses nothing from outside but leaves and functions
    Call,    ///< args[0] = Function, then its arguments; results as it yields
    Service, ///< site: Kernel::sites; args; effect unless the site says pure
    Request, ///< site: rays or lights; see passes/affine.h
    Emit,    ///< affine form of a Request: args[0] = weight (Triple), then the request's arguments; site. No result.
    Mark,    ///< affine form: Float, the number of pairs emitted so far by these lanes' strip (for Rescale)
    Rescale, ///< affine form: args = mark, factor (Triple), end mark: pairs emitted between the two marks are multiplied by
             ///< factor
    // derivatives: d/du, d/dv of a Float or Triple; the operand carries one order more than the result
    Du,
    Dv,
    // arrays are storage, not values
    ArrayNew,   ///< index = length; element kind in `element`; zeroed
    ArrayInput, ///< a shader parameter that is an array: index = Kernel::inputs (length there)
    ArrayLoad,  ///< array, index (Float, truncated; out of range reads the nearest element and is reported by the builder if
                ///< constant)
    ArrayStore, ///< array, index, value; masked
    // control: regions
    If,   ///< args[0] = Bool; regions then, else; results = yields of the taken region
    Loop, ///< args = initial values; regions[0]: params = carried, yields = {Bool continue}; regions[1]: params = carried, yields
          ///< = next
    LightLoop, ///< illuminance. args: P, axis, angle, then initial carried values; site: category, pairs. regions[0]: params =
               ///< L, Cl, Ol (Triples), lightIndex (Float), then carried; yields = next carried
    // effects
    Output ///< index: Kernel::outputs; args[0] = value
};
/// As dumps of the IR name it.
const char* name(Op);

struct Inst;
/// A block of instructions within another, or the body of the kernel.
struct Region {
    std::vector<Inst*> params; ///< RegionParam instructions
    std::vector<Inst*> body;   ///< in order
    std::vector<Inst*> yields; ///< values of the construct around it
};

/// An instruction, and its result as a value. Kernel::pool owns it.
struct Inst {
    Op op{};                     ///< what it does
    Kind kind{};                 ///< kind of the (single) result; None with several results (then `results`)
    Kind element = Kind::None;   ///< arrays
    std::vector<Kind> results;   ///< of instructions with several results
    std::vector<Inst*> args;     ///< operands
    std::vector<Region> regions; ///< bodies of a construct
    int index = 0;               ///< depends on op: component, region or result
    int site = -1;               ///< of Loop: what is called when its turns have no end (passes/looplimit.h)
    std::vector<float> numbers;  ///< of a constant
    std::string text;            ///< symbol or string constant
    Place place;                 ///< in the shader, for messages
    uint32_t id = 0;             ///< for printing
    // filled by passes
    uint8_t order = 0; ///< jet order that must be carried, 0..2 (passes/derivatives.h)
};

/// A value that comes from outside: a predefined variable, an instance parameter, a matrix between spaces.
/// Names: "P" "N" "Ng" "u" ... for predefined variables; "param:Kd" for shader parameters; "space:FROM>TO" (Matrix) for named
/// spaces, always with "current" on one side; "inverse:..." is not needed, the caller supplies both.
struct Input {
    std::string name;        ///< InputName::text()
    Kind kind = Kind::Float; ///< element kind when an array
    Type type;               ///< language type, for callers that fill it
    int array = 0;           ///< 0: none
    bool uniform = false;    ///< laid out as one value for the batch (build S)
    bool constant = false;   ///< does not change over the surface: no derivatives, in build V too
    uint8_t order = 0;       ///< derivatives the kernel reads (passes/derivatives.h)
};
/// What a kernel writes; names are those of OutputName.
struct OutputSlot {
    std::string name;        ///< OutputName::text()
    Kind kind = Kind::Float; ///< of a component
    Type type;               ///< of the value, for callers
};

/// A call site of a Service, Request or LightLoop: everything about it that is constant.
struct Site {
    std::string op;                       ///< "texture", "trace", "diffuse", "illuminance", "printf", ...
    std::vector<std::string> strings;     ///< positional string arguments that are constant ("" where not constant)
    std::vector<std::string> names;       ///< names of the optional pairs, in the order their values follow in args
    std::vector<std::string> pairStrings; ///< the pair's constant string value, "" for numeric pairs
    std::vector<Kind> argKinds;    ///< flattened argument kinds, positional then pairs (Strings that are constant are left out)
    std::vector<Type> argTypes;    ///< of the arguments, before they were flattened
    std::vector<Kind> resultKinds; ///< of the results, flattened
    std::vector<std::string> resultNames; ///< result "" for the value, then names of output pairs / output arguments
    Type resultType;                      ///< of the value
    bool pure = false;                    ///< Shadeop::pure
    const Shadeop* shadeop = nullptr;     ///< null: a loop over lights
    Place place;                          ///< of the call
};

/// What the passes found out, for `alpenglow info` and the scheduler.
struct KernelFacts {
    bool affine = true; ///< every Request was turned into Emit
    std::string whyNot; ///< the first place that is not affine, in words
    /// Something that keeps the kernel from being affine: the call whose result is concerned, and why.
    struct NonLinear {
        std::string op, why; ///< for messages
        Place place;         ///< of the call
        /// For people: "specular, line 12: ...".
        std::string text() const { return op + ", line " + std::to_string(place.line) + ": " + why; }
    };
    std::vector<NonLinear> nonLinear;               ///< everything; not kept in kernel files
    bool suspends = false;                          ///< Requests are left: the kernel becomes a coroutine
    bool lightLoops = false;                        ///< it has loops over lights
    std::vector<std::pair<int, std::string>> stuck; ///< sites that no weight can be given to, with the reason (passes/affine.h)
    std::vector<NonLinear> direct;                  ///< lobe calls that stay direct under path
    bool ambientLight = false;                      ///< light: no illuminate and no solar
    /// Light: "illuminate", "solar" or "solar()" (all directions) for each block, in order; then "outside" when Cl is also set
    /// outside them. Outputs of block k > 0 are L#k Cl#k Ol#k lit#k; of what is outside, Cl#(number of blocks).
    std::vector<std::string> blocks;
    std::string opacity;             ///< surface: what Oi is: "Os", "1", or "shader" when it must be run to know
    std::vector<std::string> writes; ///< predefined variables that the shader assigns
};

/// An output of a kernel, and whether the light that its Requests ask for reaches it.
struct OutputLight {
    OutputSlot output;
    bool light;
};
/// One kernel in static single assignment form with structured control flow.
struct Kernel {
    std::string name;                       ///< of the shader
    ShaderKind kind{};                      ///< of shader
    std::string light = "Ci";               ///< KernelOptions::light
    std::vector<Input> inputs;              ///< in the order of KernelCall::in
    std::vector<OutputSlot> outputs;        ///< in the order of KernelCall::out
    std::vector<Site> sites;                ///< numbered by Inst::site
    std::vector<std::string> files;         ///< Place::file
    Region body;                            ///< the code
    KernelFacts facts;                      ///< by the passes
    std::deque<std::unique_ptr<Inst>> pool; ///< owns all instructions

    /// A new instruction with the next id, in no region yet.
    Inst* make(Op op, Kind result, std::vector<Inst*> args = {});
};

} // namespace alpenglow::rsl::ir
