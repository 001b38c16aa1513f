#include "rsl/front/messages.h"
#include "rsl/front/messages_advice.h"
#include <cctype>
#include <string>

namespace alpenglow::rsl {

namespace {

// The more exact pattern stands before the wider one.
constexpr MessageKind kKinds[] = {
    // characters and tokens
    {"unfinished-comment", "this comment does not end"},
    {"unfinished-string", "this string does not end on its line"},
    {"stray-character", "the character * means nothing here"},
    {"bad-number", "'*' is not a number"},
    {"hash-comment", "'#' in the middle of a line begins no directive*"},
    {"hash-comment", "'##' begins no directive*"},
    {"number-suffix", "numbers take no suffix*"},
    // preprocessor
    {"pp-unfinished-if", "this #if has no #endif"},
    {"pp-too-many-tokens", "macros expand to more than * tokens"},
    {"pp-macro-call", "the call of macro '*' has no closing ')'"},
    {"pp-macro-arguments", "macro '*' takes *"},
    {"pp-macro-depth", "macro calls are nested more than * deep"},
    {"pp-paste", "'*', pasted by ##, is not one token"},
    {"pp-needs-name", "#* needs a name"},
    {"pp-stray-directive", "#* without #if*"},
    {"pp-after-else", "#* after #else"},
    {"pp-error", "#error*"},
    {"pp-warning", "#warning*"},
    {"pp-unknown-directive", "unknown directive '#*' is ignored"},
    {"pp-macro-parameter", "a macro parameter is a name, not *"},
    {"pp-macro-parameters", "the parameters of this macro have no ')'"},
    {"pp-macro-redefined", "macro '*' is defined again with another meaning"},
    {"pp-include-syntax", "#include needs *"},
    {"pp-include-depth", "includes are nested more than * deep"},
    {"pp-include-elsewhere", "'*' was not found; '*' is used"},
    {"pp-include-missing", "cannot find the included file *"},
    {"pp-line", "#line needs a number"},
    {"pp-octal", "'*' is octal in a condition *"},
    {"pp-annotation", "#pragma annotation needs *"},
    {"pp-annotation", "the value of #pragma annotation stands in *"},
    {"pp-condition", "#if needs an expression"},
    {"pp-condition", "* in the condition"},
    {"pp-condition", "this condition is nested too deeply"},
    // plug-ins
    {"plugin-refused", "plug-in \"*\" is not loaded*"},
    {"plugin-missing", "plug-in \"*\" was not found"},
    {"plugin-unusable", "plug-in \"*\" is not usable*"},
    {"plugin-unusable", "plug-in \"*\" cannot be loaded*"},
    {"plugin-unusable", "\"*\" is * RSL plug-in*"},
    // syntax
    {"too-many-errors", "too many errors; giving up on this file"},
    {"no-shader", "there is no shader in this file"},
    {"too-deep", "nested more than * deep"},
    {"too-deep", "calls of functions are nested more than * deep"},
    {"too-deep", "calls of methods are nested more than * deep"},
    {"struct-members", "a structure has no more than * members*"},
    {"too-many-includes", "more than * files are included"},
    {"too-many-includes", "the included files have more than * bytes together"},
    {"light-blocks", "a light has no more than * blocks*"},
    {"too-long", "this expression is longer than * operations in a row"},
    {"expected-semicolon", "expected ';' after *"},
    {"expected-semicolon", "expected ';' before the next parameter*"},
    {"expected-brace", "expected '}' before the end of the file"},
    {"expected-definition", "expected a shader or a function before *"},
    {"expected-expression", "expected an expression before *"},
    {"expected-pair", "expected a pair*"},
    {"expected-type", "expected a type before *"},
    {"expected-type", "expected the type of a parameter before *"},
    {"expected-name", "expected the name of * before *"},
    {"expected-token", "expected '*' before *"},
    {"expected-token", "expected * before *"},
    {"stray-brace", "this '}' closes nothing and is ignored"},
    {"stray-semicolon", "a ';' between a shader's parameters and its body is ignored"},
    {"comma-statements", "statements are separated by ';', not ','"},
    {"not-rsl", "'*' is not of this language; *"},
    {"untyped-parameter", "parameter '*' has no type; *"},
    {"stray-else", "'else' without 'if'"},
    {"semicolon-in-call", "arguments are separated by ',', not ';'"},
    {"cast-parentheses", "a conversion is written without parentheses around the type"},
    {"not-a-type", "'*' is not a type"},
    {"borrowed-type", "there is no type '*'; *"},
    {"void-value", "'void' is not the type of a value"},
    {"void-variable", "a variable cannot be void"},
    {"void-variable", "a parameter cannot be void"},
    {"array-of-arrays", "an array of arrays is not allowed"},
    {"array-length", "the length of an array must be *"},
    {"array-length", "an array has at most * elements"},
    {"function-default", "parameters of functions have no default values*"},
    {"no-default", "parameter '*' has no default value; it is * unless set"},
    {"extern-value", "an extern variable has its value already and takes no other here"},
    {"loop-levels", "the number of loops to leave must be a whole number from 1"},
    {"not-available", "* not yet available*"},
    // structures and shader objects
    {"struct-recursive", "a structure cannot contain itself"},
    {"struct-redefined", "structure '*' is defined already"},
    {"struct-empty", "structure '*' has no members"},
    {"struct-void", "a member cannot be void"},
    {"struct-count", "a shader has at most * structures"},
    {"struct-array", "member '*' of * changes its length: there are no arrays of this structure"},
    {"struct-default", "the default of a structure is written with its constructor"},
    {"struct-default", "a default value of a parameter uses a structure that a function gives"},
    {"struct-use", "structures can only be assigned"},
    {"struct-use", "* cannot be used here"},
    {"struct-use", "this is an array of *"},
    {"struct-use", "an array in the result of a call must be stored in a variable first"},
    {"struct-value", "expected a value of *"},
    {"struct-value", "expected a structure"},
    {"struct-value", "expected structure '*', not *"},
    {"struct-value", "structure '*' has * members, not *"},
    {"no-such-member", "* has no member '*'"},
    {"no-such-method", "structure '*' has no method '*'"},
    {"two-members", "there are two members called '*'"},
    {"member-dot", "'.' is the dot product"},
    {"member-of-nothing", "'->' needs a structure or a shader, not *"},
    {"method-result", "method '*' returns no value"},
    {"method-not-run", "method '*' is not run where there is a method 'surface'"},
    {"method-parameters", "method '*' has at most * parameter*"},
    {"method-parameters", "the parameters of a method 'light' with *"},
    {"recursion", "method '*' calls itself; recursion is not allowed*"},
    // co-shaders: found when a kernel is made
    {"coshader-depth", "co-shaders call each other more than * deep"},
    {"null-handle", "this handle is null here*"},
    {"null-handle", "'*' is null here*"},
    {"no-such-method", "co-shader '*' (*) has no public method '*' with * argument*"},
    {"no-such-member", "co-shader '*' (*) has no public member '*'*"},
    {"member-type", "co-shader '*' (*) has '*' as *, not *"},
    {"method-argument", "argument * of method '*' of co-shader '*' is *, not *"},
    {"method-argument", "argument * of light() is a variable of type *"},
    {"method-type", "method '*' of co-shader '*' gives *, not *"},
    // names
    {"missing-extern", "'*' is a parameter of the shader, used without being declared extern"},
    {"light-variable", "'*' belongs to light shaders; '*' is used"},
    {"function-redefined", "function '*' is defined again; the last definition counts"},
    {"undeclared", "'*' is not declared*"},
    {"no-such-function", "there is no function '*'"},
    {"no-such-extern", "there is no '*' outside for this extern declaration*"},
    {"extern-type", "'*' is * outside, not *"},
    {"two-parameters", "there are two parameters called '*'"},
    {"redeclared", "'*' was declared in this block already, as *"},
    {"redeclared-new", "'*' was declared in this block already; this is a new variable"},
    {"recursion", "function '*' calls itself; recursion is not allowed"},
    {"wrong-shader-kind", "'*' cannot be used in a * shader"},
    {"no-such-parameter", "'*' has no parameter \"*\"; it is ignored"},
    {"no-such-parameter", "'*' has no parameter \"*\"; it is ignored; *"},
    {"no-such-filter", "there is no filter \"*\"; catmull-rom is used"},
    {"no-such-filter", "there is no filter \"*\" of '*'"},
    // types
    {"no-matching-call", "'*' cannot be called with (*)"},
    {"no-matching-call", "'*' cannot be called without arguments"},
    {"output-argument", "an output argument of '*' must be a variable of the same type"},
    {"output-argument", "\"*\" gives a *: it needs a variable of that type"},
    {"output-argument", "the value of \"*\" must be a variable"},
    {"bad-operands", "'*=' cannot combine * and *"},
    {"bad-operands", "'*' cannot combine * and *"},
    {"bad-operands", "'*' cannot be applied to *"},
    {"bad-assignment", "cannot assign * to *"},
    {"bad-conversion", "cannot convert * to *"},
    {"not-assignable", "what stands left of the assignment is not a variable"},
    {"bad-condition", "* cannot be a condition"},
    {"bad-alternatives", "the two values of '?' do not fit together: * and *"},
    {"bad-component", "a component must be a float, not *"},
    {"bad-index", "an index must be a float, not *"},
    {"index-range", "index * is outside *"},
    {"index-range", "a tuple has components 0, 1 and 2"},
    {"no-elements", "a string has no elements*"},
    {"no-elements", "* has no elements"},
    {"space-name", "the name of a space is a string"},
    {"no-space", "a * is in no space"},
    {"list-place", "a list of elements {...} is of use only as the value of an array"},
    {"too-many-elements", "* elements for an array of *"},
    {"number-call", "*() is a float in arithmetic with a number; *"},
    {"tuple-length", "* components*"},
    {"type-mismatch", "expected *, not *"},
    {"fixed-length", "the length of '*' is fixed"},
    {"fixed-length", "*the length of this array is fixed"},
    // statements
    {"outside-loop", "'*' outside a loop"},
    {"outside-loop", "'*' inside * loop*"},
    {"return-value", "a shader returns no value"},
    {"return-value", "function '*' is void and returns no value"},
    {"return-missing", "function '*' must return a *"},
    {"return-missing", "function '*' can end without returning a value; it is zero then"},
    {"light-arguments", "gather begins with a category, a string"},
    {"light-arguments", "wrong arguments of '*'"},
    {"no-effect", "this expression has no effect"},
    // what may be written
    {"read-only", "'*' cannot be written"},
    {"read-only-copy", "'*' is read-only*"},
    {"moving-surface", "a surface shader that moves 'P' displaces*"},
    {"not-output", "parameter '*' is not output; *"},
    {"constant-written", "'*' is constant and is given another value here"},
    {"construct-varying", "* differs from point to point, and construct() runs once for the whole shader"},
    // uniform and varying
    {"varying-to-uniform", "a varying value is given to the uniform variable '*'*"},
    {"uniform-in-varying", "the uniform variable '*' is changed where only some points come*"},
    {"channel-open", "an array of open length is no output*"},
    {"channel-types", "output '*' is a * in an earlier call, and a * here*"},
    // of `compile -W`
    {"unlit", "'*' is read outside illuminance()*"},
    {"nested-illuminance", "illuminance inside illuminance*"},
    {"unused-parameter", "parameter '*' is not used"},
    {"unused-variable", "variable '*' is not used"},
    {"two-signs", "'*' before a variable is two signs *"},
    {"shared-output", "'*' is given to two output parameters of *"},
    {"uninitialised", "'*' is read before it has a value*"},
    {"maybe-uninitialised", "'*' may be read before it has a value*"},
    {"not-affine", "under path * is used non-linearly*"},
    {"assignment-condition", "this condition is an assignment*"},
    {"trailing-comma", "nothing stands behind this ','*"},
    {"format-conversion", "'*' is no conversion*"},
    {"format-conversion", "the pattern ends in a '%'*"},
    {"format-kind", "'%*' is for *, and this is a *"},
    {"uniform-receiver", "'*' is uniform and takes no varying parameter*"},
    {"format-count", "the pattern takes *"},
    {"unknown-name", "there is no spline basis *"},
    {"unknown-name", "there is no colour space *"},
    {"unknown-name", "area() has no strategy *"},
    {"unknown-name", "*() knows nothing of the name *"},
    {"unknown-space", "no predefined space is called *"},
    {"unknown-method", "method '*' is called by nobody*"},
    // code generation
    {"zero-derivative", "the derivative of * is taken as zero"},
    {"zero-derivative", "a derivative of third order is taken as zero"},
    {"zero-division", "a division by *, which gives 0*"},
    {"spline-points", "a spline needs at least four control points*"},
    {"not-constant", "* that is known when the shader is compiled; *"},
    {"not-constant", "* must be known when the shader is compiled; *"},
    {"made-name", "the name of a parameter of '*' must be written as a literal; *"},
    {"made-name", "the name of a parameter of '*' is known only when the shader runs; *"},
    {"made-name", "the names of * parameters of '*' are known only when the shader runs: *"},
    {"pair-type", "\"*\" of '*' is a *, and its value a *"},
    {"gather-send", "gather sends *"},
    {"not-constant", "\"*\" sends a string that is not known when the shader is compiled; *"},
    {"no-such-distribution", "*(): there is no distribution \"*\"*"},
    {"bsdf-parts", "bsdf(): \"*\" has no parts; *"},
    {"trace-parts", "trace(): \"*\" has no parts; *"},
    {"light-category", "the category \"*\" cannot be read: *"},
    {"light-pair", "\"*\" sends an array of strings; *"},
    {"light-pair", "\"lightcache\" is \"reuse\" or \"refresh\""},
    {"light-pair", "the pair \"*\" means nothing to illuminance"},
    {"outside-illuminance", "*() asks about the light of an illuminance loop*"},
    {"no-code", "*() has no code"},
    {"shader-too-large", "*more than * operations*"},
    {"shader-memory", "the local arrays of * bytes a point; the limit is *"},
};

/// Does the text look like the pattern? Linear in practice: only the last '*' is tried again.
bool matches(std::string_view pattern, std::string_view text) {
    size_t p = 0, t = 0, star = std::string_view::npos, from = 0;
    while (t < text.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            from = t;
        } else if (p < pattern.size() && pattern[p] == text[t]) {
            ++p, ++t;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            t = ++from;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*') ++p;
    return p == pattern.size();
}

/// Bytes of the token that begins at this byte of the line; at least 1.
int tokenLength(const std::string& line, size_t at) {
    if (at >= line.size()) return 1;
    size_t end = at + 1;
    if (isWord(line[at])) {
        const bool number = std::isdigit(static_cast<unsigned char>(line[at])) != 0;
        while (end < line.size() && (isWord(line[end]) || (number && line[end] == '.'))) ++end;
    } else if (line[at] == '"') {
        while (end < line.size() && line[end] != '"') end += line[end] == '\\' ? 2 : 1;
        end = std::min(end + 1, line.size());
    } else if (end < line.size() && line[end] == '=' && std::string_view("+-*/^.<>=!").find(line[at]) != std::string_view::npos) {
        ++end;
    } else if (end < line.size() && line[end] == line[at] && (line[at] == '&' || line[at] == '|')) {
        ++end;
    }
    return int(end - at);
}

/// The name of a call and its arguments, as far as they stand on this line.
int callLength(const std::string& line, size_t at) {
    size_t end = at + size_t(tokenLength(line, at));
    while (end < line.size() && line[end] == ' ') ++end;
    if (end >= line.size() || line[end] != '(') return tokenLength(line, at);
    int depth = 0;
    for (bool quoted = false; end < line.size(); ++end) {
        if (line[end] == '"' && line[end - 1] != '\\') quoted = !quoted;
        if (quoted) continue;
        if (line[end] == '(') ++depth;
        if (line[end] == ')' && --depth == 0) return int(end + 1 - at);
    }
    while (end > at && std::isspace(static_cast<unsigned char>(line[end - 1]))) --end;
    return int(end - at);
}

} // namespace

std::span<const MessageKind> messageKinds() { return kKinds; }

const char* messageId(std::string_view message) {
    for (const MessageKind& k : kKinds)
        if (matches(k.pattern, message)) return k.id;
    return "rsl-error";
}

void complete(Diagnostic& d) {
    if (d.id.empty()) d.id = messageId(d.message);
    if (d.place.line <= 0 || d.place.column <= 0) return;
    const size_t at = size_t(d.place.column) - 1;
    const bool call = d.id == "no-matching-call" || d.id == "wrong-shader-kind" || d.id == "output-argument";
    if (d.length == 0 && at < d.sourceLine.size()) d.length = call ? callLength(d.sourceLine, at) : tokenLength(d.sourceLine, at);
    if (!d.fixes.empty() || d.sourceLine.empty()) return;
    const int token = tokenLength(d.sourceLine, at);
    const std::string written = at < d.sourceLine.size() ? d.sourceLine.substr(at, size_t(token)) : "";
    advise(d, written, at);
    addFix(d, written, at);
    if (!d.fixes.empty()) return;
    if (d.id == "expected-semicolon") {
        // Only where it belongs behind what stands before: a ';' "before" something is no obvious cure.
        if (d.message.find(" before '") == std::string::npos) d.fixes.push_back({d.place, 0, ";"});
    } else if (d.id == "semicolon-in-call" && written == ";") {
        d.fixes.push_back({d.place, 1, ","});
    } else if (d.id == "number-suffix") {
        size_t digits = written.size();
        while (digits > 0 && std::isalpha(static_cast<unsigned char>(written[digits - 1]))) --digits;
        if (digits > 0 && digits < written.size()) d.fixes.push_back({d.place, token, written.substr(0, digits)});
    } else if (const std::string s = suggestion(d.hint); !s.empty() && !written.empty()) {
        // In a macro's expansion the place is that of the macro: there is nothing to replace then.
        const bool quoted = written.front() == '"';
        if (quoted ? written.size() > 2 : nearestName(written, {s}) == s)
            d.fixes.push_back({d.place, token, quoted ? "\"" + s + "\"" : s});
    }
}

} // namespace alpenglow::rsl
