// The lines that begin with #.
#include "base/file.h"
#include "base/folder.h"
#include "base/limits.h"
#include "base/realpath.h"
#include "rsl/front/preprocessor_machine.h"
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

namespace alpenglow::rsl::front {

namespace fs = std::filesystem;

std::vector<Token> Preprocessor::restOfLine() {
    std::vector<Token> line;
    Lexer& lexer = *frames_.back().lexer;
    while (!lexer.peek().lineStart) line.push_back(lexer.next());
    return line;
}

std::string Preprocessor::spelled(const std::vector<Token>& line, size_t from) {
    std::string s;
    for (size_t i = from; i < line.size(); ++i) {
        if (i > from && line[i].space) s += ' ';
        s += line[i].text;
    }
    return s;
}

void Preprocessor::directive(Place hash) {
    std::vector<Token> line = restOfLine();
    if (line.empty()) return;
    const std::string_view name = line[0].text;
    if (name == "ifdef" || name == "ifndef") {
        const bool known = line.size() > 1 && macros_.count(line[1].text);
        if (line.size() < 2 && !skipping()) sources_.report(hash, msg::kNeedsName(name));
        open(hash, known == (name == "ifdef"));
    } else if (name == "if") {
        open(hash, skipping() ? false : condition(line, hash));
    } else if (name == "elif" || name == "else" || name == "endif") {
        if (ifs_.size() <= frames_.back().conditions) {
            sources_.report(hash, msg::kStrayDirective(name));
            return;
        }
        If& f = ifs_.back();
        if (name == "endif") {
            ifs_.pop_back();
            return;
        }
        if (f.sawElse) {
            sources_.report(hash, msg::kAfterElse(name));
            return;
        }
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
        sources_.report(hash, msg::kErrorDirective(spelled(line, 1)));
    } else if (name == "warning") {
        sources_.report(hash, msg::kWarningDirective(spelled(line, 1)));
    } else if (name != "ident" && name != "sccs") {
        sources_.report(line[0].place, msg::kUnknownDirective(name));
    }
}

void Preprocessor::pragma(const std::vector<Token>& line) {
    if (line.size() < 2 || !line[1].is("annotation")) return;
    const auto isText = [&](size_t i) { return line[i].kind == Tok::String; };
    if (line.size() < 4 || !(isText(2) || line[2].kind == Tok::Identifier)) {
        sources_.report(line[1].place, msg::kAnnotationPair);
        return;
    }
    bool texts = true; // a key without quotes is common
    std::string value;
    for (size_t i = 3; i < line.size(); ++i) {
        texts &= isText(i);
        if (isText(i)) value += stringValue(line[i].text); // adjacent texts are one
    }
    if (!texts && !isText(3)) value = spelled(line, 3);
    if (!texts) sources_.report(line[3].place, msg::kAnnotationQuotes);
    out_.annotations.push_back({isText(2) ? stringValue(line[2].text) : std::string(line[2].text), value, out_.tokens.size()});
}

void Preprocessor::open(Place at, bool value) {
    const bool outer = !skipping();
    ifs_.push_back({outer && value, outer && value, false, at});
}

bool Preprocessor::condition(std::vector<Token> line, Place hash) {
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

void Preprocessor::define(const std::vector<Token>& line, Place hash) {
    if (line.size() < 2 || line[1].kind != Tok::Identifier) {
        sources_.report(hash, msg::kNeedsName("define"));
        return;
    }
    auto m = std::make_shared<Macro>();
    m->name = line[1].text;
    size_t i = 2;
    if (i < line.size() && line[i].is("(") && !line[i].space) {
        m->function = true;
        for (++i; i < line.size() && !line[i].is(")"); ++i) {
            if (line[i].is(",")) continue;
            if (line[i].is("...")) {
                m->variadic = true;
                m->parameters.push_back("__VA_ARGS__");
            } else if (line[i].kind == Tok::Identifier) m->parameters.push_back(line[i].text);
            else sources_.report(line[i].place, msg::kMacroParameter(line[i].text));
        }
        if (i == line.size()) {
            sources_.report(hash, msg::kMacroParameters);
            return;
        }
        ++i;
    }
    m->body.assign(line.begin() + long(i), line.end());
    const auto old = macros_.find(m->name);
    if (old != macros_.end() && spelled(old->second->body, 0) != spelled(m->body, 0))
        sources_.report(line[1].place, msg::kMacroRedefined(m->name));
    macros_[m->name] = m;
}

void Preprocessor::include(std::vector<Token> line, Place hash) {
    if (line.size() > 1 && line[1].kind == Tok::Identifier)
        line = expanded({line.begin() + 1, line.end()}), line.insert(line.begin(), Token{});
    std::string name;
    if (line.size() > 1 && line[1].kind == Tok::String) {
        name = std::string(line[1].text.substr(1, line[1].text.size() - 2)); // no escapes: paths of another system
    } else if (line.size() > 2 && line[1].is("<")) {
        name = spelled(line, 2);
        name = name.substr(0, name.find('>'));
    }
    if (name.empty()) {
        sources_.report(hash, msg::kIncludeSyntax);
        out_.incomplete = true;
        return;
    }
    if (files_ > limits::kIncludeDepth) {
        if (!nestedTooDeep_) sources_.report(hash, msg::kIncludeDepth(limits::kIncludeDepth));
        nestedTooDeep_ = out_.incomplete = true; // reported once: a file that includes itself twice gets here thousands of times
        return;
    }
    if (++includes_ > limits::kIncludes || read_ > limits::kSourceBytes) {
        if (!stopped_)
            sources_.report(hash, includes_ > limits::kIncludes ? msg::kTooManyIncludes(limits::kIncludes)
                                                                : msg::kIncludeBytes(limits::kSourceBytes));
        stopped_ = out_.incomplete = true;
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
        sources_.report(place, msg::kIncludeElsewhere(name, out_.dependencies.back()));
        return;
    }
    // The file system ignores case and found it.
    if (!shippedHeader(base) && includeAnyCase(folders, slashed)) {
        sources_.report(place, msg::kIncludeElsewhere(name, out_.dependencies.back()),
                        "did you mean \"" + slashed.substr(0, slashed.size() - base.size()) +
                            fs::path(out_.dependencies.back()).filename().string() + "\"?");
        return;
    }
    const bool standard = slashed.find("stdrsl/") != slashed.npos; // PRMan's own, whose names are those of others
    const ShippedHeader* own = standard ? shippedHeader("stdrsl_" + base) : nullptr;
    if (!own) own = shippedHeader(base);
    if (own) {
        pushFile(sources_.add("<" + std::string(own->name) + ">", std::string(own->text)));
        return;
    }
    out_.incomplete = true;
    if (!refused_.empty()) {
        sources_.report(place, msg::kIncludeRefused(refused_));
        refused_.clear();
        return;
    }
    out_.missing.push_back({place, name});
}

/// Whether a name says that its file is meant to be included. Others are read only below the folder of the shader: words of what
/// is no RSL would stand in the messages about it.
static bool namedAsHeader(const fs::path& path) {
    std::string e = path.extension().string();
    for (char& c : e) c = char(std::tolower(static_cast<unsigned char>(c)));
    constexpr const char* kKnown[] = {".h", ".sl", ".inc", ".hsl", ".slh", ".rsl", ".rslh", ".hh", ".hpp", ".def"};
    return std::find(std::begin(kKnown), std::end(kKnown), e) != std::end(kKnown);
}

bool Preprocessor::includeFrom(const std::vector<std::string>& folders, const std::string& wanted) {
    const bool climbs = fs::path(wanted).is_absolute() || wanted.find("..") != wanted.npos;
    for (const auto& folder : folders) {
        const std::string path = (fs::path(folder) / wanted).string();
        std::error_code e;
        const bool there = fs::is_regular_file(path, e);
        const bool elsewhere = climbs || &folder != &folders.front() || (there && !liesBelow(path, {folder}));
        if (elsewhere && !namedAsHeader(there ? followedPath(path) : path)) {
            if (there) refused_ = path;
            continue;
        }
        std::optional<std::string> text = options_.openText ? options_.openText(path) : std::nullopt;
        if (!text) text = readSource(path);
        if (text) {
            out_.dependencies.push_back(path);
            pushFile(sources_.add(path, std::move(*text)));
            return true;
        }
    }
    return false;
}

/// As includeFrom(), whatever the case of the letters of the file's own name. Of several the first in alphabetical order.
bool Preprocessor::includeAnyCase(const std::vector<std::string>& folders, const std::string& wanted) {
    const auto lower = [](std::string s) {
        for (char& c : s) c = char(std::tolower(static_cast<unsigned char>(c)));
        return s;
    };
    const fs::path path(wanted);
    const std::string name = lower(path.filename().string());
    for (const auto& folder : folders) {
        std::string found;
        const fs::path in = fs::path(folder.empty() ? "." : folder) / path.parent_path();
        for (const std::string& own : namesIn(in.string(), limits::kFolderEntries))
            if (lower(own) == name && (found.empty() || own < found)) found = own;
        if (!found.empty() && includeFrom({folder}, (path.parent_path() / found).string())) return true;
    }
    return false;
}

std::string Preprocessor::withSlashes(std::string s) {
    for (char& c : s)
        if (c == '\\') c = '/';
    return s;
}

void Preprocessor::lineDirective(const std::vector<Token>& line, Place hash) {
    const size_t i = line[0].kind == Tok::Number ? 0 : 1;
    if (i >= line.size() || line[i].kind != Tok::Number || line[i].text.size() > 8) {
        sources_.report(hash, msg::kLineNumber);
        return;
    }
    Lexer& lexer = *frames_.back().lexer;
    const int real = hash.line - delta_[lexer.file()];
    const int delta = std::max(1, std::atoi(std::string(line[i].text).c_str())) - (real + 1); // lines count from 1
    const bool named = i + 1 < line.size() && line[i + 1].kind == Tok::String;
    const std::string name = named ? stringValue(line[i + 1].text) : sources_.name(hash.file);
    delta_[lexer.file()] = delta;
    lexer.relocate(sources_.addView(lexer.file(), name, delta), delta);
}

} // namespace alpenglow::rsl::front
