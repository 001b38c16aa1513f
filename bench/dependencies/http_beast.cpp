// The server of src/view/httpserver.h written with Boost.Beast. run.sh builds the tests of tests/view/http_test.cpp with it.
#include "view/httpserver.h"
#include <algorithm>
#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <charconv>
#include <list>
#include <thread>

namespace alpenglow::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using Fault = boost::system::error_code;
using Parser = http::request_parser<http::string_body>;
using Response = http::response<http::string_body>;

std::string decoded(beast::string_view s) {
    std::string t;
    for (size_t i = 0; i < s.size(); ++i) {
        int byte = 0;
        const bool coded = s[i] == '%' && i + 2 < s.size() &&
                           std::from_chars(s.data() + i + 1, s.data() + i + 3, byte, 16).ptr == s.data() + i + 3;
        t += coded ? char(byte) : s[i] == '+' ? ' ' : s[i];
        i += coded ? 2 : 0;
    }
    return t;
}

HttpRequest requestOf(const http::request<http::string_body>& m) {
    HttpRequest r;
    r.method = std::string(m.method_string());
    const beast::string_view target = m.target();
    const size_t question = std::min(target.find('?'), target.size());
    r.path = std::string(target.substr(0, question));
    for (size_t at = question + 1; at < target.size();) {
        const size_t end = std::min(target.find('&', at), target.size());
        const beast::string_view one = target.substr(at, end - at);
        const size_t equals = std::min(one.find('='), one.size());
        r.arguments[decoded(one.substr(0, equals))] = equals == one.size() ? "" : decoded(one.substr(equals + 1));
        at = end + 1;
    }
    r.body = m.body();
    r.host = std::string(m[http::field::host]);
    r.origin = std::string(m[http::field::origin]);
    return r;
}

} // namespace

struct HttpServer::Loop {
    struct Session;
    using Sessions = std::list<std::shared_ptr<Session>>;

    HttpLimits limits;
    Handler handler;
    asio::io_context io{1};
    tcp::acceptor acceptor{io};
    Sessions sessions; ///< the oldest first
    std::thread thread;

    void accept();
    bool makeRoom();
};

struct HttpServer::Loop::Session : std::enable_shared_from_this<Session> {
    enum class State { Idle, Reading, Waiting, Writing, Draining };
    Loop& loop;
    tcp::socket socket;
    asio::steady_timer timer{loop.io};
    beast::flat_buffer buffer{loop.limits.headerBytes + loop.limits.bodyBytes + 4096};
    std::optional<Parser> parser;
    Response response;
    HttpRequest request;
    State state = State::Idle;
    bool known = false, close = false, late = false;
    size_t drained = 0;
    Sessions::iterator place;

    Session(Loop& l, tcp::socket s) : loop(l), socket(std::move(s)) {}

    void end() {
        if (!socket.is_open()) return;
        Fault ignored;
        socket.close(ignored);
        timer.cancel(ignored);
        loop.sessions.erase(place);
    }
    /// Until the next limit() nothing may take longer.
    void limit(double seconds) {
        timer.expires_after(std::chrono::microseconds(int64_t(seconds * 1e6)));
        timer.async_wait([self = shared_from_this()](Fault e) {
            if (e || !self->socket.is_open()) return;
            if (self->state == State::Waiting) return self->ask(true);
            if (self->state != State::Reading) return self->end();
            self->late = true; // the read ends with operation_aborted
            self->socket.cancel(e);
        });
    }
    void next() {
        parser.emplace();
        parser->header_limit(uint32_t(loop.limits.headerBytes));
        parser->body_limit(loop.limits.bodyBytes);
        if (buffer.size() > 0) return readHeader();
        state = State::Idle;
        limit(loop.limits.idleSeconds);
        socket.async_read_some(buffer.prepare(4096), [self = shared_from_this()](Fault e, size_t n) {
            if (e) return self->end();
            self->buffer.commit(n);
            self->readHeader();
        });
    }
    void readHeader() {
        state = State::Reading;
        limit(loop.limits.requestSeconds);
        http::async_read_header(socket, buffer, *parser, [self = shared_from_this()](Fault e, size_t) {
            if (e) return self->unreadable(e);
            const auto& m = self->parser->get();
            if (m.target().empty() || m.target()[0] != '/') return self->refuse(400, "This is no request of HTTP/1.\n");
            if (m.method() != http::verb::get && m.method() != http::verb::post)
                return self->refuse(405, "Only GET and POST are known.\n");
            if (self->parser->chunked()) return self->refuse(411, "A request needs Content-Length.\n");
            self->readBody();
        });
    }
    void readBody() {
        http::async_read(socket, buffer, *parser, [self = shared_from_this()](Fault e, size_t) {
            if (e) return self->unreadable(e);
            self->close |= !self->parser->keep_alive();
            self->request = requestOf(self->parser->get());
            self->ask(false);
        });
    }
    void unreadable(Fault e) {
        if (late) return refuse(408, "The request took too long.\n");
        if (e == http::error::end_of_stream || e == http::error::partial_message) return end();
        if (e == http::error::header_limit || e == http::error::buffer_overflow)
            return refuse(431, "The headers are too long.\n");
        if (e == http::error::body_limit || (e == http::error::bad_content_length && lengthIsHuge()))
            return refuse(413, "The request is too long.\n");
        if (e.category() == make_error_code(http::error::bad_method).category())
            return refuse(400, "This is no request of HTTP/1.\n");
        end();
    }
    /// The parser has one fault for a Content-Length that makes no sense and one that is too large a number.
    bool lengthIsHuge() const {
        const std::string all = beast::buffers_to_string(buffer.data()), name = "Content-Length: ";
        const size_t at = all.find(name);
        return at != all.npos && all.find_first_not_of("0123456789", at + name.size()) > at + name.size() + 9;
    }
    void refuse(int status, const char* text) {
        close = true;
        answer({status, "text/plain; charset=utf-8", text});
    }
    void ask(bool last) {
        std::optional<HttpResponse> r;
        try {
            r = loop.handler(request, last, &known);
        } catch (const std::exception&) { return refuse(503, "There is no memory for this.\n"); }
        if (r) return answer(std::move(*r));
        if (state == State::Waiting) return;
        state = State::Waiting;
        limit(loop.limits.waitSeconds);
        // The browser may go away meanwhile; what it sends already belongs to its next request.
        socket.async_read_some(buffer.prepare(4096), [self = shared_from_this()](Fault e, size_t n) {
            if (!e) self->buffer.commit(n);
            else if (e != asio::error::operation_aborted && self->state == State::Waiting) self->end();
        });
    }
    void answer(HttpResponse r) {
        state = State::Writing;
        Fault ignored;
        socket.cancel(ignored);
        limit(loop.limits.writeSeconds);
        response = Response(http::status(r.status), 11, std::move(r.body));
        response.set(http::field::content_type, r.type);
        response.set(http::field::cache_control, "no-store");
        response.set("X-Content-Type-Options", "nosniff");
        response.set("X-Frame-Options", "DENY");
        response.set("Referrer-Policy", "no-referrer");
        response.set("Cross-Origin-Resource-Policy", "same-origin");
        response.set("Content-Security-Policy",
                     "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
                     "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
        response.keep_alive(!close);
        response.prepare_payload();
        http::async_write(socket, response, [self = shared_from_this()](Fault e, size_t) {
            if (e) return self->end();
            self->response = {};
            if (!self->close) return self->next();
            self->socket.shutdown(tcp::socket::shutdown_send, e);
            self->state = State::Draining;
            self->limit(1);
            self->drain();
        });
    }
    /// So that closing does not take the answer back.
    void drain() {
        buffer.clear();
        socket.async_read_some(buffer.prepare(16384), [self = shared_from_this()](Fault e, size_t n) {
            if (e || (self->drained += n) > 1 << 18) return self->end();
            self->drain();
        });
    }
};

/// Ends the oldest connection that may be ended. False: there is none.
bool HttpServer::Loop::makeRoom() {
    auto oldest = std::find_if(sessions.begin(), sessions.end(), [](const auto& s) { return !s->known; });
    if (oldest == sessions.end())
        oldest = std::find_if(sessions.begin(), sessions.end(), [](const auto& s) { return s->state == Session::State::Idle; });
    if (oldest == sessions.end()) return false;
    (*std::shared_ptr<Session>(*oldest)).end();
    return true;
}

void HttpServer::Loop::accept() {
    acceptor.async_accept([this](Fault e, tcp::socket socket) {
        if (e == asio::error::operation_aborted) return;
        if (!e && (sessions.size() < limits.connections || makeRoom())) {
            socket.set_option(tcp::no_delay(true), e);
            sessions.push_back(std::make_shared<Session>(*this, std::move(socket)));
            sessions.back()->place = std::prev(sessions.end());
            sessions.back()->next();
        } else if (!e) {
            Response r(http::status(503), 11, "Too many viewers at a time.\n");
            r.keep_alive(false);
            r.prepare_payload();
            socket.non_blocking(true, e);
            http::write(socket, r, e);
        }
        accept();
    });
}

std::unique_ptr<HttpServer> HttpServer::listen(int port, std::string* fault, HttpLimits limits) {
    std::unique_ptr<HttpServer> s(new HttpServer);
    s->loop_ = std::make_unique<Loop>();
    Loop& l = *s->loop_;
    l.limits = limits;
    Fault e;
    const tcp::endpoint here(asio::ip::address_v4::loopback(), uint16_t(port));
    l.acceptor.open(tcp::v4(), e);
    if (!e) l.acceptor.set_option(asio::socket_base::reuse_address(true), e);
    if (!e) l.acceptor.bind(here, e);
    if (!e) l.acceptor.listen(128, e);
    if (e) {
        *fault = e == asio::error::address_in_use ? "port " + std::to_string(port) + " of 127.0.0.1 is in use by another program"
                                                  : "no socket can be opened: " + e.message();
        return nullptr;
    }
    s->port_ = l.acceptor.local_endpoint().port();
    return s;
}

void HttpServer::start(Handler handler) {
    loop_->handler = std::move(handler);
    loop_->accept();
    loop_->thread = std::thread([l = loop_.get()] { l->io.run(); });
}

void HttpServer::wake() {
    asio::post(loop_->io, [l = loop_.get()] {
        const Loop::Sessions all = l->sessions;
        for (const auto& s : all)
            if (s->state == Loop::Session::State::Waiting) s->ask(false);
    });
}

HttpServer::~HttpServer() { stop(); }

void HttpServer::stop() {
    if (!loop_ || !loop_->thread.joinable()) return;
    loop_->io.stop();
    loop_->thread.join();
}

} // namespace alpenglow::view
