#include "rsl/front/source.h"
#include "base/limits.h"
#include "rsl/front/complete.h"
#include <algorithm>
#include <map>
#include <string>
#include <tuple>

namespace alpenglow::rsl::front {

/// Lines of old Macs end in a carriage return alone. Those before a line feed are the ends of lines of other systems.
static void lineEnds(std::string& text) {
    size_t at = text.find('\r');
    while (at != std::string::npos) {
        const size_t behind = text.find_first_not_of('\r', at);
        if (behind == std::string::npos || text[behind] != '\n')
            std::fill(text.begin() + long(at), text.begin() + long(std::min(behind, text.size())), '\n');
        at = behind == std::string::npos ? behind : text.find('\r', behind);
    }
}

int SourceSet::add(std::string name, std::string text) {
    lineEnds(text);
    kept_.push_back(std::move(text));
    entries_.push_back({std::move(name), &kept_.back(), -1, 0});
    return int(entries_.size()) - 1;
}

int SourceSet::addView(int of, std::string name, int delta) {
    const int real = entries_[of].view >= 0 ? entries_[of].view : of;
    for (size_t i = 0; i < entries_.size(); ++i)
        if (entries_[i].view == real && entries_[i].delta == delta && entries_[i].name == name) return int(i);
    entries_.push_back({std::move(name), nullptr, real, delta});
    return int(entries_.size()) - 1;
}

std::vector<std::string> SourceSet::names() const {
    std::vector<std::string> all;
    for (const auto& e : entries_) all.push_back(e.name);
    return all;
}

std::string_view SourceSet::keep(std::string s) {
    kept_.push_back(std::move(s));
    return kept_.back();
}

bool SourceSet::tooMany() const { return errors_ >= limits::kFrontErrors; }

void SourceSet::report(Place place, const Raised& raised, std::string hint, std::vector<std::string> notes) {
    if (muted) return;
    Severity severity = raised.message->severity;
    std::string text = raised.text();
    if (hint.empty()) hint = raised.message->hint;
    if (unused && severity >= Severity::Error) {
        severity = Severity::Warning;
        ++excused;
        hint += std::string(hint.empty() ? "" : "; ") + "no shader calls this function, so it does no harm";
    }
    if (severity >= Severity::Error && tooMany()) return;
    // A function is checked once for each shader that calls it: its faults are reported once.
    if (!seen_.insert({{place.file, place.line, place.column, int(severity)}, text}).second) return;
    if (severity >= Severity::Error) ++errors_;
    messages_.push_back({place, severity, raised, std::move(text), std::move(hint), std::move(notes)});
    if (!tooMany() || severity < Severity::Error) return;
    const Raised last = msg::kTooManyErrors;
    messages_.push_back({{place.file, place.line, place.column + 1}, Severity::Error, last, last.text(), {}, {}});
}

std::string SourceSet::line(Place p) const {
    if (p.file < 0 || p.file >= int(entries_.size()) || p.line < 1) return {};
    const std::string& t = text(p.file);
    int line = p.line - entries_[p.file].delta;
    size_t at = 0;
    for (; line > 1; --line) {
        at = t.find('\n', at);
        if (at == std::string::npos) return {};
        ++at;
    }
    const size_t longest = at + std::max(size_t(std::max(p.column, 0)), limits::kExcerptLine);
    std::string s = t.substr(at, std::min({t.find('\n', at), longest, t.size()}) - at);
    while (!s.empty() && (s.back() == '\r' || s.back() == '\n')) s.pop_back();
    return s;
}

void SourceSet::flush(Diagnostics& d) {
    for (size_t i = 0; i < messages_.size(); ++i) messages_[i].order = i;
    std::sort(messages_.begin(), messages_.end(), [](const Message& a, const Message& b) {
        return std::tie(a.place.file, a.place.line, a.place.column, a.order) <
               std::tie(b.place.file, b.place.line, b.place.column, b.order);
    });
    constexpr int kAlike = 20; // in one line, which in generated text may repeat a mistake ten thousand times
    std::map<std::tuple<int, int, std::string>, std::pair<int, int>> alike; // how many there are, how many were passed on
    for (const Message& m : messages_) ++alike[{m.place.file, m.place.line, m.text}].first;
    size_t kept = 0; // bytes of source lines: thousands of messages about one long line must not keep it thousands of times
    for (auto& m : messages_) {
        auto& [all, printed] = alike[{m.place.file, m.place.line, m.text}];
        if (++printed > kAlike) continue;
        if (printed == kAlike && all > kAlike)
            m.notes.push_back("there are " + std::to_string(all - kAlike) + " more of these in this line");
        Diagnostic out = diagnostic(m.raised, Rie::Syntax, {}, std::move(m.hint));
        out.severity = m.severity;
        if (m.place.file >= 0 && m.place.file < int(entries_.size())) out.place.file = entries_[m.place.file].name;
        out.place.line = m.place.line;
        out.place.column = m.place.column;
        if (kept < limits::kExcerptBytes) out.sourceLine = line(m.place);
        kept += out.sourceLine.size();
        out.notes = std::move(m.notes);
        complete(out, &m.raised);
        d.report(std::move(out));
    }
    messages_.clear();
}

} // namespace alpenglow::rsl::front
