// The binary tokens of RIB (RISpec 3.2, appendix C.2).
#include "base/limits.h"
#include "ri/binarynumber.h"
#include "ri/lexer.h"
#include "ri/requests/request.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace alpenglow::ri {
namespace {

constexpr size_t kBuffered = 64u << 10; // bytes of an array that are allocated before they are read

uint64_t bigEndian(const std::string& s) {
    uint64_t v = 0;
    for (unsigned char c : s) v = v << 8 | c;
    return v;
}

} // namespace

bool Lexer::truncated(const char* what) {
    reporter_.error(Rie::BadFile, here(), std::string("the stream ends inside ") + what);
    return false;
}

bool Lexer::byte(unsigned& out) {
    if (!at()) return false;
    out = peek();
    ++pos_;
    return true;
}

bool Lexer::bytes(size_t n, std::string& out) {
    out.clear();
    while (out.size() < n) { // grows with the bytes read: a wrong length allocates nothing
        if (!at()) return false;
        size_t take = std::min(n - out.size(), end_ - pos_);
        out.append(buffer_.data() + pos_, take);
        pos_ += take;
    }
    return true;
}

/// The string operand of a define: any of the string forms.
bool Lexer::binaryString(std::string& out, const char* what) {
    if (!skipSpace()) return truncated(what);
    unsigned c = peek();
    Token t;
    if (c == '"') {
        quoted(out, line_, int(column()));
        return true;
    }
    bool stringForm = (c >= 0220 && c <= 0243) || c == 0317 || c == 0320;
    if (stringForm && binary(t)) {
        out = t.text;
        return true;
    }
    if (!stringForm) reporter_.error(Rie::BadFile, here(), std::string("a string is missing in ") + what);
    return false;
}

/// n floats to t.floats, or as many as there are: a wrong length allocates nothing.
bool Lexer::binaryFloats(Token& t, uint64_t n) {
    t.floats.clear();
    t.floats.reserve(size_t(std::min<uint64_t>(n, kBuffered / 4)));
    while (n > 0) {
        const size_t have = size_t(std::min<uint64_t>(n, (end_ - pos_) / 4)), old = t.floats.size();
        if (have == 0) {
            if (!more()) return truncated("a binary array");
            continue;
        }
        t.floats.resize(old + have);
        floatsAt(buffer_.data() + pos_, have, t.floats.data() + old);
        pos_ += 4 * have;
        n -= have;
    }
    return true;
}

void Lexer::binaryNumbers(std::vector<double>& out) {
    double v;
    while (end_ - pos_ >= kNumberBytes) {
        const char* end = numberAt(buffer_.data() + pos_, v);
        if (!end) return;
        out.push_back(v);
        pos_ = size_t(end - buffer_.data());
    }
}

/// Numbers and known codes, which are nearly all of a file, where they are in the buffer. False: look closer.
bool Lexer::binaryPlain(Token& t) {
    if (end_ - pos_ < kNumberBytes) return false;
    const char* const p = buffer_.data() + pos_;
    if (const char* end = numberAt(p, t.number)) {
        t.kind = Token::Kind::Number;
        pos_ = size_t(end - buffer_.data());
        return true;
    }
    const unsigned code = static_cast<unsigned char>(p[1]), first = peek();
    const size_t length = first - 0220; // of a short string
    if (length < 16 && length < end_ - pos_) {
        t.kind = Token::Kind::String;
        t.text.assign(p + 1, length);
        pos_ += 1 + length;
        return true;
    }
    if (first == 0310 && 2 + 4 * size_t(code) <= end_ - pos_) {
        t.kind = Token::Kind::Floats;
        pos_ += 2;
        return binaryFloats(t, code);
    }
    if (first == 0246 && requests_[code]) {
        t.kind = Token::Kind::Identifier;
        t.request = requests_[code];
    } else if (first == 0317 && code < stringCodes_.size() && stringCodes_[code]) {
        t.kind = Token::Kind::String;
        t.text = *stringCodes_[code];
    } else return false;
    pos_ += 2;
    return true;
}

bool Lexer::binary(Token& t) {
    if (binaryPlain(t)) return true;
    const int line = line_, at = int(column());
    unsigned c = 0, b = 0;
    byte(c);
    std::string data;
    t.kind = Token::Kind::Number;
    if (c <= 0217) { // integer, or fixed point with d bytes after the point
        unsigned w = c & 3, d = (c >> 2) & 3;
        if (!bytes(w + 1, data)) return truncated("a binary number");
        int64_t v = int64_t(bigEndian(data) << (64 - 8 * (w + 1))) >> (64 - 8 * (w + 1));
        t.number = std::ldexp(double(v), -8 * int(d));
        return true;
    }
    if (c <= 0243) { // strings
        size_t n = c - 0220;
        if (c >= 0240) {
            if (!bytes(c - 0240 + 1, data)) return truncated("a string's length");
            n = bigEndian(data);
        }
        if (n > limits::kStringBytes) {
            reporter_.error(Rie::Limit, place(line, at),
                            "a string is longer than " + std::to_string(limits::kStringBytes) + " bytes");
            return false; // what follows cannot be decoded: the request is dropped, the reader resynchronises
        }
        t.kind = Token::Kind::String;
        return bytes(n, t.text) || truncated("a binary string");
    }
    if (c == 0244 || c == 0245) {
        if (!bytes(c == 0244 ? 4 : 8, data)) return truncated("a binary number");
        t.number = c == 0244 ? double(std::bit_cast<float>(uint32_t(bigEndian(data)))) : std::bit_cast<double>(bigEndian(data));
        return true; // NaN and infinity are refused where values are checked
    }
    if (c == 0246) {
        if (!byte(b)) return truncated("a request code");
        t.kind = Token::Kind::Identifier;
        t.text = requestCodes_[b];
        t.request = requests_[b];
        if (!t.text.empty()) return true;
        reporter_.error(Rie::BadFile, place(line, at), "request code " + std::to_string(b) + " was not defined");
        return false;
    }
    if (c >= 0310 && c <= 0313) {
        if (!bytes(c - 0310 + 1, data)) return truncated("an array's length");
        t.kind = Token::Kind::Floats;
        return binaryFloats(t, bigEndian(data));
    }
    if (c == 0314) {
        if (!byte(b)) return truncated("a request definition");
        if (binaryString(data, "a request definition")) {
            requestCodes_[b] = data;
            requests_[b] = findRequest(data);
        }
        return false;
    }
    if (c >= 0315 && c <= 0320) {
        bool define = c <= 0316, two = c == 0316 || c == 0320;
        if (!bytes(two ? 2 : 1, data)) return truncated("a string code");
        unsigned code = unsigned(bigEndian(data));
        if (define) {
            if (binaryString(data, "a string definition")) {
                if (stringCodes_.size() <= code) stringCodes_.resize(code + 1);
                stringCodes_[code] = data;
            }
            return false;
        }
        if (code >= stringCodes_.size() || !stringCodes_[code]) {
            reporter_.error(Rie::BadFile, place(line, at), "string code " + std::to_string(code) + " was not defined");
            return false;
        }
        t.kind = Token::Kind::String;
        t.text = *stringCodes_[code];
        return true;
    }
    reporter_.error(Rie::BadFile, place(line, at), "byte " + std::to_string(c) + " is reserved in binary RIB");
    return false;
}

} // namespace alpenglow::ri
