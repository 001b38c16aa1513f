#include "base/diagnostics.h"
#include <algorithm>

namespace alpenglow {

std::string toString(const Diagnostic& d) {
    std::string s;
    if (!d.place.file.empty()) {
        s += d.place.file;
        if (d.place.line > 0) {
            s += ":" + std::to_string(d.place.line);
            if (d.place.column > 0) s += ":" + std::to_string(d.place.column);
        }
        s += ": ";
    }
    s += d.severity == Severity::Info ? "note: " : d.severity == Severity::Warning ? "warning: " : "error: ";
    s += d.message;
    if (!d.id.empty()) s += " [" + d.id + "]";
    s += "\n";
    if (!d.sourceLine.empty()) {
        s += "  " + d.sourceLine + "\n";
        if (d.place.column > 0) {
            s += "  ";
            for (int i = 0; i + 1 < d.place.column; ++i)
                s += i < int(d.sourceLine.size()) && d.sourceLine[i] == '\t' ? '\t' : ' ';
            s += "^";
            const int room = int(d.sourceLine.size()) - d.place.column; // behind the caret
            for (int i = 1; i < d.length && i <= room; ++i) s += "~";
            s += "\n";
        }
    }
    for (const std::string& n : d.notes) s += "  note: " + n + "\n";
    if (!d.hint.empty()) s += "  hint: " + d.hint + "\n";
    return s;
}

Diagnostics::Diagnostics(Handler h) : handler_(std::move(h)) {}

void Diagnostics::report(Diagnostic d) {
    std::lock_guard lock(mutex_);
    if (d.severity >= Severity::Error) ++errors_;
    if (d.severity == Severity::Warning) ++warnings_;
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
    report(std::move(d));
}

int Diagnostics::errors() const { std::lock_guard lock(mutex_); return errors_; }
int Diagnostics::warnings() const { std::lock_guard lock(mutex_); return warnings_; }
std::vector<Diagnostic> Diagnostics::all() const { std::lock_guard lock(mutex_); return all_; }
void Diagnostics::setHandler(Handler h) { std::lock_guard lock(mutex_); handler_ = std::move(h); }

std::string nearestName(std::string_view word, const std::vector<std::string>& candidates) {
    std::string best;
    size_t bestCost = (word.size() + 1) / 3 + 1; // strictly less wins: one slip in three letters, none in one
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
        if (row.back() < bestCost) { bestCost = row.back(); best = c; }
    }
    return best;
}

} // namespace alpenglow
