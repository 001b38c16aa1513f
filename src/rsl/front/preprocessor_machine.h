// Inside the preprocessor: where tokens come from, the macros, and the directives (preprocessor_directives.cpp).
#pragma once
#include "base/limits.h"
#include "rsl/front/headers.h"
#include "rsl/front/preprocessor.h"
#include <functional>
#include <memory>
#include <unordered_map>

namespace alpenglow::rsl::front {

/// A macro that is defined.
struct Macro {
    std::string_view name;                    ///< its text lives as long as the SourceSet
    bool function = false, variadic = false;  ///< it has brackets; its last parameter is "..."
    std::vector<std::string_view> parameters; ///< names
    std::vector<Token> body;                  ///< tokens that replace it
    int active = 0;                           ///< expansions of it that are being read
    /// Index of a parameter; -1: there is none of that name.
    int parameter(std::string_view n) const {
        for (size_t i = 0; i < parameters.size(); ++i)
            if (parameters[i] == n) return int(i);
        return -1;
    }
};
using MacroPtr = std::shared_ptr<Macro>; ///< shared with expansions that outlast #undef

/// Where tokens come from: a file, or the expansion of a macro.
struct Frame {
    std::unique_ptr<Lexer> lexer; ///< of a file; null: an expansion
    size_t conditions = 0;        ///< open #if when the file began
    std::vector<Token> list;      ///< of an expansion
    size_t at = 0;                ///< next token of `list`
    MacroPtr macro;
    bool barrier = false; ///< reading stops here until the frame is taken away
};

/// Runs over one main text and what it includes; used once.
class Preprocessor {
public:
    /// Both outlive this.
    Preprocessor(SourceSet& s, const FrontOptions& o) : sources_(s), options_(o) {}

    /// main: a file of the SourceSet.
    Preprocessed run(int main) {
        pushFile(main);
        std::string predefined = "#define ALPENGLOW 1\n";
        for (std::string_view macro : dialectMacros(options_.dialect)) predefined += "#define " + std::string(macro) + "\n";
        predefined += dialectPrelude(options_.dialect);
        for (auto [name, value] : options_.defines) {
            for (char& c : value)
                if (c == '\n' || c == '\r') c = ' ';
            predefined += "#define " + name + " " + value + "\n";
        }
        pushFile(sources_.add("<options>", predefined));
        for (;;) {
            Token t = next();
            if (t.kind == Tok::End) {
                t.place = last_;
                out_.tokens.push_back(t);
                return std::move(out_);
            }
            last_ = t.place;
            if (!(t.kind == Tok::Identifier && t.is("_Pragma"))) {
                out_.tokens.push_back(t);
                continue;
            }
            // _Pragma("text"), mostly from a macro, is what #pragma text is.
            Token parts[3];
            int given = 0;
            while (given < 3 && (given == 0 || parts[given - 1].kind != Tok::End)) parts[given++] = next();
            if (given == 3 && parts[0].is("(") && parts[1].kind == Tok::String && parts[2].is(")")) {
                std::vector<Token> line{t};
                Lexer lexer(sources_, t.place.file, sources_.keep(stringValue(parts[1].text)));
                while (lexer.peek().kind != Tok::End && line.size() < 4) line.push_back(lexer.next());
                pragma(line);
                continue;
            }
            sources_.report(t.place, msg::kPragmaOperator);
            for (int i = 0; i < given; ++i) {
                out_.tokens.push_back(parts[i]);
                if (parts[i].kind == Tok::End) return std::move(out_);
            }
        }
    }

private:
    struct If {
        bool taking, taken, sawElse;
        Place place;
    };

    void pushFile(int file) {
        read_ += sources_.text(file).size();
        Frame f;
        f.lexer = std::make_unique<Lexer>(sources_, file);
        f.conditions = ifs_.size();
        frames_.push_back(std::move(f));
        ++files_;
    }
    void pushList(std::vector<Token> list, MacroPtr macro, bool barrier = false) {
        Frame f;
        f.list = std::move(list);
        f.macro = std::move(macro);
        f.barrier = barrier;
        if (f.macro) ++f.macro->active;
        frames_.push_back(std::move(f));
    }
    void pop() {
        Frame& f = frames_.back();
        if (f.macro) --f.macro->active;
        if (f.lexer) {
            --files_;
            while (ifs_.size() > f.conditions) {
                sources_.report(ifs_.back().place, msg::kUnfinishedIf,
                                ifs_.back().taking ? "it ends with its file" : "the rest of its file is skipped");
                ifs_.pop_back();
            }
        }
        frames_.pop_back();
    }
    bool skipping() const { return !ifs_.empty() && !ifs_.back().taking; }

    /// The next token before expansion; End at the end of everything or at a barrier.
    Token read() {
        while (!frames_.empty() && !stopped_) {
            Frame& f = frames_.back();
            if (!f.lexer) {
                if (f.at < f.list.size()) {
                    count(1);
                    return f.list[f.at++];
                }
                if (f.barrier) return {};
                pop();
                continue;
            }
            Token t = f.lexer->next();
            if (t.kind == Tok::End) {
                last_ = t.place;
                pop();
                continue;
            }
            if (t.lineStart && t.is("#")) {
                directive(t.place);
                continue;
            }
            if (skipping()) continue;
            count(1);
            return t;
        }
        return {};
    }
    void count(size_t n) {
        produced_ += n;
        if (produced_ <= limits::kMacroTokens || stopped_) return;
        sources_.report(last_, msg::kTooManyTokens(limits::kMacroTokens));
        stopped_ = true;
        out_.incomplete = true;
        sources_.cut = true;
    }
    bool nextIsOpen() {
        while (!frames_.empty()) {
            Frame& f = frames_.back();
            if (f.lexer) return f.lexer->peek().is("(");
            if (f.at < f.list.size()) return f.list[f.at].is("(");
            if (f.barrier) return false;
            pop();
        }
        return false;
    }

    /// The next token after expansion.
    Token next() {
        for (;;) {
            Token t = read();
            if (t.kind != Tok::Identifier || t.noExpand) return t;
            if (t.text == "__LINE__" || t.text == "__FILE__") {
                const bool line = t.text == "__LINE__";
                t.kind = line ? Tok::Number : Tok::String;
                t.text = sources_.keep(line ? std::to_string(t.place.line) : quote(sources_.name(t.place.file)));
                return t;
            }
            const auto found = macros_.find(t.text);
            if (found == macros_.end()) return t;
            const MacroPtr m = found->second;
            if (m->active) {
                t.noExpand = true;
                return t;
            }
            std::vector<std::vector<Token>> arguments;
            if (m->function && (!nextIsOpen() || !gather(*m, t, arguments))) return t;
            auto list = substitute(*m, arguments, t);
            pushList(std::move(list), m);
        }
    }

    static std::string quote(std::string_view s) {
        std::string q = "\"";
        for (char c : s) {
            if (c == '"' || c == '\\') q += '\\';
            q += c;
        }
        return q + "\"";
    }

    bool gather(const Macro& m, const Token& call, std::vector<std::vector<Token>>& arguments) {
        read(); // the '('
        arguments.emplace_back();
        for (int depth = 0;;) {
            Token t = read();
            if (t.kind == Tok::End) {
                sources_.report(call.place, msg::kMacroCall(m.name));
                sources_.cut = true;
                return false;
            }
            if (t.is(")") && depth-- == 0) break;
            if (t.is("(")) ++depth;
            const bool last = m.variadic && arguments.size() == m.parameters.size();
            if (t.is(",") && depth == 0 && !last) {
                arguments.emplace_back();
                continue;
            }
            if (t.lineStart) {
                t.lineStart = false;
                t.space = true;
            }
            arguments.back().push_back(t);
        }
        if (m.parameters.empty() && arguments.size() == 1 && arguments[0].empty()) arguments.clear();
        if (m.variadic && arguments.size() + 1 == m.parameters.size()) arguments.emplace_back();
        if (arguments.size() != m.parameters.size()) {
            sources_.report(call.place, msg::kMacroArguments(m.name, m.parameters.size(), arguments.size()));
            // One mistake, one message: with the last argument in place of those missing the expansion is most likely well
            // formed.
            const std::vector<Token> filler = arguments.empty() ? std::vector<Token>{} : arguments.back();
            arguments.resize(m.parameters.size(), filler);
        }
        return true;
    }

    std::vector<Token> expanded(const std::vector<Token>& list) {
        if (depth_ >= limits::kMacroDepth) {
            sources_.report(last_, msg::kMacroDepth(limits::kMacroDepth));
            stopped_ = true;
            sources_.cut = true;
            return {};
        }
        ++depth_;
        const size_t level = frames_.size();
        pushList(list, nullptr, true);
        std::vector<Token> out;
        for (;;) {
            Token t = next();
            if (t.kind == Tok::End) break;
            out.push_back(t);
        }
        while (frames_.size() > level) pop();
        --depth_;
        return out;
    }

    std::vector<Token> substitute(const Macro& m, const std::vector<std::vector<Token>>& arguments, const Token& call) {
        std::vector<Token> out;
        std::vector<std::optional<std::vector<Token>>> ready(arguments.size());
        const auto put = [&](Token t) {
            t.place = call.place;
            t.lineStart = false;
            out.push_back(t);
        };
        for (size_t i = 0; i < m.body.size() && !stopped_; ++i) {
            const Token& t = m.body[i];
            const int p = t.kind == Tok::Identifier ? m.parameter(t.text) : -1;
            if (m.function && t.is("#") && i + 1 < m.body.size() && m.parameter(m.body[i + 1].text) >= 0) {
                std::string s;
                for (const Token& a : arguments[m.parameter(m.body[++i].text)]) {
                    if (a.space && !s.empty()) s += ' ';
                    s += a.text;
                }
                Token q = t;
                q.kind = Tok::String;
                q.text = sources_.keep(quote(s));
                count(1 + s.size() / 64);
                put(q);
            } else if (t.is("##") && !out.empty() && i + 1 < m.body.size()) {
                const Token& right = m.body[++i];
                const int r = right.kind == Tok::Identifier ? m.parameter(right.text) : -1;
                const std::vector<Token> tail = r >= 0 ? arguments[r] : std::vector<Token>{right};
                for (size_t k = 0; k < tail.size(); ++k)
                    if (k == 0) paste(out, tail[0], call);
                    else put(tail[k]);
            } else if (p >= 0) {
                const bool pasted = i + 1 < m.body.size() && m.body[i + 1].is("##");
                if (!pasted && !ready[p]) ready[p] = expanded(arguments[p]);
                const std::vector<Token>& list = pasted ? arguments[p] : *ready[p];
                count(list.size());
                for (size_t k = 0; k < list.size(); ++k) {
                    Token a = list[k];
                    if (k == 0) a.space = t.space;
                    put(a);
                }
                // ## after an empty argument pastes nothing.
                if (pasted && list.empty() && i + 2 < m.body.size()) {
                    ++i;
                    const int r = m.parameter(m.body[i + 1].text);
                    if (r < 0) put(m.body[++i]);
                    else {
                        for (const Token& a : arguments[r]) put(a);
                        ++i;
                    }
                }
            } else put(t);
        }
        return out;
    }
    void paste(std::vector<Token>& out, const Token& right, const Token& call) {
        const std::string text = std::string(out.back().text) + std::string(right.text);
        count(1 + text.size() / 64);
        Lexer lexer(sources_, call.place.file, sources_.keep(text));
        Token joined = lexer.next();
        if (joined.kind == Tok::Invalid || lexer.peek().kind != Tok::End) {
            sources_.report(call.place, msg::kPaste(text.substr(0, 60)));
            out.back().kind = Tok::Invalid; // the parser passes over it without a word
            out.back().text = {};
            return;
        }
        joined.place = call.place;
        joined.lineStart = false;
        out.back() = joined;
    }

    std::vector<Token> restOfLine();
    static std::string spelled(const std::vector<Token>& line, size_t from);

    void directive(Place hash);
    /// #pragma annotation "key" "value"; other pragmas mean nothing to us.
    void pragma(const std::vector<Token>& line);
    void open(Place at, bool value);
    bool condition(std::vector<Token> line, Place hash);

    void define(const std::vector<Token>& line, Place hash);

    void include(std::vector<Token> line, Place hash);
    bool includeFrom(const std::vector<std::string>& folders, const std::string& wanted);
    bool includeAnyCase(const std::vector<std::string>& folders, const std::string& wanted);
    static std::string withSlashes(std::string s);
    void lineDirective(const std::vector<Token>& line, Place hash);

    std::string refused_; ///< a file that is there and may not be included
    SourceSet& sources_;
    const FrontOptions& options_;
    Preprocessed out_;
    std::vector<Frame> frames_;
    std::vector<If> ifs_;
    std::unordered_map<std::string_view, MacroPtr> macros_;
    std::unordered_map<int, int> delta_;
    Place last_;
    size_t produced_ = 0;
    int files_ = 0, depth_ = 0;
    bool stopped_ = false;
    bool nestedTooDeep_ = false; ///< the limit of nested includes was reported
    int includes_ = 0;           ///< #include lines that were followed
    size_t read_ = 0;            ///< bytes of files so far
};

} // namespace alpenglow::rsl::front
