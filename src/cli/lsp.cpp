// alpenglow lsp: the language server on standard input and output.
#include "base/limits.h"
#include "cli/command.h"
#include "cli/languageserver.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <memory>
#include <poll.h>
#include <unistd.h>

namespace alpenglow::cli {
namespace {

/// Cuts standard input into messages: headers, an empty line, as many bytes as Content-Length says.
class Input {
public:
    enum class Kind { Message, Garbage, TooLong, End };

    Kind next(std::string& body) {
        size_t length = 0;
        bool known = false;
        for (;;) {
            std::string line;
            if (!readLine(line)) return Kind::End;
            if (line.empty()) {
                if (known) break;
                continue; // empty lines between messages do no harm
            }
            constexpr std::string_view kName = "content-length:";
            if (line.size() < kName.size()) continue;
            std::string name = line.substr(0, kName.size());
            for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
            if (name != kName) continue;
            size_t a = line.find_first_not_of(' ', kName.size());
            if (a == std::string::npos) a = line.size();
            const auto [end, code] = std::from_chars(line.data() + a, line.data() + line.size(), length);
            if (code != std::errc() || end != line.data() + line.size()) return Kind::Garbage;
            known = true;
        }
        if (length > limits::kServerMessage) {
            while (length > 0) {
                if (at_ == buffer_.size() && !fill()) return Kind::End;
                const size_t n = std::min(length, buffer_.size() - at_);
                at_ += n;
                length -= n;
            }
            return Kind::TooLong;
        }
        body.clear();
        while (body.size() < length) {
            if (at_ == buffer_.size() && !fill()) return Kind::End;
            const size_t n = std::min(length - body.size(), buffer_.size() - at_);
            body.append(buffer_, at_, n);
            at_ += n;
        }
        return Kind::Message;
    }

    /// Would next() find bytes at once?
    bool waiting() const {
        if (at_ < buffer_.size()) return true;
        pollfd p{STDIN_FILENO, POLLIN, 0};
        return poll(&p, 1, 0) > 0 && (p.revents & POLLIN);
    }

private:
    bool readLine(std::string& line) {
        line.clear();
        for (;;) {
            if (at_ == buffer_.size() && !fill()) return false;
            const char c = buffer_[at_++];
            if (c == '\n') break;
            if (line.size() < limits::kTokenBytes) line += c;
        }
        if (!line.empty() && line.back() == '\r') line.pop_back();
        return true;
    }
    bool fill() {
        buffer_.resize(1 << 16);
        at_ = 0;
        ssize_t n;
        do n = read(STDIN_FILENO, buffer_.data(), buffer_.size());
        while (n < 0 && errno == EINTR);
        buffer_.resize(n > 0 ? size_t(n) : 0);
        return n > 0;
    }
    std::string buffer_;
    size_t at_ = 0;
};

bool send(const nlohmann::json& message) {
    const std::string s = message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    std::printf("Content-Length: %zu\r\n\r\n", s.size());
    std::fwrite(s.data(), 1, s.size(), stdout);
    return std::fflush(stdout) == 0;
}

int serve(LanguageServer& server) {
    std::signal(SIGPIPE, SIG_IGN); // an editor that is gone shows as a failed write
    Input input;
    std::string body;
    bool open = true;
    const auto sendAll = [&](const std::vector<nlohmann::json>& list) {
        for (const auto& m : list) open = open && send(m);
    };
    while (open && !server.ended()) {
        switch (input.next(body)) {
        case Input::Kind::End: return server.status();
        case Input::Kind::Garbage:
            open = send(LanguageServer::error(nullptr, -32700, "Content-Length is not a number"));
            continue;
        case Input::Kind::TooLong:
            open = send(LanguageServer::error(nullptr, -32600, "a message of more than " +
                                                                   std::to_string(limits::kServerMessage) + " bytes"));
            continue;
        case Input::Kind::Message: break;
        }
        const auto message = nlohmann::json::parse(body, nullptr, false);
        if (message.is_discarded()) {
            open = send(LanguageServer::error(nullptr, -32700, "this is not JSON"));
            continue;
        }
        sendAll(server.handle(message));
        // While messages wait, what the text is now is not what the user sees last.
        if (!input.waiting()) sendAll(server.publish());
    }
    sendAll(server.publish());
    return open ? server.status() : int(kOutputFailed);
}

} // namespace

void addLsp(CLI::App& app, int* status) {
    struct Arguments {
        std::vector<std::string> searchPaths, defines;
        std::string dialect;
        bool stdio = true;
    };
    auto a = std::make_shared<Arguments>();
    CLI::App* c = app.add_subcommand("lsp", "Language server for editors, over standard input and output");
    c->add_option("-I,--searchpath", a->searchPaths, "Folders for #include, separated by :")
        ->type_name("DIRS")
        ->allow_extra_args(false);
    c->add_option("-D", a->defines, "Define a macro")->type_name("NAME[=TEXT]")->allow_extra_args(false);
    addDialect(*c, a->dialect);
    c->add_flag("--stdio", a->stdio, "Standard input and output, as always; some editors insist on saying so");
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
        LanguageServer server(std::move(options));
        *status = serve(server);
    });
}

} // namespace alpenglow::cli
