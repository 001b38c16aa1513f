// The one type of diagnostic and its sink. Errors are values that reach the user once (docs/design/decisions.md, "Diagnostics").
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow {

enum class Severity { Info = 0, Warning = 1, Error = 2, Severe = 3 }; ///< RIE_INFO .. RIE_SEVERE

/// RIE error codes, RISpec 3.2, 7.2.
enum class Rie : int {
    NoError = 0,
    NoMem = 1,
    System = 2,
    NoFile = 3,
    BadFile = 4,
    Version = 5,
    DiskFull = 6,
    Incapable = 11,
    Unimplement = 12,
    Limit = 13,
    Bug = 14,
    NotStarted = 23,
    Nesting = 24,
    NotOptions = 25,
    NotAttribs = 26,
    NotPrims = 27,
    IllState = 28,
    BadMotion = 29,
    BadSolid = 30,
    BadToken = 41,
    Range = 42,
    Consistency = 43,
    BadHandle = 44,
    NoShader = 45,
    MissingData = 46,
    Syntax = 47,
    Math = 61
};

/// A place in a text; line and column count from 1, 0 = unknown. Columns count bytes.
struct SourcePlace {
    std::string file;
    int line = 0, column = 0;
};

/// A change of the text that removes a fault: `length` bytes from the place on, on its line, become `text`.
struct FixIt {
    SourcePlace place;
    int length = 0;
    std::string text;
};

struct Diagnostic {
    Severity severity = Severity::Error;
    Rie code = Rie::NoError;
    SourcePlace place;
    std::string message;
    std::string hint;                 ///< "did you mean ...", or empty
    std::string sourceLine;           ///< the offending line, for the caret; or empty
    std::string id{};                 ///< stable name of this kind of message ("no-matching-call"), whatever its words; or empty
    int length = 0;                   ///< bytes of the line, from the column on, that the message is about; 0 = unknown
    std::vector<std::string> notes{}; ///< candidates and why they were rejected, one a line
    std::vector<FixIt> fixes{};
    bool always = false; ///< a note that users see without asking for notes (-v)
    std::string once{};  ///< the key of Diagnostics::reportOnce(), which sets it; empty: report()
};

/// "file:line:column: error: message [id]", then the line, a caret and its range, then "  note: ..." and "  hint: ...", as far as
/// they are there. Ends with a newline.
std::string toString(const Diagnostic&);

/// Collects diagnostics, counts them, and passes each to a handler. Thread safe.
class Diagnostics {
public:
    using Handler = std::function<void(const Diagnostic&)>;
    /// Without a handler they are only stored.
    explicit Diagnostics(Handler h = {});
    void report(Diagnostic d);
    void report(Severity s, Rie code, SourcePlace place, std::string message, std::string hint = {});
    /// Reports only the first time this key is seen ("unknown things are reported once each").
    void reportOnce(const std::string& key, Diagnostic d);
    int errors() const; ///< Error and Severe
    int warnings() const;
    std::vector<Diagnostic> all() const;
    void setHandler(Handler h);

private:
    mutable std::mutex mutex_;
    Handler handler_;
    std::vector<Diagnostic> all_;
    std::set<std::string> seen_;
    int errors_ = 0, warnings_ = 0;
};

/// The candidate nearest to word by edit distance, or "" when none is near enough for a hint.
std::string nearestName(std::string_view word, const std::vector<std::string>& candidates);

} // namespace alpenglow
