#include "view/preview.h"
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace alpenglow::view {
namespace {

constexpr int kConnectMs = 2000, kSendMs = 5000;
enum Kind : char { kCreateImage = 4, kUpdateImageV3 = 6 };

class Packet {
public:
    explicit Packet(Kind k) : bytes_(4, '\0') { bytes_ += char(k); }
    template <class T> void put(T v) {
        char raw[sizeof v];
        std::memcpy(raw, &v, sizeof v); // this machine is little-endian, as the protocol
        bytes_.append(raw, sizeof v);
    }
    void put(const std::string& s) { bytes_.append(s.c_str(), std::strlen(s.c_str()) + 1); }
    void raw(const void* data, size_t n) { bytes_.append(static_cast<const char*>(data), n); }
    std::string whole() && {
        const auto n = uint32_t(bytes_.size());
        std::memcpy(bytes_.data(), &n, 4);
        return std::move(bytes_);
    }

private:
    std::string bytes_;
};

/// tev calls red, green, blue and alpha by capitals.
std::vector<std::string> tevNames(const std::vector<std::string>& channels) {
    std::vector<std::string> names;
    for (const std::string& c : channels)
        names.push_back(c == "r" ? "R" : c == "g" ? "G" : c == "b" ? "B" : c == "a" ? "A" : c == "z" ? "Z" : c);
    return names;
}

int connectTo(const addrinfo& a) {
    const int s = ::socket(a.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, a.ai_protocol);
    if (s < 0) return -1;
    bool there = ::connect(s, a.ai_addr, a.ai_addrlen) == 0;
    if (!there && errno == EINPROGRESS) {
        pollfd p{s, POLLOUT, 0};
        int fault = 0;
        socklen_t size = sizeof fault;
        there = ::poll(&p, 1, kConnectMs) == 1 && getsockopt(s, SOL_SOCKET, SO_ERROR, &fault, &size) == 0 && fault == 0;
    }
    if (there) return s;
    ::close(s);
    return -1;
}

} // namespace

std::string tevCreate(const std::string& name, int width, int height, const std::vector<std::string>& channels) {
    Packet p(kCreateImage);
    p.put(char(1)); // to the front
    p.put(name);
    p.put(int32_t(width));
    p.put(int32_t(height));
    p.put(int32_t(channels.size()));
    for (const std::string& c : channels) p.put(c);
    return std::move(p).whole();
}

std::string tevUpdate(const std::string& name, int x, int y, int width, int height, const std::vector<std::string>& channels,
                      const std::vector<float>& data) {
    Packet p(kUpdateImageV3);
    p.put(char(0));
    p.put(name);
    p.put(int32_t(channels.size()));
    for (const std::string& c : channels) p.put(c);
    for (int v : {x, y, width, height}) p.put(int32_t(v));
    for (size_t i = 0; i < channels.size(); ++i) p.put(int64_t(i));               // start of each channel,
    for (size_t i = 0; i < channels.size(); ++i) p.put(int64_t(channels.size())); // and how far its pixels are apart
    p.raw(data.data(), data.size() * sizeof(float));
    return std::move(p).whole();
}

std::unique_ptr<TevPreview> TevPreview::connect(const std::string& host, int port, Diagnostics& diags) {
    const std::string where = host + ":" + std::to_string(port);
    addrinfo wanted{}, *all = nullptr;
    wanted.ai_socktype = SOCK_STREAM;
    if (const int fault = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &all); fault != 0) {
        diags.report(Severity::Warning, Rie::System, {},
                     "--display tev:" + where + ": " + gai_strerror(fault) + "; rendering continues without it");
        return nullptr;
    }
    int s = -1;
    for (const addrinfo* a = all; a && s < 0; a = a->ai_next) s = connectTo(*a);
    freeaddrinfo(all);
    if (s < 0) {
        diags.report(Severity::Warning, Rie::System, {},
                     "--display tev:" + where + ": no viewer listens there; rendering continues without it",
                     "start tev first; it listens at 127.0.0.1:14158");
        return nullptr;
    }
    return std::unique_ptr<TevPreview>(new TevPreview(s, where, diags));
}

TevPreview::~TevPreview() {
    if (socket_ >= 0) ::close(socket_);
}

bool TevPreview::wants(const render::OutputSpec&) const { return socket_ >= 0; }

void TevPreview::send(const std::string& bytes) {
    for (size_t at = 0; at < bytes.size() && socket_ >= 0;) {
        const ssize_t n = ::send(socket_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
        if (n > 0) {
            at += size_t(n);
            continue;
        }
        pollfd p{socket_, POLLOUT, 0};
        if ((errno == EAGAIN || errno == EINTR) && ::poll(&p, 1, kSendMs) == 1) continue;
        ::close(socket_);
        socket_ = -1;
        diagnostics_.report(Severity::Warning, Rie::System, {},
                            "tev at " + where_ + " takes no more pictures; rendering continues without it");
    }
}

void TevPreview::show(const render::OutputSpec& s, const render::PictureFacts& f, const display::Image& image) {
    const std::vector<std::string> channels = tevNames(image.channels);
    const std::string made = s.name + "\n" + std::to_string(f.width) + "x" + std::to_string(f.height);
    if (std::find(made_.begin(), made_.end(), made) == made_.end()) {
        send(tevCreate(s.name, f.width, f.height, channels));
        made_.push_back(made);
    }
    // In pieces, so that no packet is large.
    const int rows = std::max(1, int((size_t(4) << 20) / (size_t(image.width) * channels.size() * sizeof(float) + 1)));
    const size_t row = size_t(image.width) * channels.size();
    for (int y = 0; y < image.height; y += rows) {
        const int n = std::min(rows, image.height - y);
        const std::vector<float> part(image.data.begin() + long(size_t(y) * row), image.data.begin() + long(size_t(y + n) * row));
        send(tevUpdate(s.name, f.window.x0, f.window.y0 + y, image.width, n, channels, part));
    }
}

} // namespace alpenglow::view
