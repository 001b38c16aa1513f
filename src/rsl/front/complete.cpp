#include "rsl/front/complete.h"
#include "rsl/front/advice.h"
#include "rsl/messages/messages.h"
#include <cctype>
#include <string>

namespace alpenglow::rsl {

namespace {

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

/// The name of a call and those of its arguments that are on this line.
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

void complete(Diagnostic& d, const Raised* raised) {
    if (d.place.line <= 0 || d.place.column <= 0) return;
    const size_t at = size_t(d.place.column) - 1;
    const auto is = [&](const MessageKind& k) { return d.id == k.id; };
    const bool call = is(msg::kKindNoMatchingCall) || is(msg::kKindWrongShaderKind) || is(msg::kKindOutputArgument);
    if (d.length == 0 && at < d.sourceLine.size()) d.length = call ? callLength(d.sourceLine, at) : tokenLength(d.sourceLine, at);
    if (!d.fixes.empty() || d.sourceLine.empty()) return;
    const int token = tokenLength(d.sourceLine, at);
    const std::string written = at < d.sourceLine.size() ? d.sourceLine.substr(at, size_t(token)) : "";
    if (raised) {
        advise(d, *raised, written, at);
        addFix(d, *raised, written, at);
    }
    const std::string meant = suggestion(d.hint);
    if (!d.fixes.empty() || meant.empty() || written.empty()) return;
    // In a macro's expansion the place is that of the macro: there is nothing to replace then.
    const bool quoted = written.front() == '"';
    if (quoted ? written.size() > 2 : nearestName(written, {meant}) == meant)
        d.fixes.push_back({d.place, token, quoted ? "\"" + meant + "\"" : meant});
}

} // namespace alpenglow::rsl
