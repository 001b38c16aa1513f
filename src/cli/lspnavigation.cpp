// Where else a name is: references, highlights, and names changed in all texts.
#include "base/limits.h"
#include "cli/languageserver.h"
#include "rsl/front/preprocessor.h"
#include "shadeops/descriptor.h"
#include <algorithm>
#include <cctype>
#include <set>

namespace alpenglow::cli {

using Json = nlohmann::json;

namespace {

/// What a name means, so that two places can be compared: where it is declared, or that it is everyone's.
struct Meaning {
    enum class Kind { Unknown, Declared, Predefined, Shadeop, Macro };
    Kind kind = Kind::Unknown;
    std::string name, file;
    int line = 0, column = 0;
    bool operator==(const Meaning&) const = default;
};

Meaning declared(const std::string& name, const Origin& o) {
    if (o.file.empty()) return {};
    return {Meaning::Kind::Declared, name, normalPath(o.file), o.line, o.column};
}

/// What the word means as this text was read. `uses`: Document::uses().
Meaning meaningAt(const Document& d, const Document::Word& w, const std::map<size_t, Document::Use>& uses) {
    const std::string name = d.text().substr(w.begin, w.end - w.begin);
    if (const auto m = d.macro(name); m && w.directive && d.offset(m->first, m->second) == w.begin)
        return {Meaning::Kind::Macro, name, normalPath(d.path()), int(m->first) + 1, int(m->second) + 1};
    if (w.directive) return {};
    if (const auto r = d.receiver(w.begin)) {
        for (const auto& m : d.members(*r, w.begin))
            if (m.name == name) return declared(name, d.origin(m.place));
        if (r->arrow) return {};
    }
    const auto at = uses.find(w.begin);
    const Document::Use use = at != uses.end() ? at->second : d.named(w.begin);
    if (use.symbol) {
        if (use.symbol->origin == rsl::Symbol::Origin::Global) return {Meaning::Kind::Predefined, name, "", 0, 0};
        return declared(name, d.origin(use.symbol->place));
    }
    if (use.function) return declared(name, d.origin(use.function->place));
    if (use.shader) return declared(name, d.origin(use.shader->place));
    if (use.shadeop) return {Meaning::Kind::Shadeop, name, "", 0, 0};
    if (const auto* s = d.structure(name)) return declared(name, d.origin(s->place));
    if (d.program())
        for (const auto& s : d.program()->structs) { // a member where the structure is declared
            const auto here = [&](const auto& m) {
                return m.name == name && d.isHere(m.place) &&
                       d.offset(size_t(m.place.line) - 1, size_t(m.place.column) - 1) == w.begin;
            };
            for (const auto& m : s.members)
                if (here(m)) return declared(name, d.origin(m.place));
            for (const auto& m : s.methods)
                if (here(m)) return declared(name, d.origin(m.place));
        }
    if (const auto list = d.functions(name); !list.empty()) return declared(name, d.origin(list[0]->place));
    if (const auto m = d.macro(name))
        return {Meaning::Kind::Macro, name, normalPath(d.path()), int(m->first) + 1, int(m->second) + 1};
    if (shadeops::findShadeop(name)) return {Meaning::Kind::Shadeop, name, "", 0, 0};
    return {};
}

struct Found {
    size_t begin, end;
    bool declaration, written;
};

/// Is the name the target of an assignment? By the operator behind it and behind its index.
bool assigned(const std::string& text, size_t end) {
    const auto blank = [&](size_t i) { return i < text.size() && (text[i] == ' ' || text[i] == '\t'); };
    while (blank(end)) ++end;
    if (end < text.size() && text[end] == '[') {
        for (int depth = 0; end < text.size() && text[end] != '\n';) {
            depth += text[end] == '[';
            depth -= text[end] == ']';
            ++end;
            if (depth == 0) break;
        }
        while (blank(end)) ++end;
    }
    if (end < text.size() && std::string_view("+-*/").find(text[end]) != std::string_view::npos) ++end;
    return end + 1 < text.size() && text[end] == '=' && text[end + 1] != '=';
}

/// The places of a meaning in a text. Macros are compared by name: another file may define them.
std::vector<Found> placesOf(const Document& d, const Meaning& m) {
    std::vector<Found> list;
    const auto uses = d.uses();
    for (const Document::Word& w : d.words()) {
        if (d.text().compare(w.begin, w.end - w.begin, m.name) != 0 || w.end - w.begin != m.name.size()) continue;
        if (m.kind == Meaning::Kind::Macro) {
            list.push_back({w.begin, w.end, w.directive, false});
            continue;
        }
        if (!(meaningAt(d, w, uses) == m)) continue;
        const bool here = m.kind == Meaning::Kind::Declared && normalPath(d.path()) == m.file &&
                          d.offset(size_t(m.line) - 1, size_t(m.column) - 1) == w.begin;
        list.push_back({w.begin, w.end, here, here || assigned(d.text(), w.end)});
    }
    return list;
}

/// The word at a place of the code and what it means.
std::optional<std::pair<Document::Word, Meaning>> asked(const Document& d, size_t at) {
    const auto word = d.wordAt(at);
    if (!word) return std::nullopt;
    for (const Document::Word& w : d.words()) {
        if (w.begin != word->first) continue;
        Meaning m = meaningAt(d, w, d.uses());
        if (m.kind == Meaning::Kind::Unknown) return std::nullopt;
        return std::make_pair(w, std::move(m));
    }
    return std::nullopt;
}

bool isName(const std::string& s) {
    return !s.empty() && !std::isdigit(static_cast<unsigned char>(s[0])) &&
           std::all_of(s.begin(), s.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

} // namespace

void LanguageServer::eachRelated(Document& start, const std::function<void(const std::string& uri, const Document&)>& f) {
    std::set<std::string> seen;
    std::vector<std::string> files;
    const auto take = [&](const std::string& uri, Document& d) {
        d.analyse(optionsFor(d));
        if (!seen.insert(normalPath(d.path())).second) return;
        f(uri, d);
        if (d.program())
            for (const std::string& file : d.program()->dependencies) files.push_back(file);
    };
    for (auto& [uri, d] : documents_)
        if (&d == &start) take(uri, d);
    for (auto& [uri, d] : documents_)
        if (!d.rib()) take(uri, d);
    for (size_t i = 0; i < files.size() && seen.size() < limits::kServerDocuments; ++i) {
        if (files[i].empty() || files[i][0] == '<' || seen.count(normalPath(files[i]))) continue;
        Document d(normalPath(files[i]), textOf(files[i]));
        take(uriOf(d.path()), d);
    }
}

Json LanguageServer::references(const Json& params) {
    Document* d = document(params);
    const auto p = params.find("position");
    if (!d || p == params.end()) return nullptr;
    const auto what = asked(*d, position(*d, *p));
    if (!what) return nullptr;
    const auto context = params.find("context");
    const bool declarations = context == params.end() || !context->is_object() || context->value("includeDeclaration", true);
    Json list = Json::array();
    eachRelated(*d, [&](const std::string& uri, const Document& in) {
        for (const Found& f : placesOf(in, what->second))
            if (declarations || !f.declaration) list.push_back({{"uri", uri}, {"range", range(in, f.begin, f.end)}});
    });
    return list;
}

Json LanguageServer::highlights(const Json& params) {
    Document* d = document(params);
    const auto p = params.find("position");
    if (!d || p == params.end()) return nullptr;
    const auto what = asked(*d, position(*d, *p));
    if (!what) return nullptr;
    constexpr int kRead = 2, kWrite = 3;
    Json list = Json::array();
    for (const Found& f : placesOf(*d, what->second))
        list.push_back({{"range", range(*d, f.begin, f.end)}, {"kind", f.written ? kWrite : kRead}});
    return list;
}

Json LanguageServer::prepareRename(const Json& params) {
    Document* d = document(params);
    const auto p = params.find("position");
    if (!d || p == params.end()) return nullptr;
    const auto what = asked(*d, position(*d, *p));
    if (!what) return nullptr;
    if (what->second.kind == Meaning::Kind::Predefined || what->second.kind == Meaning::Kind::Shadeop)
        throw Refused{"\"" + what->second.name + "\" belongs to the language and keeps its name"};
    return {{"range", range(*d, what->first.begin, what->first.end)}, {"placeholder", what->second.name}};
}

Json LanguageServer::rename(const Json& params) {
    Document* d = document(params);
    const auto p = params.find("position"), n = params.find("newName");
    if (!d || p == params.end() || n == params.end() || !n->is_string()) return nullptr;
    if (prepareRename(params).is_null()) throw Refused{"there is no name here"};
    const auto what = asked(*d, position(*d, *p));
    const std::string to = n->get<std::string>();
    if (!isName(to)) throw Refused{"\"" + to + "\" is no name: letters, digits and _, and no digit first"};
    const auto& keywords = languageKeywords();
    if (std::find(keywords.begin(), keywords.end(), to) != keywords.end() || shadeops::findShadeop(to) || isPredefined(to))
        throw Refused{"\"" + to + "\" belongs to the language; choose another name"};
    Json changes = Json::object();
    eachRelated(*d, [&](const std::string& uri, const Document& in) {
        const auto places = placesOf(in, what->second);
        if (places.empty()) return;
        std::set<std::pair<const void*, const void*>> around; // definitions with the name
        for (const Found& f : places) {
            const Document::Around a = in.around(f.begin);
            around.insert({a.shader, a.function});
        }
        for (const Document::Word& w : in.words()) {
            const std::string_view word = std::string_view(in.text()).substr(w.begin, w.end - w.begin);
            const std::string line = in.path() + ":" + std::to_string(in.lineOf(w.begin) + 1);
            const Document::Around a = in.around(w.begin);
            const bool meet =
                (!a.shader && !a.function) || around.count({nullptr, nullptr}) || around.count({a.shader, a.function});
            if (word == to && meet && !in.receiver(w.begin)) throw Refused{"\"" + to + "\" is used already, at " + line};
            // What a macro makes of the name cannot be followed.
            if (w.directive && word == what->second.name && what->second.kind != Meaning::Kind::Macro)
                throw Refused{"the macro at " + line + " uses \"" + what->second.name + "\"; change both by hand"};
        }
        Json edits = Json::array();
        for (const Found& f : places) edits.push_back({{"range", range(in, f.begin, f.end)}, {"newText", to}});
        changes[uri] = std::move(edits);
    });
    return {{"changes", std::move(changes)}};
}

} // namespace alpenglow::cli
