// The one description of a request: the reader, the scope check, the documentation and the tests all read it.
// An entry and its handler are in the same file of this folder, grouped by kind.
#pragma once
#include "base/matrix.h"
#include "ri/call.h"
#include <optional>
#include <string_view>
#include <vector>

namespace alpenglow::ri {

class Interpreter;

/// The section of the manual that a request belongs to.
enum class Kind { Structure, Option, Attribute, Shader, Light, Transform, Primitive, Archive, Texture, Other };
const char* toString(Kind); ///< in small letters, for messages and JSON

/// Where a request may stand. Blocks not named here (Attribute, Transform, Solid, Resource) inherit from what they are in.
enum Scope : unsigned { kBase = 1, kFrame = 2, kWorld = 4, kObject = 8, kAnywhere = 15 };

/// One entry of a signature.
struct ArgSpec {
    /// What is accepted. Handle: a number or text. Basis: a name or 16 numbers.
    enum class Form { Number, Int, String, Handle, Basis };
    Form form = Form::Number; ///< of each value
    bool array = false;       ///< any length
    int count = 1;            ///< numbers, when not an array: bare or in brackets, mixed as one likes
    int otherCount = 0;       ///< also accepted in one array (the 16-number Translate of old files)
    bool optional = false;    ///< it may be left out
    std::string name;         ///< for messages and prototypes
};

/// The description of a request.
struct Request {
    using Handler = void (*)(Interpreter&, const Call&); ///< does what the request asks, in legal scopes only
    /// The matrix of a transform request; empty when its arguments are bad (reported).
    using MatrixOf = std::optional<Matrix> (*)(Interpreter&, const Call&);

    std::string_view name; ///< as in RIB
    /// "string name; number[4] window; int[] nverts; handle h; basis u; number x?; .." - entries separated by "; ",
    /// [n] = exactly n, [a/b] = a or b, [] = any number, ? = may be left out, .. = a parameter list follows.
    std::string_view signature;
    Kind kind;
    unsigned scopes;
    bool motion;               ///< legal in a motion block (RISpec 3.2, section 6)
    std::string_view doc;      ///< for the manual
    std::string_view sample;   ///< arguments that are correct; the tests read every one
    Handler handler;           ///< not null
    MatrixOf matrix = nullptr; ///< null: no transform
    /// Arguments of the call in C without the parameter list, where they do not follow from the signature (header.h).
    std::string_view c = {};

    // Filled in from the signature when the table is built.
    std::vector<ArgSpec> args = {};
    bool parameters = false;
};

/// Every request, sorted by name. Immutable; built on first use.
const std::vector<Request>& requestTable();
/// Null when there is none of that name.
const Request* findRequest(std::string_view name);
/// For hints.
const std::vector<std::string>& requestNames();

/// Returns `good`; if it is false, reports a range error of the call. `what`: the requirement, for the message.
bool within(Interpreter&, const Call&, bool good, const char* what);

// The lists of the files of this folder.
std::vector<Request> structureRequests();
std::vector<Request> optionRequests();
std::vector<Request> attributeRequests();
std::vector<Request> shaderRequests();
std::vector<Request> transformRequests();
std::vector<Request> quadricRequests();
std::vector<Request> primitiveRequests();
std::vector<Request> archiveRequests();
std::vector<Request> textureRequests();
std::vector<Request> foreignRequests();
std::vector<Request> risRequests();

} // namespace alpenglow::ri
