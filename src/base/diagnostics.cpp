#include "base/diagnostics.h"
#include "base/limits.h"
#include "base/printable.h"
#include <algorithm>

namespace alpenglow {

namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; } ///< a later byte of a character in UTF-8

/// The line, or for long lines the part around the column, with a caret and range below it.
std::string excerpt(const Diagnostic& d) {
    std::string_view line = d.sourceLine;
    if (line.ends_with('\r')) line.remove_suffix(1); // of a file with CRLF line ends
    const size_t room = limits::kExcerptColumns, at = d.place.column > 0 ? std::min(size_t(d.place.column) - 1, line.size()) : 0;
    size_t begin = 0, end = line.size();
    if (line.size() > room) {
        const size_t caret = std::min(at, line.size());
        // A range that fits is shown completely, with some text before it.
        const size_t before = d.length > 0 && size_t(d.length) < room / 2 ? room / 2 : room / 4;
        begin = caret > before ? caret - before : 0;
        if (begin + room >= line.size()) begin = line.size() - room;
        end = begin + room;
        while (begin > 0 && continues(line[begin])) --begin;
        while (end < line.size() && continues(line[end])) ++end;
    }
    const std::string head = begin > 0 ? "... " : "";
    std::string shown, below;
    for (size_t i = begin; i < end;) { // below: one column for one character, or more if its bytes are shown
        const size_t from = shown.size(), n = appendPrintable(line, i, shown);
        const bool caret = i <= at && at<i + n, under = i> at && i < at + size_t(std::max(d.length, 0));
        const bool bytes = shown[from] == '\\' && line[i] != '\\';
        below += caret ? '^' : under ? '~' : i < at && line[i] == '\t' ? '\t' : ' ';
        if (bytes) below.append(shown.size() - from - 1, caret || under ? '~' : ' ');
        i += n;
    }
    if (at >= end) below.append(at - end, ' ').append("^");
    std::string s = "  " + head + shown + (end < line.size() ? " ..." : "") + "\n";
    if (d.place.column <= 0) return s;
    below.resize(below.find_last_not_of(" \t") + 1);
    return s + "  " + std::string(head.size(), ' ') + below + "\n";
}

} // namespace

std::string toString(const Diagnostic& d) {
    std::string s;
    if (!d.place.file.empty()) {
        for (const char c : printable(d.place.file)) c == '\n' ? s += "\\x0a" : s += c;
        if (d.place.line > 0) {
            s += ":" + std::to_string(d.place.line);
            if (d.place.column > 0) s += ":" + std::to_string(d.place.column);
        }
        s += ": ";
    }
    s += d.severity == Severity::Info ? "note: " : d.severity == Severity::Warning ? "warning: " : "error: ";
    s += printable(d.message);
    if (!d.id.empty()) s += " [" + d.id + "]";
    s += "\n";
    if (!d.sourceLine.empty()) s += excerpt(d);
    for (const std::string& n : d.notes) s += "  note: " + printable(n) + "\n";
    if (!d.hint.empty()) s += "  hint: " + printable(d.hint) + "\n";
    return s;
}

Diagnostics::Diagnostics(Handler h) : handler_(std::move(h)) {}

void Diagnostics::report(Diagnostic d) {
    std::lock_guard lock(mutex_);
    d.ignored |= ignores_ && (d.severity == Severity::Warning || d.severity == Severity::Error);
    if (d.ignored) ++ignored_;
    else if (d.severity >= Severity::Error) ++errors_;
    else if (d.severity == Severity::Warning) ++warnings_;
    if (handler_) handler_(d);
    all_.push_back(std::move(d));
}

void Diagnostics::report(Severity s, Rie code, SourcePlace place, std::string message, std::string hint) {
    report(Diagnostic{s, code, std::move(place), std::move(message), std::move(hint), {}, {}, 0, {}, {}});
}

void Diagnostics::reportOnce(const std::string& key, Diagnostic d) {
    {
        std::lock_guard lock(mutex_);
        if (!seen_.insert(key).second) return;
    }
    d.once = key;
    report(std::move(d));
}

int Diagnostics::errors() const {
    std::lock_guard lock(mutex_);
    return errors_;
}
int Diagnostics::warnings() const {
    std::lock_guard lock(mutex_);
    return warnings_;
}
void Diagnostics::ignore(bool on) {
    std::lock_guard lock(mutex_);
    ignores_ = on;
}
int Diagnostics::ignored() const {
    std::lock_guard lock(mutex_);
    return ignored_;
}
std::vector<Diagnostic> Diagnostics::all() const {
    std::lock_guard lock(mutex_);
    return all_;
}
void Diagnostics::setHandler(Handler h) {
    std::lock_guard lock(mutex_);
    handler_ = std::move(h);
}

std::string nearestName(std::string_view word, const std::vector<std::string>& candidates) {
    std::string best;
    size_t bestCost = (word.size() + 1) / 3 + 1; // strictly less wins: one edit per three letters, none in one letter
    for (const auto& c : candidates) {
        if (c.size() > word.size() + bestCost || word.size() > c.size() + bestCost) continue;
        std::vector<size_t> row(c.size() + 1);
        for (size_t j = 0; j <= c.size(); ++j) row[j] = j;
        for (size_t i = 1; i <= word.size(); ++i) {
            size_t diagonal = row[0];
            row[0] = i;
            for (size_t j = 1; j <= c.size(); ++j) {
                size_t up = row[j];
                size_t lowA = word[i - 1] | 32, lowB = c[j - 1] | 32;
                row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (lowA != lowB)});
                diagonal = up;
            }
        }
        if (row.back() < bestCost) {
            bestCost = row.back();
            best = c;
        }
    }
    return best;
}

} // namespace alpenglow
