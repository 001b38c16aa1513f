// An HTTP server of src/view/httpserver.h among many connections, with the limit on them raised: memory, threads, time of a
// request.
//   http_crowd [CONNECTIONS]
#include "client.h"
#include "view/httpserver.h"
#include <cstdio>
#include <fstream>
#include <list>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>

using namespace alpenglow::view;
using namespace alpenglow::view::testing;

namespace {

long statusField(const std::string& name) {
    std::ifstream in("/proc/self/status");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(name)) return std::strtol(line.c_str() + name.size(), nullptr, 10);
    return 0;
}

double cpuSeconds() {
    rusage r{};
    getrusage(RUSAGE_SELF, &r);
    return double(r.ru_utime.tv_sec + r.ru_stime.tv_sec) + 1e-6 * double(r.ru_utime.tv_usec + r.ru_stime.tv_usec);
}

/// In a process of its own: so many connections, each with 4 KiB of headers that do not end, until `hold` closes.
[[noreturn]] void crowd(int port, int count, int ready, int hold) {
    std::list<Socket> all;
    char made = 1;
    for (int i = 0; i < count; ++i) {
        Socket& s = all.emplace_back(port);
        made = char(made && s.open());
        s.send("GET / HTTP/1.1\r\nX: " + std::string(4000, 'a'));
    }
    [[maybe_unused]] ssize_t n = write(ready, &made, 1);
    n = read(hold, &made, 1);
    _exit(0);
}

} // namespace

int main(int argc, char** argv) {
    const int count = argc > 1 ? std::atoi(argv[1]) : 9000;
    rlimit files{};
    getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
    HttpLimits limits;
    limits.connections = size_t(count) + 10;
    limits.requestSeconds = limits.idleSeconds = 600;
    std::string fault;
    const auto server = HttpServer::listen(0, &fault, limits);
    if (!server) return std::fprintf(stderr, "%s\n", fault.c_str()), 1;
    server->start([](const HttpRequest& r, bool, bool* known) -> std::optional<HttpResponse> {
        *known = true;
        return HttpResponse{200, "text/plain", r.path};
    });
    const int port = server->port();
    {
        Socket first(port);
        first.send(get(port, "/a"));
        first.answer();
    }
    const long before = statusField("VmRSS:");
    int ready[2], hold[2];
    if (pipe(ready) || pipe(hold)) return 1;
    const pid_t other = fork();
    if (other == 0) {
        close(hold[1]);
        crowd(port, count, ready[1], hold[0]);
    }
    char made = 0;
    if (read(ready[0], &made, 1) != 1) return 1;
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    Socket s(port);
    s.send(get(port, "/b"));
    const int status = statusOf(s.answer());
    std::printf("%d connections%s: %.1f KiB each, %ld threads, answers %d", count, made ? "" : " (not all could be made)",
                double(statusField("VmRSS:") - before) / count, statusField("Threads:") - 1, status);
    constexpr int kRequests = 500;
    const double cpu = cpuSeconds();
    for (int k = 0; k < kRequests; ++k) {
        s.send(get(port, "/c"));
        s.answer();
    }
    std::printf("; a request takes %.3f ms of CPU\n", (cpuSeconds() - cpu) / kRequests * 1e3);
    close(hold[1]);
    waitpid(other, nullptr, 0);
}
