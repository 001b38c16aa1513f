#include "view/httpserver.h"
#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <atomic>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <list>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace alpenglow::view {
namespace {

namespace http = boost::beast::http;
using Parser = http::request_parser<http::string_body>;

double secondsNow() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::string text(boost::beast::string_view s) { return {s.data(), s.size()}; }

std::string headOf(const HttpResponse& r, bool close) {
    return "HTTP/1.1 " + std::to_string(r.status) + " " + text(http::obsolete_reason(http::status(r.status))) +
           "\r\nContent-Type: " + r.type + "\r\nContent-Length: " + std::to_string(r.body.size()) +
           "\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\nReferrer-Policy: "
           "no-referrer\r\n"
           "Cross-Origin-Resource-Policy: same-origin\r\nContent-Security-Policy: default-src 'none'; script-src 'self'; "
           "style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action "
           "'none'; "
           "frame-ancestors 'none'\r\n" +
           (close ? "Connection: close\r\n\r\n" : "\r\n");
}

int hexDigit(char c) {
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string decoded(const std::string& s) {
    std::string t;
    for (size_t i = 0; i < s.size(); ++i) {
        if (s[i] == '%' && i + 2 < s.size() && hexDigit(s[i + 1]) >= 0 && hexDigit(s[i + 2]) >= 0) {
            t += char(hexDigit(s[i + 1]) * 16 + hexDigit(s[i + 2]));
            i += 2;
        } else t += s[i] == '+' ? ' ' : s[i];
    }
    return t;
}

std::map<std::string, std::string> argumentsOf(const std::string& query) {
    std::map<std::string, std::string> all;
    for (size_t at = 0; at < query.size();) {
        const size_t end = std::min(query.find('&', at), query.size());
        const std::string one = query.substr(at, end - at);
        const size_t equals = one.find('=');
        all[decoded(one.substr(0, equals))] = equals == one.npos ? "" : decoded(one.substr(equals + 1));
        at = end + 1;
    }
    return all;
}

HttpRequest requestOf(Parser::value_type&& m) {
    HttpRequest r;
    r.method = text(m.method_string());
    const std::string target = text(m.target());
    const size_t query = target.find('?');
    r.path = target.substr(0, query);
    if (query != target.npos) r.arguments = argumentsOf(target.substr(query + 1));
    r.host = text(m[http::field::host]);
    r.origin = text(m[http::field::origin]);
    r.body = std::move(m.body());
    return r;
}

HttpResponse refusal(int status, const char* why) { return {status, "text/plain; charset=utf-8", why}; }

/// Whether the parser refused a Content-Length because it is too large a number. The parser has one code for all it refuses.
bool lengthIsHuge(std::string_view head) {
    const std::string_view name = "content-length:";
    const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
    const auto at = std::search(head.begin(), head.end(), name.begin(), name.end(), same);
    const std::string_view value = head.substr(std::min(size_t(at - head.begin()) + name.size(), head.size()));
    const size_t first = std::min(value.find_first_not_of(" \t"), value.size());
    const size_t end = std::min(value.find_first_not_of("0123456789", first), value.size());
    return end - first > 9;
}

/// The answer to bytes that are no request.
HttpResponse refusalOf(const boost::system::error_code& e, std::string_view head) {
    if (e == http::error::header_limit) return refusal(431, "The headers are too long.\n");
    if (e == http::error::body_limit || (e == http::error::bad_content_length && lengthIsHuge(head)))
        return refusal(413, "The request is too long.\n");
    if (e == http::error::bad_content_length) return refusal(400, "Content-Length is invalid.\n");
    return refusal(400, "This is not an HTTP/1 request.\n");
}

/// The response to a request that its headers disqualify; otherwise nothing.
std::optional<HttpResponse> refusalOf(const Parser& p) {
    const auto& m = p.get();
    if (m.target().empty() || m.target()[0] != '/') return refusal(400, "This is not an HTTP/1 request.\n");
    if (m.method() != http::verb::get && m.method() != http::verb::post)
        return refusal(405, "Only GET and POST are supported.\n");
    for (const http::field f : {http::field::host, http::field::origin}) // ambiguous between proxy and browser
        if (m.count(f) > 1) return refusal(400, "Host and Origin may be given once.\n");
    if (p.chunked()) return refusal(411, "A request needs Content-Length.\n");
    return {};
}

/// Draining: the last response is written; discards further input, so that closing does not abort the response.
enum class State { Reading, Waiting, Writing, Draining };
constexpr double kDrainSeconds = 1;
constexpr size_t kDrainBytes = 1 << 18;

struct Connection {
    int fd = -1;
    State state = State::Reading;
    std::string in, out;
    size_t written = 0;
    std::optional<Parser> parser; ///< for the incoming request
    HttpRequest request;
    bool close = false, known = false;
    double since = 0;   ///< start of its state, or of its request
    double taken = 0;   ///< when a part of the answer was last taken
    bool begun = false; ///< a byte of the request has arrived
    ~Connection() {
        if (fd >= 0) ::close(fd);
    }
};

} // namespace

struct HttpServer::Loop {
    HttpLimits limits;
    Handler handler;
    int listener = -1, waker = -1;
    std::atomic<bool> end{false};
    std::list<Connection> connections; ///< the oldest first
    std::thread thread;

    ~Loop() {
        if (listener >= 0) ::close(listener);
        if (waker >= 0) ::close(waker);
    }
    void run();
    void accept();
    bool serve(Connection&, short events); ///< false: it is over
    bool read(Connection&);
    bool write(Connection&);
    bool advance(Connection&);
    void answer(Connection&, HttpResponse, bool close);
    bool ask(Connection&, bool last);
    bool timeOut(Connection&, double t);
    int patience(double t) const;
};

/// Milliseconds until something has to be done about time.
int HttpServer::Loop::patience(double t) const {
    double least = 60;
    for (const Connection& c : connections) {
        const double s = c.state == State::Waiting    ? limits.waitSeconds
                         : c.state == State::Writing  ? std::min(limits.writeSeconds, c.taken - c.since + limits.stallSeconds)
                         : c.state == State::Draining ? kDrainSeconds
                         : c.begun                    ? limits.requestSeconds
                                                      : limits.idleSeconds;
        least = std::min(least, c.since + s - t);
    }
    return std::max(1, int(least * 1000) + 1);
}

void HttpServer::Loop::run() {
    std::vector<pollfd> fds;
    while (!end) {
        fds.assign({{listener, POLLIN, 0}, {waker, POLLIN, 0}});
        for (const Connection& c : connections)
            fds.push_back({c.fd, short(c.state == State::Writing ? POLLOUT : c.state == State::Waiting ? POLLRDHUP : POLLIN), 0});
        if (::poll(fds.data(), fds.size(), patience(secondsNow())) < 0 && errno != EINTR) return;
        bool woken = false;
        if (fds[1].revents) {
            uint64_t n;
            woken = ::read(waker, &n, sizeof n) > 0;
        }
        const double t = secondsNow();
        size_t i = 2;
        for (auto c = connections.begin(); c != connections.end(); ++i) {
            bool stays = !fds[i].revents || serve(*c, fds[i].revents);
            if (stays && woken && c->state == State::Waiting) stays = ask(*c, false);
            if (stays) stays = timeOut(*c, t);
            c = stays ? std::next(c) : connections.erase(c);
        }
        if (fds[0].revents) accept();
    }
}

void HttpServer::Loop::accept() {
    for (int n = 0; n < 64; ++n) { // then handles existing connections
        const int fd = ::accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (fd < 0) {
            const bool full = errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM;
            if (full) ::poll(nullptr, 0, 50); // it stays ready
            return;
        }
        if (connections.size() >= limits.connections) {
            auto oldest = std::find_if(connections.begin(), connections.end(), [](const Connection& c) { return !c.known; });
            if (oldest == connections.end())
                oldest = std::find_if(connections.begin(), connections.end(),
                                      [](const Connection& c) { return c.state == State::Reading && !c.begun; });
            if (oldest == connections.end()) {
                const HttpResponse r = refusal(503, "Too many viewers.\n");
                const std::string text = headOf(r, true) + r.body;
                [[maybe_unused]] ssize_t k = ::send(fd, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
                ::close(fd);
                continue;
            }
            connections.erase(oldest);
        }
        const int one = 1;
        setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
        Connection& c = connections.emplace_back();
        c.fd = fd;
        c.since = secondsNow();
    }
}

bool HttpServer::Loop::serve(Connection& c, short events) {
    if (events & (POLLERR | POLLNVAL)) return false;
    if (c.state == State::Writing) return (events & POLLHUP) ? false : write(c);
    if (c.state == State::Waiting) return !(events & (POLLHUP | POLLRDHUP)); // the browser went away
    return read(c);
}

bool HttpServer::Loop::read(Connection& c) {
    std::array<char, 16384> piece;
    const ssize_t n = ::recv(c.fd, piece.data(), piece.size(), 0);
    if (n < 0) return errno == EAGAIN || errno == EINTR;
    if (n == 0) return false;
    if (c.state == State::Draining) return (c.written += size_t(n)) < kDrainBytes;
    if (!c.begun) c.since = secondsNow();
    c.begun = true;
    c.in.append(piece.data(), size_t(n));
    return advance(c);
}

void HttpServer::Loop::answer(Connection& c, HttpResponse r, bool close) {
    c.close |= close;
    c.out = headOf(r, c.close) + std::move(r.body);
    c.written = 0;
    c.state = State::Writing;
    c.since = c.taken = secondsNow();
}

/// Takes a complete request out of the input.
bool HttpServer::Loop::advance(Connection& c) {
    if (c.state != State::Reading) return true;
    if (!c.parser) {
        c.parser.emplace();
        c.parser->header_limit(uint32_t(limits.headerBytes));
        c.parser->body_limit(limits.bodyBytes);
    }
    while (!c.parser->is_done()) { // headers, then body
        if (c.in.empty()) return true;
        const bool headers = !c.parser->is_header_done();
        boost::system::error_code fault;
        const size_t taken = c.parser->put(boost::asio::const_buffer(c.in.data(), c.in.size()), fault);
        if (fault == http::error::need_more) {
            c.in.erase(0, taken);
            return true;
        }
        std::optional<HttpResponse> refused;
        if (fault) refused = refusalOf(fault, c.in);
        else if (headers && c.parser->is_header_done()) refused = refusalOf(*c.parser);
        if (refused) {
            answer(c, std::move(*refused), true);
            return write(c);
        }
        c.in.erase(0, taken);
    }
    c.close |= !c.parser->keep_alive();
    c.request = requestOf(c.parser->release());
    c.parser.reset();
    c.begun = false;
    c.since = secondsNow();
    return ask(c, false);
}

bool HttpServer::Loop::ask(Connection& c, bool last) {
    std::optional<HttpResponse> r;
    try {
        r = handler(c.request, last, &c.known);
    } catch (const std::exception&) { // out of memory for the response
        answer(c, refusal(503, "Out of memory.\n"), true);
        return write(c);
    }
    if (r) {
        answer(c, std::move(*r), false);
        return write(c);
    }
    c.state = State::Waiting;
    return true;
}

bool HttpServer::Loop::write(Connection& c) {
    while (c.written < c.out.size()) {
        const ssize_t n = ::send(c.fd, c.out.data() + c.written, c.out.size() - c.written, MSG_NOSIGNAL);
        if (n < 0) return errno == EAGAIN || errno == EINTR;
        c.written += size_t(n);
        c.taken = secondsNow();
    }
    std::string().swap(c.out);
    if (c.close) {
        ::shutdown(c.fd, SHUT_WR);
        std::string().swap(c.in);
        c.state = State::Draining;
        c.written = 0;
        c.since = secondsNow();
        return true;
    }
    c.state = State::Reading;
    c.since = secondsNow();
    c.begun = !c.in.empty();
    return c.in.empty() || advance(c);
}

bool HttpServer::Loop::timeOut(Connection& c, double t) {
    const double spent = t - c.since;
    switch (c.state) {
    case State::Waiting:
        return spent < limits.waitSeconds || ask(c, true);
    case State::Writing:
        return spent < limits.writeSeconds && t - c.taken < limits.stallSeconds;
    case State::Draining:
        return spent < kDrainSeconds;
    case State::Reading:
        if (!c.begun) return spent < limits.idleSeconds;
        if (spent < limits.requestSeconds) return true;
        answer(c, refusal(408, "The request took too long.\n"), true);
        return write(c);
    }
    return true;
}

std::unique_ptr<HttpServer> HttpServer::listen(int port, std::string* fault, HttpLimits limits) {
    std::unique_ptr<HttpServer> s(new HttpServer);
    s->loop_ = std::make_unique<Loop>();
    Loop& l = *s->loop_;
    l.limits = limits;
    l.listener = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    l.waker = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    const int one = 1;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (l.listener >= 0) setsockopt(l.listener, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one);
    if (l.listener < 0 || l.waker < 0 || ::bind(l.listener, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(l.listener, 128) != 0 || ::getsockname(l.listener, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
        *fault = errno == EADDRINUSE ? "port " + std::to_string(port) + " of 127.0.0.1 is in use by another program"
                 : errno == EACCES   ? "port " + std::to_string(port) + " may not be used"
                                     : std::string("no socket can be opened: ") + std::strerror(errno);
        return nullptr;
    }
    s->port_ = ntohs(address.sin_port);
    return s;
}

void HttpServer::start(Handler handler) {
    loop_->handler = std::move(handler);
    loop_->thread = std::thread([l = loop_.get()] { l->run(); });
}

void HttpServer::wake() {
    const uint64_t one = 1;
    [[maybe_unused]] ssize_t n = ::write(loop_->waker, &one, sizeof one);
}

HttpServer::~HttpServer() { stop(); }

void HttpServer::stop() {
    if (!loop_ || !loop_->thread.joinable()) return;
    loop_->end = true;
    wake();
    loop_->thread.join();
}

} // namespace alpenglow::view
