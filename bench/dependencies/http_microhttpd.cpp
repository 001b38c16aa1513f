// The server of src/view/httpserver.h written with libmicrohttpd. run.sh builds the tests of tests/view/http_test.cpp with it.
#include "view/httpserver.h"
#include <arpa/inet.h>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <list>
#include <microhttpd.h>
#include <mutex>
#include <thread>
#include <unistd.h>
#include <utility>

namespace alpenglow::view {

/// Timeouts are whole seconds, and of a connection: one for requests, idle connections and answers. Connections over the limit
/// are closed; the library offers no way to close another one instead.
struct HttpServer::Loop {
    struct Request {
        HttpRequest request;
        size_t body = 0;
        bool begun = false, known = false, waiting = false;
        std::chrono::steady_clock::time_point since;
        MHD_Connection* connection = nullptr;
    };
    HttpLimits limits;
    Handler handler;
    int socket = -1;
    MHD_Daemon* daemon = nullptr;
    std::mutex mutex;
    std::list<Request*> waiting; ///< under the mutex

    static MHD_Result send(MHD_Connection* c, const HttpResponse& r, bool close = false) {
        MHD_Response* m = MHD_create_response_from_buffer(r.body.size(), const_cast<char*>(r.body.data()), MHD_RESPMEM_MUST_COPY);
        MHD_add_response_header(m, "Content-Type", r.type.c_str());
        MHD_add_response_header(m, "Cache-Control", "no-store");
        if (close) MHD_add_response_header(m, "Connection", "close");
        const MHD_Result done = MHD_queue_response(c, unsigned(r.status), m);
        MHD_destroy_response(m);
        return done;
    }
    static MHD_Result ask(void* self, MHD_Connection* c, const char* url, const char* method, const char*, const char* data,
                          size_t* size, void** state) {
        auto& loop = *static_cast<Loop*>(self);
        auto*& r = reinterpret_cast<Request*&>(*state);
        if (!r) {
            r = new Request;
            return MHD_YES;
        }
        const bool first = !std::exchange(r->begun, true);
        if (first) {
            if (url[0] != '/') return send(c, {400, "text/plain", "This is no request of HTTP/1.\n"}, true);
            if (std::strcmp(method, "GET") != 0 && std::strcmp(method, "POST") != 0)
                return send(c, {405, "text/plain", "Only GET and POST are known.\n"}, true);
            if (MHD_lookup_connection_value(c, MHD_HEADER_KIND, "Transfer-Encoding"))
                return send(c, {411, "text/plain", "A request needs Content-Length.\n"}, true);
            const char* length = MHD_lookup_connection_value(c, MHD_HEADER_KIND, "Content-Length");
            if (length && std::strtoull(length, nullptr, 10) > loop.limits.bodyBytes)
                return send(c, {413, "text/plain", "The request is too long.\n"}, true);
            const auto header = [c](const char* name) {
                const char* v = MHD_lookup_connection_value(c, MHD_HEADER_KIND, name);
                return std::string(v ? v : "");
            };
            r->request.method = method;
            r->request.path = url;
            r->request.host = header("Host");
            r->request.origin = header("Origin");
            MHD_get_connection_values(c, MHD_GET_ARGUMENT_KIND, &argument, &r->request.arguments);
        }
        if (*size > 0) {
            r->request.body.append(data, *size);
            *size = 0;
            return MHD_YES;
        }
        const bool last =
            r->waiting && std::chrono::steady_clock::now() - r->since > std::chrono::duration<double>(loop.limits.waitSeconds);
        std::optional<HttpResponse> answer;
        try {
            answer = loop.handler(r->request, last, &r->known);
        } catch (const std::exception&) { return send(c, {503, "text/plain", "There is no memory for this.\n"}, true); }
        if (answer) return send(c, *answer);
        const std::unique_lock lock(loop.mutex);
        if (!std::exchange(r->waiting, true)) r->since = std::chrono::steady_clock::now();
        r->connection = c;
        loop.waiting.push_back(r);
        MHD_suspend_connection(c);
        return MHD_YES;
    }
    static MHD_Result argument(void* all, MHD_ValueKind, const char* key, const char* value) {
        (*static_cast<std::map<std::string, std::string>*>(all))[key] = value ? value : "";
        return MHD_YES;
    }
    static void over(void* self, MHD_Connection*, void** state, MHD_RequestTerminationCode) {
        auto& loop = *static_cast<Loop*>(self);
        const std::unique_lock lock(loop.mutex);
        loop.waiting.remove(static_cast<Request*>(*state));
        delete static_cast<Request*>(*state);
        *state = nullptr;
    }
    /// As sent: nothing is decoded.
    static size_t asSent(void*, MHD_Connection*, char* text) { return std::strlen(text); }
    void resume() {
        const std::unique_lock lock(mutex);
        for (Request* r : waiting) MHD_resume_connection(r->connection);
        waiting.clear();
    }
};

std::unique_ptr<HttpServer> HttpServer::listen(int port, std::string* fault, HttpLimits limits) {
    std::unique_ptr<HttpServer> s(new HttpServer);
    s->loop_ = std::make_unique<Loop>();
    Loop& l = *s->loop_;
    l.limits = limits;
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_port = htons(uint16_t(port));
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    l.daemon =
        MHD_start_daemon(MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME | MHD_USE_ITC, uint16_t(port), nullptr, nullptr,
                         &Loop::ask, &l, MHD_OPTION_SOCK_ADDR, &here, MHD_OPTION_CONNECTION_LIMIT, unsigned(limits.connections),
                         MHD_OPTION_CONNECTION_MEMORY_LIMIT, limits.headerBytes + 4096, MHD_OPTION_CONNECTION_TIMEOUT,
                         unsigned(std::ceil(limits.requestSeconds)), MHD_OPTION_NOTIFY_COMPLETED, &Loop::over, &l,
                         MHD_OPTION_UNESCAPE_CALLBACK, &Loop::asSent, nullptr, MHD_OPTION_END);
    if (!l.daemon) {
        *fault = "port " + std::to_string(port) + " of 127.0.0.1 is in use by another program";
        return nullptr;
    }
    s->port_ = MHD_get_daemon_info(l.daemon, MHD_DAEMON_INFO_BIND_PORT)->port;
    return s;
}

void HttpServer::start(Handler handler) { loop_->handler = std::move(handler); }
void HttpServer::wake() { loop_->resume(); }
HttpServer::~HttpServer() { stop(); }

void HttpServer::stop() {
    if (!loop_ || !loop_->daemon) return;
    loop_->resume();
    MHD_stop_daemon(loop_->daemon);
    loop_->daemon = nullptr;
}

} // namespace alpenglow::view
