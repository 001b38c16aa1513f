// The page of a view, and its requests: pixels, figures, settings.
#pragma once
#include "view/httpserver.h"
#include "view/session.h"

namespace alpenglow::view {

/// Answers requests with the token that come to this port under a name of this machine; rejects all others.
class ViewServer {
public:
    /// token: the secret that each request must have. Session and server must outlive this.
    ViewServer(Session&, HttpServer&, std::string token);
    /// HttpServer::Handler.
    std::optional<HttpResponse> answer(const HttpRequest&, bool last, bool* known);
    /// For the browser.
    std::string address() const;

private:
    std::optional<HttpResponse> picture(const HttpRequest&, bool last);
    HttpResponse pixel(const HttpRequest&);
    HttpResponse act(const HttpRequest&);
    bool isOurs(const std::string& host) const;

    Session& session_;
    const int port_;
    const std::string token_;
};

} // namespace alpenglow::view
