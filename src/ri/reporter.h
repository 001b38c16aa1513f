// The messages of one reader: adds the source line, and limits how many messages a file can cause.
#pragma once
#include "base/diagnostics.h"
#include <functional>

namespace alpenglow::ri {

/// Reports to a Diagnostics, which must outlive it.
class Reporter {
public:
    /// d: receives the messages.
    explicit Reporter(Diagnostics& d) : sink_(d) {}
    /// Report one message at a place.
    void report(Severity, Rie, const SourcePlace&, std::string message, std::string hint = {});
    void error(Rie c, const SourcePlace& p, std::string m, std::string hint = {}) {
        report(Severity::Error, c, p, std::move(m), std::move(hint));
    }
    void warning(Rie c, const SourcePlace& p, std::string m, std::string hint = {}) {
        report(Severity::Warning, c, p, std::move(m), std::move(hint));
    }
    /// Only the first time this key is seen by the sink.
    void once(const std::string& key, Severity, Rie, const SourcePlace&, std::string message, std::string hint = {});
    /// Errors reported so far, shown or not.
    int errors() const { return errors_; }
    /// Errors of the whole run that count, from whomever.
    int errorsOfAll() const { return sink_.errors(); }
    /// ErrorHandler "ignore" for the whole run.
    void ignore(bool on) { sink_.ignore(on); }
    /// Reports how many messages were omitted since the last call, if any.
    void flush(const SourcePlace&);
    /// Text of a line that is still at hand, for the caret; may return "".
    std::function<std::string(const SourcePlace&)> lineText;

private:
    bool admit(Severity);
    Diagnostics& sink_;
    int shown_ = 0, errors_ = 0, hidden_ = 0;
};

} // namespace alpenglow::ri
