// Messages, texts and diagnostics; what is asked about a place stands in lspqueries.cpp.
#include "cli/languageserver.h"
#include "base/limits.h"
#include "rsl/front/preprocessor.h"
#include <algorithm>
#include <cctype>
#include <filesystem>

namespace fs = std::filesystem;

namespace alpenglow::cli {

using Json = nlohmann::json;

namespace {

// Of JSON-RPC and of the protocol.
constexpr int kInvalidRequest = -32600, kMethodNotFound = -32601, kInvalidParams = -32602, kInternalError = -32603,
              kNotInitialized = -32002, kRequestFailed = -32803;

/// A wrong shape of parameters; becomes an error of the request.
struct BadParams {};

const Json& member(const Json& j, const char* key) {
    if (!j.is_object()) throw BadParams{};
    const auto it = j.find(key);
    if (it == j.end()) throw BadParams{};
    return *it;
}
std::string text(const Json& j, const char* key) {
    const Json& m = member(j, key);
    if (!m.is_string()) throw BadParams{};
    return m.get<std::string>();
}
size_t number(const Json& j, const char* key) {
    const Json& m = member(j, key);
    if (!m.is_number_integer() || m.get<int64_t>() < 0) throw BadParams{};
    return size_t(std::min<int64_t>(m.get<int64_t>(), INT32_MAX));
}

Json notice(const char* method, Json params) { return {{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}}; }

} // namespace

std::string pathOf(const std::string& uri) {
    if (uri.rfind("file://", 0) != 0) return "";
    std::string p;
    size_t i = 7;
    if (i < uri.size() && uri[i] != '/') i = std::min(uri.find('/', i), uri.size()); // a host
    const auto hex = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        return std::isxdigit(static_cast<unsigned char>(c)) ? (c | 32) - 'a' + 10 : -1;
    };
    for (; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0) {
            const char c = char(hex(uri[i + 1]) * 16 + hex(uri[i + 2]));
            if (c) p += c;
            i += 2;
        } else p += uri[i];
    }
    return p;
}

std::string uriOf(const std::string& path) {
    std::string u = "file://";
    for (const char c : fs::absolute(path).lexically_normal().string()) {
        if (std::isalnum(static_cast<unsigned char>(c)) || std::string_view("/-_.~").find(c) != std::string_view::npos) u += c;
        else {
            const char* digits = "0123456789ABCDEF";
            const auto b = static_cast<unsigned char>(c);
            u += '%', u += digits[b >> 4], u += digits[b & 15];
        }
    }
    return u;
}

Json LanguageServer::error(const Json& id, int code, const std::string& text) {
    return {{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", text}}}};
}

std::vector<Json> LanguageServer::handle(const Json& message) {
    std::vector<Json> out;
    const bool object = message.is_object();
    const bool hasId = object && message.contains("id") && (message["id"].is_number() || message["id"].is_string());
    const bool oddId = object && message.contains("id") && !hasId && !message["id"].is_null();
    const Json id = hasId ? message["id"] : Json();
    if (oddId) {
        out.push_back(error(nullptr, kInvalidRequest, "the id of a request is a number or a text"));
        return out;
    }
    if (!object || !message.contains("method") || !message["method"].is_string()) {
        // Replies to requests of ours, of which there are none, have an id and a result.
        if (!object || !(message.contains("result") || message.contains("error")))
            out.push_back(error(id, kInvalidRequest, "this is neither a request nor a notification"));
        return out;
    }
    const std::string method = message["method"].get<std::string>();
    const Json params = message.contains("params") ? message["params"] : Json::object();
    try {
        if (!hasId) {
            if (initialized_ || method == "exit") notification(method, params);
        } else if (shutdown_) {
            out.push_back(error(id, kInvalidRequest, "the server was shut down"));
        } else if (initialized_ && method == "initialize") {
            out.push_back(error(id, kInvalidRequest, "initialize comes once"));
        } else if (!initialized_ && method != "initialize") {
            out.push_back(error(id, kNotInitialized, "initialize comes first"));
        } else {
            Json result = request(method, params);
            if (result.is_discarded()) out.push_back(error(id, kMethodNotFound, "unknown method"));
            else out.push_back({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}});
        }
    } catch (const Refused& r) {
        if (hasId) out.push_back(error(id, kRequestFailed, r.why));
    } catch (const BadParams&) {
        if (hasId) out.push_back(error(id, kInvalidParams, "the parameters are not as the protocol has them"));
    } catch (const Json::exception&) {
        if (hasId) out.push_back(error(id, kInvalidParams, "the parameters are not as the protocol has them"));
    } catch (const std::exception& e) { // no memory, a folder that cannot be read: the next message may do
        if (hasId) out.push_back(error(id, kInternalError, e.what()));
    }
    return out;
}

Json LanguageServer::request(const std::string& method, const Json& params) {
    if (method == "initialize") return initialize(params);
    if (method == "shutdown") {
        shutdown_ = true;
        return nullptr;
    }
    if (method == "textDocument/completion") return completion(params);
    if (method == "textDocument/hover") return hover(params);
    if (method == "textDocument/definition") return definition(params);
    if (method == "textDocument/documentSymbol") return symbols(params);
    if (method == "textDocument/signatureHelp") return signatureHelp(params);
    if (method == "textDocument/codeAction") return codeActions(params);
    if (method == "textDocument/references") return references(params);
    if (method == "textDocument/documentHighlight") return highlights(params);
    if (method == "textDocument/prepareRename") return prepareRename(params);
    if (method == "textDocument/rename") return rename(params);
    if (method == "textDocument/semanticTokens/full") return semanticTokens(params);
    if (method == "textDocument/formatting") return formatting(params);
    return Json(Json::value_t::discarded);
}

Json LanguageServer::initialize(const Json& params) {
    initialized_ = true;
    if (params.is_object()) {
        // Bytes are what the compiler counts; a client that can do them saves the conversion.
        if (const auto p = params.find("capabilities"); p != params.end() && p->is_object() && p->contains("general")) {
            const Json& g = (*p)["general"];
            if (g.is_object() && g.contains("positionEncodings") && g["positionEncodings"].is_array())
                for (const Json& e : g["positionEncodings"]) utf8_ |= e == "utf-8";
        }
        const auto options = params.find("initializationOptions");
        if (options != params.end() && options->is_object()) {
            if (options->contains("includePaths") && (*options)["includePaths"].is_array())
                for (const Json& f : (*options)["includePaths"])
                    if (f.is_string()) options_.includePaths.push_back(f.get<std::string>());
            if (options->contains("defines") && (*options)["defines"].is_object())
                for (const auto& [name, value] : (*options)["defines"].items())
                    if (value.is_string()) options_.defines.emplace_back(name, value.get<std::string>());
        }
    }
    return {{"capabilities",
             {{"positionEncoding", utf8_ ? "utf-8" : "utf-16"},
              {"textDocumentSync", {{"openClose", true}, {"change", 2}, {"save", true}}},
              {"completionProvider", {{"triggerCharacters", {"\"", ">", "."}}}},
              {"hoverProvider", true},
              {"definitionProvider", true},
              {"documentSymbolProvider", true},
              {"referencesProvider", true},
              {"documentHighlightProvider", true},
              {"renameProvider", {{"prepareProvider", true}}},
              {"documentFormattingProvider", true},
              {"semanticTokensProvider", {{"legend", tokenLegend()}, {"full", true}}},
              {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}},
              {"signatureHelpProvider", {{"triggerCharacters", {"(", ","}}}}}},
            {"serverInfo", {{"name", "alpenglow"}}}};
}

void LanguageServer::changed(const std::string& uri) {
    if (std::find(changed_.begin(), changed_.end(), uri) == changed_.end()) changed_.push_back(uri);
}

void LanguageServer::includersChanged(const std::string& path) {
    for (auto& [uri, d] : documents_) {
        if (d.path() == path || !d.includes(path)) continue;
        d.touch();
        changed(uri);
    }
}

void LanguageServer::didOpen(const Json& params) {
    const Json& d = member(params, "textDocument");
    const std::string uri = text(d, "uri"), path = pathOf(uri);
    std::string content = text(d, "text");
    const std::string language =
        d.contains("languageId") && d["languageId"].is_string() ? d["languageId"].get<std::string>() : "";
    if (!documents_.count(uri) && documents_.size() >= limits::kServerDocuments) {
        pending_.push_back(notice("window/logMessage", {{"type", 1},
                                                        {"message", "more than " + std::to_string(limits::kServerDocuments) +
                                                                        " open texts: " + uri + " is not looked at"}}));
        return;
    }
    documents_.erase(uri);
    const auto at = documents_.emplace(uri, Document(path.empty() ? uri : path, std::move(content), language == "rib")).first;
    changed(uri);
    includersChanged(at->second.path());
}

void LanguageServer::didChange(const Json& params) {
    const std::string uri = text(member(params, "textDocument"), "uri");
    const auto at = documents_.find(uri);
    if (at == documents_.end()) return;
    Document& d = at->second;
    const Json& changes = member(params, "contentChanges");
    if (!changes.is_array()) throw BadParams{};
    for (const Json& c : changes) {
        std::string content = text(c, "text");
        if (!c.contains("range")) {
            d.set(std::move(content));
            continue;
        }
        const size_t a = position(d, member(c["range"], "start")), b = position(d, member(c["range"], "end"));
        d.replace(std::min(a, b), std::max(a, b), content);
    }
    changed(uri);
    includersChanged(d.path());
}

void LanguageServer::didClose(const Json& params) {
    const std::string uri = text(member(params, "textDocument"), "uri");
    const auto at = documents_.find(uri);
    if (at == documents_.end()) return;
    const std::string path = at->second.path();
    documents_.erase(at);
    std::erase(changed_, uri);
    includersChanged(path);
    pending_.push_back(notice("textDocument/publishDiagnostics", {{"uri", uri}, {"diagnostics", Json::array()}}));
}

void LanguageServer::didRename(const Json& params) {
    // Editors close and open what they rename; one that does not still has its text under the new name.
    const Json& files = member(params, "files");
    if (!files.is_array()) throw BadParams{};
    for (const Json& file : files) {
        const std::string from = text(file, "oldUri"), to = text(file, "newUri");
        const auto at = documents_.find(from);
        if (at == documents_.end() || documents_.count(to)) continue;
        const std::string path = pathOf(to), before = at->second.path();
        Document moved(path.empty() ? to : path, at->second.text(), at->second.rib());
        documents_.erase(at);
        std::erase(changed_, from);
        documents_.emplace(to, std::move(moved));
        pending_.push_back(notice("textDocument/publishDiagnostics", {{"uri", from}, {"diagnostics", Json::array()}}));
        changed(to);
        includersChanged(before);
        includersChanged(path);
    }
}

void LanguageServer::notification(const std::string& method, const Json& params) {
    if (method == "exit") {
        ended_ = true;
    } else if (method == "textDocument/didOpen") {
        didOpen(params);
    } else if (method == "textDocument/didChange") {
        didChange(params);
    } else if (method == "textDocument/didSave") {
        // The saved file may be an include of the others: they are checked again.
        for (auto& [uri, d] : documents_) {
            d.touch();
            changed(uri);
        }
    } else if (method == "textDocument/didClose") {
        didClose(params);
    } else if (method == "workspace/didRenameFiles") {
        didRename(params);
    }
}

std::vector<Json> LanguageServer::publish() {
    std::vector<Json> out = std::move(pending_);
    pending_.clear();
    for (const std::string& uri : changed_) {
        const auto d = documents_.find(uri);
        if (d == documents_.end()) continue;
        Json found = Json::array();
        try {
            d->second.analyse(optionsFor(d->second));
            found = diagnosticsOf(uri, d->second);
        } catch (const std::exception& e) { // the text stays open; its next change is checked again
            const Json start = {{"line", 0}, {"character", 0}};
            found.push_back({{"range", {{"start", start}, {"end", start}}},
                             {"severity", 1},
                             {"source", "alpenglow"},
                             {"message", std::string("this text could not be checked: ") + e.what()}});
        }
        out.push_back(notice("textDocument/publishDiagnostics", {{"uri", uri}, {"diagnostics", std::move(found)}}));
    }
    changed_.clear();
    return out;
}

Json LanguageServer::diagnosticsOf(const std::string&, Document& d) {
    Json list = Json::array();
    for (const Diagnostic& m : d.diagnostics()) {
        if (list.size() >= size_t(limits::kServerDiagnostics)) break;
        std::string words = m.message;
        size_t begin = 0, end = 0;
        if (m.place.file == d.path() && m.place.line > 0) {
            const size_t line = size_t(m.place.line) - 1;
            begin = d.offset(line, size_t(std::max(1, m.place.column)) - 1);
            end = d.offset(line, size_t(std::max(1, m.place.column) - 1 + std::max(1, m.length)));
        } else {
            // In an include: shown at the #include that brings it in.
            const std::string name = fs::path(m.place.file).filename().string();
            for (size_t n = 0; n < d.lines(); ++n) {
                const std::string_view l = d.line(n);
                if (name.empty() || l.find("include") == l.npos || l.find(name) == l.npos) continue;
                begin = d.offset(n, 0);
                end = d.offset(n, l.size());
                break;
            }
            words = m.place.file + ":" + std::to_string(m.place.line) + ":" + std::to_string(m.place.column) + ": " + words;
        }
        if (!m.hint.empty()) words += "\n" + m.hint;
        for (const std::string& n : m.notes) words += "\n" + n;
        Json j = {{"range", range(d, begin, end)},
                  {"severity", m.severity >= Severity::Error     ? 1
                               : m.severity == Severity::Warning ? 2
                                                                 : 3},
                  {"source", "alpenglow"},
                  {"message", words}};
        if (!m.id.empty()) j["code"] = m.id;
        if (m.id.rfind("unused-", 0) == 0) {
            j["severity"] = 4;
            j["tags"] = {1}; // unnecessary: shown faded
        }
        list.push_back(std::move(j));
    }
    return list;
}

Json LanguageServer::codeActions(const Json& params) {
    Json list = Json::array();
    Document* d = document(params);
    if (!d) return list;
    const Json& r = member(params, "range");
    const size_t first = number(member(r, "start"), "line"), last = number(member(r, "end"), "line");
    const std::string uri = text(member(params, "textDocument"), "uri");
    for (const Diagnostic& m : d->diagnostics()) {
        if (m.place.file != d->path() || m.place.line < 1) continue;
        const size_t line = size_t(m.place.line) - 1;
        if (line < first || line > last) continue;
        for (const FixIt& f : m.fixes) {
            const size_t n = size_t(f.place.line) - 1;
            const size_t begin = d->offset(n, size_t(f.place.column) - 1);
            const size_t end = d->offset(n, size_t(f.place.column - 1 + f.length));
            const std::string title = f.length == 0 ? "Insert '" + f.text + "'" : "Change to '" + f.text + "'";
            list.push_back({{"title", title},
                            {"kind", "quickfix"},
                            {"edit", {{"changes", {{uri, {{{"range", range(*d, begin, end)}, {"newText", f.text}}}}}}}}});
        }
    }
    return list;
}

// ---- texts and positions

Document* LanguageServer::document(const Json& params) {
    const auto d = documents_.find(text(member(params, "textDocument"), "uri"));
    if (d == documents_.end()) return nullptr;
    d->second.analyse(optionsFor(d->second));
    return &d->second;
}

rsl::FrontOptions LanguageServer::optionsFor(const Document& d) const {
    rsl::FrontOptions o = options_;
    o.includePaths.insert(o.includePaths.begin(), fs::path(d.path()).parent_path().string());
    o.openText = [this](const std::string& path) -> std::optional<std::string> {
        const std::string wanted = normalPath(path);
        for (const auto& [uri, open] : documents_)
            if (normalPath(open.path()) == wanted) return open.text();
        return std::nullopt;
    };
    return o;
}

std::string LanguageServer::textOf(const std::string& path) {
    for (const auto& [uri, d] : documents_)
        if (normalPath(d.path()) == normalPath(path)) return d.text();
    return rsl::front::readSource(path).value_or("");
}

size_t LanguageServer::units(std::string_view line, size_t count) const {
    count = std::min(count, line.size());
    if (utf8_) return count;
    size_t n = 0;
    for (size_t i = 0; i < count; ++i) {
        const auto b = static_cast<unsigned char>(line[i]);
        if ((b & 0xC0) != 0x80) n += b >= 0xF0 ? 2 : 1; // UTF-16: what takes four bytes takes two units
    }
    return n;
}

size_t LanguageServer::bytes(std::string_view line, size_t wanted) const {
    if (utf8_) return std::min(wanted, line.size());
    size_t n = 0, i = 0;
    while (i < line.size() && n < wanted) {
        n += static_cast<unsigned char>(line[i]) >= 0xF0 ? 2 : 1;
        ++i;
        while (i < line.size() && (static_cast<unsigned char>(line[i]) & 0xC0) == 0x80) ++i;
    }
    return i;
}

size_t LanguageServer::position(const Document& d, const Json& p) const {
    const size_t line = number(p, "line");
    return d.offset(line, bytes(d.line(line), number(p, "character")));
}

Json LanguageServer::place(const Document& d, size_t at) const {
    const size_t line = d.lineOf(std::min(at, d.text().size()));
    return {{"line", line}, {"character", units(d.line(line), at - std::min(at, d.startOf(line)))}};
}

Json LanguageServer::range(const Document& d, size_t begin, size_t end) const {
    return {{"start", place(d, begin)}, {"end", place(d, end)}};
}

Json LanguageServer::location(const Origin& o, size_t length) {
    const Document d(o.file, textOf(o.file));
    const size_t begin = d.offset(size_t(std::max(1, o.line)) - 1, size_t(std::max(1, o.column)) - 1);
    return {{"uri", uriOf(o.file)}, {"range", range(d, begin, std::min(begin + length, d.text().size()))}};
}

} // namespace alpenglow::cli
