// alpenglow lsp: the language server on standard input and output.
#include "base/installation.h"
#include "base/limits.h"
#include "cli/command.h"
#include "cli/languageserver.h"
#include "cli/lspstream.h"
#include "rsl/plugins.h"
#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <deque>
#include <memory>
#include <poll.h>
#include <unistd.h>

namespace alpenglow::cli {
namespace {

bool send(const nlohmann::json& message) {
    const std::string s = message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    std::printf("Content-Length: %zu\r\n\r\n", s.size());
    std::fwrite(s.data(), 1, s.size(), stdout);
    return std::fflush(stdout) == 0;
}

/// Messages that came and were not answered yet, in their order.
class Queue {
public:
    /// Takes in what is there; waits for bytes when nothing is. False at the end of the input.
    bool fetch() {
        for (;;) {
            while (take()) {}
            if (waiting_.empty() ? !read() : held_ + stream_.held() >= limits::kServerMessage || !readable() || !read()) break;
        }
        return !waiting_.empty();
    }
    nlohmann::json pop() {
        nlohmann::json m = std::move(waiting_.front().message);
        held_ -= waiting_.front().bytes;
        waiting_.pop_front();
        return m;
    }
    bool empty() const { return waiting_.empty(); }
    /// Would fetch() find bytes at once?
    static bool readable() {
        pollfd p{STDIN_FILENO, POLLIN, 0};
        return poll(&p, 1, 0) > 0 && (p.revents & POLLIN);
    }

private:
    struct Waiting {
        nlohmann::json message;
        size_t bytes;
    };

    bool take() {
        std::string body;
        switch (stream_.next(body)) {
        case MessageStream::Kind::More:
            return false;
        case MessageStream::Kind::BadLength:
            refuse(-32700, "Content-Length is not a number");
            return true;
        case MessageStream::Kind::NoLength:
            refuse(-32700, "a message without Content-Length");
            return true;
        case MessageStream::Kind::TooLong:
            refuse(-32600, "a message of more than " + std::to_string(limits::kServerMessage) + " bytes");
            return true;
        case MessageStream::Kind::Message:
            break;
        }
        auto message = nlohmann::json::parse(body, nullptr, false);
        if (message.is_discarded()) refuse(-32700, "this is not JSON");
        else if (!cancels(message)) push(std::move(message), body.size());
        return true;
    }
    /// A fault of the stream: its answer waits where the message would.
    void refuse(int code, const std::string& why) { push({{"refused", LanguageServer::error(nullptr, code, why)}}, 0); }
    void push(nlohmann::json m, size_t bytes) {
        held_ += bytes;
        waiting_.push_back({std::move(m), bytes});
    }
    /// "$/cancelRequest" of a request that waits: it is answered as cancelled.
    bool cancels(const nlohmann::json& m) {
        if (!m.is_object() || m.value("method", nlohmann::json()) != "$/cancelRequest") return false;
        const auto p = m.find("params");
        if (p == m.end() || !p->is_object() || !p->contains("id")) return true;
        for (Waiting& w : waiting_)
            if (w.message.is_object() && w.message.contains("method") && w.message.contains("id") &&
                w.message["id"] == (*p)["id"])
                w.message = {{"refused", LanguageServer::error((*p)["id"], -32800, "cancelled")}};
        return true;
    }
    bool read() {
        char bytes[1 << 16];
        ssize_t n;
        do n = ::read(STDIN_FILENO, bytes, sizeof bytes);
        while (n < 0 && errno == EINTR);
        if (n > 0) stream_.feed(bytes, size_t(n));
        return n > 0;
    }

    MessageStream stream_;
    std::deque<Waiting> waiting_;
    size_t held_ = 0;
};

int serve(LanguageServer& server) {
    std::signal(SIGPIPE, SIG_IGN); // an editor that is gone shows as a failed write
    Queue queue;
    bool open = true;
    const auto sendAll = [&](const std::vector<nlohmann::json>& list) {
        for (const auto& m : list) open = open && send(m);
    };
    while (open && !server.ended()) {
        if (!queue.fetch()) return server.status();
        const nlohmann::json message = queue.pop();
        if (message.is_object() && message.contains("refused")) open = send(message["refused"]);
        else sendAll(server.handle(message));
        // While messages wait, what the text is now is not what the user sees last.
        if (queue.empty() && !Queue::readable()) sendAll(server.publish());
    }
    sendAll(server.publish());
    return open ? server.status() : int(kOutputFailed);
}

} // namespace

void addLsp(CLI::App& app, int* status) {
    struct Arguments {
        std::vector<std::string> searchPaths, defines;
        std::string dialect;
        bool stdio = true, allowExec = false;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = app.add_subcommand("lsp", "Language server for editors, over standard input and output");
    c->add_option("-I,--searchpath", a->searchPaths, "Folders for #include, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    c->add_option("-D", a->defines, "Define a macro")->type_name("NAME[=TEXT]")->allow_extra_args(false);
    addDialect(*c, a->dialect);
    c->add_flag("--allow-exec", a->allowExec, "Allow shaders to load plug-ins");
    c->add_flag("--stdio", a->stdio, "Use standard input and output (always the case; accepted for editors that pass it)");
    c->footer("docs/editors.md shows it in VS Code and Vim. Exit status 0 when the editor asked it to shut down, else 1.");
    c->callback([a, status] {
        rsl::FrontOptions options;
        options.includePaths = folders(a->searchPaths);
        for (std::string& f : environmentShaders()) options.includePaths.push_back(std::move(f));
        if (std::string s = shippedShaders(); !s.empty()) options.includePaths.push_back(s);
        for (const std::string& d : a->defines) {
            size_t eq = d.find('=');
            options.defines.emplace_back(d.substr(0, eq), eq == std::string::npos ? "1" : d.substr(eq + 1));
        }
        options.dialect = a->dialect;
        const auto plugins = std::make_shared<rsl::PluginLibrary>();
        if (a->allowExec)
            options.plugin = [plugins, paths = options.includePaths](const std::string& name, const std::string& folder,
                                                                     rsl::Raised& why, std::string& hint) {
                std::vector<std::string> all{folder};
                all.insert(all.end(), paths.begin(), paths.end());
                return plugins->load(name, all, why, hint);
            };
        LanguageServer server(std::move(options));
        *status = serve(server);
    });
}

} // namespace alpenglow::cli
