#include "worker.h"
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <execinfo.h>
#include <fcntl.h>
#include <filesystem>
#include <memory>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fs = std::filesystem;

extern "C" const char* __asan_default_options() {
    return "detect_leaks=0:abort_on_error=1:allocator_may_return_null=1:handle_abort=0";
}
extern "C" const char* __ubsan_default_options() { return "print_stacktrace=1:abort_on_error=1"; }

namespace alpenglow::fuzz {
namespace {

constexpr size_t kBatch = 400; ///< inputs of one child: what it leaks does not add up to a finding

/// What the child reports while it runs.
struct Shared {
    std::atomic<size_t> current{0}, done{0}; ///< index in the batch of the running input; how many are done
    std::atomic<double> started{0};          ///< processor seconds of the child when the running input began
    std::atomic<bool> interrupted{false};    ///< the parent has sent SIGINT: flags are set that stay set
    std::atomic<uint8_t> outcome[kBatch];
};

class SharedMemory {
public:
    SharedMemory()
        : p_(static_cast<Shared*>(mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
        if (p_ == MAP_FAILED) std::abort();
        new (p_) Shared;
    }
    ~SharedMemory() { munmap(p_, sizeof(Shared)); }
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;
    Shared* operator->() const { return p_; }

private:
    Shared* p_;
};

double processorSeconds(pid_t pid) {
    clockid_t clock = CLOCK_PROCESS_CPUTIME_ID;
    timespec t{};
    if (pid != 0 && clock_getcpuclockid(pid, &clock) != 0) return 0;
    clock_gettime(clock, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

size_t residentBytes(pid_t pid) {
    const std::string text = contentsOf("/proc/" + std::to_string(pid) + "/statm");
    unsigned long long size = 0, resident = 0;
    return std::sscanf(text.c_str(), "%llu %llu", &size, &resident) == 2 ? size_t(resident) * size_t(sysconf(_SC_PAGESIZE)) : 0;
}

/// A folder that goes when this goes.
struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "alpenglow-fuzz-XXXXXX").string();
        if (!mkdtemp(name.data())) std::abort();
        path = name;
    }
    ~Folder() {
        std::error_code e;
        fs::remove_all(path, e);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

void onCrash(int signal) {
    void* frames[24];
    backtrace_symbols_fd(frames, backtrace(frames, 24), STDERR_FILENO);
    std::signal(signal, SIG_DFL);
    raise(signal);
}

/// For targets that cache kernels; it goes with this process, which never leaves by _exit().
std::string sessionCache() {
    static const Folder folder;
    return folder.path.string();
}

/// Standard input empty, output and messages to files, crashes with a trace, no core files.
void becomeWorker(const fs::path& logs, const fs::path& folder, const std::string& cache) {
    if (chdir(folder.c_str()) != 0) _exit(97);
    const auto redirect = [&](int fd, const std::string& path, int flags) {
        const int f = open(path.c_str(), flags, 0600);
        if (f < 0 || dup2(f, fd) < 0) _exit(97);
        close(f);
    };
    redirect(0, "/dev/null", O_RDONLY);
    redirect(1, (logs / "out").string(), O_RDWR | O_CREAT | O_APPEND);
    redirect(2, (logs / "err").string(), O_RDWR | O_CREAT | O_APPEND);
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
    setenv("ALPENGLOW_CACHE", cache.c_str(), 1);
    for (const char* module : {"ALPENGLOW_PICTURES", "ALPENGLOW_GRIDS", "ALPENGLOW_GLTF", "ALPENGLOW_MODELS"})
        setenv(module, "", 1); // each file would be a process
    std::signal(SIGINT, SIG_DFL);
    if (!kSanitized) {
        static char stack[1 << 16]; // a stack that overflowed cannot tell where
        const stack_t s{stack, 0, sizeof stack};
        sigaltstack(&s, nullptr);
        void* frame;
        backtrace(&frame, 1); // loads what it needs while that is still possible
        struct sigaction a{};
        a.sa_handler = onCrash;
        a.sa_flags = SA_ONSTACK | SA_RESETHAND;
        for (int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) sigaction(signal, &a, nullptr);
    }
}

[[noreturn]] void work(const Target& target, const std::function<Bytes(size_t)>& input, size_t count, const SharedMemory& shared,
                       const fs::path& logs) {
    {
        Folder folder;
        becomeWorker(logs, folder.path, target.caches ? sessionCache() : "off");
        for (size_t i = 0; i < count && !shared->interrupted; ++i) {
            const Bytes bytes = input(i);
            clearOutput();
            if (ftruncate(2, 0) != 0) _exit(97);
            std::error_code e;
            for (const auto& entry : fs::directory_iterator(folder.path, e)) fs::remove_all(entry.path(), e);
            shared->started = processorSeconds(0);
            shared->current = i;
            const Outcome o = target.run(bytes);
            std::fflush(nullptr);
            shared->outcome[i] = uint8_t(shared->interrupted && !defect(o) ? Outcome::Slow : o);
            shared->done = i + 1;
        }
    }
    _exit(0);
}

/// What distinguishes defects: the places in the trace, without addresses of data; a sanitizer's own summary.
std::string signatureOf(const std::string& log, int signal) {
    std::string s = signal ? "signal " + std::to_string(signal) : "exit";
    if (const size_t at = log.find("SUMMARY: "); at != std::string::npos)
        return s + " " + log.substr(at, log.find('\n', at) - at);
    if (const size_t at = log.find("runtime error: "); at != std::string::npos)
        return s + " " + log.substr(at, log.find('\n', at) - at);
    int frames = 0;
    for (size_t at = 0; (at = log.find("(+0x", at)) != std::string::npos && frames < 6; ++at, ++frames)
        s += " " + log.substr(at + 2, log.find(')', at) - at - 2);
    return s;
}

struct Ending {
    size_t done = 0;     ///< inputs that have an outcome
    bool broken = false; ///< the input after them ended the child
    Verdict verdict{};   ///< of that
};

/// The running input of a child, as the parent sees it from time to time. Only processor time tells work from a machine that is
/// busy with other things; the clock on the wall shows only that a child has not worked at all.
class Watched {
public:
    Watched(pid_t pid, const SharedMemory& shared, const Limits& limits) : pid_(pid), shared_(shared), limits_(limits) {}

    void look() {
        const double now = clockSeconds(), spent = processorSeconds(pid_);
        if (spent > spent_ + 0.01) spent_ = spent, worked_ = now;
        if (residentBytes(pid_) > limits_.memory) tooMuch = true;
        const bool running = shared_->done <= shared_->current, stalled = now - worked_ > limits_.stallSeconds;
        if (!interrupted && running && (spent - shared_->started > limits_.processorSeconds || stalled)) {
            interrupted = true;
            at_ = shared_->done;
            spentThen_ = spent;
            worked_ = now; // once more for the interrupt
            shared_->interrupted = true;
            kill(pid_, SIGINT);
        } else if (interrupted && shared_->done == at_ && (spent - spentThen_ > limits_.graceSeconds || stalled)) {
            tooLong = true;
        }
    }

    bool tooMuch = false, interrupted = false, tooLong = false;

private:
    pid_t pid_;
    const SharedMemory& shared_;
    const Limits& limits_;
    double worked_ = clockSeconds(), spent_ = 0, spentThen_ = 0;
    size_t at_ = 0;
};

/// Watches a child until it ends or `end` is past; inputs that take too long or too much are ended.
Ending watch(pid_t pid, const Target& target, const SharedMemory& shared, double end, const Limits& limits,
             const fs::path& logs) {
    Watched w(pid, shared, limits);
    bool stopped = false;
    int status = 0;
    for (useconds_t nap = 300; waitpid(pid, &status, WNOHANG) == 0; nap = std::min<useconds_t>(nap * 2, 5000)) {
        usleep(nap);
        w.look();
        stopped = clockSeconds() > end && !w.interrupted;
        if (w.tooMuch || w.tooLong || stopped) {
            kill(pid, SIGKILL);
            waitpid(pid, &status, 0);
            break;
        }
    }
    const bool interrupted = w.interrupted, tooMuch = w.tooMuch, tooLong = w.tooLong;
    Ending e;
    e.done = shared->done;
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (stopped || (signal == 0 && WEXITSTATUS(status) == 0)) return e;
    e.broken = true;
    const std::string log = contentsOf((logs / "err").string());
    e.verdict.messages = log.size() > 6000 ? log.substr(0, 3000) + "\n...\n" + log.substr(log.size() - 3000) : log;
    const bool fairEnd = interrupted && (signal == SIGINT || WEXITSTATUS(status) == 130);
    e.verdict.outcome = tooMuch   ? Outcome::Memory
                        : tooLong ? Outcome::Hang
                        : fairEnd ? target.loops ? Outcome::Slow : Outcome::Hang
                                  : Outcome::Crash;
    e.verdict.signature = e.verdict.outcome == Outcome::Crash ? signatureOf(log, signal) : nameOf(e.verdict.outcome);
    return e;
}

Ending batch(const Target& target, const std::function<Bytes(size_t)>& input, size_t count, double end, const Limits& limits,
             const SharedMemory& shared, const fs::path& logs) {
    std::fflush(nullptr);
    sessionCache(); // made here, not in each child
    const pid_t pid = fork();
    if (pid < 0) std::abort();
    if (pid == 0) work(target, input, count, shared, logs);
    return watch(pid, target, shared, end, limits, logs);
}

size_t sizeOf(int fd) {
    struct stat s{};
    return fstat(fd, &s) == 0 ? size_t(s.st_size) : 0;
}

} // namespace

double clockSeconds() {
    static const auto begin = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string outputSoFar() {
    std::fflush(nullptr);
    std::string text(sizeOf(1), '\0');
    const ssize_t n = pread(1, text.data(), text.size(), 0);
    text.resize(size_t(std::max<ssize_t>(0, n)));
    return text;
}

void clearOutput() {
    if (ftruncate(1, 0) != 0) _exit(97);
}

bool saidAnything() {
    std::fflush(nullptr);
    return sizeOf(1) + sizeOf(2) > 0;
}

Verdict runAlone(const Target& target, const Bytes& bytes, const Limits& limits) {
    Folder logs;
    SharedMemory shared;
    const Ending e = batch(target, [&](size_t) { return bytes; }, 1, clockSeconds() + 1000, limits, shared, logs.path);
    if (e.broken) return e.verdict;
    const Outcome o = e.done ? Outcome(shared->outcome[0].load()) : Outcome::Ok;
    return {o, nameOf(o), contentsOf((logs.path / "err").string())};
}

Tally runMany(const Target& target, const Source& source, size_t first, size_t last, double end, const Limits& limits,
              const std::function<void(size_t, const Verdict&)>& found) {
    Tally tally;
    Folder logs;
    for (size_t at = first; at < last && clockSeconds() < end;) {
        SharedMemory shared;
        const size_t count = std::min(kBatch, last - at);
        const Ending e = batch(target, [&](size_t i) { return source(at + i); }, count, end, limits, shared, logs.path);
        const auto take = [&](size_t i, const Verdict& v) {
            ++tally.count[size_t(v.outcome)];
            ++tally.runs;
            if (v.outcome > Outcome::Refused) found(at + i, v);
        };
        for (size_t i = 0; i < e.done; ++i) {
            const Outcome o = Outcome(shared->outcome[i].load());
            take(i, {o, nameOf(o), ""});
        }
        if (e.broken) take(e.done, e.verdict);
        at += e.done + (e.broken ? 1 : 0);
        if (e.done == 0 && !e.broken) break; // the clock
    }
    return tally;
}

Seeds madeInChild(const std::function<void()>& make, const std::vector<std::string>& extensions) {
    Folder logs, folder;
    std::fflush(nullptr);
    sessionCache();
    const pid_t pid = fork();
    if (pid < 0) std::abort();
    if (pid == 0) {
        becomeWorker(logs.path, folder.path, sessionCache());
        make();
        _exit(0);
    }
    int status = 0;
    waitpid(pid, &status, 0);
    return filesOf(folder.path.string(), extensions);
}

} // namespace alpenglow::fuzz
