// Tokens to calls. A request ends where the next name begins, so after any error the reader is in step again at the next request.
#pragma once
#include "ri/call.h"
#include "ri/lexer.h"
#include <set>
#include <string>

namespace alpenglow::ri {

class Parser {
public:
    Parser(std::unique_ptr<ByteSource> source, std::string file, Reporter& reporter, Lexer::Comments comments = {});
    /// The next well-formed call; false at the end of the stream. Bad requests are reported and passed over.
    bool next(Call& out);
    SourcePlace here() const { return lexer_.here(); }
    std::string lineText(const SourcePlace& p) const { return lexer_.lineText(p); }
    /// Gets requests that are not in the table, as ReaderOptions::unknown.
    std::function<void(const std::string& name, const std::vector<Value>& values)> unknown;

private:
    struct Comment {
        std::string kind, text;
    };
    /// Those that were met behind the name of the last request.
    void passComments();
    void collect(std::vector<Value>& out);
    void array(Value& out);

    const Lexer::Comments comments_;
    std::vector<Comment> held_; ///< comments that the next call of next() passes on
    Lexer lexer_;
    Reporter& reporter_;
    Token token_;
    std::vector<Value> values_;     ///< of the request that is read
    bool pending_ = false;          ///< token_ was read ahead
    std::set<std::string> unknown_; ///< names that are no requests, reported
};

/// Fits values to the signature of call.request and fills arguments and params. False (reported) when they do not fit.
bool matchArguments(std::vector<Value>& values, Call& call, Reporter& reporter);

} // namespace alpenglow::ri
