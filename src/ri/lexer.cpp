#include "ri/lexer.h"
#include "base/limits.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fast_float/fast_float.h>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

bool letter(unsigned char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; }
bool digit(unsigned char c) { return c >= '0' && c <= '9'; }
bool startsNumber(unsigned char c) { return digit(c) || c == '-' || c == '+' || c == '.'; }
/// Bytes that cannot directly follow a number.
bool sticks(unsigned char c) { return letter(c) || startsNumber(c); }
constexpr size_t kBuffer = 256u << 10;    // comfortably above limits::kTokenBytes: a token always fits
constexpr size_t kFirstBuffer = 4u << 10; // small archives may be open by the thousand
constexpr size_t kPlainNumber = 64;       // bytes that the fast path for numbers reads
constexpr size_t kLineKept = 16 << 10;    // bytes of the current line kept for messages
constexpr size_t kNotFinite = 24;         // bytes that decide whether a word is nan or inf
constexpr double kInfinite = 1e38;        // RI_INFINITY

/// Bytes at p that C libraries print for what is no number, 0 for others: nan, -inf, Infinity, -nan(ind). `value`: what is taken
/// for it.
size_t notFinite(const char* p, const char* e, double& value) {
    const char* q = p < e && (*p == '+' || *p == '-') ? p + 1 : p;
    const auto word = [&](const char* w) {
        const size_t n = std::strlen(w);
        return size_t(e - q) >= n &&
               std::equal(w, w + n, q, [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
    };
    size_t n = 0;
    for (const char* w : {"nan(ind)", "nan(snan)", "nan", "infinity", "inf"})
        if (word(w)) {
            n = std::strlen(w);
            break;
        }
    if (n == 0 || (q + n < e && sticks(static_cast<unsigned char>(q[n])))) return 0;
    value = *q == 'n' || *q == 'N' ? 0 : *p == '-' ? -kInfinite : kInfinite;
    return size_t(q - p) + n;
}

/// The same of an old library of Windows, whose "-1.#IND00" has a '#' in it; p is behind the point.
size_t notFiniteBehindPoint(const char* p, const char* e, double& value) {
    for (const char* w : {"#IND", "#INF", "#QNAN", "#SNAN"}) {
        const size_t n = std::strlen(w);
        if (size_t(e - p) < n || std::memcmp(p, w, n) != 0) continue;
        value = w[3] == 'F' ? std::copysign(kInfinite, value) : 0;
        const char* q = p + n;
        while (q < e && digit(static_cast<unsigned char>(*q))) ++q;
        return q < e && letter(static_cast<unsigned char>(*q)) ? 0 : size_t(q - p);
    }
    return 0;
}

} // namespace

Lexer::Lexer(std::unique_ptr<ByteSource> source, std::string file, Reporter& reporter, Comments comments)
    : source_(std::move(source)), file_(std::move(file)), reporter_(reporter), comments_(std::move(comments)),
      buffer_(kFirstBuffer) {
    static_assert(kBuffer % kFirstBuffer == 0 && kBuffer > 2 * limits::kTokenBytes + kLineKept);
    // A UTF-8 mark: its first byte would be a reserved binary code.
    if (at() && peek() == 0xef) {
        while (end_ - pos_ < 3 && more()) {}
        if (end_ - pos_ >= 3 && std::memcmp(&buffer_[pos_], "\xef\xbb\xbf", 3) == 0) {
            pos_ += 3;
            lineStart_ = 3;
        }
    }
    if (at() && (peek() == 0xfe || peek() == 0xff)) {
        if (end_ - pos_ < 2) more();
        if (end_ - pos_ >= 2 && (peek() ^ static_cast<unsigned char>(buffer_[pos_ + 1])) == 1) { // fe ff, ff fe
            reporter_.error(Rie::BadFile, here(), "this is UTF-16, and RIB is ASCII or UTF-8", "iconv -f utf-16 -t utf-8");
            pos_ = end_;
            ended_ = true;
        }
    }
}

Lexer::~Lexer() = default;

bool Lexer::more() {
    if (ended_) return false;
    if (end_ == buffer_.size() && end_ < kBuffer) buffer_.resize(8 * end_);
    size_t keep = pos_;
    for (size_t start : {lineStart_, markStart_})
        if (start >= base_ && start - base_ < keep && base_ + pos_ - start <= kLineKept) keep = start - base_;
    if (keep > 0 && (end_ > buffer_.size() / 2 || pos_ == end_)) { // not for every few bytes of a pipe
        std::memmove(buffer_.data(), buffer_.data() + keep, end_ - keep);
        base_ += keep;
        pos_ -= keep;
        end_ -= keep;
    }
    if (end_ == buffer_.size()) return false; // cannot happen: tokens are shorter than the buffer
    size_t n = source_->read(buffer_.data() + end_, buffer_.size() - end_);
    if (n == 0) {
        ended_ = true;
        if (!source_->failure().empty())
            reporter_.error(source_->limitHit() ? Rie::Limit : Rie::BadFile, here(), source_->failure());
        return false;
    }
    end_ += n;
    return true;
}

std::string Lexer::lineText(const SourcePlace& p) const {
    size_t start = p.line == line_ ? lineStart_ : markStart_;
    if ((p.line != line_ && p.line != markLine_) || p.file != file_ || start < base_) return {};
    size_t from = start - base_, to = from;
    while (to < end_ && to - from < 200 && buffer_[to] != '\n' && buffer_[to] != '\r') {
        if (static_cast<unsigned char>(buffer_[to]) >= 0x80 || buffer_[to] == 0) return {}; // binary: nothing to read for people
        ++to;
    }
    return std::string(buffer_.data() + from, to - from);
}

void Lexer::newline() {
    ++pos_;
    ++line_;
    lineStart_ = base_ + pos_;
}

void Lexer::comment() {
    std::string text;
    ++pos_;
    while (at() && peek() != '\n' && peek() != '\r') {
        if (comments_ && text.size() < limits::kTokenBytes) text += buffer_[pos_];
        ++pos_;
    }
    if (!comments_) return;
    bool structure = !text.empty() && text[0] == '#';
    comments_(structure ? "structure" : "comment", structure ? text.substr(1) : text);
}

bool Lexer::skipSpace() {
    while (at()) {
        switch (peek()) {
        case ' ':
        case '\t':
        case '\f':
        case '\v':
        case 0377:
        case 032:
            ++pos_;
            break; // 0377 ends a RunProgram answer, 032 a file of DOS: nothing elsewhere
        case '\n':
            newline();
            break;
        case '\r': // a line end of its own only when no \n follows
            if (pos_ + 1 >= end_) more();
            if (pos_ + 1 < end_ && buffer_[pos_ + 1] == '\n') ++pos_;
            else newline();
            break;
        case '#':
            comment();
            break;
        default:
            return true;
        }
    }
    return false;
}

bool Lexer::number(double& out) {
    for (;;) {
        const char* p = buffer_.data() + pos_;
        const char* e = buffer_.data() + end_;
        const char* digits = p;
        if (digits < e && (*digits == '+' || *digits == '-')) ++digits;
        const char* q = digits;
        bool good = false, huge = false;
        if (digits < e && (digit(static_cast<unsigned char>(*digits)) || *digits == '.')) {
            auto r = fast_float::from_chars(*p == '+' ? digits : p, e, out);
            // Too small to represent is zero; too large is an error.
            good = r.ec == std::errc() || (r.ec == std::errc::result_out_of_range && std::isfinite(out));
            huge = (good || r.ec == std::errc::result_out_of_range) && !std::isfinite(out);
            q = r.ptr;
        }
        const char* stop = q;
        // A sign behind a number begins the next one: ".4-.4".
        const auto signedNumber = [&] {
            return good && q + 1 < e && q > digits && (*q == '+' || *q == '-') &&
                   (digit(static_cast<unsigned char>(q[1])) || q[1] == '.');
        };
        while (!signedNumber() && stop < e && sticks(static_cast<unsigned char>(*stop)) &&
               size_t(stop - p) <= limits::kTokenBytes)
            ++stop;
        if (stop == e && !ended_ && size_t(e - p) <= limits::kTokenBytes) {
            if (more()) continue; // the rest of the number may only just have arrived
        }
        size_t length = size_t(stop - p);
        if (size_t(e - stop) < kNotFinite && (!good || (stop < e && *stop == '#')) && more()) continue;
        const size_t none = good ? (q[-1] == '.' ? notFiniteBehindPoint(q, e, out) : 0) : notFinite(p, e, out);
        if (none > 0) {
            length = none + (good ? size_t(q - p) : 0);
            reporter_.once("ri:notfinite:" + file_, Severity::Error, Rie::Range, here(),
                           "'" + std::string(p, length) +
                               fmt::format("' is no number: {:g} is taken, and so on in this file", out));
            pos_ += length;
            return true;
        }
        if (good && !huge && stop == q && length <= limits::kTokenBytes) {
            pos_ += length;
            return true;
        }
        SourcePlace where = here();
        if (length > limits::kTokenBytes) {
            reporter_.error(Rie::Limit, where, "a number is longer than " + std::to_string(limits::kTokenBytes) + " bytes");
        } else if (huge && stop == q) {
            reporter_.error(Rie::Range, where, "the number " + std::string(p, std::min<size_t>(length, 40)) + " is out of range");
        } else {
            reporter_.error(Rie::Syntax, where, "'" + std::string(p, std::min<size_t>(length, 40)) + "' is not a number");
        }
        pos_ += std::max<size_t>(length, 1);
        while (at() && sticks(peek())) ++pos_;
        return false;
    }
}

/// Plain numbers between blanks and line ends, well inside the buffer: nearly all of a large file. Stops before anything else.
void Lexer::plainNumbers(std::vector<double>& out) {
    const char* const begin = buffer_.data();
    const char* p = begin + pos_;
    const char* const safe =
        begin + end_ - std::min(end_ - pos_, kPlainNumber); // a whole number and its end lie beyond every start
    while (p < safe) {
        if (*p == ' ') {
            ++p;
            continue;
        }
        if (*p == '\n') {
            ++p;
            ++line_;
            lineStart_ = base_ + size_t(p - begin);
            continue;
        }
        const char* digits = *p == '-' ? p + 1 : p;
        if (!digit(static_cast<unsigned char>(*digits)) && *digits != '.') break;
        double v;
        auto r = fast_float::from_chars(p, p + kPlainNumber, v);
        if (r.ec != std::errc() || (*r.ptr != ' ' && *r.ptr != '\n' && *r.ptr != ']') || !std::isfinite(v) ||
            r.ptr >= p + kPlainNumber - 1)
            break;
        out.push_back(v);
        p = r.ptr;
    }
    pos_ = size_t(p - begin);
}

void Lexer::numbers(std::vector<double>& out) {
    plainNumbers(out);
    binaryNumbers(out);
    if (pos_ < end_ && peek() >= 0x80) return; // another token
    const auto begins = [&] {
        if (startsNumber(peek())) return true;
        if (!std::strchr("nNiI", peek())) return false;
        while (end_ - pos_ < kNotFinite && more()) {}
        double v;
        return notFinite(buffer_.data() + pos_, buffer_.data() + end_, v) > 0;
    };
    while (skipSpace() && begins()) {
        double v;
        if (number(v)) out.push_back(v);
        plainNumbers(out);
    }
}

void Lexer::identifier(std::string& out) {
    out.clear();
    const int line = line_, first = int(column());
    while (at() && (letter(peek()) || digit(peek()))) {
        if (out.size() == limits::kTokenBytes) {
            reporter_.error(Rie::Limit, place(line, first),
                            "a name is longer than " + std::to_string(limits::kTokenBytes) + " bytes");
            while (at() && (letter(peek()) || digit(peek()))) ++pos_;
            return;
        }
        out += buffer_[pos_++];
    }
}

/// After a backslash; RISpec 3.2, appendix C.2.
void Lexer::escape(std::string& out) {
    if (!at()) return;
    unsigned char c = peek();
    if (c >= '0' && c <= '7') {
        unsigned v = 0;
        for (int i = 0; i < 3 && at() && peek() >= '0' && peek() <= '7'; ++i, ++pos_) v = v * 8 + (peek() - '0');
        out += char(v & 0xff);
        return;
    }
    if (c == '\r') { // continuation
        ++pos_;
        if (at() && peek() == '\n') newline();
        return;
    }
    if (c == '\n') {
        newline();
        return;
    }
    ++pos_;
    switch (c) {
    case 'n':
        out += '\n';
        break;
    case 'r':
        out += '\r';
        break;
    case 't':
        out += '\t';
        break;
    case 'b':
        out += '\b';
        break;
    case 'f':
        out += '\f';
        break;
    case '"':
    case '\\':
        out += char(c);
        break;
    default: // names of Windows files: the backslash is kept
        out += '\\';
        out += char(c);
    }
}

void Lexer::quoted(std::string& out, int line, int column) {
    out.clear();
    const unsigned char quote = peek();
    ++pos_;
    bool tooLong = false;
    while (at()) {
        unsigned char c = peek();
        if (c == quote) {
            ++pos_;
            return;
        }
        if (out.size() >= limits::kStringBytes) {
            if (!tooLong)
                reporter_.error(Rie::Limit, place(line, column),
                                "a string is longer than " + std::to_string(limits::kStringBytes) + " bytes");
            tooLong = true;
            out.resize(limits::kStringBytes - 1);
        }
        if (c == '\\') {
            ++pos_;
            escape(out);
        } else if (c == '\n') {
            out += '\n';
            newline();
        } else {
            out += char(c);
            ++pos_;
        }
    }
    reporter_.error(Rie::Syntax, place(line, column), "a string has no closing quote");
}

bool Lexer::apostrophes() {
    for (size_t k = 1; k < limits::kTokenBytes; ++k) {
        while (pos_ + k >= end_)
            if (!more()) return false;
        const char c = buffer_[pos_ + k];
        if (c == '\'') return true;
        if (c == '\n' || c == '\r') return false;
    }
    return false;
}

void Lexer::badBytes() {
    SourcePlace where = here();
    unsigned first = peek();
    size_t n = 0;
    while (at()) {
        unsigned char c = peek();
        if (letter(c) || startsNumber(c) || std::strchr(" \t\f\v\r\n#\"[]", c) != nullptr || c >= 0200) {
            if (c != 0) break;
        }
        ++pos_;
        ++n;
    }
    std::string shown = first > 32 && first < 127 ? std::string("'") + char(first) + "'" : "byte " + std::to_string(first);
    reporter_.error(Rie::Syntax, where,
                    shown + (n > 1 ? " and " + std::to_string(n - 1) + " more bytes are" : " is") + " not part of any RIB token");
}

void Lexer::next(Token& t) {
    t.text.clear();
    t.floats.clear();
    t.request = nullptr;
    for (;;) {
        bool any = skipSpace();
        t.line = line_;
        t.column = int(column());
        t.lineStart = lineStart_;
        if (!any) {
            t.kind = Token::Kind::End;
            return;
        }
        unsigned char c = peek();
        if (letter(c)) {
            t.kind = Token::Kind::Identifier;
            return identifier(t.text);
        }
        if (startsNumber(c)) {
            t.kind = Token::Kind::Number;
            if (number(t.number)) return;
            continue;
        }
        if (c == '"') {
            t.kind = Token::Kind::String;
            return quoted(t.text, t.line, t.column);
        }
        if (c == '\'' && apostrophes()) { // some published files have them
            reporter_.once("ri:apostrophes", Severity::Warning, Rie::Syntax, here(),
                           "a string in apostrophes: RIB writes it in double quotes");
            t.kind = Token::Kind::String;
            return quoted(t.text, t.line, t.column);
        }
        if (c == '[' || c == ']') {
            t.kind = c == '[' ? Token::Kind::Open : Token::Kind::Close;
            ++pos_;
            return;
        }
        if (c >= 0200) {
            if (binary(t)) return;
            continue;
        }
        badBytes();
    }
}

} // namespace alpenglow::ri
