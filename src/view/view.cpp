#include "view/view.h"
#include "view/viewserver.h"
#include <chrono>
#include <thread>

namespace alpenglow::view {

ViewEnd view(ViewOptions options, int port, const StopFlag* stop, const std::function<void(const std::string&)>& announce,
             std::string* fault) {
    const bool watch = options.watch;
    options.settings.stop = stop;
    const std::unique_ptr<HttpServer> http = HttpServer::listen(port, fault);
    if (!http) return ViewEnd::PortTaken;
    Session session(std::move(options), [&] { http->wake(); });
    ViewServer server(session, *http, randomToken());
    // A scene that cannot be read may be mended while it is watched.
    if (!session.load() && !watch && !*stop) return ViewEnd::NoScene;
    if (*stop) return ViewEnd::Done;
    session.start();
    http->start([&](const HttpRequest& r, bool last, bool* known) { return server.answer(r, last, known); });
    announce(server.address());
    while (!*stop) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    http->stop();
    return ViewEnd::Done;
}

} // namespace alpenglow::view
