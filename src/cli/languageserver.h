// The language server: messages of the Language Server Protocol in, messages out. It knows nothing of streams.
#pragma once
#include "cli/lspdocument.h"
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

namespace alpenglow::cli {

/// The language server: answers the messages of one editor, one after the other.
class LanguageServer {
public:
    using Json = nlohmann::json; ///< a message, or a part of one
    /// Folders for #include in addition to that of the shader, and macros.
    explicit LanguageServer(rsl::FrontOptions options) : options_(std::move(options)) {}

    /// Answers one message; what is to be sent, in order. Never throws: what cannot be understood gets an error or, when it asks
    /// for no answer, nothing.
    std::vector<Json> handle(const Json& message);
    /// Diagnostics of the texts that changed since the last call: to be sent when no message waits.
    std::vector<Json> publish();
    /// After `exit`.
    bool ended() const { return ended_; }
    /// 0 when `shutdown` came before the end, else 1.
    int status() const { return shutdown_ ? 0 : 1; }

    /// An answer to something that is no message: JSON-RPC error codes, -32700 for text that is not JSON.
    static Json error(const Json& id, int code, const std::string& text);

private:
    /// The result of a request. Throws Refused, or the exceptions of Json for parameters of another form.
    Json request(const std::string& method, const Json& params);
    void notification(const std::string& method, const Json& params);
    void didOpen(const Json& params);
    void didChange(const Json& params);
    void didClose(const Json& params);
    void didRename(const Json& params);
    /// Queues a text for publish().
    void changed(const std::string& uri);
    /// Queues the open texts that include this file: they see the editor's version, not the one on disk.
    void includersChanged(const std::string& path);

    Json initialize(const Json& params);
    Json completion(const Json& params);
    Json hover(const Json& params);
    Json definition(const Json& params);
    Json symbols(const Json& params);
    Json signatureHelp(const Json& params);
    Json codeActions(const Json& params);
    // lspnavigation.cpp
    Json references(const Json& params);
    Json highlights(const Json& params);
    Json prepareRename(const Json& params);
    Json rename(const Json& params);
    /// Calls f(uri, text) for a text, the others that are open and what they include; each once, analysed.
    void eachRelated(Document&, const std::function<void(const std::string& uri, const Document&)>&);
    Json semanticTokens(const Json& params); // lsptokens.cpp
    Json formatting(const Json& params);     // lspformat.cpp
    // lsprib.cpp: the same requests in a scene
    Json ribCompletion(const Document&, size_t at);
    Json ribHover(const Document&, size_t at);
    Json ribDefinition(const Document&, size_t at);
    Json ribSymbols(const Document&) const;
    std::vector<std::string> shaderFolders(const Document&) const;
    Json diagnosticsOf(const std::string& uri, Document&);

    Document* document(const Json& params); ///< null when it is not open; analysed
    /// Byte offset in the text of a position of the protocol, and ranges and positions of the protocol for byte offsets.
    size_t position(const Document&, const Json& position) const;
    Json range(const Document&, size_t begin, size_t end) const;
    Json place(const Document&, size_t at) const;
    Json location(const Origin&, size_t length); ///< `length` in bytes
    std::string textOf(const std::string& path); ///< the editor's version if the file is open; "" if it cannot be read
    rsl::FrontOptions optionsFor(const Document&) const;
    /// A column as the client counts (UTF-16 units, or bytes if it takes UTF-8), and back.
    size_t units(std::string_view line, size_t bytes) const;
    size_t bytes(std::string_view line, size_t units) const;

    rsl::FrontOptions options_;
    std::map<std::string, Document> documents_; ///< open texts by URI
    std::vector<std::string> changed_;          ///< URIs of texts for publish()
    std::vector<Json> pending_;                 ///< to be sent before the next answer
    bool utf8_ = false;                         ///< columns are bytes, as agreed in initialize()
    bool initialized_ = false, shutdown_ = false, ended_ = false;
};

/// A request that cannot be fulfilled, with the reason, which the editor shows.
struct Refused {
    std::string why; ///< for people
};

/// Kinds and modifiers of semantic tokens, in the order of their numbers.
nlohmann::json tokenLegend();
/// Keywords of RSL.
const std::vector<std::string>& languageKeywords();
/// Is this a predefined variable of some kind of shader, or PI?
bool isPredefined(const std::string& name);
/// The text with every line indented by its depth and without blanks at the ends of lines. The text of a line is kept.
/// `tab`: columns of a step; `spaces`: made of spaces, else of tabs.
std::string formatted(const std::string& text, size_t tab, bool spaces);

/// "file:///a%20b.sl" to "/a b.sl"; other schemes give "".
std::string pathOf(const std::string& uri);
/// The reverse.
std::string uriOf(const std::string& path);

} // namespace alpenglow::cli
