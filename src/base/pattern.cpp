#include "base/pattern.h"
#include "base/limits.h"
#include <cctype>
#include <cstring>
#include <functional>

namespace alpenglow {
namespace {

constexpr int kMostRepeats = 32767; // RE_DUP_MAX
constexpr int kNesting = 256;

using Bytes = std::bitset<256>;

bool isWordByte(unsigned char c) { return std::isalnum(c) || c == '_'; }

Bytes bytesThat(const std::function<bool(unsigned char)>& fit) {
    Bytes b;
    for (int c = 1; c < 256; ++c) b[size_t(c)] = fit(static_cast<unsigned char>(c));
    return b;
}

/// [:alpha:] and its like.
bool classBytes(const std::string& name, Bytes& out) {
    const std::pair<const char*, int (*)(int)> known[] = {
        {"alpha", std::isalpha}, {"digit", std::isdigit}, {"alnum", std::isalnum}, {"upper", std::isupper},
        {"lower", std::islower}, {"space", std::isspace}, {"blank", std::isblank}, {"punct", std::ispunct},
        {"print", std::isprint}, {"graph", std::isgraph}, {"cntrl", std::iscntrl}, {"xdigit", std::isxdigit}};
    for (const auto& [n, is] : known)
        if (name == n) {
            out |= bytesThat([test = is](unsigned char c) { return test(c) != 0; });
            return true;
        }
    return false;
}

/// Whether a word starts ('<'), ends ('>'), either ('b') or neither ('B') before byte `at`.
bool isEdge(std::string_view text, size_t at, char kind) {
    const bool before = at > 0 && isWordByte(static_cast<unsigned char>(text[at - 1]));
    const bool behind = at < text.size() && isWordByte(static_cast<unsigned char>(text[at]));
    return kind == '<' ? !before && behind : kind == '>' ? before && !behind : (before != behind) == (kind == 'b');
}

} // namespace

/// Recursive descent parser. A piece of the automaton has one entry, and one state whose exit is not yet set.
class PatternParser {
public:
    PatternParser(const std::string& text, Pattern& p) : text_(text), p_(p) {}

    bool run(std::string& error) {
        const Piece all = alternatives(0);
        if (error_.empty() && at_ < text_.size()) fail("there is a ')' without its '('");
        error = error_;
        if (!error_.empty()) return false;
        p_.start_ = all.in;
        p_.states_[all.out] = {Pattern::Op::Found};
        return true;
    }

private:
    using Op = Pattern::Op;
    /// `out` is a Split with unset exits.
    struct Piece {
        uint32_t in, out;
    };

    void fail(const char* why) {
        if (error_.empty()) error_ = why;
    }
    bool good() const { return error_.empty(); }
    bool more() const { return good() && at_ < text_.size(); }
    char peek() const { return text_[at_]; }

    uint32_t state(Pattern::State s) {
        if (p_.states_.size() >= limits::kPatternStates) fail("the pattern is too large after expanding repetitions");
        else p_.states_.push_back(s);
        return uint32_t(p_.states_.size() - 1);
    }
    uint32_t open() { return state({Op::Split}); }
    void join(uint32_t from, uint32_t to) { p_.states_[from].next = p_.states_[from].other = to; }
    Piece single(Pattern::State s) {
        const uint32_t out = open();
        s.next = s.other = out;
        return {state(s), out};
    }
    Piece nothing() {
        const uint32_t out = open();
        return {out, out};
    }
    Piece oneOf(const Bytes& b) {
        p_.sets_.push_back(b);
        return single({Op::Byte, 0, 0, uint32_t(p_.sets_.size() - 1)});
    }

    Piece alternatives(int depth) {
        Piece a = sequence(depth);
        while (more() && peek() == '|') {
            ++at_;
            const Piece b = sequence(depth);
            const uint32_t in = state({Op::Split, a.in, b.in}), out = open();
            join(a.out, out);
            join(b.out, out);
            a = {in, out};
        }
        return a;
    }

    Piece sequence(int depth) {
        Piece all = nothing();
        while (more() && peek() != '|' && !(peek() == ')' && depth > 0)) {
            const Piece next = repeated(depth);
            if (!good()) break;
            join(all.out, next.in);
            all.out = next.out;
        }
        return all;
    }

    /// An atom and the signs of repetition behind it. The atom's text is read again for each time it is needed.
    Piece repeated(int depth) {
        const size_t begin = at_;
        Piece p = atom(depth);
        const size_t end = at_;
        while (more() && std::strchr("*+?{", peek())) {
            int least = 0, most = -1;
            const size_t sign = at_;
            if (peek() == '{') {
                if (!bounds(least, most)) return p;
            } else {
                least = peek() == '+';
                most = peek() == '?' ? 1 : -1;
                ++at_;
            }
            const size_t behind = at_;
            p = times(begin, sign, end, depth, least, most);
            at_ = behind;
        }
        return p;
    }

    /// The text from begin to sign, `least` times, then optionally up to `most` times (-1: unlimited).
    Piece times(size_t begin, size_t sign, size_t end, int depth, int least, int most) {
        Piece all = nothing();
        const auto copy = [&]() {
            at_ = begin;
            if (sign == end) return atom(depth);
            // Consecutive repetition signs, as in a*{2}: repeats everything before the last one.
            const std::string saved = text_.substr(sign);
            text_.resize(sign);
            const Piece p = repeated(depth);
            text_ += saved;
            return p;
        };
        for (int n = 0; n < least && good(); ++n) {
            const Piece p = copy();
            join(all.out, p.in);
            all.out = p.out;
        }
        if (most < 0 && good()) {
            const Piece p = copy();
            const uint32_t out = open(), again = state({Op::Split, p.in, out});
            join(all.out, again);
            join(p.out, again);
            all.out = out;
        }
        if (most > least && good()) {
            const uint32_t out = open();
            for (int n = least; n < most && good(); ++n) {
                const Piece p = copy();
                const uint32_t maybe = state({Op::Split, p.in, out});
                join(all.out, maybe);
                all.out = p.out;
            }
            join(all.out, out);
            all.out = out;
        }
        return all;
    }

    bool bounds(int& least, int& most) {
        const auto number = [&](int& n) {
            const size_t first = at_;
            n = 0;
            for (; more() && std::isdigit(static_cast<unsigned char>(peek())); ++at_)
                n = std::min(n * 10 + (peek() - '0'), kMostRepeats + 1);
            return at_ > first;
        };
        ++at_;
        const bool from = number(least);
        most = least;
        if (more() && peek() == ',') {
            ++at_;
            if (!number(most)) most = -1;
            else if (!from) least = 0;
        } else if (!from) {
            return fail("expected one or two numbers between '{' and '}'"), false;
        }
        if (at_ >= text_.size()) return fail("there is a '{' without its '}'"), false;
        if (peek() != '}') return fail("expected one or two numbers between '{' and '}'"), false;
        ++at_;
        if (least > kMostRepeats || most > kMostRepeats) return fail("a repetition is too large"), false;
        if (most >= 0 && most < least) return fail("the second number of a repetition is less than the first"), false;
        return true;
    }

    Piece atom(int depth) {
        if (depth > kNesting) fail("it is nested too deeply");
        if (!more()) return {0, 0};
        const char c = text_[at_++];
        switch (c) {
        case '(': {
            const Piece p = alternatives(depth + 1);
            if (good() && (at_ >= text_.size() || peek() != ')')) fail("there is a '(' without its ')'");
            ++at_;
            return p;
        }
        case '^':
            return single({Op::Begin});
        case '$':
            return single({Op::End});
        case '.':
            return oneOf(bytesThat([](unsigned char) { return true; }));
        case '[':
            return set();
        case '*':
        case '+':
        case '?':
        case '{':
            fail("nothing to repeat before a repetition sign");
            return {0, 0};
        case '\\':
            return escaped();
        default:
            break;
        }
        Bytes b;
        b[static_cast<unsigned char>(c)] = true;
        return oneOf(b);
    }

    Piece escaped() {
        if (at_ >= text_.size()) {
            fail("there is a '\\' at the end");
            return {0, 0};
        }
        const auto c = static_cast<unsigned char>(text_[at_++]);
        if (c >= '1' && c <= '9') fail("back-references such as \\1 are not supported");
        switch (c) {
        case 'b':
        case 'B':
        case '<':
        case '>':
            return single({Op::Edge, 0, 0, c});
        case '`':
            return single({Op::Begin});
        case '\'':
            return single({Op::End});
        case 'w':
            return oneOf(bytesThat(isWordByte));
        case 'W':
            return oneOf(bytesThat([](unsigned char x) { return !isWordByte(x); }));
        case 's':
            return oneOf(bytesThat([](unsigned char x) { return std::isspace(x) != 0; }));
        case 'S':
            return oneOf(bytesThat([](unsigned char x) { return std::isspace(x) == 0; }));
        default:
            break;
        }
        Bytes b;
        b[c] = true;
        return oneOf(b);
    }

    /// Behind '['.
    Piece set() {
        Bytes b;
        const bool negative = at_ < text_.size() && peek() == '^';
        at_ += negative;
        for (bool first = true; good(); first = false) {
            if (at_ >= text_.size()) {
                fail("there is a '[' without its ']'");
                break;
            }
            if (peek() == ']' && !first) break;
            member(b);
        }
        ++at_;
        if (negative) {
            b = ~b;
            b[0] = false; // ends a text
        }
        return oneOf(b);
    }

    /// A character, a range of them, or a class.
    void member(Bytes& b) {
        if (text_.compare(at_, 2, "[:") == 0) {
            const size_t end = text_.find(":]", at_ + 2);
            if (end == std::string::npos) return fail("there is a '[:' without its ':]'");
            if (!classBytes(text_.substr(at_ + 2, end - at_ - 2), b)) fail("unknown character class");
            at_ = end + 2;
            return;
        }
        unsigned char low = 0, high = 0;
        if (!element(low)) return;
        high = low;
        if (at_ + 1 < text_.size() && peek() == '-' && text_[at_ + 1] != ']') {
            ++at_;
            if (!element(high)) return;
            if (high < low) return fail("a range of characters ends before it starts");
        }
        for (int c = low; c <= high; ++c) b[size_t(c)] = true;
    }

    /// x, [.x.] or [=x=].
    bool element(unsigned char& c) {
        for (const char* form : {"[.", "[="}) {
            if (text_.compare(at_, 2, form) != 0) continue;
            if (at_ + 5 > text_.size() || text_[at_ + 3] != form[1] || text_[at_ + 4] != ']')
                return fail("expected one character between '[.' and '.]'"), false;
            c = static_cast<unsigned char>(text_[at_ + 2]);
            at_ += 5;
            return true;
        }
        c = static_cast<unsigned char>(text_[at_++]);
        return true;
    }

    std::string text_;
    Pattern& p_;
    size_t at_ = 0;
    std::string error_;
};

std::shared_ptr<const Pattern> Pattern::make(const std::string& text, std::string& error) {
    auto p = std::make_shared<Pattern>();
    p->states_.reserve(2 * text.size() + 4);
    if (!PatternParser(text, *p).run(error)) return nullptr;
    return p;
}

bool Pattern::occurs(std::string_view text) const {
    // The set of active states of the automaton, advanced byte by byte; a new match may start at every byte.
    std::vector<uint32_t> now, next, open;
    std::vector<uint32_t> seen(states_.size(), 0);
    uint32_t round = 0;
    bool found = false;
    const auto enter = [&](std::vector<uint32_t>& set, uint32_t first, size_t at) {
        open.push_back(first);
        while (!open.empty()) {
            const uint32_t s = open.back();
            open.pop_back();
            if (seen[s] == round) continue;
            seen[s] = round;
            const State& x = states_[s];
            switch (x.op) {
            case Op::Byte:
                set.push_back(s);
                break;
            case Op::Found:
                found = true;
                break;
            case Op::Split:
                open.push_back(x.next);
                if (x.other != x.next) open.push_back(x.other);
                break;
            case Op::Edge:
                if (isEdge(text, at, char(x.bytes))) open.push_back(x.next);
                break;
            case Op::Begin:
                if (at == 0) open.push_back(x.next);
                break;
            case Op::End:
                if (at == text.size()) open.push_back(x.next);
                break;
            }
        }
    };
    for (size_t at = 0; !found; ++at) {
        if (at == 0) ++round;
        enter(now, start_, at);
        if (found || at == text.size()) break;
        ++round;
        next.clear();
        const auto c = static_cast<unsigned char>(text[at]);
        for (uint32_t s : now)
            if (sets_[states_[s].bytes][c]) enter(next, states_[s].next, at + 1);
        now.swap(next);
    }
    return found;
}

} // namespace alpenglow
