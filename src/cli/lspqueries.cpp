// What the language server is asked about a place: completion, hover, definition, symbols, signatures.
#include "cli/languageserver.h"
#include "cli/manual.h"
#include "rsl/front/inspect.h"
#include "shadeops/descriptor.h"
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <utility>

namespace fs = std::filesystem;

namespace alpenglow::cli {

using Json = nlohmann::json;

namespace {

enum CompletionKind { kMethod = 2, kFunction = 3, kField = 5, kVariable = 6, kProperty = 10, kKeyword = 14, kConstant = 21 };
enum SymbolKind { kClass = 5, kProperty2 = 7, kFunctionSymbol = 12 };

Json markdown(std::string text) { return {{"kind", "markdown"}, {"value", std::move(text)}}; }
std::string fenced(const std::string& code) { return "```rsl\n" + code + "\n```\n"; }

bool begins(const std::string& name, const std::string& prefix) {
    if (name.size() < prefix.size()) return false;
    return std::equal(prefix.begin(), prefix.end(), name.begin(),
                      [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
}

const rsl::GlobalVariable* globalNamed(const std::string& name, std::optional<rsl::ShaderKind> kind) {
    for (int k = 0; k < 6; ++k) {
        if (kind && int(*kind) != k) continue;
        for (const auto& g : rsl::globalVariables(rsl::ShaderKind(k)))
            if (name == g.name) return &g;
    }
    return nullptr;
}

std::string globalText(const rsl::GlobalVariable& g) {
    return std::string(g.uniform ? "uniform " : "varying ") + shadeops::toString(g.type) + " " + g.name;
}

std::string parameterText(const rsl::ShaderParameter& p, const rsl::Program& program) {
    return declarationOf(*p.symbol, program) + (p.defaultText.empty() ? "" : " = " + p.defaultText);
}

std::string shaderText(const rsl::Shader& s, const rsl::Program& program) {
    std::string t = std::string(toString(s.kind)) + " " + s.name + "(";
    for (size_t i = 0; i < s.parameters.size(); ++i) t += (i ? ";\n    " : "\n    ") + parameterText(s.parameters[i], program);
    return t + ")";
}

/// A parameter of a shader with its default, any other variable by its declaration. It is one of the document's program.
std::string variableText(const Document& d, const rsl::Symbol& v) {
    if (v.origin == rsl::Symbol::Origin::ShaderParameter)
        for (const auto& s : d.program()->shaders)
            for (const auto& p : s->parameters)
                if (p.symbol == &v) return parameterText(p, *d.program());
    return declarationOf(v, *d.program());
}

/// What stands here: as the compiler read it, or by its name where it read nothing.
Document::Use useOf(const Document& d, size_t word) {
    const Document::Use u = d.useAt(word);
    return u.symbol || u.function || u.shader || u.shadeop ? u : d.named(word);
}

std::optional<Document::Member> memberNamed(const Document& d, const Document::Receiver& r, size_t word,
                                            const std::string& name) {
    for (auto& m : d.members(r, word))
        if (m.name == name && d.origin(m.place).line > 0) return m;
    return std::nullopt;
}

std::string structText(const rsl::StructType& type, const rsl::Program& program) {
    const rsl::StructSummary s = rsl::summary(type, program);
    std::string t = "struct " + s.name + " {\n";
    for (const auto& m : s.members) t += "    " + m.type + " " + m.name + ";\n";
    for (const auto& m : s.methods) t += "    " + m.name + "()\n";
    return t + "}";
}

/// Parameters of "float f(point p, q; output color c)": the parts between the parentheses.
std::vector<std::pair<size_t, size_t>> parameterRanges(const std::string& signature) {
    std::vector<std::pair<size_t, size_t>> list;
    size_t begin = signature.find('(');
    if (begin == std::string::npos) return list;
    ++begin;
    for (size_t i = begin; i < signature.size(); ++i) {
        const char c = signature[i];
        if (c != ',' && c != ';' && c != ')') continue;
        size_t a = begin, b = i;
        while (a < b && signature[a] == ' ') ++a;
        if (a < b) list.emplace_back(a, b);
        begin = i + 1;
        if (c == ')') break;
    }
    return list;
}

} // namespace

const std::vector<std::string>& languageKeywords() {
    static const std::vector<std::string> words = {
        "float",   "color",   "point",  "vector", "normal",       "matrix", "string",      "void",       "uniform",
        "varying", "output",  "extern", "if",     "else",         "while",  "for",         "break",      "continue",
        "return",  "surface", "light",  "volume", "displacement", "imager", "illuminance", "illuminate", "solar",
        "gather",  "struct",  "class",  "public", "constant",     "shader"};
    return words;
}

bool isPredefined(const std::string& name) { return name == "PI" || globalNamed(name, std::nullopt); }

Json LanguageServer::completion(const Json& params) {
    Json items = Json::array();
    Document* d = document(params);
    const auto p = params.find("position");
    if (!d || p == params.end()) return items;
    const size_t at = position(*d, *p);
    if (d->rib()) return ribCompletion(*d, at);
    const Document::Where where = d->where(at);
    if (where == Document::Where::Comment) return items;
    if (where == Document::Where::String) {
        // The names of the optional parameters of the shadeop that is being called.
        const auto call = d->callAround(at);
        const shadeops::Shadeop* op = call ? shadeops::findShadeop(call->name) : nullptr;
        if (op)
            for (const auto& o : op->optional)
                items.push_back({{"label", o.name},
                                 {"kind", int(kProperty)},
                                 {"detail", std::string(o.output ? "output " : "") + shadeops::toString(o.type) +
                                                (o.defaultText.empty() ? "" : " = " + o.defaultText)},
                                 {"documentation", o.doc}});
        return items;
    }
    size_t begin = at;
    while (begin > 0 && (std::isalnum(static_cast<unsigned char>(d->text()[begin - 1])) || d->text()[begin - 1] == '_')) --begin;
    const std::string prefix = d->text().substr(begin, at - begin);
    std::set<std::string> seen;
    const auto offer = [&](const std::string& name, CompletionKind kind, const std::string& detail, Json documentation = {}) {
        if (name.empty() || !begins(name, prefix) || !seen.insert(name).second) return;
        Json item = {{"label", name}, {"kind", int(kind)}};
        if (!detail.empty()) item["detail"] = detail;
        if (!documentation.is_null()) item["documentation"] = std::move(documentation);
        items.push_back(std::move(item));
    };
    if (const auto r = d->receiver(begin)) {
        const auto members = d->members(*r, begin);
        for (const auto& m : members) offer(m.name, m.method ? kMethod : kField, m.detail, "of " + m.of);
        if (r->arrow || !members.empty()) return items; // else '.' is the dot product
    } else if (begin > 0 && begin == at && d->text()[begin - 1] == '>') {
        return items; // a comparison has just begun
    }
    const Document::Around a = d->around(at);
    const auto variable = [&](const rsl::Symbol& s) {
        if (s.type.base == shadeops::Base::Void || s.origin == rsl::Symbol::Origin::Global) return;
        // A local is known behind its declaration.
        if (s.origin == rsl::Symbol::Origin::Local && d->isHere(s.place) &&
            d->offset(size_t(s.place.line) - 1, size_t(std::max(1, s.place.column)) - 1) >= begin)
            return;
        offer(s.name, kVariable, declarationOf(s, *d->program()));
    };
    if (a.function)
        for (const auto& s : a.function->symbols) variable(*s);
    if (a.shader)
        for (const auto& s : a.shader->symbols) variable(*s);
    const bool inside = a.shader || a.function;
    for (int k = 0; inside && k < 6; ++k) {
        if (a.shader && int(a.shader->kind) != k) continue;
        for (const auto& g : rsl::globalVariables(rsl::ShaderKind(k))) offer(g.name, kVariable, globalText(g), g.doc);
    }
    for (const rsl::Function* f : d->functions())
        if (f->name.find("->") == std::string::npos) offer(f->name, kFunction, signatureOf(*f, *d->program()));
    for (const auto& s : shadeops::allShadeops()) {
        if (s.name.rfind("__", 0) == 0) continue;
        if (a.shader && !(s.contexts & rsl::contextOf(a.shader->kind))) continue;
        const std::string more = s.signatures.size() > 1 ? "  (+" + std::to_string(s.signatures.size() - 1) + ")" : std::string();
        offer(s.name, kFunction, (s.signatures.empty() ? s.name : s.signatures[0].text) + more, markdown(s.doc));
    }
    offer("PI", kConstant, "3.14159265");
    for (const std::string& k : languageKeywords()) offer(k, kKeyword, "");
    return items;
}

Json LanguageServer::hover(const Json& params) {
    Document* d = document(params);
    const auto p = params.find("position");
    if (!d || p == params.end()) return nullptr;
    if (d->rib()) return ribHover(*d, position(*d, *p));
    const auto word = d->wordAt(position(*d, *p));
    if (!word || d->where(word->first + 1) == Document::Where::Comment) return nullptr;
    const std::string name = d->text().substr(word->first, word->second - word->first);
    const bool string = d->where(word->first + 1) == Document::Where::String;
    std::string text;
    const auto function = [&](const rsl::Function& f) {
        text = fenced(signatureOf(f, *d->program()));
        const Origin o = d->origin(f.place);
        if (o.file.empty()) return;
        const std::string comment = Document::commentAbove(o.file == d->path() ? d->text() : textOf(o.file), size_t(o.line) - 1);
        if (!comment.empty()) text += "\n" + comment + "\n";
        if (o.file != d->path()) text += "\n" + o.file + "\n";
    };
    const auto global = [&](const rsl::GlobalVariable& g) {
        text = fenced(globalText(g)) + "\n" + g.doc + (g.writable ? "" : " (read-only)") + "\n";
    };
    const Document::Use use = useOf(*d, word->first);
    const auto receiver = string ? std::nullopt : d->receiver(word->first);
    const auto kind = [&]() -> std::optional<rsl::ShaderKind> {
        const auto a = d->around(word->first);
        if (a.shader) return a.shader->kind;
        return std::nullopt;
    };
    if (string) {
        const auto call = d->callAround(word->first);
        const shadeops::Shadeop* op = call ? shadeops::findShadeop(call->name) : nullptr;
        if (op)
            for (const auto& o : op->optional)
                if (o.name == name)
                    text = fenced(std::string(o.output ? "output " : "") + shadeops::toString(o.type) + " \"" + o.name + "\"" +
                                  (o.defaultText.empty() ? "" : " = " + o.defaultText)) +
                           "\n" + o.doc + "\n";
    } else if (const auto m = receiver ? memberNamed(*d, *receiver, word->first, name) : std::nullopt) {
        text = fenced(m->detail) + "\n" + (m->method ? "method of " : "member of ") + m->of + "\n";
    } else if (const auto* s = d->structure(name)) {
        text = fenced(structText(*s, *d->program()));
        const Origin o = d->origin(s->place);
        const std::string comment = o.file.empty() ? "" : Document::commentAbove(textOf(o.file), size_t(o.line) - 1);
        if (!comment.empty()) text += "\n" + comment + "\n";
    } else if (use.symbol) {
        const rsl::GlobalVariable* g = use.symbol->origin == rsl::Symbol::Origin::Global ? globalNamed(name, kind()) : nullptr;
        if (g) global(*g);
        else {
            text = fenced(variableText(*d, *use.symbol));
            if (use.symbol->origin == rsl::Symbol::Origin::ShaderParameter) text += "\nparameter of the shader\n";
            else if (use.symbol->origin == rsl::Symbol::Origin::FunctionParameter) text += "\nparameter of the function\n";
        }
    } else if (use.shader) {
        text = fenced(shaderText(*use.shader, *d->program()));
        const std::string comment = Document::commentAbove(d->text(), d->lineOf(word->first));
        if (!comment.empty()) text += "\n" + comment + "\n";
    } else if (use.function) {
        function(*use.function);
    } else if (use.shadeop) {
        text = manualMarkdown(*use.shadeop, use.signature);
    } else if (const auto list = d->functions(name); !list.empty()) {
        function(*list[0]);
    } else if (const shadeops::Shadeop* shadeop = shadeops::findShadeop(name)) {
        text = manualMarkdown(*shadeop);
    } else if (const auto* g = globalNamed(name, kind())) {
        global(*g);
    } else if (const auto macro = d->macro(name)) {
        text = fenced(std::string(d->line(macro->first)));
    }
    if (text.empty()) return nullptr;
    return {{"contents", markdown(text)}, {"range", range(*d, word->first, word->second)}};
}

Json LanguageServer::definition(const Json& params) {
    Document* d = document(params);
    const auto p = params.find("position");
    if (!d || p == params.end()) return nullptr;
    const size_t at = position(*d, *p);
    if (d->rib()) return ribDefinition(*d, at);
    // On an #include: the file itself.
    const std::string_view line = d->line(d->lineOf(at));
    if (const size_t i = line.find_first_not_of(" \t"); i != std::string_view::npos && line[i] == '#') {
        const size_t a = line.find_first_of("\"<"), b = a == std::string_view::npos ? a : line.find_first_of("\">", a + 1);
        if (line.find("include") != std::string_view::npos && b != std::string_view::npos) {
            const std::string name = fs::path(std::string(line.substr(a + 1, b - a - 1))).filename().string();
            if (d->program())
                for (const std::string& f : d->program()->dependencies)
                    if (fs::path(f).filename() == name && f != d->path()) return location({f, 1, 1}, 0);
            return nullptr;
        }
    }
    const auto word = d->wordAt(at);
    if (!word || d->where(word->first + 1) != Document::Where::Code) return nullptr;
    const std::string name = d->text().substr(word->first, word->second - word->first);
    const Document::Use use = useOf(*d, word->first);
    Origin o;
    if (const auto r = d->receiver(word->first))
        if (const auto m = memberNamed(*d, *r, word->first, name)) return location(d->origin(m->place), name.size());
    if (const auto* s = d->structure(name)) o = d->origin(s->place);
    else if (use.symbol) o = d->origin(use.symbol->place);
    else if (use.shader) o = d->origin(use.shader->place);
    else if (use.function) o = d->origin(use.function->place);
    else if (use.shadeop) return nullptr;
    if (!o.file.empty()) return location(o, name.size());
    if (use.symbol) return nullptr; // a predefined variable stands nowhere
    if (const auto list = d->functions(name); !list.empty()) {
        Json all = Json::array();
        for (const rsl::Function* f : list) all.push_back(location(d->origin(f->place), name.size()));
        return all;
    }
    if (const auto m = d->macro(name)) return location({d->path(), int(m->first) + 1, int(m->second) + 1}, name.size());
    if (d->program())
        for (const std::string& f : d->program()->dependencies) {
            const Document other(f, textOf(f));
            if (const auto m = other.macro(name)) return location({f, int(m->first) + 1, int(m->second) + 1}, name.size());
        }
    return nullptr;
}

Json LanguageServer::symbols(const Json& params) {
    Json list = Json::array();
    Document* d = document(params);
    if (d && d->rib()) return ribSymbols(*d);
    if (!d || !d->program()) return list;
    const auto symbol = [&](const std::string& name, int kind, const std::string& detail, const rsl::Place& p, bool body) {
        const size_t at = d->offset(size_t(p.line) - 1, size_t(std::max(1, p.column)) - 1);
        const size_t end = std::min(at + name.size(), d->text().size());
        const size_t begin = body ? d->startOf(d->lineOf(at)) : at;
        return Json{{"name", name.empty() ? "?" : name},
                    {"kind", kind},
                    {"detail", detail},
                    {"range", range(*d, begin, body ? std::max(end, d->endOfDefinition(at)) : end)},
                    {"selectionRange", range(*d, at, end)}};
    };
    std::set<std::pair<int, int>> seen; // a class is there once for each kind of shader it can be
    for (const auto& s : d->program()->shaders) {
        if (!d->isHere(s->place) || !seen.insert({s->place.line, s->place.column}).second) continue;
        Json j = symbol(s->name, kClass, toString(s->kind), s->place, true);
        Json children = Json::array();
        for (const auto& q : s->parameters)
            if (d->isHere(q.symbol->place))
                children.push_back(
                    symbol(q.symbol->name, kProperty2, declarationOf(*q.symbol, *d->program()), q.symbol->place, false));
        if (!children.empty()) j["children"] = std::move(children);
        list.push_back(std::move(j));
    }
    for (const rsl::Function* f : d->functions())
        if (d->isHere(f->place)) list.push_back(symbol(f->name, kFunctionSymbol, signatureOf(*f, *d->program()), f->place, true));
    return list;
}

Json LanguageServer::signatureHelp(const Json& params) {
    Document* d = document(params);
    const auto p = params.find("position");
    if (!d || p == params.end()) return nullptr;
    const auto call = d->callAround(position(*d, *p));
    if (!call) return nullptr;
    std::vector<std::string> texts;
    std::string doc;
    const bool method = d->functions(call->name).empty(); // of a structure: "S->f"
    for (const rsl::Function* f : d->functions()) {
        if (!(f->name == call->name || (method && f->name.ends_with("->" + call->name)))) continue;
        // At the definition itself there is nothing to choose.
        if (d->isHere(f->place) && d->offset(size_t(f->place.line) - 1, size_t(f->place.column) - 1) == call->at) return nullptr;
        texts.push_back(signatureOf(*f, *d->program()));
    }
    size_t chosen = 0;
    if (const shadeops::Shadeop* op = shadeops::findShadeop(call->name)) {
        doc = op->doc;
        const Document::Use use = d->useAt(call->at);
        for (const auto& s : op->signatures) {
            if (use.signature == &s) chosen = texts.size();
            texts.push_back(s.text);
        }
    }
    if (texts.empty()) return nullptr;
    Json list = Json::array();
    bool fits = false;
    for (size_t k = 0; k < texts.size(); ++k) {
        Json parameters = Json::array();
        const auto ranges = parameterRanges(texts[k]);
        for (const auto& [a, b] : ranges) parameters.push_back({{"label", {a, b}}});
        // The first that has room for the argument, unless the compiler has chosen one.
        if (chosen == 0 && !fits && ranges.size() > call->argument) {
            fits = true;
            chosen = k;
        }
        Json s = {{"label", texts[k]}, {"parameters", std::move(parameters)}};
        if (!doc.empty()) s["documentation"] = markdown(doc);
        list.push_back(std::move(s));
    }
    return {{"signatures", std::move(list)}, {"activeSignature", chosen}, {"activeParameter", call->argument}};
}

} // namespace alpenglow::cli
