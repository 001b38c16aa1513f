#include "render/frameprocesses.h"
#include "render/framerecords.h"
#include "render/limits.h"
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <string_view>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace alpenglow::render {
namespace {

// A record in what a process writes to standard error: mark, kind, length, bytes. Text contains no zeros.
constexpr std::string_view kMark("\0\1alpenglow\2", 12);
constexpr size_t kHead = kMark.size() + 1 + sizeof(uint64_t);
constexpr int kLook = 50; ///< milliseconds between checks of the stop flag

void closeAll(std::initializer_list<int*> fds) {
    for (int* fd : fds) {
        if (*fd >= 0) ::close(*fd);
        *fd = -1;
    }
}

/// The last component of a name in lower case: findFile() may find it by that.
std::string baseOf(const std::string& name) {
    std::string base = name.substr(name.find_last_of("/\\") + 1);
    for (char& c : base) c = char(std::tolower(static_cast<unsigned char>(c)));
    return base;
}

} // namespace

FrameProcesses::FrameProcesses(Use use, Diagnostics& messages) : use_(std::move(use)), messages_(messages) {}

FrameProcesses::~FrameProcesses() {
    for (Part& p : parts_) {
        closeAll({&p.out, &p.error, &p.answer});
        if (p.process < 0) continue;
        ::kill(p.process, SIGKILL);
        while (::waitpid(p.process, nullptr, 0) < 0 && errno == EINTR) {}
    }
}

int FrameProcesses::running() const {
    return int(std::count_if(parts_.begin(), parts_.end(), [](const Part& p) { return p.process >= 0; }));
}

void FrameProcesses::say(const Diagnostic& d) {
    if (process_) return send(Kind::Message, packed(d));
    if (parts_.empty() || (!open_ && parts_.back().process >= 0) || parts_.back().result) parts_.emplace_back();
    parts_.back().events.push_back({Kind::Message, packed(d)});
    printMessages();
}

void FrameProcesses::openFrame() {
    serve(0);
    while (running() >= use_.most || parts_.size() >= size_t(limits::kFramesAhead) * size_t(use_.most)) serve(kLook);
    parts_.emplace_back();
    open_ = true;
    printMessages();
}

void FrameProcesses::closeFrame() {
    open_ = false;
    printMessages();
}

void FrameProcesses::waitForFrames() {
    while (running() > 0) serve(kLook);
    printMessages();
}

bool FrameProcesses::start(const std::string& what, Writes writes, bool alone) {
    Part& part = parts_.back();
    int out[2] = {-1, -1}, error[2] = {-1, -1}, answer[2] = {-1, -1};
    const pid_t parent = ::getpid();
    std::fflush(stdout); // the fork must not write it again
    std::fflush(stderr);
    pid_t process = -1;
    if (::pipe2(out, O_CLOEXEC) == 0 && ::pipe2(error, O_CLOEXEC) == 0 && ::pipe2(answer, O_CLOEXEC) == 0) process = ::fork();
    if (process < 0) {
        const int why = errno;
        closeAll({&out[0], &out[1], &error[0], &error[1], &answer[0], &answer[1]});
        throw std::system_error(why, std::generic_category(), "no process can be started");
    }
    if (process > 0) {
        closeAll({&out[1], &error[1], &answer[0]});
        part.process = process;
        part.what = what;
        part.out = out[0];
        part.error = error[0];
        part.answer = answer[1];
        part.writes = std::move(writes);
        return false;
    }
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);
    process_ = true;
    if (use_.begins) use_.begins(alone);
    ::dup2(out[1], STDOUT_FILENO);
    ::dup2(error[1], STDERR_FILENO);
    closeAll({&out[0], &out[1], &error[0], &error[1], &answer[1]});
    answers_ = answer[0];
    for (Part& p : parts_) {
        closeAll({&p.out, &p.error, &p.answer});
        p.process = -1; // not a child of this process
    }
    return true;
}

void FrameProcesses::askToStop() {
    if (stopSent_ || !use_.stop || !*use_.stop) return;
    stopSent_ = true;
    for (const Part& p : parts_)
        if (p.process >= 0 && use_.stopSignal) ::kill(p.process, use_.stopSignal);
}

/// Reads output of the processes; waits at most this long if there is none.
void FrameProcesses::serve(int milliseconds) {
    askToStop();
    std::vector<pollfd> fds;
    std::vector<Part*> of;
    for (Part& p : parts_) {
        if (p.process < 0) continue;
        for (const int fd : {p.error, p.out}) {
            fds.push_back({fd, POLLIN, 0}); // poll() ignores descriptors below 0
            of.push_back(&p);
        }
    }
    if (fds.empty() || ::poll(fds.data(), nfds_t(fds.size()), milliseconds) < 0) return;
    for (size_t i = 0; i < fds.size(); ++i)
        if (fds[i].revents) readFrom(*of[i], fds[i].fd == of[i]->error);
    for (Part* p : of) reap(*p);
    answerAll();
    printMessages();
}

void FrameProcesses::readFrom(Part& p, bool error) {
    char bytes[1 << 16];
    int& fd = error ? p.error : p.out;
    const ssize_t n = ::read(fd, bytes, sizeof bytes);
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) return;
    if (n <= 0) return closeAll({&fd});
    if (!error) return p.events.push_back({Kind::Text, std::string(bytes, size_t(n))});
    p.unread.append(bytes, size_t(n));
    split(p);
}

/// Separates records and text in the data read so far.
void FrameProcesses::split(Part& p) {
    while (!p.unread.empty()) {
        const size_t zero = std::min(p.unread.find('\0'), p.unread.size());
        if (zero > 0) {
            p.events.push_back({Kind::Error, p.unread.substr(0, zero)});
            p.unread.erase(0, zero);
            continue;
        }
        const size_t same = std::min(kMark.size(), p.unread.size());
        if (p.unread.compare(0, same, kMark.substr(0, same)) != 0) {
            p.unread.erase(0, 1); // a zero outside of records
            continue;
        }
        uint64_t length = 0;
        if (p.unread.size() < kHead) return;
        std::memcpy(&length, p.unread.data() + kMark.size() + 1, sizeof length);
        if (p.unread.size() - kHead < length) return;
        const Kind kind = Kind(p.unread[kMark.size()]);
        std::string bytes = p.unread.substr(kHead, size_t(length));
        p.unread.erase(0, kHead + size_t(length));
        take(p, kind, std::move(bytes));
    }
}

void FrameProcesses::take(Part& p, Kind kind, std::string bytes) {
    if (kind == Kind::Result) p.result = unpack(bytes, p.made);
    if (kind == Kind::Declare) p.writes.declared = true, p.writes.others |= bytes == "+";
    if (kind == Kind::Ask) p.asks = true, p.asked = bytes;
    if (kind == Kind::Message) p.events.push_back({kind, std::move(bytes)});
}

/// Closes a process that has delivered its result, or has ended.
void FrameProcesses::reap(Part& p) {
    if (p.process < 0) return;
    int status = 0;
    pid_t ended = 0;
    while ((ended = ::waitpid(p.process, &status, p.result ? 0 : WNOHANG)) < 0 && errno == EINTR) {}
    if (ended == 0) return;
    p.process = -1;
    for (const bool error : {true, false}) { // reads its remaining output
        int& fd = error ? p.error : p.out;
        if (fd >= 0) ::fcntl(fd, F_SETFL, O_NONBLOCK); // programs that it started may hold the other end
        for (pollfd left{fd, POLLIN, 0}; fd >= 0 && ::poll(&left, 1, 0) > 0;) readFrom(p, error);
    }
    closeAll({&p.out, &p.error, &p.answer});
    p.asks = false;
    if (!p.result) sayLost(p, ended < 0 ? 0 : status);
}

void FrameProcesses::sayLost(Part& p, int status) {
    Diagnostic d;
    d.severity = Severity::Severe;
    d.code = Rie::System;
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    d.message = p.what + " is given up: its process ended " +
                (signal ? "by signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")"
                        : "with status " + std::to_string(WEXITSTATUS(status)));
    p.made = {};
    p.made.outcome.refused = 1;
    if (!signal) p.made.outcome.outOfMemory = true; // the only way to end without delivering a result
    p.result = true;
    p.events.push_back({Kind::Message, packed(std::move(d))});
}

/// Whether no earlier frame that is still rendering may write a file of this name; "": any file.
bool FrameProcesses::mayRead(size_t part, const std::string& name) const {
    const std::string base = baseOf(name);
    return std::none_of(parts_.begin(), parts_.begin() + std::ptrdiff_t(part), [&](const Part& p) {
        if (p.process < 0) return false;
        if (name.empty() || !p.writes.declared || p.writes.others) return true;
        return std::any_of(p.writes.files.begin(), p.writes.files.end(),
                           [&](const std::string& file) { return baseOf(file) == base; });
    });
}

void FrameProcesses::answerAll() {
    for (size_t i = 0; i < parts_.size(); ++i) {
        Part& p = parts_[i];
        if (!p.asks || p.process < 0 || !mayRead(i, p.asked)) continue;
        p.asks = false;
        const char yes = 1;
        [[maybe_unused]] const ssize_t n = ::write(p.answer, &yes, 1); // a process that has ended needs none
    }
}

/// Not by `stdout`, which is redirected to standard error if pictures go to standard output.
void FrameProcesses::writeOut(const std::string& bytes) {
    std::fflush(stdout);
    for (size_t at = 0; at < bytes.size() && !lost_;) {
        const ssize_t n = ::write(STDOUT_FILENO, bytes.data() + at, bytes.size() - at);
        if (n >= 0) at += size_t(n);
        else if (errno != EINTR) lost_ = true;
    }
    if (lost_ && errno != EPIPE) // no message if the reader of the pipe has gone
        messages_.reportOnce("stdout", {Severity::Error,
                                        errno == ENOSPC ? Rie::DiskFull : Rie::System,
                                        {},
                                        std::string("cannot write to standard output: ") + std::strerror(errno),
                                        {},
                                        {}});
}

void FrameProcesses::printEvent(const Event& e) {
    if (e.kind == Kind::Text) writeOut(e.bytes);
    if (e.kind == Kind::Error) std::fwrite(e.bytes.data(), 1, e.bytes.size(), stderr);
    Diagnostic d;
    if (e.kind != Kind::Message || !unpack(e.bytes, d)) return;
    if (d.once.empty()) return messages_.report(std::move(d));
    const std::string key = d.once;
    messages_.reportOnce(key, std::move(d));
}

/// Prints what is due: all finished parts, and what exists of the first unfinished one.
void FrameProcesses::printMessages() {
    while (!parts_.empty()) {
        Part& p = parts_.front();
        if (!p.begun) p.errors = messages_.errors(), p.warnings = messages_.warnings(), p.begun = true;
        for (const Event& e : std::exchange(p.events, {})) printEvent(e);
        if (p.process >= 0 || (open_ && parts_.size() == 1)) return;
        if (p.result && p.made.stats) {
            p.made.stats->figures.errors = messages_.errors() - p.errors;
            p.made.stats->figures.warnings = messages_.warnings() - p.warnings;
        }
        FrameResult made = std::move(p.made);
        made.outcome.outputFailed |= lost_;
        parts_.pop_front();
        if (take_) take_(std::move(made));
    }
}

void FrameProcesses::send(Kind kind, const std::string& bytes) {
    std::string record(kMark);
    const uint64_t length = bytes.size();
    record += char(kind);
    record.append(reinterpret_cast<const char*>(&length), sizeof length);
    record += bytes;
    std::fwrite(record.data(), 1, record.size(), stderr); // in one call: the stream is locked meanwhile
    std::fflush(stderr);
}

void FrameProcesses::declare(bool others) { send(Kind::Declare, others ? "+" : "-"); }

void FrameProcesses::awaitRead(const std::string& name) {
    if (!process_) {
        while (!mayRead(parts_.size(), name)) serve(kLook);
        return;
    }
    const std::lock_guard lock(asking_);
    if (!name.empty() && answered_.insert(name).second) await(name);
}

void FrameProcesses::awaitTurn() {
    const std::lock_guard lock(asking_);
    await("");
}

/// After a stop is requested no process waits; a late answer is ignored.
void FrameProcesses::await(const std::string& asked) {
    const auto stopped = [&] { return use_.stop && *use_.stop; };
    if (stopped()) return;
    send(Kind::Ask, asked);
    while (!stopped()) {
        pollfd p{answers_, POLLIN, 0};
        char yes = 0;
        if (::poll(&p, 1, kLook) > 0 && (::read(answers_, &yes, 1) >= 0 || errno != EINTR)) return;
    }
}

void FrameProcesses::finish(FrameResult result) {
    if (use_.ends) use_.ends();
    std::fflush(stdout);
    send(Kind::Result, packed(std::move(result)));
    ::_exit(0);
}

} // namespace alpenglow::render
