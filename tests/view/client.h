// A plain client over a raw socket: what a browser would send, and what no browser would.
#pragma once
#include <arpa/inet.h>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

namespace alpenglow::view::testing {

class Socket {
public:
    explicit Socket(int port) : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in a{};
        a.sin_family = AF_INET;
        a.sin_port = htons(uint16_t(port));
        a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (::connect(fd_, reinterpret_cast<sockaddr*>(&a), sizeof a) != 0) close();
    }
    Socket(Socket&& o) noexcept : fd_(std::exchange(o.fd_, -1)), in_(std::move(o.in_)) {}
    ~Socket() { close(); }
    bool open() const { return fd_ >= 0; }
    void close() {
        if (fd_ >= 0) ::close(fd_);
        fd_ = -1;
    }
    bool send(const std::string& text) {
        for (size_t n = 0; n < text.size();) {
            const ssize_t k = ::send(fd_, text.data() + n, text.size() - n, MSG_NOSIGNAL);
            if (k <= 0) return false;
            n += size_t(k);
        }
        return true;
    }
    /// What has come until the other side closed, or for so many seconds.
    std::string rest(double seconds) {
        while (more(seconds)) {}
        return std::exchange(in_, "");
    }
    /// Head and body of one answer; "" when none came.
    std::string answer(double seconds = 20) {
        size_t head = std::string::npos;
        while ((head = in_.find("\r\n\r\n")) == std::string::npos)
            if (!more(seconds)) return "";
        const size_t at = in_.find("Content-Length: ");
        const size_t length = at < head ? std::strtoul(in_.c_str() + at + 16, nullptr, 10) : 0;
        while (in_.size() < head + 4 + length)
            if (!more(seconds)) return "";
        std::string all = in_.substr(0, head + 4 + length);
        in_.erase(0, all.size());
        return all;
    }
    /// Whether the other side has closed, after so many seconds at most.
    bool closed(double seconds) {
        while (more(seconds)) {}
        return ended_;
    }

private:
    bool more(double seconds) {
        pollfd p{fd_, POLLIN, 0};
        if (fd_ < 0 || ::poll(&p, 1, int(seconds * 1000)) <= 0) return false;
        char piece[65536];
        const ssize_t n = ::recv(fd_, piece, sizeof piece, 0);
        if (n <= 0) return !(ended_ = true);
        in_.append(piece, size_t(n));
        return true;
    }
    int fd_;
    std::string in_;
    bool ended_ = false;
};

inline int statusOf(const std::string& answer) { return answer.size() > 12 ? std::atoi(answer.c_str() + 9) : 0; }
inline std::string bodyOf(const std::string& answer) {
    const size_t head = answer.find("\r\n\r\n");
    return head == std::string::npos ? "" : answer.substr(head + 4);
}
inline std::string get(int port, const std::string& target, const std::string& more = "") {
    return "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n" + more + "\r\n";
}
inline std::string post(int port, const std::string& target, const std::string& body) {
    return "POST " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
           "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

} // namespace alpenglow::view::testing
