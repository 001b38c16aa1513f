// A small HTTP/1.1 server for the page of a view: one thread, 127.0.0.1 only, bounded in everything that a stranger can send.
// Boost.Beast parses the requests. Why not its connections, too: docs/design/dependencies.md.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace alpenglow::view {

/// A request of a client.
struct HttpRequest {
    std::string method;                           ///< "GET" or "POST"
    std::string path;                             ///< the part before ?, not decoded
    std::map<std::string, std::string> arguments; ///< behind ?, decoded
    std::string body;                             ///< at most HttpLimits::bodyBytes
    std::string host, origin;                     ///< headers; "" when missing
};

/// What a client gets.
struct HttpResponse {
    int status = 200;                               ///< HTTP status code
    std::string type = "text/plain; charset=utf-8"; ///< media type
    std::string body;                               ///< bytes
};

/// Limits on the resources that clients can use.
struct HttpLimits {
    size_t connections = 64;    ///< open connections; a further one replaces the oldest without a known request
    size_t headerBytes = 16384; ///< of request line and headers
    size_t bodyBytes = 1 << 16; ///< of a request
    double requestSeconds = 10; ///< from a request's first byte to its last
    double idleSeconds = 120;   ///< between two requests
    double stallSeconds = 5;    ///< time in which a client accepts no data
    double writeSeconds = 60;   ///< for an answer to be taken
    double waitSeconds = 15;    ///< that an answer may be put off
};

/// The server. It stops when it is destroyed.
class HttpServer {
public:
    /// Runs on the server's thread. Returns nothing if there is no response yet; called again after wake(), and with `last` at
    /// the deadline, when it must respond. *known: set for requests with permission.
    using Handler = std::function<std::optional<HttpResponse>(const HttpRequest&, bool last, bool* known)>;

    /// Listens on 127.0.0.1; port 0: any free port. Returns null after an error, with *fault.
    static std::unique_ptr<HttpServer> listen(int port, std::string* fault, HttpLimits = {});
    ~HttpServer();
    /// That it listens on.
    int port() const { return port_; }
    /// Begins to answer. Once.
    void start(Handler);
    /// Answers no more; the handler is not called again.
    void stop();
    /// From any thread: postponed requests may have a response now.
    void wake();

private:
    struct Loop;
    HttpServer() = default;
    int port_ = 0;
    std::unique_ptr<Loop> loop_;
};

/// 32 unpredictable hexadecimal digits.
std::string randomToken();
/// Compares without telling by its time where the difference is.
bool sameText(const std::string&, const std::string&);

} // namespace alpenglow::view
