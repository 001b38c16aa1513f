// Scenes in the language server: what the RIB reader says of them, and what the tables of requests, options and shaders know.
#include "base/knownoptions.h"
#include "base/limits.h"
#include "cli/languageserver.h"
#include "cli/optionmanual.h"
#include "cli/shaderlist.h"
#include "ri/reader.h"
#include "ri/requests/manual.h"
#include "rsl/front/inspect.h"
#include "rsl/front/preprocessor.h"
#include "rsl/shadersearch.h"
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>

namespace fs = std::filesystem;

namespace alpenglow::cli {

using Json = nlohmann::json;

namespace {

/// Frames are read and dropped.
struct NoRenderer : scene::FrameConsumer {
    void render(std::shared_ptr<const scene::Frame>) override {}
    void makeTexture(const std::string&, const std::vector<std::string>&, const scene::ParamList&, const SourcePlace&) override {}
};

/// The request in which a place is, and what stands between.
struct Around {
    std::string request;
    size_t at = 0;                    ///< of the request's name
    std::vector<std::string> strings; ///< behind it and before the place, whole ones
    bool inString = false;
    size_t begin = 0, end = 0; ///< of the string or word that the place touches; end = begin: none
    bool comment = false;
};

bool isRibWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ':'; }

Around aroundOf(const std::string& text, size_t at) {
    Around a;
    a.begin = a.end = at;
    for (size_t i = 0; i < text.size() && i <= at;) {
        if (text[i] == '#') {
            const size_t end = std::min(text.find('\n', i), text.size());
            if (at > i && at <= end) a.comment = true;
            i = end;
        } else if (text[i] == '"') {
            size_t end = i + 1;
            while (end < text.size() && text[end] != '"' && text[end] != '\n') end += text[end] == '\\' ? 2 : 1;
            end = std::min(end, text.size());
            if (at > i && at <= end) {
                a.inString = true;
                a.begin = i + 1;
                a.end = end;
                return a;
            }
            a.strings.push_back(text.substr(i + 1, end - i - 1));
            i = end + 1;
        } else if (isRibWord(text[i]) && !std::isdigit(static_cast<unsigned char>(text[i]))) {
            size_t end = i;
            while (end < text.size() && isRibWord(text[end])) ++end;
            if (at >= i && at <= end) {
                a.begin = i;
                a.end = end;
            }
            if (at > end || a.end == end) {
                a.request = text.substr(i, end - i);
                a.at = i;
                a.strings.clear();
            }
            i = end;
        } else if (std::isdigit(static_cast<unsigned char>(text[i]))) { // 1e5 is no request
            while (i < text.size() && (isRibWord(text[i]) || text[i] == '.')) ++i;
        } else ++i;
    }
    return a;
}

/// The kind of shader that a request names by its first string; "" for others.
std::string kindOf(const std::string& request) {
    static const std::map<std::string, std::string> kinds = {{"Surface", "surface"},          {"Displacement", "displacement"},
                                                             {"LightSource", "light"},        {"AreaLightSource", "light"},
                                                             {"Atmosphere", "volume"},        {"Interior", "volume"},
                                                             {"Exterior", "volume"},          {"Imager", "imager"},
                                                             {"Deformation", "displacement"}, {"Shader", ""}};
    const auto k = kinds.find(request);
    return k == kinds.end() ? "-" : k->second;
}

/// "uniform float Kd" gives "Kd".
std::string lastWord(const std::string& s) {
    const size_t space = s.find_last_of(" \t");
    return space == std::string::npos ? s : s.substr(space + 1);
}

Json fencedRib(const std::string& text, const std::string& language = "") {
    return {{"kind", "markdown"}, {"value", "```" + language + "\n" + text + (text.ends_with("\n") ? "" : "\n") + "```\n"}};
}

/// The parameters of a shader, "float Kd = .5", by name; empty when its file cannot be found or read.
std::vector<std::pair<std::string, std::string>> parametersOf(const std::string& shader, const std::vector<std::string>& folders,
                                                              const rsl::FrontOptions& options) {
    std::vector<std::pair<std::string, std::string>> list;
    const auto file = rsl::fileWithShader(shader, folders);
    const auto text = file ? rsl::front::readSource(*file) : std::nullopt;
    if (!text) return list;
    Diagnostics quiet;
    rsl::FrontOptions o = options;
    o.includePaths.insert(o.includePaths.begin(), fs::path(*file).parent_path().string());
    const auto program = rsl::inspectText(*text, *file, o, quiet); // lowered: a scene gives members of structures one by one
    for (const auto& s : program->shaders) {
        if (s->name != shader || !list.empty()) continue;
        for (const auto& p : s->parameters)
            list.emplace_back(p.symbol->name,
                              declarationOf(*p.symbol, *program) + (p.defaultText.empty() ? "" : " = " + p.defaultText));
    }
    return list;
}

std::span<const known::OptionDescription> tableOf(const std::string& request) {
    if (request == "Option") return known::knownOptions();
    if (request == "Attribute") return known::knownAttributes();
    if (request == "Hider") return known::knownHiderParameters();
    if (request == "Display") return known::knownDisplayParameters();
    return {};
}

} // namespace

void Document::analyseScene() {
    Diagnostics d;
    if (text_.size() > limits::kServerScene) {
        d.report(Severity::Info, Rie::NoError, {path_, 1, 1},
                 "a scene of more than " + std::to_string(limits::kServerScene >> 20) + " MiB is not checked while it is edited",
                 "alpenglow render checks it");
    } else {
        ri::ReaderOptions o;
        o.allowRead = false;
        NoRenderer nobody;
        ri::RibReader(o, nobody, d).readMemory(text_, path_);
    }
    diagnostics_ = d.all();
    program_.reset();
}

std::vector<std::string> LanguageServer::shaderFolders(const Document& d) const {
    std::vector<std::string> folders = {fs::path(d.path()).parent_path().string()};
    folders.insert(folders.end(), options_.includePaths.begin(), options_.includePaths.end());
    return folders;
}

Json LanguageServer::ribCompletion(const Document& d, size_t at) {
    Json items = Json::array();
    const Around a = aroundOf(d.text(), at);
    if (a.comment) return items;
    const auto offer = [&](const std::string& name, int kind, const std::string& detail) {
        Json item = {{"label", name}, {"kind", kind}};
        if (!detail.empty()) item["detail"] = detail;
        items.push_back(std::move(item));
    };
    constexpr int kFunction = 3, kClass = 7, kProperty = 10, kValue = 12;
    if (!a.inString) {
        for (const ri::Request& r : ri::requestTable()) offer(std::string(r.name), kFunction, std::string(r.signature));
        return items;
    }
    const std::string kind = kindOf(a.request);
    if (kind != "-" && a.strings.empty()) {
        for (const ListedShader& s : listShaders(shaderFolders(d)))
            if (!s.hidden && (kind.empty() || s.kind == kind || s.kind == "class")) offer(s.name, kClass, s.doc);
    } else if (kind != "-") {
        for (const auto& [name, text] : parametersOf(a.strings[0], shaderFolders(d), options_)) offer(name, kProperty, text);
    } else if (a.request == "Option" || a.request == "Attribute") {
        const auto table = tableOf(a.request);
        for (const std::string& name : known::knownNames(table, a.strings.empty() ? "" : a.strings[0])) {
            const auto* entry = a.strings.empty() ? nullptr : known::findKnown(table, a.strings[0] + ":" + name);
            const std::string type = entry && !entry->type.empty() ? std::string(entry->type) + " " : "";
            offer(type + name, a.strings.empty() ? kValue : kProperty, entry ? std::string(entry->doc) : "");
        }
    } else if (a.request == "Hider" && a.strings.empty()) {
        for (const auto& h : known::knownHiders()) offer(std::string(h.name), kValue, std::string(h.doc));
    } else if (a.request == "Display" && a.strings.size() == 1) {
        for (const std::string& name : topicNames(Topic::Displays)) offer(name, kValue, "");
    } else if ((a.request == "Hider" && !a.strings.empty()) || (a.request == "Display" && a.strings.size() > 2)) {
        for (const auto& o : tableOf(a.request)) offer(std::string(o.name), kProperty, std::string(o.doc));
    }
    return items;
}

Json LanguageServer::ribHover(const Document& d, size_t at) {
    const Around a = aroundOf(d.text(), at);
    if (a.comment || a.end == a.begin) return nullptr;
    const std::string word = d.text().substr(a.begin, a.end - a.begin);
    const auto answer = [&](Json text) -> Json { return {{"contents", std::move(text)}, {"range", range(d, a.begin, a.end)}}; };
    if (!a.inString) {
        const ri::Request* r = ri::findRequest(word);
        return r ? answer(fencedRib(ri::requestText(*r))) : Json(nullptr);
    }
    const std::string kind = kindOf(a.request);
    if (kind != "-") {
        const std::string shader = a.strings.empty() ? word : a.strings[0];
        std::string text;
        for (const auto& [name, declaration] : parametersOf(shader, shaderFolders(d), options_))
            if (a.strings.empty() || name == lastWord(word)) text += declaration + "\n";
        return text.empty() ? Json(nullptr) : answer(fencedRib((a.strings.empty() ? shader + "\n" : "") + text, "rsl"));
    }
    if (a.request == "Option" || a.request == "Attribute") {
        const Topic topic = a.request == "Option" ? Topic::Options : Topic::Attributes;
        const std::string text = topicText(topic, a.strings.empty() ? word : a.strings[0] + ":" + lastWord(word));
        return text.empty() ? Json(nullptr) : answer(fencedRib(text));
    }
    return nullptr;
}

Json LanguageServer::ribDefinition(const Document& d, size_t at) {
    const Around a = aroundOf(d.text(), at);
    if (!a.inString || !a.strings.empty()) return nullptr;
    const std::string word = d.text().substr(a.begin, a.end - a.begin);
    if (kindOf(a.request) != "-") {
        const auto file = rsl::fileWithShader(word, shaderFolders(d));
        return file ? location({normalPath(*file), 1, 1}, 0) : Json(nullptr);
    }
    if (a.request != "ReadArchive") return nullptr;
    std::error_code failed;
    const fs::path file = fs::path(d.path()).parent_path() / word;
    return fs::is_regular_file(file, failed) ? location({normalPath(file.string()), 1, 1}, 0) : Json(nullptr);
}

Json LanguageServer::ribSymbols(const Document& d) const {
    static const std::set<std::string> shown = {"FrameBegin",   "WorldBegin",  "ObjectBegin",     "ObjectBeginInstance",
                                                "ArchiveBegin", "LightSource", "AreaLightSource", "Surface",
                                                "Display",      "SolidBegin"};
    constexpr int kNamespace = 3, kObject = 19;
    Json list = Json::array();
    for (size_t n = 0; n < d.lines() && list.size() < size_t(limits::kServerDiagnostics); ++n) {
        const std::string_view line = d.line(n);
        const size_t begin = line.find_first_not_of(" \t");
        if (begin == std::string_view::npos || !std::isalpha(static_cast<unsigned char>(line[begin]))) continue;
        size_t end = begin;
        while (end < line.size() && isRibWord(line[end])) ++end;
        const std::string name(line.substr(begin, end - begin));
        if (!shown.count(name)) continue;
        const size_t at = d.startOf(n) + begin;
        list.push_back({{"name", std::string(line.substr(begin, 60))},
                        {"kind", name.ends_with("Begin") ? kNamespace : kObject},
                        {"range", range(d, at, d.startOf(n) + line.size())},
                        {"selectionRange", range(d, at, d.startOf(n) + end)}});
    }
    return list;
}

} // namespace alpenglow::cli
