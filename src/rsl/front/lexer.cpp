#include "rsl/front/lexer.h"
#include <array>

namespace alpenglow::rsl::front {

namespace {
// By hand: <cctype> depends on the locale.
bool isDigit(int c) { return c >= '0' && c <= '9'; }
bool isWordByte(int c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || isDigit(c); }
bool isBlank(int c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v' || c == 0 || c == 0x1a; }
constexpr std::array<std::string_view, 15> kLong = {
    "...", "##", "->", "+=", "-=", "*=", "/=", "==", "!=", "<=", ">=", "&&", "||", "<<", ">>"};
constexpr std::string_view kShort = "()[]{};,.?:=+-*/%^!<>&|~#";
} // namespace

Lexer::Lexer(SourceSet& s, int file) : Lexer(s, file, s.text(file)) {}

Lexer::Lexer(SourceSet& s, int file, std::string_view text) : sources_(s), text_(text), file_(file), placeFile_(file) {
    if (text_.compare(0, 3, "\xef\xbb\xbf") == 0) pos_ = lineBegin_ = 3; // a UTF-8 mark
}

/// At a backslash that ends a line: i moves behind the line end.
bool Lexer::joined(size_t& i) const {
    if (at(i) != '\\') return false;
    size_t k = i + 1;
    while (at(k) == ' ' || at(k) == '\t' || at(k) == '\r') ++k;
    if (at(k) != '\n') return false;
    i = k + 1;
    return true;
}

void Lexer::skipBlank(Token& t) {
    for (;;) {
        const int c = at(pos_);
        size_t k = pos_;
        if (c == '\n') {
            ++pos_, ++line_;
            lineBegin_ = pos_;
            lineStart_ = t.space = true;
        } else if (c >= 0 && isBlank(c)) {
            ++pos_;
            t.space = true;
        } else if (joined(k)) {
            pos_ = lineBegin_ = k;
            ++line_;
        } else if (c == '/' && at(pos_ + 1) == '/') {
            while (at(pos_) >= 0 && at(pos_) != '\n') {
                k = pos_;
                if (joined(k)) {
                    pos_ = lineBegin_ = k;
                    ++line_;
                } else ++pos_;
            }
            t.space = true;
        } else if (c == '/' && at(pos_ + 1) == '*') {
            const Place begin{placeFile_, line_ + delta_, int(pos_ - lineBegin_) + 1};
            for (pos_ += 2; at(pos_) >= 0 && !(at(pos_) == '*' && at(pos_ + 1) == '/'); ++pos_)
                if (at(pos_) == '\n') {
                    ++line_;
                    lineBegin_ = pos_ + 1;
                }
            if (at(pos_) < 0) {
                sources_.report(begin, msg::kUnfinishedComment);
                sources_.cut = true;
            } else pos_ += 2;
            t.space = true;
        } else {
            return;
        }
    }
}

/// Reads bytes that `accept` accepts, across joined lines.
void Lexer::takeWhile(bool (*accept)(int)) {
    for (;;) {
        size_t k = pos_;
        if (joined(k)) {
            if (!accept(at(k))) return;
            joinLine(k);
        }
        if (!accept(at(pos_))) return;
        ++pos_;
    }
}

/// Goes on behind the end of a line that is joined to the next.
void Lexer::joinLine(size_t next) {
    pos_ = lineBegin_ = next;
    ++line_;
    broken_ = true;
}

void Lexer::scanNumber() {
    takeWhile(isDigit);
    if (at(pos_) == '.' && !(at(pos_ + 1) == '.')) {
        ++pos_;
        takeWhile(isDigit);
    }
    if ((at(pos_) | 32) == 'e') {
        size_t k = pos_ + 1;
        if (at(k) == '+' || at(k) == '-') ++k;
        if (isDigit(at(k))) {
            pos_ = k;
            takeWhile(isDigit);
        }
    }
    takeWhile(isWordByte); // invalid letters, which the parser reports
}

/// Whether the string ends on its line.
bool Lexer::scanString() {
    for (++pos_;;) {
        const int d = at(pos_);
        size_t k = pos_;
        if (d < 0 || d == '\n') return false;
        if (joined(k)) {
            joinLine(k);
            continue;
        }
        pos_ += d == '\\' && at(pos_ + 1) >= 0 && at(pos_ + 1) != '\n' ? 2 : 1;
        if (d == '"') return true;
    }
}

Tok Lexer::scanPunct() {
    for (auto p : kLong)
        if (text_.compare(pos_, p.size(), p) == 0) {
            pos_ += p.size();
            return Tok::Punct;
        }
    const int c = at(pos_++);
    if (kShort.find(char(c)) != kShort.npos) return Tok::Punct;
    while (c >= 0x80 && at(pos_) >= 0x80) ++pos_; // the rest of a character of several bytes
    return Tok::Invalid;
}

/// The text from `begin` on without the ends of lines that were joined.
std::string Lexer::joinedText(size_t begin) const {
    std::string clean;
    for (size_t i = begin; i < pos_;) {
        size_t k = i;
        if (joined(k)) i = k;
        else clean += text_[i++];
    }
    return clean;
}

Token Lexer::scan() {
    Token t;
    skipBlank(t);
    t.lineStart = lineStart_;
    lineStart_ = false;
    t.place = {placeFile_, line_ + delta_, int(pos_ - lineBegin_) + 1};
    const size_t begin = pos_;
    broken_ = false;
    const int c = at(pos_);
    if (c < 0) {
        t.kind = Tok::End;
        t.lineStart = true;
        return t;
    }
    if (isWordByte(c) && !isDigit(c)) {
        t.kind = Tok::Identifier;
        takeWhile(isWordByte);
    } else if (isDigit(c) || (c == '.' && isDigit(at(pos_ + 1)))) {
        t.kind = Tok::Number;
        scanNumber();
    } else if (c == '"') {
        t.kind = scanString() ? Tok::String : Tok::Invalid;
    } else {
        t.kind = scanPunct();
    }
    t.text = text_.substr(begin, pos_ - begin);
    if (broken_) t.text = sources_.keep(joinedText(begin));
    return t;
}

const Token& Lexer::peek() {
    if (!peeked_) {
        ahead_ = scan();
        peeked_ = true;
    }
    return ahead_;
}

Token Lexer::next() {
    if (peeked_) {
        peeked_ = false;
        return ahead_;
    }
    return scan();
}

std::string stringValue(std::string_view t) {
    if (t.size() >= 2) t = t.substr(1, t.size() - 2);
    std::string s;
    for (size_t i = 0; i < t.size(); ++i) {
        if (t[i] != '\\' || i + 1 == t.size()) {
            s += t[i];
            continue;
        }
        const char c = t[++i];
        if (c == 'n') s += '\n';
        else if (c == 't') s += '\t';
        else if (c == 'r') s += '\r';
        else if (c == 'b') s += '\b';
        else if (c == 'f') s += '\f';
        else if (c >= '0' && c <= '7') {
            int v = 0, k = 0;
            for (; k < 3 && i < t.size() && t[i] >= '0' && t[i] <= '7'; ++k, ++i) v = v * 8 + (t[i] - '0');
            --i;
            s += char(v & 255);
        } else s += c;
    }
    return s;
}

} // namespace alpenglow::rsl::front
