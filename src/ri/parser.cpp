#include "ri/parser.h"
#include "base/limits.h"
#include "ri/requests/request.h"

namespace alpenglow::ri {

namespace {

constexpr size_t kSpare = 64;          // values whose room is used again
constexpr size_t kSpareNumbers = 4096; // of one of them

template <class T> void empty(std::vector<T>& v) {
    if (v.capacity() > kSpareNumbers) v = {};
    else v.clear();
}

} // namespace

Parser::Parser(std::unique_ptr<ByteSource> source, std::string file, Reporter& reporter, Lexer::Comments comments)
    : comments_(std::move(comments)),
      lexer_(std::move(source), std::move(file), reporter,
             comments_ ? [this](const std::string& kind, const std::string& text) { held_.push_back({kind, text}); }
                       : Lexer::Comments()),
      reporter_(reporter) {}

void Parser::passComments() {
    for (const Comment& c : held_) comments_(c.kind, c.text);
    held_.clear();
}

Value Parser::fresh() {
    if (spare_.empty()) return {};
    Value v = std::move(spare_.back());
    spare_.pop_back();
    return v;
}

void Parser::keep(Value&& v) {
    if (spare_.size() >= kSpare) return;
    v.kind = Value::Kind::Empty;
    v.array = false;
    empty(v.numbers);
    empty(v.strings);
    spare_.push_back(std::move(v));
}

void Parser::takeBack(Call& call) {
    for (Value& v : values_) keep(std::move(v));
    values_.clear();
    for (RawParam& p : call.params) keep(std::move(p.value));
    call.params.clear();
    for (Argument& a : call.arguments) {
        a.given = false;
        empty(a.numbers);
        empty(a.strings);
    }
}

/// After '['. Without a ']' the array ends before the first token that it cannot hold (docs/design/ri.md).
void Parser::array(Value& v) {
    v.array = true;
    for (;;) {
        if (v.kind != Value::Kind::Strings) {
            lexer_.numbers(v.numbers);
            if (!v.numbers.empty()) v.kind = Value::Kind::Numbers;
        }
        lexer_.next(token_);
        switch (token_.kind) {
        case Token::Kind::Close:
            return;
        case Token::Kind::Number:
            if (v.kind == Value::Kind::Strings) break;
            v.kind = Value::Kind::Numbers;
            v.numbers.push_back(token_.number);
            continue;
        case Token::Kind::String:
            if (v.kind == Value::Kind::Numbers) break;
            v.kind = Value::Kind::Strings;
            v.strings.push_back(std::move(token_.text));
            continue;
        default:
            break;
        }
        pending_ = true;
        reporter_.warning(Rie::Syntax, lexer_.place(v.line, v.column), "this array has no closing ']'",
                          "it ends before line " + std::to_string(token_.line) + " column " + std::to_string(token_.column));
        return;
    }
}

/// All values up to the next name.
void Parser::collect(std::vector<Value>& out) {
    for (;;) {
        if (!pending_) lexer_.next(token_);
        pending_ = false;
        if (token_.kind == Token::Kind::End || token_.kind == Token::Kind::Identifier) {
            pending_ = true;
            return;
        }
        Value v = fresh();
        v.line = token_.line;
        v.column = token_.column;
        switch (token_.kind) {
        case Token::Kind::End:
        case Token::Kind::Identifier:
            break; // seen above
        case Token::Kind::Close:
            reporter_.warning(Rie::Syntax, lexer_.place(token_.line, token_.column), "']' without '['");
            continue;
        case Token::Kind::Number: { // what follows one that was no number belongs to the same run
            const bool run = !out.empty() && out.back().kind == Value::Kind::Numbers && !out.back().array;
            if (!run) {
                v.kind = Value::Kind::Numbers;
                out.push_back(std::move(v));
            }
            out.back().numbers.push_back(token_.number);
            lexer_.numbers(out.back().numbers);
            continue;
        }
        case Token::Kind::String:
            v.kind = Value::Kind::Strings;
            v.strings.push_back(std::move(token_.text));
            break;
        case Token::Kind::Floats:
            v.array = true;
            v.kind = token_.floats.empty() ? Value::Kind::Empty : Value::Kind::Numbers;
            v.numbers.swap(token_.floats);
            break;
        case Token::Kind::Open:
            array(v);
            break;
        }
        out.push_back(std::move(v));
    }
}

bool Parser::next(Call& call) {
    for (;;) {
        if (!pending_) lexer_.next(token_);
        passComments();
        pending_ = false;
        if (token_.kind == Token::Kind::End) {
            pending_ = true;
            return false;
        }
        call.place.file = lexer_.file(); // the caller's call keeps its memory
        call.place.line = token_.line;
        call.place.column = token_.column;
        lexer_.mark(token_);
        if (token_.kind != Token::Kind::Identifier) {
            reporter_.error(Rie::Syntax, call.place, "a request is expected here");
            pending_ = true;
            takeBack(call);
            collect(values_);
            continue;
        }
        call.request = token_.request ? token_.request : findRequest(token_.text);
        if (!call.request) {
            std::string shown = token_.text.substr(0, 60);
            std::string near = nearestName(shown, requestNames());
            if (unknown_.size() >= size_t(limits::kUnknownNames) || unknown_.insert(shown).second) // each name once
                reporter_.error(Rie::BadToken, call.place, "unknown request '" + shown + "'",
                                near.empty() ? "" : "did you mean " + near + "?");
            const std::string name = std::move(token_.text);
            takeBack(call);
            collect(values_);
            if (unknown) unknown(name, values_);
            continue;
        }
        // Without arguments it is done at once: a pipe's WorldEnd renders before the next request is written.
        if (call.request->args.empty() && !call.request->parameters) {
            direct_.resize(call, 0, 0);
            return true;
        }
        if (direct_.read(lexer_, call)) return true;
        takeBack(call);
        collect(values_);
        if (matchArguments(values_, call, reporter_)) return true;
    }
}

} // namespace alpenglow::ri
