// Names that the compiler and those who run its kernels have agreed on: of inputs, outputs, pairs of call sites, hidden
// parameters and handles. A name is made from a record here and taken apart here, when a kernel is built or bound; nobody else
// prints or parses one (tests/base/protocol_test.cpp reads the sources), and nobody does while rendering.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace alpenglow::rsl {

/// A variable of the compiler's own: a vector along Ng, of any length (passes/normal_side.h).
inline constexpr char kSideNormal[] = "__side";

/// ir::Input::name: what fills an input.
struct InputName {
    /// Where the value comes from.
    enum class Kind : uint8_t {
        Variable,     ///< a predefined variable: "P"
        Parameter,    ///< a parameter of the shader: "param:Kd"
        Displacement, ///< an output of the displacement shader of the primitive: "displacement:height"
        Sent,         ///< what a gather() sends to a parameter: "sent:name"; zero where there is no `length`
        Space         ///< the matrix between two spaces: "space:object>current"
    };
    Kind kind = Kind::Variable; ///< where it comes from
    std::string name;           ///< of the variable or parameter; of a member of a class without "this->"
    bool member = false;        ///< Displacement: what the displacement() of a class left in a member, "displacement:this->NAME"
    /// Of a member the number of elements: "displacement:this->NAME#". Sent: one more than the elements that came, 2 for a
    /// value that is no array, 0 where nothing was sent: "sent:NAME#".
    bool length = false;
    std::string from, to; ///< Space

    /// Reads a name; whatever has no prefix is a variable.
    static InputName parse(std::string_view);
    static InputName parameter(std::string_view name) { return {Kind::Parameter, std::string(name), false, false, {}, {}}; }
    /// What gather() sends to this parameter, or the length of that.
    static InputName sent(std::string_view name, bool length = false) {
        return {Kind::Sent, std::string(name), false, length, {}, {}};
    }
    /// The matrix from one space to the other.
    static InputName space(std::string_view from, std::string_view to) {
        return {Kind::Space, {}, false, false, std::string(from), std::string(to)};
    }
    /// Under it the caller of the compiler says what there is, too: KernelOptions::stringParameters (QueriedOutput,
    /// QueriedMember).
    static InputName displacement(std::string_view name) { return {Kind::Displacement, std::string(name), false, false, {}, {}}; }
    /// A member that displacement() leaves, or its length.
    static InputName left(std::string_view member, bool length = false) {
        return {Kind::Displacement, std::string(member), true, length, {}, {}};
    }
    /// The name as the IR has it.
    std::string text() const;
    bool operator==(const InputName&) const = default;
};

/// KernelOptions::outputs, ir::OutputSlot::name.
struct OutputName {
    /// What is written.
    enum class What : uint8_t {
        Value, ///< "Ci", "list[1]", "param:Kd"
        Du,    ///< its derivative by u: "Du:P", "Du:param:height"
        Dv,    ///< by v
        Given, ///< of an output that outputchannel() makes when the shader runs: 1 where it was made, "given:NAME"
        Slope  ///< how much of a variable comes through a volume shader: "slope:Ci"
    };
    What what = What::Value; ///< what is written
    bool parameter = false;  ///< "param:": any parameter; else a variable, an output parameter or a channel
    bool member =
        false; ///< with `parameter`: a member of a class that displacement() leaves to its other methods, "param:this->NAME"
    bool length = false; ///< of that the number of elements, "param:this->NAME#"
    std::string name;    ///< without all of that
    int element = -1;    ///< of an array: "list[1]"; -1: the whole
    int block = 0;       ///< of a light: the number of its illuminate or solar statement, from the second on "Cl#1"

    /// Any text: a name without a prefix is a variable or channel.
    static OutputName parse(std::string_view);
    /// A variable or an output as displays name it.
    static OutputName of(std::string_view name) { return plain(What::Value, name); }
    /// Its derivative by u, or v.
    static OutputName du(std::string_view name) { return plain(What::Du, name); }
    static OutputName dv(std::string_view name) { return plain(What::Dv, name); }
    /// Whether the output was made.
    static OutputName given(std::string_view name) { return plain(What::Given, name); }
    /// Of such a name the output's; empty for any other.
    static std::string_view givenName(std::string_view);
    /// How much of it comes through.
    static OutputName slope(std::string_view name) { return plain(What::Slope, name); }
    /// Any parameter, and how it changes.
    static OutputName parameterOf(std::string_view name, int element = -1, What what = What::Value) {
        return {what, true, false, false, std::string(name), element, 0};
    }
    /// A member that displacement() leaves, its length, or its derivatives.
    static OutputName left(std::string_view member, bool length = false, What what = What::Value) {
        return {what, true, true, length, std::string(member), -1, 0};
    }
    /// Of a light: "L", "Cl", "Ol" or "lit" of one of its statements.
    static OutputName ofBlock(std::string_view name, int block) {
        return {What::Value, false, false, false, std::string(name), -1, block};
    }
    /// The name as the IR has it.
    std::string text() const;
    bool operator==(const OutputName&) const = default;

private:
    static OutputName plain(What what, std::string_view name) { return {what, false, false, false, std::string(name), -1, 0}; }

public:
    /// Of "list[3]": "list".
    static std::string withoutElement(std::string_view name) { return std::string(name.substr(0, name.find('['))); }
};

/// Describes an output of the displacement shader to the surface's kernel, which may query it: the value of the string parameter
/// InputName::displacement(NAME).
struct QueriedOutput {
    int kind = 0;         ///< ir::Kind of an element
    int length = 0;       ///< of an array; 0: none
    bool varying = false; ///< points differ
    /// Nothing for any other text.
    static std::optional<QueriedOutput> parse(const std::string&);
    /// What parse() reads.
    std::string text() const;
};
/// The same of a member that displacement() leaves: InputName::left(NAME).
struct QueriedMember {
    int count = 0;       ///< elements of an array; 0: none
    bool length = false; ///< their number is an input, too
    /// As QueriedOutput, for names that text() makes.
    static QueriedMember parse(const std::string&);
    /// What parse() reads.
    std::string text() const;
};

// Further string parameters that control how a kernel is built.
inline constexpr char kBeginQuiet[] = "begin()";     ///< begin() of the class prints nothing
inline constexpr char kOpacityAlone[] = "opacity()"; ///< what the method opacity() gives is Oi
/// Under it the number of elements that the scene gave an array of open length.
std::string lengthParameter(std::string_view array);
/// Whether a string parameter is such a number.
bool isLengthParameter(std::string_view name);

/// A pair of a call site: ir::Site::names.
struct PairName {
    /// What the pair is for.
    enum class Kind : uint8_t {
        Plain,  ///< of the call itself
        Send,   ///< a value for a parameter of other shaders: "send:light:NAME", "send:surface:NAME"
        Surface ///< the value of an output of the surface, for lights that ask: "surface:NAME"
    };
    /// Send: the shaders that the value is for. Loops over lights send to lights, gather() to the shaders that its rays hit.
    enum class To : uint8_t { Light, Surface, Displacement, Volume };
    Kind kind = Kind::Plain;
    std::string name;
    int element = -1;    ///< Send: of an array that is sent element by element
    To to = To::Light;   ///< for whom it is sent
    bool length = false; ///< Send: how many elements of the array count, "send:surface:NAME#"
    /// Reads a name; whatever has no prefix is Plain.
    static PairName parse(std::string_view);
    /// A value, or an element of it, for a parameter of shaders of that kind.
    static PairName send(std::string_view name, int element = -1, To to = To::Light, bool length = false) {
        return {Kind::Send, std::string(name), element, to, length};
    }
    /// The value of an output for lights that query it.
    static PairName surface(std::string_view name) { return {Kind::Surface, std::string(name), -1, To::Light, false}; }
    /// The name as the IR has it.
    std::string text() const;
};
// Pairs that the compiler adds to a call; shaders do not write them.
inline constexpr char kPairSetUp[] = "__setup";     ///< a loop over lights has a setup
inline constexpr char kPairOutside[] = "__outside"; ///< outside of loops over lights
inline constexpr char kPairPart[] = "__part";       ///< of the form of trace() that gives an array: which element
inline constexpr char kPairOnce[] = "__once";       ///< in construct(): once for the shader
inline constexpr char kPairGather[] = "__gather"; ///< of the two sites of a gather, its rays and a turn: its number in the shader
inline constexpr char kPairPoints[] = "__points"; ///< a call that is answered from point clouds
inline constexpr char kPairHemisphere[] = "__hemisphere"; ///< a trace() that is an indirectdiffuse(): over the hemisphere
inline constexpr char kPairHighlight[] = "__highlight";   ///< a loop over lights made from specular() or phong()
/// An indirectdiffuse() together with diffuse() or loops over lights, and such a diffuse() of a kernel that waits: each brings
/// its part of the light.
inline constexpr char kPairApart[] = "__apart";
/// A subsurface() with "irradiance": a kernel of its own gives that, as the output kEntering.
inline constexpr char kPairEntering[] = "__entering";
inline constexpr char kPairSteady[] = "__steady";   ///< a bake() that all points of a primitive reach, or none
inline constexpr char kPairUniform[] = "__uniform"; ///< the variable that takes the answer is uniform

/// ir::Site::resultNames of a query: its answer, and before that of an array of open length how long it is.
std::string lengthResult(std::string_view name);
/// Whether a result is such a length.
bool isLengthResult(std::string_view name);
/// Whether a result is an element of an array.
bool isElementResult(std::string_view name);

// Parameters of shaders that the renderer reads.
inline constexpr char kNonDiffuse[] = "__nondiffuse", kNonSpecular[] = "__nonspecular", kCategory[] = "__category";
inline constexpr char kImportanceSample[] = "__importancesample";
inline constexpr char kGroup[] = "__group"; ///< of a light: the name of its group in light path expressions
/// Parameters of a displacement shader: its bound, and the space of that.
inline constexpr char kBoundSize[] = "__displacementbound_sphere", kBoundSpace[] = "__displacementbound_coordinatesystem";
/// Of a light that sends through generateSamples(): ways and light of its samples, and whether their light is traced.
inline constexpr char kSentL[] = "__sentL", kSentCl[] = "__sentCl", kSentShadows[] = "__sentShadows";
/// Outputs of a class light with generatePhoton(), if photons are requested.
inline constexpr char kPhotonFrom[] = "__photonFrom", kPhotonWay[] = "__photonWay", kPhotonPower[] = "__photonPower",
                      kPhotonPdf[] = "__photonPdf";
/// A parameter of lights that send the radiance of emit() under every hider.
inline constexpr char kEmits[] = "__emits";

// What gives light where, ir::KernelFacts::blocks.
inline constexpr char kBlockOutside[] = "outside"; ///< outside of illuminate and solar statements
inline constexpr char kBlockSky[] = "solar()", kBlockCone[] = "solar cone", kBlockSolar[] = "solar";

/// Output of a surface: the "irradiance" of the first subsurface() that gives one; whether one does is OutputName::given() of it.
/// Kernels that have it as KernelOptions::light send nothing below the surface themselves.
inline constexpr char kEntering[] = "subsurface()";

/// Channels that get their names when the shader runs have keys that begin so (front/calls_bind.cpp); of channels of one name and
/// several types the type stands behind it.
inline constexpr char kAnyChannel = '?';
/// A name as outputchannel() has it: without "light:" or "local:", which keep the channel where it is made.
inline constexpr std::string_view kKeptChannels[] = {"light:", "local:"};
/// A name split in two.
struct ChannelName {
    std::string name;
    bool kept = false; ///< it was "light:" or "local:"
    /// Any text.
    static ChannelName parse(std::string_view);
};

/// Handles that getlights() gives: the number of a light among those of the frame, and what its declaration called it.
struct LightHandle {
    int light = -1;
    std::string declared; ///< its handle; may be ""
    /// Nothing for any other handle.
    static std::optional<LightHandle> parse(std::string_view);
    /// What parse() reads.
    std::string text() const;
};
/// What "%h" of format() and messages call a handle: lights and co-shaders by the handle of their declaration, no shader
/// "<null>".
std::string shownHandle(const std::string& handle);

} // namespace alpenglow::rsl
