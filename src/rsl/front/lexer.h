// Characters to tokens, before macros. Comments and joined lines vanish here; every token knows where it stood.
#pragma once
#include "rsl/front/source.h"

namespace alpenglow::rsl::front {

/// Kinds of tokens.
enum class Tok : uint8_t {
    End,
    Identifier,
    Number, ///< as written, possibly followed by letters, which make it invalid
    String, ///< with its quotes and escapes
    Punct,
    Invalid ///< a character that starts nothing, or a string without end; an error only if it reaches the parser
};

/// A token; its text lives as long as the SourceSet.
struct Token {
    Tok kind = Tok::End;    ///< what it is
    bool lineStart = false; ///< first on its line
    bool space = false;     ///< white space before it
    bool noExpand = false;  ///< a macro's name inside its own expansion
    Place place;            ///< of its first byte
    std::string_view text;
    /// Whether it is this word or sign; never true for numbers and strings.
    bool is(std::string_view s) const { return text == s && (kind == Tok::Punct || kind == Tok::Identifier); }
};

/// Reads one text from its beginning to its end.
class Lexer {
public:
    /// file: of the SourceSet.
    Lexer(SourceSet&, int file);
    /// Over another text, which must stay alive; places name `file`.
    Lexer(SourceSet&, int file, std::string_view text);
    /// The next token; Tok::End at the end, again and again.
    Token next();
    /// The next token, which next() then returns; valid until next().
    const Token& peek();
    /// Index of the file in the SourceSet.
    int file() const { return file_; }
    /// Later places count `line` for the line after the current one, under file index `file` (#line).
    void relocate(int file, int delta) {
        placeFile_ = file;
        if (peeked_) ahead_.place = {file, ahead_.place.line - delta_ + delta, ahead_.place.column};
        delta_ = delta;
    }
    /// The line of the next token.
    int line() const { return line_; }

private:
    Token scan();
    void takeWhile(bool (*accept)(int byte));
    void joinLine(size_t next);
    void scanNumber();
    bool scanString();
    Tok scanPunct();
    std::string joinedText(size_t begin) const;
    bool joined(size_t& i) const;
    int at(size_t i) const { return i < text_.size() ? static_cast<unsigned char>(text_[i]) : -1; }
    void skipBlank(Token&);
    SourceSet& sources_;
    std::string_view text_;
    int file_, placeFile_;
    int delta_ = 0;
    size_t pos_ = 0, lineBegin_ = 0;
    int line_ = 1;
    bool lineStart_ = true;
    bool broken_ = false; ///< there is a joined line inside the token
    bool peeked_ = false;
    Token ahead_;
};

/// The characters of a string token: quotes removed, \n \t \r \\ \" and octal escapes replaced.
std::string stringValue(std::string_view token);

} // namespace alpenglow::rsl::front
