#include "ri/reporter.h"
#include "base/limits.h"

namespace alpenglow::ri {

bool Reporter::admit(Severity s) {
    if (s >= Severity::Error) ++errors_;
    if (shown_ < limits::kReportedProblems) {
        ++shown_;
        return true;
    }
    ++hidden_;
    return false;
}

void Reporter::report(Severity s, Rie code, const SourcePlace& place, std::string message, std::string hint) {
    if (!admit(s)) return;
    sink_.report({s, code, place, std::move(message), std::move(hint), lineText ? lineText(place) : std::string()});
}

void Reporter::once(const std::string& key, Severity s, Rie code, const SourcePlace& place, std::string message,
                    std::string hint) {
    if (s >= Severity::Error) ++errors_;
    sink_.reportOnce(key, {s, code, place, std::move(message), std::move(hint), lineText ? lineText(place) : std::string()});
}

void Reporter::flush(const SourcePlace& place) {
    if (!hidden_) return;
    sink_.report(Severity::Warning, Rie::Limit, place, std::to_string(hidden_) + " more messages were not shown");
    hidden_ = 0;
}

} // namespace alpenglow::ri
