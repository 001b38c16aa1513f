// The page of a view, and what it asks for: pixels, figures, switches.
#pragma once
#include "view/httpserver.h"
#include "view/session.h"

namespace alpenglow::view {

/// Answers requests that name the token and come to this port under a name of this machine. Everything else is refused in a line.
class ViewServer {
public:
    ViewServer(Session&, HttpServer&, std::string token);
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
