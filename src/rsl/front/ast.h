// The checked syntax tree. The parser builds it, the checker resolves names, overloads and conversions in place; what leaves the
// checker without errors is fully typed: every conversion is an explicit Cast node, every call is bound.
#pragma once
#include "base/diagnostics.h"
#include "rsl/front/plugin.h"
#include "rsl/names.h"
#include "shadeops/descriptor.h"
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace alpenglow::rsl {

/// The class of a variable: one value for all points, or one for each (RISpec 3.2, 11).
enum class Storage : uint8_t { Unspecified, Uniform, Varying };
/// The kinds of shaders (RISpec 3.2, 9).
enum class ShaderKind : uint8_t { Surface, Displacement, Light, Volume, Imager, Transformation };
/// The keyword of a shader definition: "surface".
const char* toString(ShaderKind);
/// The bit of a kind in Shadeop::contexts.
Context contextOf(ShaderKind);

/// Position in the file set of a Program: file index, line and column from 1.
struct Place {
    int file = 0, line = 0, column = 0;
};

struct Expr;
struct Stmt;
struct Function;
/// The parent owns its children.
using ExprPtr = std::unique_ptr<Expr>;
using StmtPtr = std::unique_ptr<Stmt>;

/// A variable of any origin. Address identity: two uses of one variable share the Symbol.
struct Symbol {
    /// Where it is declared. Global: predefined.
    enum class Origin : uint8_t { Local, ShaderParameter, FunctionParameter, Global };
    std::string name;                       ///< as declared; "this->x" for members
    Type type;                              ///< as declared
    Storage storage = Storage::Unspecified; ///< after checking: parameters of shaders default to Uniform, locals to Varying
    Origin origin = Origin::Local;
    bool output = false;     ///< shader: AOV; function: by reference
    bool writable = true;    ///< globals: by kind of shader
    bool isConstant = false; ///< `constant`: written where the shader begins, then never again
    bool open =
        false; ///< parameter of a shader, `float x[]`: as long as what the scene gives; `type` has the length of the default
    bool resizable = false; ///< `float x[]`, local or a parameter of a function: its length may change
    bool isExtern = false;  ///< only between parser and checker, which puts the outer variable in its place
    Place place;            ///< of the declaration
};

/// What an expression is; behind each kind the members of Expr that it uses.
enum class ExprKind : uint8_t {
    Number,      ///< number
    String,      ///< text
    Variable,    ///< symbol
    Index,       ///< args[0][args[1]]: array element, or component of a tuple (type Float), or matrix row is not allowed
    Unary,       ///< op Negate, Not
    Binary,      ///< op; operands already of matching types; Float operand of a tuple operation has been cast to the tuple
    Assign,      ///< args[0] = args[1]; op Assign (compound forms keep op: `a op= b`, args[1] cast to what op needs); value = new
                 ///< value
    Conditional, ///< args[0] ? args[1] : args[2]
    Tuple,       ///< (a,b,c) of type Color/Point/Vector/Normal; args = three floats; `space` = optional space name expression
    MatrixTuple, ///< 16 floats; `space` optional
    ArrayList, ///< {a, b, c} of an array type, type.array long; elements beyond the args are the last again (text "...") or zero
    Cast, ///< to `type`, from args[0] (Bool to Float too); `space` when written `point "shader" p` (value given in that space) or
          ///< color "hsv" c
    ShadeopCall,  ///< shadeop, signature; args = positional; pairs; `channel` for texture(name[channel]); outputs are lvalues
    FunctionCall, ///< function; args
    Sequence,     ///< args one after the other; its value is that of the last, which is no array
    Member,       ///< args[0]->text: a member of another shader; before checking, of a structure, too
    Method,       ///< args[0]->text(args[1], ...): a method of another shader; before checking, of a structure, too
    // Only between the checker and the pass that takes structures apart:
    Part,     ///< args[0]->text: a member of a structure; of an array of them, the array of that member of all
    Construct ///< a structure from its members, which args are
};
/// The operator of Unary, Binary and Assign.
enum class ExprOp : uint8_t {
    None,
    Add,
    Sub,
    Mul,
    Div,
    Dot,
    Cross,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
    Negate,
    Not,
    Assign
};

/// A token and its value, behind the positional arguments of a call or a statement.
struct NamedArg {
    /// Where the name comes from. A name that is no literal stands as a pair of its own, without a name, before the pair that it
    /// names: its value is a string, which is known when the kernel is built, or only when it runs (ir/build_names.cpp).
    enum class Name : uint8_t {
        Written,
        Made,  ///< `value` is the name of the next pair
        ByMade ///< the pair before gives the name; `output`: it may be one that is filled
    };
    std::string name;
    ExprPtr value;
    bool output = false;        ///< a variable that the call sets
    Place place;                ///< of the token
    Name named = Name::Written; ///< how the name is known
};

/// An expression, or the place of an assignment. Before checking `type` and what calls are bound to are not set.
struct Expr {
    ExprKind kind{};          ///< what it is
    ExprOp op = ExprOp::None; ///< of expressions with an operator
    Type type;
    bool varying = true; ///< by declaration and operands; the IR infers more
    Place place;
    bool handle = false;         ///< String: a handle, no text: null (empty), or what RSL has names for, "(this)", "(light)"
    int height = 1;              ///< of this tree; never above limits::kTreeHeight, so recursion over it is safe
    double number = 0;           ///< of Number
    std::string text;            ///< String; callee name before binding
    Symbol* symbol = nullptr;    ///< of Variable; owned by shader or function
    std::vector<ExprPtr> args;   ///< operands, arguments or components
    ExprPtr space;               ///< Tuple, MatrixTuple, Cast
    ExprPtr channel;             ///< texture-like calls
    std::vector<NamedArg> pairs; ///< token/value pairs of calls
    /// What a call is bound to, by the checker; null: something else.
    const Shadeop* shadeop = nullptr;
    const Signature* signature = nullptr;
    Function* function = nullptr; ///< user's function, or the RSL body of a Lowering::Rsl shadeop (then shadeop is set too)
};

/// What a statement is; of those about light the members of Stmt that they use.
enum class StmtKind : uint8_t {
    Block,
    Declare,
    Expression,
    If,
    While,
    For,
    Break,
    Continue,
    Return,
    Illuminance, ///< exprs: P [, axis, angle]; category; pairs; body
    Illuminate,  ///< exprs: from [, axis, angle]; body
    Solar,       ///< exprs: nothing or axis, angle; body
    Gather       ///< exprs: P, dir, angle, samples; category; pairs; body, elseBody
};

/// A statement.
struct Stmt {
    StmtKind kind{};           ///< what it is
    Place place;               ///< of its first token
    std::vector<StmtPtr> body; ///< Block: statements. Others: body[0]; For: init expr statements are exprs below
    StmtPtr elseBody;          ///< If, Gather
    ExprPtr condition;         ///< If, While, For
    ExprPtr init, step;        ///< For
    ExprPtr value;             ///< Expression, Return
    int levels = 1;            ///< Break, Continue
    /// Declare: one symbol each, with optional initialisers.
    struct Declarator {
        Symbol* symbol;
        ExprPtr init; ///< null: none
    };
    std::vector<Declarator> declarators;
    std::vector<ExprPtr> exprs;     ///< light statements
    ExprPtr category;               ///< of Illuminance and Gather; null: none
    std::vector<NamedArg> pairs;    ///< of Illuminance and Gather
    Function* definition = nullptr; ///< Declare: the place of a nested function's definition (no declarators)
};

/// A function of the shader, or a method of a class or a structure.
struct Function {
    std::string name;                ///< as declared; methods without the class
    Type result;                     ///< Void: none
    std::vector<Symbol*> parameters; ///< in their order
    std::vector<ExprPtr>
        defaults; ///< of a method: what a parameter is that a call leaves out; empty, or null where there is none
    StmtPtr body; ///< a Block
    std::vector<std::unique_ptr<Symbol>> symbols;  ///< owns parameters and locals
    std::vector<std::unique_ptr<Function>> nested; ///< functions defined in it
    bool anywhere = false; ///< a method that only other shaders call: of which kind these are is not known
    Place place;           ///< of the definition
};

/// What the light() of a class is called by now where it gave nothing and the samples of the class light instead.
inline constexpr const char* kReplacedLight = "__light";

/// A parameter that scenes set.
struct ShaderParameter {
    Symbol* symbol = nullptr;  ///< its variable
    ExprPtr defaultValue;      ///< null: zero, or of a member
    std::string defaultText{}; ///< the default as the shader writes it, macros expanded; "" where there is none
};

/// A member of a structure. Those of members that are structures are members of these.
struct StructMember {
    std::string name;                       ///< as declared
    Type type;                              ///< as declared
    Storage storage = Storage::Unspecified; ///< as declared
    ExprPtr init; ///< not checked: its names are those where a variable of the structure is declared; null: zero
    Place place;  ///< of the declaration
};

/// A structure as the shader declares it.
struct StructType {
    /// A method, by the place of its definition.
    struct Method {
        std::string name; ///< without the structure
        Place place;
    };
    std::string name;
    std::vector<StructMember> members;
    std::vector<Method> methods; ///< in the order of the text; they are functions of the program, called "Structure->method"
    int base = -1;               ///< the structure it extends, by its number in Program::structs; its members come first
    std::string text;            ///< the definition as written: a repeated, equal one is the same structure
    Place place;                 ///< of the definition
};

/// A shader, or a class as one of the kinds of shaders that it can be.
struct Shader {
    ShaderKind kind{};                             ///< surface, light, ...
    bool object = false;                           ///< made from a class: the body begins with the members, then the methods
    std::set<std::string> publics;                 ///< members and methods of a class that other shaders see
    std::string name;                              ///< of the shader or class
    std::vector<ShaderParameter> parameters;       ///< in their order
    StmtPtr body;                                  ///< the statements
    std::vector<std::unique_ptr<Symbol>> symbols;  ///< owns parameters, locals, and the globals used
    std::vector<std::unique_ptr<Function>> nested; ///< functions defined in it
    Place place;                                   ///< of the definition
    /// `#pragma annotation` key/value pairs, in order.
    std::vector<std::pair<std::string, std::string>> annotations;
};

/// One source file with its includes: shaders (usually one) and functions.
struct Program {
    std::map<std::string, Type> primitiveVariables; ///< names in getvar(), with the types of the variables that it fills
    bool rispecSpecular = false;                    ///< FrontOptions::rispecSpecular, or by the dialect
    bool handles = false;                           ///< it uses or queries members or methods of other shaders
    /// Outputs that outputchannel() makes, and their types; without "light:" or "local:".
    std::map<std::string, Type> channels;
    std::vector<std::string> files; ///< Place::file indexes this
    std::vector<std::unique_ptr<Shader>> shaders;
    /// Every function that a shader calls, once for each shader that calls it (its predefined variables and externs are then that
    /// shader's symbols); functions of the main file that nothing calls, once.
    std::vector<std::unique_ptr<Function>> functions;
    std::vector<StructType> structs;                    ///< in the order of the text; Type::structure indexes this
    std::string preprocessed;                           ///< text after includes and macros: part of the cache key
    std::vector<std::string> dependencies;              ///< every file read
    std::vector<std::shared_ptr<const Plugin>> plugins; ///< in the order of the text; calls refer to these
    /// FrontOptions::keepWritten: the program from before lowerStructs(), for tools; null where there are no structures.
    std::shared_ptr<const Program> written;
};

/// What preprocessing and checking depend on besides the text.
struct FrontOptions {
    std::vector<std::string> includePaths; ///< for #include, in order
    /// Whose predefined macros there are: "prman", "3delight" (also when empty), "aqsis", "bmrt", ... "rispec" has none, and
    /// rispecSpecular.
    std::string dialect;
    bool rispecSpecular = false; ///< specular() and specularbrdf() have the exponent that RISpec prints (shadeops/specular.h)
    std::vector<std::pair<std::string, std::string>> defines; ///< macros: name and text
    PluginFinder plugin;      ///< empty: code from outside is not run, and `plugin "name"` is an error that says so
    bool lint = false;        ///< warn about unused, uninitialised and the like, too (lint.h)
    bool keepWritten = false; ///< Program::written
    /// The text of an included file that is newer than what the disk has (open in an editor); nothing: the disk's is right.
    std::function<std::optional<std::string>(const std::string& path)> openText{};
};

/// Preprocesses, parses and checks. Returns null when there were errors (all of them reported, none that follow from another).
std::unique_ptr<Program> compileFile(const std::string& path, const FrontOptions&, Diagnostics&);
/// The same for a text; `name` stands for its file in messages.
std::unique_ptr<Program> compileText(const std::string& text, const std::string& name, const FrontOptions&, Diagnostics&);

/// A predefined variable (RISpec 3.2, section 12) in one kind of shader.
struct GlobalVariable {
    const char* name; ///< as shaders write it
    Type type;        ///< its type
    bool uniform;     ///< the same at all points
    bool writable;    ///< shaders of the kind may set it
    const char* doc;  ///< for the manual
};
/// All predefined variables of a kind of shader.
std::span<const GlobalVariable> globalVariables(ShaderKind);

} // namespace alpenglow::rsl
