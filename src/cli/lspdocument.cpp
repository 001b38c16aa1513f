#include "cli/lspdocument.h"
#include "rsl/front/complete.h"
#include "rsl/front/inspect.h"
#include "rsl/front/structures.h"
#include "rsl/front/visit.h"
#include "rsl/nonlinear.h"
#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <set>
#include <tuple>

namespace alpenglow::cli {

namespace {

bool isMainFile(const rsl::Program& p, const rsl::Place& at) {
    return at.file >= 0 && size_t(at.file) < p.files.size() && p.files[size_t(at.file)] == p.files[0];
}

/// Calls f(position, where) for every byte of the text, where saying what it belongs to, until f returns false.
template <class F> void scan(const std::string& text, size_t end, F&& f) {
    using Where = Document::Where;
    Where where = Where::Code;
    bool block = false;
    for (size_t i = 0; i < end && i < text.size(); ++i) {
        const char c = text[i], next = i + 1 < text.size() ? text[i + 1] : '\0';
        if (where == Where::Code) {
            if (c == '/' && (next == '/' || next == '*')) {
                where = Where::Comment;
                block = next == '*';
                if (!f(i, where)) return;
                ++i;
                if (i < end && !f(i, where)) return;
                continue;
            }
            if (!f(i, where)) return;
            if (c == '"') where = Where::String;
        } else if (where == Where::String) {
            if (c == '"' || c == '\n') where = Where::Code;
            if (!f(i, c == '"' ? Where::Code : where)) return;
            if (c == '\\' && next != '\n' && i + 1 < end) {
                ++i;
                if (!f(i, where)) return;
            }
        } else {
            if (!block && c == '\n') where = Where::Code;
            if (!f(i, where)) return;
            if (block && c == '*' && next == '/' && i + 1 < end) {
                ++i;
                if (!f(i, where)) return;
                where = Where::Code;
            }
        }
    }
}

} // namespace

void Document::set(std::string text) {
    text_ = std::move(text);
    starts_.assign(1, 0);
    for (size_t i = 0; i < text_.size(); ++i)
        if (text_[i] == '\n') starts_.push_back(i + 1);
    stale_ = true;
}

void Document::replace(size_t begin, size_t end, const std::string& by) {
    begin = std::min(begin, text_.size());
    end = std::clamp(end, begin, text_.size());
    std::string t = std::move(text_);
    t.replace(begin, end - begin, by);
    set(std::move(t));
}

void Document::analyse(const rsl::FrontOptions& options) {
    if (!stale_) return;
    stale_ = false;
    if (rib_) return analyseScene();
    Diagnostics d;
    rsl::FrontOptions o = options;
    o.lint = true;
    std::shared_ptr<const rsl::Program> lowered = rsl::inspectText(text_, path_, o, d);
    // Of what compiles: where the path tracer would have to wait for light.
    for (const auto& s : lowered->shaders) {
        if (d.errors() > 0 || s->kind != rsl::ShaderKind::Surface || !isMainFile(*lowered, s->place)) continue;
        for (Diagnostic& warning : rsl::nonlinearUses(*lowered, *s, {})) {
            const size_t n = size_t(std::max(warning.place.line, 1)) - 1;
            warning.sourceLine = warning.place.file == path_ ? std::string(line(n)) : "";
            rsl::complete(warning);
            d.report(std::move(warning));
        }
    }
    diagnostics_ = d.all();
    // While a shader is being typed there are moments in which nothing can be read of it: the last reading serves then.
    const auto program = lowered->written ? lowered->written : lowered;
    const bool empty = program->shaders.empty() && program->functions.empty();
    if (!empty || !program_ || diagnostics_.empty()) program_ = program;
}

std::string normalPath(const std::string& path) {
    std::error_code failed; // without a working folder the path stays as it is
    const std::filesystem::path whole = std::filesystem::absolute(path, failed);
    return (failed ? std::filesystem::path(path) : whole).lexically_normal().string();
}

bool Document::includes(const std::string& path) const {
    const std::string wanted = normalPath(path);
    if (program_)
        for (const std::string& f : program_->dependencies)
            if (normalPath(f) == wanted) return true;
    // It may have been missing until now.
    return !rib_ && text_.find(std::filesystem::path(path).filename().string()) != std::string::npos;
}

std::string_view Document::line(size_t n) const {
    if (n >= starts_.size()) return {};
    const size_t begin = starts_[n];
    size_t end = n + 1 < starts_.size() ? starts_[n + 1] : text_.size();
    while (end > begin && (text_[end - 1] == '\n' || text_[end - 1] == '\r')) --end;
    return std::string_view(text_).substr(begin, end - begin);
}

size_t Document::offset(size_t n, size_t column) const {
    if (n >= starts_.size()) return text_.size();
    return starts_[n] + std::min(column, line(n).size());
}

size_t Document::lineOf(size_t position) const {
    return size_t(std::upper_bound(starts_.begin(), starts_.end(), position) - starts_.begin()) - 1;
}

std::optional<std::pair<size_t, size_t>> Document::wordAt(size_t position) const {
    size_t begin = std::min(position, text_.size()), end = begin;
    while (begin > 0 && isWord(text_[begin - 1])) --begin;
    while (end < text_.size() && isWord(text_[end])) ++end;
    if (begin == end || std::isdigit(static_cast<unsigned char>(text_[begin]))) return std::nullopt;
    return std::make_pair(begin, end);
}

Document::Where Document::where(size_t position) const {
    // What the byte before belongs to, unless it ends it.
    Where result = Where::Code;
    bool open = false;
    scan(text_, position, [&](size_t i, Where w) {
        if (w == Where::Code && text_[i] == '"') open = !open;
        if (w == Where::Code && text_[i] == '\n') open = false;
        result = w;
        return true;
    });
    if (result == Where::Code && open && position > 0 && text_[position - 1] == '"') return Where::String;
    if (result == Where::Comment && position >= 2 && text_.compare(position - 2, 2, "*/") == 0) return Where::Code;
    return result;
}

std::optional<CallAround> Document::callAround(size_t position) const {
    struct Open {
        size_t at;
        size_t separators;
        char kind;
    };
    std::vector<Open> open;
    scan(text_, position, [&](size_t i, Where w) {
        if (w != Where::Code) return true;
        const char c = text_[i];
        if (c == '(' || c == '{' || c == '[') open.push_back({i, 0, c});
        else if ((c == ')' || c == '}' || c == ']') && !open.empty()) open.pop_back();
        else if ((c == ',' || c == ';') && !open.empty()) ++open.back().separators;
        return true;
    });
    for (size_t k = open.size(); k-- > 0;) {
        if (open[k].kind == '{') return std::nullopt;
        if (open[k].kind != '(') continue;
        size_t end = open[k].at;
        while (end > 0 && (text_[end - 1] == ' ' || text_[end - 1] == '\t')) --end;
        size_t begin = end;
        while (begin > 0 && isWord(text_[begin - 1])) --begin;
        if (begin == end || std::isdigit(static_cast<unsigned char>(text_[begin]))) continue; // a parenthesis or a triple
        return CallAround{text_.substr(begin, end - begin), begin, open[k].separators};
    }
    return std::nullopt;
}

size_t Document::endOfDefinition(size_t name) const {
    int depth = 0;
    size_t end = std::min(name, text_.size());
    scan(text_, text_.size(), [&](size_t i, Where w) {
        if (i < name || w != Where::Code) return true;
        if (text_[i] == '{') ++depth;
        if (text_[i] != '}') return true;
        --depth;
        end = i + 1;
        return depth > 0;
    });
    return end;
}

std::string Document::commentAbove(const std::string& text, size_t line) {
    std::vector<std::string> lines;
    for (size_t at = 0; at <= text.size() && lines.size() < line;) {
        const size_t end = std::min(text.find('\n', at), text.size());
        lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    const auto trimmed = [](const std::string& s) {
        const size_t a = s.find_first_not_of(" \t\r"), b = s.find_last_not_of(" \t\r");
        return a == std::string::npos ? std::string() : s.substr(a, b - a + 1);
    };
    std::vector<std::string> found;
    bool block = false;
    for (size_t k = lines.size(); k-- > 0 && found.size() < 40;) {
        std::string s = trimmed(lines[k]);
        if (!block && s.rfind("//", 0) == 0) {
            found.push_back(trimmed(s.substr(std::min(s.find_first_not_of('/'), s.size()))));
            continue;
        }
        if (!block && (s.size() < 2 || s.compare(s.size() - 2, 2, "*/") != 0)) break;
        if (!block) s.erase(s.size() - 2);
        block = true;
        const size_t begin = s.find("/*");
        if (begin != std::string::npos) s.erase(0, begin + 2), block = false;
        s = trimmed(s);
        while (!s.empty() && s[0] == '*') s = trimmed(s.substr(1));
        while (!s.empty() && s.back() == '*') s = trimmed(s.substr(0, s.size() - 1));
        found.push_back(s);
        if (!block) break;
    }
    std::string t;
    for (size_t k = found.size(); k-- > 0;)
        if (!found[k].empty() || !t.empty()) t += (t.empty() ? "" : "\n") + found[k];
    return t;
}

Origin Document::origin(const rsl::Place& p) const {
    if (!program_ || p.file < 0 || size_t(p.file) >= program_->files.size() || p.line < 1) return {};
    const std::string& f = program_->files[size_t(p.file)];
    if (f.empty() || f[0] == '<') return {};
    return {f, p.line, std::max(1, p.column)};
}

bool Document::isHere(const rsl::Place& p) const { return origin(p).file == path_ && !path_.empty(); }

template <class F> void Document::eachUse(F&& f) const {
    if (!program_) return;
    const auto note = [&](const rsl::Place& p, const std::string& name, const Use& use) {
        if (isHere(p)) f(p.line, p.column, name, use);
    };
    const auto symbol = [&](const rsl::Symbol* s) {
        Use use;
        use.symbol = s;
        note(s->place, s->name, use);
    };
    const auto expression = [&](const rsl::Expr& e) {
        Use use;
        if (e.kind == rsl::ExprKind::Variable && e.symbol) {
            use.symbol = e.symbol;
            note(e.place, e.symbol->name, use);
        }
        if (e.kind != rsl::ExprKind::ShadeopCall && e.kind != rsl::ExprKind::FunctionCall) return;
        if (e.function && !e.shadeop) use.function = e.function;
        if (e.shadeop) use.shadeop = e.shadeop, use.signature = e.signature;
        note(e.place, e.text, use);
    };
    const auto statement = [&](const rsl::Stmt& s) {
        for (const auto& d : s.declarators)
            if (d.symbol) symbol(d.symbol);
    };
    for (const auto& s : program_->shaders) {
        Use use;
        use.shader = s.get();
        note(s->place, s->name, use);
        for (const auto& p : s->parameters) {
            symbol(p.symbol);
            if (p.defaultValue) rsl::front::everyExpr(*p.defaultValue, expression);
        }
        if (s->body) rsl::front::everyStmt(*s->body, statement, expression);
    }
    rsl::front::everyFunction(*program_, [&](const rsl::Function& g) {
        Use use;
        use.function = &g;
        note(g.place, g.name, use);
        for (const rsl::Symbol* p : g.parameters) symbol(p);
        if (g.body && isHere(g.body->place)) rsl::front::everyStmt(*g.body, statement, expression);
    });
}

Document::Use Document::useAt(size_t word) const {
    Use use;
    const auto end = wordAt(word);
    if (!program_ || !end) return use;
    const std::string name = text_.substr(word, end->second - word);
    const size_t n = lineOf(word);
    const int line = int(n) + 1, column = int(word - startOf(n)) + 1;
    eachUse([&](int l, int c, const std::string& of, const Use& u) {
        // A function's own name may be "class->name".
        if (l != line || c != column || (of != name && !u.function && !u.shader)) return;
        if (u.symbol) use.symbol = u.symbol;
        if (u.function) use.function = u.function;
        if (u.shader) use.shader = u.shader;
        if (u.shadeop) use.shadeop = u.shadeop, use.signature = u.signature;
    });
    return use;
}

std::map<size_t, Document::Use> Document::uses() const {
    std::map<size_t, Use> all;
    eachUse([&](int line, int column, const std::string& of, const Use& u) {
        const size_t at = offset(size_t(line) - 1, size_t(std::max(column, 1)) - 1);
        const auto word = wordAt(at);
        if (word && word->first == at && (u.function || u.shader || text_.compare(at, word->second - at, of) == 0)) all[at] = u;
    });
    return all;
}

std::optional<std::pair<size_t, size_t>> Document::macro(const std::string& name) const {
    for (size_t n = 0; n < lines(); ++n) {
        const std::string_view l = line(n);
        size_t i = l.find_first_not_of(" \t");
        if (i == std::string_view::npos || l[i] != '#') continue;
        i = l.find_first_not_of(" \t", i + 1);
        if (i == std::string_view::npos || l.substr(i, 6) != "define") continue;
        i = l.find_first_not_of(" \t", i + 6);
        if (i == std::string_view::npos || l.substr(i, name.size()) != name) continue;
        const char after = i + name.size() < l.size() ? l[i + name.size()] : ' ';
        if (!std::isalnum(static_cast<unsigned char>(after)) && after != '_') return std::make_pair(n, i);
    }
    return std::nullopt;
}

std::vector<Document::Word> Document::words() const {
    std::vector<Word> list;
    bool directive = false, blank = true;
    scan(text_, text_.size(), [&](size_t i, Where w) {
        const char c = text_[i];
        if (c == '\n') {
            directive = directive && i > 0 && text_[i - 1] == '\\'; // it goes on
            blank = true;
        } else if (w == Where::Code) {
            if (blank && c == '#') directive = true;
            if (c != ' ' && c != '\t' && c != '\r') blank = false;
            if (!isWord(c)) return true;
            if (!list.empty() && list.back().end == i) ++list.back().end;
            else list.push_back({i, i + 1, directive});
        }
        return true;
    });
    std::erase_if(
        list, [&](const Word& w) { return std::isdigit(static_cast<unsigned char>(text_[w.begin])) || text_[w.begin] == '"'; });
    return list;
}

Document::Around Document::around(size_t position) const {
    Around a;
    if (!program_) return a;
    size_t best = 0;
    bool any = false;
    const auto consider = [&](const rsl::Place& p, const rsl::Shader* s, const rsl::Function* f) {
        if (!isHere(p)) return;
        const size_t at = offset(size_t(p.line) - 1, size_t(p.column) - 1);
        if (at > position || (any && at < best) || endOfDefinition(at) < position) return;
        any = true;
        best = at;
        if (s) a.shader = s, a.function = nullptr;
        if (f) a.function = f;
    };
    for (const auto& s : program_->shaders) {
        consider(s->place, s.get(), nullptr);
        for (const auto& n : s->nested)
            rsl::front::everyFunction(*n, [&](const rsl::Function& f) { consider(f.place, nullptr, &f); });
    }
    for (const auto& g : program_->functions)
        rsl::front::everyFunction(*g, [&](const rsl::Function& f) {
            if (isHere(f.place) && offset(size_t(f.place.line) - 1, size_t(f.place.column) - 1) > best) {
                const rsl::Function* before = a.function;
                consider(f.place, nullptr, &f);
                if (a.function != before && g.get() == &f) a.shader = nullptr; // it stands outside of shaders
            }
        });
    return a;
}

std::vector<const rsl::Function*> Document::functions() const {
    std::vector<const rsl::Function*> list;
    std::set<std::array<int, 3>> seen;
    if (!program_) return list;
    rsl::front::everyFunction(*program_, [&](const rsl::Function& f) {
        if (origin(f.place).file.empty()) return;
        // A function is there once for each shader that calls it.
        if (seen.insert({f.place.file, f.place.line, f.place.column}).second) list.push_back(&f);
    });
    std::sort(list.begin(), list.end(), [](const rsl::Function* a, const rsl::Function* b) {
        return std::tie(a->place.file, a->place.line, a->place.column) < std::tie(b->place.file, b->place.line, b->place.column);
    });
    return list;
}

std::vector<const rsl::Function*> Document::functions(const std::string& name) const {
    auto list = functions();
    std::erase_if(list, [&](const rsl::Function* f) { return f->name != name; });
    return list;
}

namespace {

/// "float", "S": the type of an element, as it is written. Handles are of type shader.
std::string typeOf(const rsl::Symbol& s, const rsl::Program& program) {
    return rsl::front::Structures(program.structs).text(s.type.element());
}

std::string brackets(const rsl::Symbol& s) {
    if (s.type.array < 0 || s.open || s.resizable) return "[]";
    return s.type.array > 0 ? "[" + std::to_string(s.type.array) + "]" : "";
}

} // namespace

std::string declarationOf(const rsl::Symbol& s, const rsl::Program& program) {
    std::string t = s.output ? "output " : "";
    if (s.isConstant) t += "constant ";
    else if (s.storage != rsl::Storage::Unspecified) t += s.storage == rsl::Storage::Uniform ? "uniform " : "varying ";
    return t + typeOf(s, program) + " " + s.name + brackets(s);
}

std::string signatureOf(const rsl::Function& f, const rsl::Program& program) {
    std::string list;
    for (const rsl::Symbol* p : f.parameters)
        if (p->name != "this") // what a method is called for
            list += (list.empty() ? "" : "; ") + std::string(p->output ? "output " : "") + typeOf(*p, program) + " " + p->name +
                    brackets(*p);
    return rsl::front::Structures(program.structs).text(f.result) + " " + f.name + "(" + list + ")";
}

} // namespace alpenglow::cli
