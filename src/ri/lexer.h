// RIB bytes to tokens: ASCII and binary, freely mixed (RISpec 3.2, appendix C.2).
#pragma once
#include "ri/direct.h"
#include "ri/reporter.h"
#include "ri/source.h"
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::ri {

struct Request;

/// A token of a stream, ASCII or binary.
struct Token {
    enum class Kind { End, Identifier, Number, String, Open, Close, Floats /* a whole binary array */ };
    Kind kind = Kind::End;      ///< what it is
    double number = 0;          ///< of Number
    std::string text;           ///< identifier or string
    std::vector<double> floats; ///< Kind::Floats
    /// Of an identifier that has a code, where findRequest() leads, and then there may be no text; null: not known.
    const Request* request = nullptr;
    int line = 0, column = 0; ///< of its first byte, from 1
    size_t lineStart = 0;     ///< stream offset of that line
};

/// Splits a stream into tokens, line by line. Errors are reported, and the bytes skipped.
class Lexer {
public:
    /// Called with "comment" or "structure" and the text after # or ##.
    using Comments = std::function<void(const std::string& kind, const std::string& text)>;
    /// `file` names the stream in messages.
    Lexer(std::unique_ptr<ByteSource> source, std::string file, Reporter& reporter, Comments comments = {});
    ~Lexer();
    /// The next token; Kind::End for ever at the end. Damaged bytes are reported and passed over.
    void next(Token& out);
    /// Numbers that follow directly, up to anything else, appended to `out`: the fast way through long arrays.
    void numbers(std::vector<double>& out);
    /// A place in the stream; that of the next byte.
    SourcePlace place(int line, int column) const { return {file_, line, column}; }
    SourcePlace here() const { return {file_, line_, int(column())}; }
    /// Keeps the line of this token at hand for lineText(): messages about a request come when the next one has been read.
    void mark(const Token& t) {
        markLine_ = t.line;
        markStart_ = t.lineStart;
    }
    /// The text of `line` when it is the current or the marked one and still buffered, at most 200 bytes of it.
    std::string lineText(const SourcePlace&) const;
    /// As given to the constructor.
    const std::string& file() const { return file_; }

    // For what reads ahead in the buffer (direct.h):
    Ahead ahead() const {
        const char* p = buffer_.data() + pos_;
        return {p, buffer_.data() + end_, p, line_, int(column())};
    }
    void advance(const Ahead& a) { ///< to a later place of what ahead() gave
        pos_ = size_t(a.p - buffer_.data());
        line_ = a.line;
        lineStart_ = base_ + pos_ + 1 - size_t(a.column());
    }
    /// The string that binary files have given a code; null: none.
    const std::string* stringOfCode(unsigned code) const {
        return code < stringCodes_.size() && stringCodes_[code] ? &*stringCodes_[code] : nullptr;
    }
    /// Whether a code stands for a request of the table.
    bool definesRequest(unsigned char code) const { return requests_[code] != nullptr; }

private:
    size_t column() const { return base_ + pos_ - lineStart_ + 1; }
    bool more(); ///< reads on; false at the end. Keeps bytes from pos_ on.
    bool at() { return pos_ < end_ || more(); }
    unsigned char peek() const { return static_cast<unsigned char>(buffer_[pos_]); }
    bool skipSpace(); ///< to the next token; false at the end
    void newline();   ///< the byte at pos_ is one: counts and passes it
    void comment();
    void plainNumbers(std::vector<double>& out);
    bool number(double& out); ///< false (reported) when malformed
    void identifier(std::string& out);
    /// Reads on to the quote that the string began with.
    void quoted(std::string& out, int line, int column);
    bool apostrophes(); ///< whether the apostrophe at pos_ has a second one in its line
    void escape(std::string& out);
    void badBytes();
    // binary.cpp
    bool binary(Token& out); ///< decodes at pos_; false when it made no token
    bool binaryPlain(Token& out);
    bool binaryFloats(Token& out, uint64_t n);
    void binaryNumbers(std::vector<double>& out); ///< those that follow directly and are all in the buffer
    bool byte(unsigned& out);
    bool bytes(size_t n, std::string& out);
    bool binaryString(std::string& out, const char* what);
    bool truncated(const char* what);

    std::unique_ptr<ByteSource> source_;
    std::string file_;
    Reporter& reporter_;
    Comments comments_;
    std::vector<char> buffer_;
    size_t pos_ = 0, end_ = 0;
    size_t base_ = 0;      ///< stream offset of buffer_[0]
    size_t lineStart_ = 0; ///< stream offset
    int line_ = 1;
    int markLine_ = 0;
    size_t markStart_ = 0;
    bool ended_ = false;
    std::array<std::string, 256> requestCodes_;
    std::array<const Request*, 256> requests_{}; ///< of these codes
    std::vector<std::optional<std::string>> stringCodes_;
};

} // namespace alpenglow::ri
