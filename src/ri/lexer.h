// RIB bytes to tokens: ASCII and binary, freely mixed (RISpec 3.2, appendix C.2).
#pragma once
#include "ri/reporter.h"
#include "ri/source.h"
#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace alpenglow::ri {

struct Token {
    enum class Kind { End, Identifier, Number, String, Open, Close, Floats /* a whole binary array */ };
    Kind kind = Kind::End;
    double number = 0;
    std::string text;           ///< identifier or string
    std::vector<double> floats; ///< Kind::Floats
    int line = 0, column = 0;   ///< of its first byte, from 1
    size_t lineStart = 0;       ///< stream offset of that line
};

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
    SourcePlace place(int line, int column) const { return {file_, line, column}; }
    SourcePlace here() const { return {file_, line_, int(column())}; }
    /// Keeps the line of this token at hand for lineText(): messages about a request come when the next one has been read.
    void mark(const Token& t) {
        markLine_ = t.line;
        markStart_ = t.lineStart;
    }
    /// The text of `line` when it is the current or the marked one and still buffered, at most 200 bytes of it.
    std::string lineText(const SourcePlace&) const;
    const std::string& file() const { return file_; }

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
    bool binaryFloats(Token& out, uint64_t n);
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
    std::unordered_map<unsigned, std::string> stringCodes_;
};

} // namespace alpenglow::ri
