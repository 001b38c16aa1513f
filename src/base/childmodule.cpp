#include "base/childmodule.h"
#include "base/limits.h"
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace alpenglow {

namespace {

constexpr int kWhy = 512;                   ///< bytes of what a child has to say
constexpr int kReported = 1, kNoModule = 2; ///< exit codes of the child: it wrote the reason; the module cannot be loaded

/// Lets this process take so much memory in addition to what it has; allocations beyond that fail. Not under
/// AddressSanitizer, whose own tables are larger than any limit.
void limitMemory([[maybe_unused]] uint64_t bytes) {
#if !__has_feature(address_sanitizer)
    unsigned long has = 0; // pages of data
    if (FILE* f = std::fopen("/proc/self/statm", "re")) {
        if (std::fscanf(f, "%*u %*u %*u %*u %*u %lu", &has) != 1) has = 0;
        std::fclose(f);
    }
    const rlim_t all = rlim_t(has) * rlim_t(sysconf(_SC_PAGESIZE)) + bytes;
    rlimit now{};
    if (getrlimit(RLIMIT_DATA, &now) == 0 && (now.rlim_cur == RLIM_INFINITY || now.rlim_cur > all)) {
        now.rlim_cur = all;
        setrlimit(RLIMIT_DATA, &now);
    }
#endif
}

[[noreturn]] void child(const std::string& file, const char* name, uint64_t memory, const ChildWork& work, int to, int errors) {
    char why[kWhy] = "";
    int code = kNoModule;
    const rlimit noCore{0, 0};
    setrlimit(RLIMIT_CORE, &noCore);
    limitMemory(memory);
    for (const int s : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT}) std::signal(s, SIG_DFL);
    void* handle = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (void* function = handle ? dlsym(handle, name) : nullptr) {
        code = work(function, to, why, kWhy) == 0 ? 0 : kReported;
    } else {
        const char* text = dlerror();
        std::strncpy(why, text ? text : "it has no function of ours", kWhy - 1);
    }
    for (size_t done = 0, n = std::strlen(why); done < n;) {
        const ssize_t k = write(errors, why + done, n - done);
        if (k <= 0) break;
        done += size_t(k);
    }
    _exit(code);
}

/// What the child says until it is gone or its time is over; false: over.
bool listen(int from, std::string& why) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(limits::kProgramSeconds);
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
        if (left <= 0) return false;
        pollfd p{from, POLLIN, 0};
        const int n = poll(&p, 1, int(left));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        char text[kWhy];
        const ssize_t k = read(from, text, sizeof text);
        if (k < 0 && errno == EINTR) continue;
        if (k <= 0) return true;
        if (why.size() < kWhy) why.append(text, size_t(k));
    }
}

} // namespace

Descriptor::~Descriptor() {
    if (fd >= 0) close(fd);
}

ChildResult runChildModule(const std::string& file, const char* name, uint64_t memory, const ChildWork& work) {
    ChildResult r;
    r.written.fd = memfd_create("alpenglow-module", MFD_CLOEXEC);
    int ends[2] = {-1, -1};
    const bool piped = r.written.fd >= 0 && pipe2(ends, O_CLOEXEC) == 0;
    const Descriptor from(ends[0]);
    Descriptor to(ends[1]);
    const pid_t pid = piped ? fork() : -1;
    if (pid == 0) child(file, name, memory, work, r.written.fd, to.fd);
    if (pid < 0) {
        r.why = std::string("no child process: ") + std::strerror(errno);
        return r;
    }
    close(to.fd);
    to.fd = -1;
    const bool ended = listen(from.fd, r.why);
    if (!ended) kill(pid, SIGKILL);
    int status = 0;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {}
    for (char& c : r.why)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    using End = ChildResult::End;
    if (WIFSIGNALED(status)) r.signal = WTERMSIG(status);
    r.end = !ended                             ? End::Late
            : WIFSIGNALED(status)              ? End::Signal
            : WEXITSTATUS(status) == kNoModule ? End::NoModule
            : WEXITSTATUS(status) != 0         ? End::Failed
                                               : End::Done;
    return r;
}

size_t writtenBytes(const ChildResult& r) {
    struct stat about{};
    return fstat(r.written.fd, &about) == 0 && about.st_size > 0 ? size_t(about.st_size) : 0;
}

bool readWritten(const ChildResult& r, void* to, size_t bytes, size_t from) {
    for (size_t done = 0; done < bytes;) {
        const ssize_t k = pread(r.written.fd, static_cast<char*>(to) + done, std::min<size_t>(bytes - done, size_t(1) << 30),
                                off_t(from + done));
        if (k <= 0) return false;
        done += size_t(k);
    }
    return true;
}

} // namespace alpenglow
