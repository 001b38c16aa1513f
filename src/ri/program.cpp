#include "ri/program.h"
#include "base/limits.h"
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <string_view>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace alpenglow::ri {

namespace {

using Clock = std::chrono::steady_clock;
constexpr char kEnd = char(0377);
constexpr std::string_view kEndAsText = "\303\277"; ///< the same as UTF-8 has it
constexpr std::chrono::milliseconds kSilence(500);

/// Until the descriptor is ready, the time is over (false) or the user has stopped (false).
bool waitFor(int fd, short events, Clock::time_point end, const StopFlag* stop) {
    while (!(stop && *stop)) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        if (left <= 0) return false;
        pollfd p{fd, events, 0};
        const int n = poll(&p, 1, int(std::min<long long>(left, 200)));
        if (n > 0) return true;
        if (n < 0 && errno != EINTR) return false;
    }
    return false;
}

} // namespace

std::vector<std::string> commandWords(const std::string& command) {
    std::vector<std::string> words;
    std::string word;
    bool begun = false;
    char quote = 0;
    for (const char c : command) {
        if (quote ? c == quote : c == '"' || c == '\'') {
            quote = quote ? 0 : c;
            begun = true;
        } else if (!quote && (c == ' ' || c == '\t' || c == '\n')) {
            if (begun) words.push_back(std::move(word));
            word.clear();
            begun = false;
        } else {
            word += c;
            begun = true;
        }
    }
    if (begun) words.push_back(std::move(word));
    return words;
}

std::unique_ptr<Program> Program::start(const std::vector<std::string>& arguments, std::string& why) {
    // Sockets, because a write to one of a process that has ended need not raise SIGPIPE.
    int in[2] = {-1, -1}, out[2] = {-1, -1};
    const auto failed = [&](int error) {
        why = std::strerror(error);
        for (int fd : {in[0], in[1], out[0], out[1]})
            if (fd >= 0) close(fd);
        return nullptr;
    };
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in) != 0 || pipe2(out, O_CLOEXEC) != 0) return failed(errno);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[1], 0);
    posix_spawn_file_actions_adddup2(&actions, out[1], 1);
    posix_spawn_file_actions_addclosefrom_np(&actions, 3);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setpgroup(&attributes, 0); // it is ended with all that it started
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    sigset_t broken; // we ignore it, and what is ignored stays so: a program that prints on would outlive us
    sigemptyset(&broken);
    sigaddset(&broken, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes, &broken);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    std::vector<char*> argv;
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    pid_t pid = -1;
    const int error = posix_spawn(&pid, argv[0], &actions, &attributes, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (error) return failed(error);
    close(in[1]);
    close(out[1]);
    std::unique_ptr<Program> p(new Program);
    p->process_ = pid;
    p->to_ = in[0];
    p->from_ = out[0];
    fcntl(p->from_, F_SETFL, O_NONBLOCK);
    return p;
}

void Program::kill() {
    if (to_ >= 0) close(to_);
    if (from_ >= 0) close(from_);
    to_ = from_ = -1;
    if (process_ < 0) return;
    ::kill(-process_, SIGKILL);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {}
    process_ = -1;
}

void Program::leave() {
    process_ = -1;
    kill();
}

Program::~Program() {
    if (to_ >= 0) {
        close(to_);
        to_ = -1;
        for (int i = 0; i < 100 && process_ >= 0; ++i) {
            if (waitpid(process_, nullptr, WNOHANG) == process_) {
                ::kill(-process_, SIGKILL); // what it left behind
                process_ = -1;
            } else {
                usleep(10'000);
            }
        }
    }
    kill();
}

bool Program::ask(const std::string& line, double seconds, const StopFlag* stop, std::string& answer, std::string& why,
                  size_t most) {
    answer.clear();
    const auto fail = [&](const char* reason) {
        why = reason;
        kill();
        return false;
    };
    if (process_ < 0) return fail("it has ended");
    const auto end = Clock::now() + std::chrono::milliseconds((long long)(seconds * 1000));
    for (size_t sent = 0; sent < line.size();) {
        if (!waitFor(to_, POLLOUT, end, stop)) return fail("it does not read what it is asked");
        const ssize_t n = send(to_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n > 0) sent += size_t(n);
        else if (errno != EAGAIN && errno != EINTR) return fail("it ended before it was asked");
    }
    answer = std::move(rest_);
    rest_.clear();
    // A text stream writes 0377 as two bytes. Where these come last, and nothing after them, the program waits for its next line.
    const auto endsAsText = [&] {
        size_t n = answer.size();
        while (n > 0 && (answer[n - 1] == '\n' || answer[n - 1] == '\r')) --n;
        if (n < kEndAsText.size() || answer.compare(n - kEndAsText.size(), kEndAsText.size(), kEndAsText) != 0) return false;
        if (waitFor(from_, POLLIN, std::min(end, Clock::now() + kSilence), stop)) return false;
        answer.resize(n - kEndAsText.size());
        return true;
    };
    for (size_t looked = 0;;) {
        if (const size_t at = answer.find(kEnd, looked); at != answer.npos) {
            rest_ = answer.substr(at + 1);
            answer.resize(at);
            return true;
        }
        looked = answer.size();
        if (looked > most) return fail("its answer is too long");
        if (endsAsText()) return fail(kEndsAsText);
        if (!waitFor(from_, POLLIN, end, stop)) return fail(stop && *stop ? "the render was stopped" : "it took too long");
        char buffer[65536];
        const ssize_t n = ::read(from_, buffer, sizeof buffer);
        if (n > 0) answer.append(buffer, size_t(n));
        else if (n == 0) return fail("it ended before the end of its answer, a byte 0377");
        else if (errno != EAGAIN && errno != EINTR) return fail(std::strerror(errno));
    }
}

} // namespace alpenglow::ri
