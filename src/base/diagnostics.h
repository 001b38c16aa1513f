// The diagnostic type and its sink. Errors are values that are reported once (docs/design/decisions.md, "Diagnostics").
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

/// A position in a text; line and column count from 1, 0 = unknown. Columns count bytes.
struct SourcePlace {
    std::string file; ///< as the user named it; "": unknown
    int line = 0, column = 0;
};

/// A change that fixes an error: replaces `length` bytes from the place on, on its line, by `text`.
struct FixIt {
    SourcePlace place;
    int length = 0;
    std::string text;
};

/// One message to the user: what is wrong, where, and what would help.
struct Diagnostic {
    Severity severity = Severity::Error; ///< how serious
    Rie code = Rie::NoError;             ///< RI error code
    SourcePlace place;                   ///< in the text of the user; unknown if its line is 0
    std::string message;
    std::string hint;       ///< "did you mean ...", or empty
    std::string sourceLine; ///< the offending line, for the caret; or empty
    std::string id{};       ///< stable identifier of the message ("no-matching-call"), independent of its text; or empty
    int length = 0;         ///< bytes of the line that the message is about, from the column on; 0 = unknown
    std::vector<std::string> notes{}; ///< candidates and why they were rejected, one per line
    std::vector<FixIt> fixes{};       ///< changes that would mend it
    bool always = false;              ///< a note that is shown without -v
    bool ignored = false; ///< ErrorHandler "ignore" was in effect: shown with -v only, and not counted. Diagnostics sets it
    std::string once{};   ///< key of Diagnostics::reportOnce(), which sets it; empty: report()
};

/// "file:line:column: error: message [id]", then the line, a caret and its range, then "  note: ..." and "  hint: ...", as far as
/// available. Ends with a newline.
std::string toString(const Diagnostic&);

/// Collects diagnostics, counts them, and passes each to a handler. Thread safe.
class Diagnostics {
public:
    /// Receives each diagnostic, in the thread that reports it, one at a time.
    using Handler = std::function<void(const Diagnostic&)>;
    /// Without a handler diagnostics are only stored.
    explicit Diagnostics(Handler h = {});
    /// Stores a diagnostic, counts it and passes it to the handler.
    void report(Diagnostic d);
    void report(Severity s, Rie code, SourcePlace place, std::string message, std::string hint = {});
    /// Reports only the first diagnostic with this key ("unknown things are reported once each").
    void reportOnce(const std::string& key, Diagnostic d);
    int errors() const; ///< Error and Severe, without ignored ones
    /// Without ignored ones.
    int warnings() const;
    /// From now on warnings and errors are ignored (RiErrorIgnore; RISpec 3.2, 7.2), or no more. Severe ones never are.
    void ignore(bool on);
    int ignored() const; ///< warnings and errors that were
    /// A copy of all so far, in the order of the reports.
    std::vector<Diagnostic> all() const;
    /// Replaces the handler. It is not called for earlier diagnostics.
    void setHandler(Handler h);

private:
    mutable std::mutex mutex_;
    Handler handler_;
    std::vector<Diagnostic> all_;
    std::set<std::string> seen_;
    int errors_ = 0, warnings_ = 0, ignored_ = 0;
    bool ignores_ = false;
};

/// The candidate nearest to word by edit distance, or "" if none is near enough for a hint.
std::string nearestName(std::string_view word, const std::vector<std::string>& candidates);

} // namespace alpenglow
