#include "view/viewserver.h"
#include "view/page.h"
#include <charconv>
#include <cstring>

namespace alpenglow::view {
namespace {

using Json = nlohmann::json;

HttpResponse refused(int status, std::string text) { return {status, "text/plain; charset=utf-8", std::move(text)}; }

std::string textOf(const Json& j) { return j.dump(-1, ' ', false, Json::error_handler_t::replace); }

HttpResponse json(const Json& j) { return {200, "application/json", textOf(j)}; }

uint64_t number(const HttpRequest& r, const char* name) {
    const auto i = r.arguments.find(name);
    uint64_t n = 0;
    if (i != r.arguments.end()) std::from_chars(i->second.data(), i->second.data() + i->second.size(), n);
    return n;
}

std::string word(const HttpRequest& r, const char* name) {
    const auto i = r.arguments.find(name);
    return i == r.arguments.end() ? "" : i->second;
}

} // namespace

ViewServer::ViewServer(Session& s, HttpServer& h, std::string token) : session_(s), port_(h.port()), token_(std::move(token)) {}

std::string ViewServer::address() const { return "http://127.0.0.1:" + std::to_string(port_) + "/" + token_ + "/"; }

/// Whether a host name refers to this machine: another could be a foreign page whose name was pointed here (DNS rebinding).
bool ViewServer::isOurs(const std::string& host) const {
    const std::string port = ":" + std::to_string(port_);
    return host == "127.0.0.1" + port || host == "localhost" + port;
}

std::optional<HttpResponse> ViewServer::answer(const HttpRequest& r, bool last, bool* known) {
    if (!isOurs(r.host)) return refused(403, "This server is for 127.0.0.1 only.\n");
    if (!r.origin.empty() && (!r.origin.starts_with("http://") || !isOurs(r.origin.substr(7))))
        return refused(403, "Requests from other sites are rejected.\n");
    const size_t end = r.path.find('/', 1);
    if (end == r.path.npos || !sameText(r.path.substr(1, end - 1), token_))
        return refused(403, "The address needs the token that alpenglow view has printed.\n");
    *known = true;
    const std::string name = r.path.substr(end + 1);
    if (r.method == "POST") return name == "do" ? act(r) : refused(404, "Not found.\n");
    if (name == "picture") return picture(r, last);
    if (name == "pixel") return pixel(r);
    if (name == "scene") return json(session_.scene());
    if (const PageFile* f = pageFile(name.empty() ? "index.html" : name))
        return HttpResponse{200, f->type, std::string(f->text, f->size)};
    return refused(404, "Not found.\n");
}

/// The bytes of a text, little-endian count first, and the pixels behind it.
std::optional<HttpResponse> ViewServer::picture(const HttpRequest& r, bool last) {
    const std::string plane = word(r, "plane").empty() ? "picture" : word(r, "plane").substr(0, 200);
    const Session::Shot shot = session_.look(plane);
    if (!last && shot.serial <= number(r, "have")) return {};
    Json state = session_.state(size_t(number(r, "messages")), size_t(number(r, "points")));
    std::string pixels;
    if (shot.picture) {
        const Picture& p = *shot.picture;
        const Plane* there = p.plane(plane);
        const Plane& shown = there ? *there : p.planes.front();
        // Who has them, and only figures are new, need not get them again.
        const auto tag =
            std::to_string(p.number) + "." + std::to_string(std::hash<std::string>()(textOf(Json(shot.dim)))) + "." + shown.name;
        if (word(r, "tag") != tag) pixels = halves(p, shown, shot.dim);
        state["tag"] = tag;
        Json names = Json::array();
        for (const Plane& q : p.planes) names.push_back(q.name);
        state["picture"] = {{"width", p.width},
                            {"height", p.height},
                            {"stepX", p.stepX},
                            {"stepY", p.stepY},
                            {"x0", p.window.x0},
                            {"y0", p.window.y0},
                            {"w", shown.image->width},
                            {"h", shown.image->height},
                            {"plane", shown.name},
                            {"planes", names},
                            {"channels", shown.image->channels},
                            {"pixels", !pixels.empty()}};
    }
    state["serial"] = shot.serial;
    std::string text = textOf(state);
    text.resize((text.size() + 7) / 8 * 8 + 4, ' '); // aligns pixels to eight bytes
    std::string body(4, '\0');
    const uint32_t n = uint32_t(text.size());
    for (int k = 0; k < 4; ++k) body[size_t(k)] = char(n >> 8 * k);
    return HttpResponse{200, "application/octet-stream", body + text + pixels};
}

HttpResponse ViewServer::pixel(const HttpRequest& r) {
    const Session::Shot shot = session_.look(word(r, "plane").empty() ? "picture" : word(r, "plane").substr(0, 200));
    Json j{{"x", number(r, "x")}, {"y", number(r, "y")}};
    if (!shot.picture) return json(j);
    const Picture& p = *shot.picture;
    const int x = int(double(number(r, "x") & 0xfffff) / p.stepX) - p.window.x0,
              y = int(double(number(r, "y") & 0xfffff) / p.stepY) - p.window.y0;
    Json& values = j["values"] = Json::object();
    for (const Plane& q : p.planes) {
        const display::Image& image = *q.image;
        if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
        for (size_t k = 0; k < image.channels.size(); ++k)
            values[q.name + "/" + image.channels[k]] = double(image.pixel(x, y)[k]);
    }
    return json(j);
}

HttpResponse ViewServer::act(const HttpRequest& r) {
    const Json j = Json::parse(r.body, nullptr, false);
    if (j.is_discarded()) return refused(400, "This is no JSON.\n");
    return json(session_.act(j));
}

} // namespace alpenglow::view
