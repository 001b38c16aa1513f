// Tokens to calls. A request ends where the next name begins, so after any error the reader is in step again at the next request.
#pragma once
#include "ri/call.h"
#include "ri/lexer.h"
#include <set>
#include <string>

namespace alpenglow::ri {

/// Reads calls from a stream of RIB, ASCII or binary. Errors are reported with their place.
class Parser {
public:
    /// `file`: name for messages. The reporter must outlive the parser.
    Parser(std::unique_ptr<ByteSource> source, std::string file, Reporter& reporter, Lexer::Comments comments = {});
    /// The next well-formed call; false at the end of the stream. Bad requests are reported and passed over.
    bool next(Call& out);
    /// The place of the next token, and the text of a line that is still in memory ("" otherwise).
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
    /// An empty one, with room that another one had.
    Value fresh();
    /// Takes what the last request held.
    void keep(Value&& v);
    void takeBack(Call& call);

    DirectReader direct_;
    std::vector<Value> values_;     ///< of the request that is read
    std::vector<Value> spare_;      ///< of those before
    bool pending_ = false;          ///< token_ was read ahead
    std::set<std::string> unknown_; ///< names that are no requests, reported
};

/// Fits values to the signature of call.request and fills arguments and params. False (reported) when they do not fit.
bool matchArguments(std::vector<Value>& values, Call& call, Reporter& reporter);

} // namespace alpenglow::ri
