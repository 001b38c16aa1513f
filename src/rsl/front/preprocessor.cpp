#include "rsl/front/preprocessor.h"
#include "base/limits.h"
#include "rsl/front/headers.h"
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <unordered_map>

namespace alpenglow::rsl::front {

namespace fs = std::filesystem;

std::optional<std::string> readSource(const std::string& path) {
    std::error_code ec;
    if (!fs::is_regular_file(path, ec) || fs::file_size(path, ec) > limits::kStringBytes || ec) return std::nullopt;
    std::ifstream in(path, std::ios::binary);
    if (!in) return std::nullopt;
    std::ostringstream s;
    s << in.rdbuf();
    return s.str();
}

std::string Preprocessed::text() const {
    std::string s;
    int line = 0, file = -1;
    for (const Token& t : tokens) {
        if (t.kind == Tok::End) break;
        if (!s.empty()) s += t.place.line != line || t.place.file != file ? '\n' : ' ';
        line = t.place.line;
        file = t.place.file;
        s += t.text;
    }
    for (const Annotation& a : annotations) s += "\n#pragma annotation \"" + a.key + "\" \"" + a.value + "\"";
    return s;
}

namespace {

struct Macro {
    std::string_view name;
    bool function = false, variadic = false;
    std::vector<std::string_view> parameters;
    std::vector<Token> body;
    int active = 0; ///< expansions of it that are being read
    int parameter(std::string_view n) const {
        for (size_t i = 0; i < parameters.size(); ++i)
            if (parameters[i] == n) return int(i);
        return -1;
    }
};
using MacroPtr = std::shared_ptr<Macro>;

/// Where tokens come from: a file, or the expansion of a macro.
struct Frame {
    std::unique_ptr<Lexer> lexer;
    size_t conditions = 0; ///< open #if when the file began
    std::vector<Token> list;
    size_t at = 0;
    MacroPtr macro;
    bool barrier = false; ///< reading stops here until the frame is taken away
};

class Preprocessor {
public:
    Preprocessor(SourceSet& s, const FrontOptions& o) : sources_(s), options_(o) {}

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
            sources_.warning(t.place, "_Pragma stands before a text in parentheses; it is ignored");
            for (int i = 0; i < given; ++i) {
                out_.tokens.push_back(parts[i]);
                if (parts[i].kind == Tok::End) return std::move(out_);
            }
        }
    }

private:
    struct If { bool taking, taken, sawElse; Place place; };

    void pushFile(int file) {
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
                sources_.error(ifs_.back().place, "this #if has no #endif");
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
                if (f.at < f.list.size()) { count(1); return f.list[f.at++]; }
                if (f.barrier) return {};
                pop();
                continue;
            }
            Token t = f.lexer->next();
            if (t.kind == Tok::End) { last_ = t.place; pop(); continue; }
            if (t.lineStart && t.is("#")) { directive(t.place); continue; }
            if (skipping()) continue;
            count(1);
            return t;
        }
        return {};
    }
    void count(size_t n) {
        produced_ += n;
        if (produced_ <= limits::kMacroTokens || stopped_) return;
        sources_.error(last_, "macros expand to more than " + std::to_string(limits::kMacroTokens) + " tokens");
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
            if (m->active) { t.noExpand = true; return t; }
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
                sources_.error(call.place, "the call of macro '" + std::string(m.name) + "' has no closing ')'");
                sources_.cut = true;
                return false;
            }
            if (t.is(")") && depth-- == 0) break;
            if (t.is("(")) ++depth;
            const bool last = m.variadic && arguments.size() == m.parameters.size();
            if (t.is(",") && depth == 0 && !last) { arguments.emplace_back(); continue; }
            if (t.lineStart) { t.lineStart = false; t.space = true; }
            arguments.back().push_back(t);
        }
        if (m.parameters.empty() && arguments.size() == 1 && arguments[0].empty()) arguments.clear();
        if (m.variadic && arguments.size() + 1 == m.parameters.size()) arguments.emplace_back();
        if (arguments.size() != m.parameters.size()) {
            sources_.error(call.place, "macro '" + std::string(m.name) + "' takes " + std::to_string(m.parameters.size()) +
                                           " arguments, not " + std::to_string(arguments.size()));
            // One mistake, one message: with the last argument in place of those missing the expansion is most likely well formed.
            const std::vector<Token> filler = arguments.empty() ? std::vector<Token>{} : arguments.back();
            arguments.resize(m.parameters.size(), filler);
        }
        return true;
    }

    std::vector<Token> expanded(const std::vector<Token>& list) {
        if (depth_ >= limits::kMacroDepth) {
            sources_.error(last_, "macro calls are nested more than " + std::to_string(limits::kMacroDepth) + " deep");
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
                    else { for (const Token& a : arguments[r]) put(a); ++i; }
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
            sources_.error(call.place, "'" + text.substr(0, 60) + "', pasted by ##, is not one token");
            out.back().kind = Tok::Invalid; // the parser passes over it without a word
            out.back().text = {};
            return;
        }
        joined.place = call.place;
        joined.lineStart = false;
        out.back() = joined;
    }

    std::vector<Token> restOfLine() {
        std::vector<Token> line;
        Lexer& lexer = *frames_.back().lexer;
        while (!lexer.peek().lineStart) line.push_back(lexer.next());
        return line;
    }
    static std::string spelled(const std::vector<Token>& line, size_t from) {
        std::string s;
        for (size_t i = from; i < line.size(); ++i) {
            if (i > from && line[i].space) s += ' ';
            s += line[i].text;
        }
        return s;
    }

    void directive(Place hash) {
        std::vector<Token> line = restOfLine();
        if (line.empty()) return;
        const std::string_view name = line[0].text;
        if (name == "ifdef" || name == "ifndef") {
            const bool known = line.size() > 1 && macros_.count(line[1].text);
            if (line.size() < 2 && !skipping()) sources_.error(hash, "#" + std::string(name) + " needs a name");
            open(hash, known == (name == "ifdef"));
        } else if (name == "if") {
            open(hash, skipping() ? false : condition(line, hash));
        } else if (name == "elif" || name == "else" || name == "endif") {
            if (ifs_.size() <= frames_.back().conditions) {
                sources_.error(hash, "#" + std::string(name) + " without #if");
                return;
            }
            If& f = ifs_.back();
            if (name == "endif") { ifs_.pop_back(); return; }
            if (f.sawElse) { sources_.error(hash, "#" + std::string(name) + " after #else"); return; }
            const bool outer = ifs_.size() < 2 || ifs_[ifs_.size() - 2].taking;
            f.sawElse = name == "else";
            f.taking = outer && !f.taken && (name == "else" || condition(line, hash));
            f.taken |= f.taking;
        } else if (skipping()) {
        } else if (name == "define") {
            define(line, hash);
        } else if (name == "undef") {
            if (line.size() > 1) macros_.erase(line[1].text);
        } else if (name == "include") {
            include(line, hash);
        } else if (name == "pragma") {
            pragma(line);
        } else if (name == "line" || line[0].kind == Tok::Number) {
            lineDirective(line, hash);
        } else if (name == "error") {
            sources_.error(hash, "#error " + spelled(line, 1));
        } else if (name == "warning") {
            sources_.warning(hash, "#warning " + spelled(line, 1));
        } else if (name != "ident" && name != "sccs") {
            sources_.warning(line[0].place, "unknown directive '#" + std::string(name) + "' is ignored");
        }
    }
    /// #pragma annotation "key" "value"; other pragmas mean nothing to us.
    void pragma(const std::vector<Token>& line) {
        if (line.size() > 3 && line[1].is("annotation") && line[2].kind == Tok::String && line[3].kind == Tok::String)
            out_.annotations.push_back({out_.tokens.size(), stringValue(line[2].text), stringValue(line[3].text)});
    }
    void open(Place at, bool value) {
        const bool outer = !skipping();
        ifs_.push_back({outer && value, outer && value, false, at});
    }
    bool condition(std::vector<Token> line, Place hash) {
        std::vector<Token> list;
        for (size_t i = 1; i < line.size(); ++i) {
            Token t = line[i];
            if (t.is("defined")) {
                const bool paren = i + 1 < line.size() && line[i + 1].is("(");
                const size_t at = i + (paren ? 2 : 1);
                if (at < line.size()) {
                    t.text = macros_.count(line[at].text) ? "1" : "0";
                    t.kind = Tok::Number;
                    i = paren && at + 1 < line.size() && line[at + 1].is(")") ? at + 1 : at;
                }
            }
            list.push_back(t);
        }
        return conditionValue(expanded(list), hash, sources_);
    }

    void define(const std::vector<Token>& line, Place hash) {
        if (line.size() < 2 || line[1].kind != Tok::Identifier) { sources_.error(hash, "#define needs a name"); return; }
        auto m = std::make_shared<Macro>();
        m->name = line[1].text;
        size_t i = 2;
        if (i < line.size() && line[i].is("(") && !line[i].space) {
            m->function = true;
            for (++i; i < line.size() && !line[i].is(")"); ++i) {
                if (line[i].is(",")) continue;
                if (line[i].is("...")) { m->variadic = true; m->parameters.push_back("__VA_ARGS__"); }
                else if (line[i].kind == Tok::Identifier) m->parameters.push_back(line[i].text);
                else sources_.error(line[i].place, "a macro parameter is a name, not '" + std::string(line[i].text) + "'");
            }
            if (i == line.size()) { sources_.error(hash, "the parameters of this macro have no ')'"); return; }
            ++i;
        }
        m->body.assign(line.begin() + long(i), line.end());
        const auto old = macros_.find(m->name);
        if (old != macros_.end() && spelled(old->second->body, 0) != spelled(m->body, 0))
            sources_.warning(line[1].place, "macro '" + std::string(m->name) + "' is defined again with another meaning");
        macros_[m->name] = m;
    }

    void include(std::vector<Token> line, Place hash) {
        if (line.size() > 1 && line[1].kind == Tok::Identifier)
            line = expanded({line.begin() + 1, line.end()}), line.insert(line.begin(), Token{});
        std::string name;
        if (line.size() > 1 && line[1].kind == Tok::String) {
            name = std::string(line[1].text.substr(1, line[1].text.size() - 2)); // no escapes: paths of another system
        } else if (line.size() > 2 && line[1].is("<")) {
            name = spelled(line, 2);
            name = name.substr(0, name.find('>'));
        }
        if (name.empty()) { sources_.error(hash, "#include needs \"file\" or <file>"); out_.incomplete = true; return; }
        if (files_ > limits::kIncludeDepth) {
            sources_.error(hash, "includes are nested more than " + std::to_string(limits::kIncludeDepth) + " deep");
            out_.incomplete = true;
            return;
        }
        std::vector<std::string> folders = {fs::path(sources_.name(frames_.back().lexer->file())).parent_path().string()};
        folders.insert(folders.end(), options_.includePaths.begin(), options_.includePaths.end());
        const std::string slashed = withSlashes(name);
        for (const std::string& wanted : {name, slashed})
            if (includeFrom(folders, wanted)) return;
        const Place place = line[1].place.line ? line[1].place : hash;
        // A path of another machine: the file's own name along the search path, then among the headers of our own.
        const std::string base = slashed.substr(slashed.find_last_of('/') + 1);
        if (base != slashed && includeFrom(folders, base)) {
            sources_.warning(place, "'" + name + "' was not found; '" + out_.dependencies.back() + "' is used");
            return;
        }
        if (const ShippedHeader* own = shippedHeader(base)) {
            pushFile(sources_.add("<" + std::string(own->name) + ">", std::string(own->text)));
            return;
        }
        out_.incomplete = true;
        out_.missing.push_back({place, name});
    }
    bool includeFrom(const std::vector<std::string>& folders, const std::string& wanted) {
        for (const auto& folder : folders) {
            const std::string path = (fs::path(folder) / wanted).string();
            if (auto text = readSource(path)) {
                out_.dependencies.push_back(path);
                pushFile(sources_.add(path, std::move(*text)));
                return true;
            }
        }
        return false;
    }
    static std::string withSlashes(std::string s) {
        for (char& c : s)
            if (c == '\\') c = '/';
        return s;
    }
    void lineDirective(const std::vector<Token>& line, Place hash) {
        const size_t i = line[0].kind == Tok::Number ? 0 : 1;
        if (i >= line.size() || line[i].kind != Tok::Number || line[i].text.size() > 8) {
            sources_.error(hash, "#line needs a number");
            return;
        }
        Lexer& lexer = *frames_.back().lexer;
        const int real = hash.line - delta_[lexer.file()];
        const int delta = std::atoi(std::string(line[i].text).c_str()) - (real + 1);
        const bool named = i + 1 < line.size() && line[i + 1].kind == Tok::String;
        const std::string name = named ? stringValue(line[i + 1].text) : sources_.name(hash.file);
        delta_[lexer.file()] = delta;
        lexer.relocate(sources_.addView(lexer.file(), name, delta), delta);
    }

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
};

} // namespace

Preprocessed preprocess(SourceSet& s, int main, const FrontOptions& o) { return Preprocessor(s, o).run(main); }

} // namespace alpenglow::rsl::front
