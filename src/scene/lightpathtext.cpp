#include "scene/lightpathtext.h"
#include <algorithm>
#include <cctype>
#include <cstring>
#include <utility>

namespace alpenglow::scene {

namespace {

constexpr uint8_t bit(PathEvent e) { return uint8_t(1u << unsigned(e)); }
constexpr uint8_t bit(PathScattering s) { return uint8_t(1u << unsigned(s)); }

struct Letter {
    char c;
    uint8_t bits;
};
constexpr Letter kEvents[] = {{'C', bit(PathEvent::Camera)},
                              {'R', bit(PathEvent::Reflection)},
                              {'T', bit(PathEvent::Transmission)},
                              {'V', bit(PathEvent::Volume)},
                              {'L', uint8_t(bit(PathEvent::Light) | bit(PathEvent::Sky))},
                              {'B', bit(PathEvent::Sky)},
                              {'O', bit(PathEvent::Object)}};
constexpr Letter kScatterings[] = {{'D', bit(PathScattering::Diffuse)},
                                   {'G', bit(PathScattering::Glossy)},
                                   {'S', bit(PathScattering::Singular)},
                                   {'s', bit(PathScattering::Straight)}};
constexpr char kEventLetters[] = "events are C R T V L B O, and . for any",
               kScatteringLetters[] = "scatterings are D G S s, and . for any";

template <size_t N> uint8_t bitsOf(const Letter (&letters)[N], char c) {
    for (const Letter& l : letters)
        if (l.c == c) return l.bits;
    return 0;
}

/// A part of an expression: where paths through it begin and end.
struct Fragment {
    PathPositions first, last;
    bool empty = false;
};

struct Wrong {
    size_t at;
    std::string what, hint;
};

class Reader {
public:
    Reader(const std::string& text, size_t room) : text_(text), room_(room) {}
    LightPathText read() {
        const Fragment f = alternatives(0);
        if (peek()) fail("\")\" closes nothing", "");
        out_.first = f.first;
        out_.last = f.last;
        out_.empty = f.empty;
        return std::move(out_);
    }

private:
    char peek() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
        return at_ < text_.size() ? text_[at_] : 0;
    }
    bool take(char c) {
        if (peek() != c) return false;
        ++at_;
        return true;
    }
    [[noreturn]] void fail(const std::string& what, const std::string& hint) {
        throw Wrong{std::min(at_, text_.size()), what, hint};
    }
    void expect(char c, const char* what) {
        if (!take(c)) fail(std::string("\"") + c + "\" is missing " + what, "");
    }

    Fragment alternatives(int depth) {
        if (depth > LightPaths::kMostDepth)
            fail("parentheses lie more than " + std::to_string(LightPaths::kMostDepth) + " deep", "");
        Fragment all = sequence(depth);
        while (take('|')) {
            const Fragment f = sequence(depth);
            all.first |= f.first;
            all.last |= f.last;
            all.empty |= f.empty;
        }
        return all;
    }

    Fragment sequence(int depth) {
        if (const char c = peek(); !c || c == '|' || c == ')') fail("an event is missing", "");
        Fragment all;
        all.empty = true;
        for (char c = peek(); c && c != '|' && c != ')'; c = peek()) all = joined(all, repeated(depth));
        return all;
    }

    Fragment joined(const Fragment& a, const Fragment& b) {
        for (size_t p = 0; p < out_.positions.size(); ++p)
            if (a.last[p]) out_.follow[p] |= b.first;
        Fragment f;
        f.first = a.empty ? a.first | b.first : a.first;
        f.last = b.empty ? a.last | b.last : b.last;
        f.empty = a.empty && b.empty;
        return f;
    }

    Fragment again(Fragment f) { // any number, at least one
        f.empty |= joined(f, f).empty;
        return f;
    }

    Fragment repeated(int depth) {
        const size_t begin = at_;
        Fragment f = atom(depth);
        for (;;) {
            const size_t end = at_;
            if (take('*')) f = again(f), f.empty = true;
            else if (take('+')) f = again(f);
            else if (take('?')) f.empty = true;
            else if (take('{')) f = counted(f, begin, end, depth);
            else return f;
        }
    }

    /// `{n}`, `{n,}` and `{n,m}` behind what stands from `begin` to `end`, whose first copy is `one`.
    Fragment counted(const Fragment& one, size_t begin, size_t end, int depth) {
        const int least = number();
        int most = least;
        bool open = false;
        if (take(',')) {
            open = peek() == '}';
            if (!open) most = number();
        }
        expect('}', "behind a repetition");
        if (most < least || (most == 0 && !open))
            fail("a repetition has to be {n}, {n,} or {n,m} with n up to m, and m not 0", "");
        const size_t behind = at_;
        const int copies = std::max(open ? std::max(least, 1) : most, 1);
        Fragment all;
        all.empty = true;
        for (int k = 0; k < copies; ++k) {
            Fragment f = k == 0 ? one : copy(begin, end, depth);
            if (open && k == copies - 1) f = again(f);
            if (k >= least) f.empty = true;
            all = joined(all, f);
        }
        at_ = behind;
        return all;
    }

    Fragment copy(size_t begin, size_t end, int depth) {
        at_ = begin;
        Fragment f = atom(depth);
        // What stands behind the atom and before the braces, as in "(ab)+{2}".
        while (at_ < end) {
            const size_t here = at_;
            if (take('*')) f = again(f), f.empty = true;
            else if (take('+')) f = again(f);
            else if (take('?')) f.empty = true;
            else if (take('{')) f = counted(f, begin, here, depth);
            else break;
        }
        return f;
    }

    int number() {
        if (!std::isdigit(static_cast<unsigned char>(peek()))) fail("a number is missing", "repetitions are {n}, {n,} and {n,m}");
        int n = 0;
        while (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_]))) {
            n = n * 10 + (text_[at_++] - '0');
            if (n > int(LightPaths::kMostPositions)) tooLong();
        }
        return n;
    }

    [[noreturn]] void tooLong() {
        fail("all expressions of a frame together have more than " + std::to_string(LightPaths::kMostPositions) +
                 " events, repetitions written out",
             "");
    }

    Fragment position(PathPosition p) {
        if (out_.positions.size() >= room_) tooLong();
        Fragment f;
        f.first[out_.positions.size()] = f.last[out_.positions.size()] = true;
        out_.positions.push_back(std::move(p));
        out_.follow.emplace_back();
        return f;
    }

    Fragment atom(int depth) {
        if (take('(')) {
            const Fragment f = alternatives(depth + 1);
            expect(')', "behind what began with \"(\"");
            return f;
        }
        PathPosition p;
        if (take('[')) {
            p.negated = take('^');
            do p.any.push_back(events());
            while (peek() && peek() != ']');
            expect(']', "behind what began with \"[\"");
        } else {
            p.any.push_back(events());
        }
        return position(std::move(p));
    }

    /// A letter, ".", a label, or what stands in angle brackets.
    PathEvents events() {
        PathEvents e;
        const char c = peek();
        if (take('<')) {
            if (peek() != '>') e.events = mask(kEvents, "event", kEventLetters);
            if (peek() != '>' && peek() != '\'' && peek() != '"')
                e.scatterings = mask(kScatterings, "scattering", kScatteringLetters);
            if (peek() != '>') labels(e);
            expect('>', "behind what began with \"<\"");
            return e;
        }
        if (take('.')) return e;
        if (c == '\'' || c == '"') {
            e.labels.push_back(label());
            return e;
        }
        if (const uint8_t bits = bitsOf(kEvents, c)) e.events = bits;
        else if (const uint8_t more = bitsOf(kScatterings, c)) {
            e.scatterings = more;
            out_.straight |= c == 's';
        } else {
            unknown(c, "an event", std::string(kEventLetters) + "; " + kScatteringLetters);
        }
        ++at_;
        return e;
    }

    template <size_t N> uint8_t mask(const Letter (&letters)[N], const char* what, const char* hint) {
        if (take('.')) return 0xff;
        const bool several = take('['), negated = take('^');
        uint8_t bits = 0;
        do {
            const char c = peek();
            const uint8_t one = bitsOf(letters, c);
            if (!one) unknown(c, what, hint);
            out_.straight |= c == 's';
            bits |= one;
            ++at_;
        } while (several && peek() && peek() != ']');
        if (several) expect(']', "behind what began with \"[\"");
        return negated ? uint8_t(~bits) : bits;
    }

    void labels(PathEvents& e) {
        if (take('.')) return;
        const bool several = take('[');
        e.notLabels = take('^');
        do e.labels.push_back(label());
        while (several && peek() && peek() != ']');
        if (several) expect(']', "behind what began with \"[\"");
    }

    std::string label() {
        const char quote = peek();
        if (quote != '\'' && quote != '"') fail("a label in quotes is missing", "<L.'key'>");
        const size_t end = text_.find(quote, at_ + 1);
        if (end == std::string::npos) fail("the quote is not closed", "");
        const std::string l = text_.substr(at_ + 1, end - at_ - 1);
        if (l.empty()) fail("a label is empty", "<L.> is any light");
        at_ = end + 1;
        return l;
    }

    [[noreturn]] void unknown(char c, const std::string& what, std::string hint) {
        const char upper = char(std::toupper(static_cast<unsigned char>(c)));
        if (!c) fail(what + " is missing", hint);
        if (c == 'U' || std::isdigit(static_cast<unsigned char>(c)))
            hint = "lobes have no numbers here: a label names one, as in <RD'diffuse'>; " + hint;
        else if (c != upper && (bitsOf(kEvents, upper) || bitsOf(kScatterings, upper)))
            hint = std::string("did you mean ") + upper + "? " + hint;
        fail(std::string("\"") + c + "\" is not " + (what[0] == 'a' ? what : (what[0] == 'e' ? "an " : "a ") + what), hint);
    }

    const std::string& text_;
    const size_t room_;
    size_t at_ = 0;
    LightPathText out_;
};

} // namespace

bool PathEvents::has(PathEvent e, PathScattering s, std::span<const std::string> carried) const {
    if (!(events & bit(e)) || !(scatterings & bit(s))) return false;
    if (labels.empty()) return true;
    const bool one = std::any_of(carried.begin(), carried.end(), [&](const std::string& c) {
        return std::find(labels.begin(), labels.end(), c) != labels.end();
    });
    return one != notLabels;
}

bool PathPosition::has(PathEvent e, PathScattering s, std::span<const std::string> carried) const {
    return negated != std::any_of(any.begin(), any.end(), [&](const PathEvents& one) { return one.has(e, s, carried); });
}

std::optional<LightPathText> readLightPath(const std::string& text, size_t room, const SourcePlace& place, Diagnostics& d) {
    std::string shown = text.substr(0, 60) + (text.size() > 60 ? "..." : "");
    try {
        if (text.size() > LightPaths::kMostLength)
            throw Wrong{LightPaths::kMostLength, "it has more than " + std::to_string(LightPaths::kMostLength) + " characters",
                        ""};
        if (const size_t flag = text.find(';'); flag != std::string::npos)
            throw Wrong{0, "\"" + text.substr(0, flag) + ";\" is not available",
                        "unoccluded, holdout and other flags are not; expressions show light as it is in Ci"};
        return Reader(text, room).read();
    } catch (const Wrong& w) {
        d.report(Severity::Error, Rie::Syntax, place,
                 "light path expression \"" + shown + "\", character " + std::to_string(w.at + 1) + ": " + w.what, w.hint);
        return std::nullopt;
    }
}

} // namespace alpenglow::scene
