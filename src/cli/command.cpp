#include "cli/command.h"
#include "base/file.h"
#include "base/limits.h"
#include "base/printable.h"
#include "base/realpath.h"
#include "display/imageio.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <sys/stat.h>
#include <unistd.h>

namespace alpenglow::cli {

namespace {

/// The line of a text file that a message is about; "" when the file is none, is compressed or binary, or is so
/// large that looking for lines would take long. Lines end as the reader of RIB has them.
std::string lineOf(const SourcePlace& p) {
    struct stat s;
    if (p.line <= 0 || stat(p.file.c_str(), &s) != 0 || !S_ISREG(s.st_mode)) return "";
    if (size_t(s.st_size) > limits::kExcerptBytes) return "";
    std::ifstream in(p.file, std::ios::binary);
    std::string line;
    int at = 1;
    for (char c; at <= p.line && in.get(c);) {
        if (c == '\r' && in.peek() == '\n') in.get(c);
        if (c == '\n' || c == '\r') ++at;
        else if (at == p.line && line.size() < limits::kTokenBytes) line += c;
    }
    const auto binary = [](char c) { return static_cast<unsigned char>(c) >= 0x80 || (c < ' ' && c != '\t'); };
    return at < p.line || std::any_of(line.begin(), line.end(), binary) ? "" : line;
}

} // namespace

namespace {

/// Warnings that say the same of one thing after another: the first few are printed, the others counted. What was counted is
/// printed when the last printer of a run is gone.
class Repeats {
public:
    ~Repeats() {
        for (const auto& [kind, c] : kinds_)
            if (c.times > kShown)
                std::fprintf(stderr, "warning: %d more like this were not shown (-v shows all): %s\n", c.times - kShown,
                             printable(c.first).c_str());
    }
    bool shows(const Diagnostic& d) {
        std::string kind;
        for (const char c : d.message)
            if (!std::isdigit(static_cast<unsigned char>(c)) || kind.empty() || kind.back() != '0')
                kind += std::isdigit(static_cast<unsigned char>(c)) ? '0' : c;
        if (kinds_.size() >= kMostKinds && !kinds_.count(kind)) return true;
        Kind& k = kinds_[kind];
        if (k.times == 0) k.first = d.message;
        return ++k.times <= kShown;
    }

private:
    static constexpr int kShown = 3;
    static constexpr size_t kMostKinds = 4096;
    struct Kind {
        int times = 0;
        std::string first;
    };
    std::map<std::string, Kind> kinds_; ///< by message, its numbers left out
};

} // namespace

Diagnostics::Handler printer(Severity least) {
    bool terminal = isatty(STDERR_FILENO) != 0;
    return [least, terminal, lines = limits::kSourceLines, repeats = std::make_shared<Repeats>()](Diagnostic d) mutable {
        if (d.severity < least && !(d.always && least <= Severity::Warning)) return;
        if (d.ignored && least > Severity::Info) return;
        if (d.severity == Severity::Warning && least == Severity::Warning && !repeats->shows(d)) return;
        // Who reports when the scene has been read has its places, and no more its text.
        if (d.sourceLine.empty() && lines > 0 && !(d.sourceLine = lineOf(d.place)).empty()) --lines;
        std::string text = toString(d);
        if (terminal) text.insert(0, "\r\033[K");
        std::fputs(text.c_str(), stderr);
    };
}

namespace {

// A signal handler can reach nothing but a global.
StopFlag signalled{0};

extern "C" void onInterrupt(int) {
    if (signalled) _exit(kInterrupted);
    signalled = 1;
}

extern "C" void onStopSignal(int) { signalled = 1; }

void handle(std::initializer_list<int> signals, void (*handler)(int)) {
    struct sigaction a;
    std::memset(&a, 0, sizeof a);
    a.sa_handler = handler;
    a.sa_flags = SA_RESTART;
    for (const int s : signals) sigaction(s, &a, nullptr);
}

} // namespace

std::span<const StatusText> statusTexts() {
    static const StatusText all[] = {{kDone, "done"},
                                     {kDoneWithErrors, "done, but requests failed"},
                                     {kWrongUse, "wrong use"},
                                     {kNothingRendered, "nothing could be rendered"},
                                     {kLimit, "a limit or memory"},
                                     {kOutputFailed, "an output could not be written"},
                                     {kInterrupted, "interrupted, what was done is saved"}};
    return all;
}

bool standardInputHasData() {
    struct stat s;
    return fstat(STDIN_FILENO, &s) == 0 && (S_ISREG(s.st_mode) || S_ISFIFO(s.st_mode) || S_ISSOCK(s.st_mode));
}

const StopFlag* watchInterrupts() {
    handle({SIGINT, SIGTERM}, onInterrupt);
    return &signalled;
}

void watchStopSignal(int signal) { handle({signal}, onStopSignal); }

void leaveInterrupts() { handle({SIGINT, SIGTERM}, SIG_IGN); }

std::vector<std::string> environmentShaders() {
    const char* e = std::getenv("ALPENGLOW_SHADERS");
    return e && *e ? splitSearchPath(e) : std::vector<std::string>{};
}

void addDialect(CLI::App& app, std::string& name) {
    app.add_option("--dialect", name,
                   "Predefine the macros of this renderer's shader compiler (default 3delight); rispec: exponent 1/roughness in "
                   "specular()")
        ->check(CLI::IsMember({"prman", "3delight", "aqsis", "bmrt", "pixie", "entropy", "air", "rispec"}, CLI::ignore_case))
        ->type_name("NAME");
}

std::string faultOfPictureName(const std::string& name, bool output) {
    if (output && name == "-")
        return isatty(STDOUT_FILENO) ? "standard output is a terminal; name a file, or lead it into one or into a program" : "";
    if (display::formatOfExtension(name)) return "";
    return "\"" + name + "\" has no extension of a format that is written: " + display::pictureExtensions() +
           (output ? "; - is standard output" : "");
}

std::vector<std::string> folders(const std::vector<std::string>& lists) {
    std::vector<std::string> all;
    for (const std::string& l : lists)
        for (std::string& f : splitSearchPath(l)) all.push_back(std::move(f));
    return all;
}

void readFormat(const std::string& s, int* width, int* height) {
    int w = 0, h = 0, end = 0;
    if (std::sscanf(s.c_str(), "%6dx%6d%n", &w, &h, &end) != 2 || size_t(end) != s.size() || w <= 0 || h <= 0)
        throw CLI::ValidationError("--format", "takes WIDTHxHEIGHT, for example 640x480");
    if (w > limits::kImageSide || h > limits::kImageSide) throw CLI::ValidationError("--format", "a side is too long");
    *width = w;
    *height = h;
}

void refuseOwnInput(const std::vector<std::string>& files) {
    for (size_t i = 0; i + 1 < files.size(); ++i)
        if (sameFile(files[i], files.back()))
            throw CLI::ValidationError("files", "\"" + files.back() + "\" would replace the file that it is made of");
}

std::optional<std::vector<double>> parseNumbers(const std::string& s, size_t count) {
    std::vector<double> v;
    const char* p = s.c_str();
    while (true) {
        char* end;
        double d = std::strtod(p, &end);
        if (end == p || !std::isfinite(d)) return std::nullopt;
        v.push_back(d);
        p = end;
        if (*p == 0) break;
        if (*p++ != ',') return std::nullopt;
    }
    if (count && v.size() != count) return std::nullopt;
    return v;
}

std::optional<std::vector<int>> parseFrames(const std::string& s) {
    std::vector<int> frames;
    const char* p = s.c_str();
    while (true) {
        char* end;
        long a = std::strtol(p, &end, 10), b = a;
        if (end == p) return std::nullopt;
        p = end;
        if (*p == '-') {
            b = std::strtol(p + 1, &end, 10);
            if (end == p + 1) return std::nullopt;
            p = end;
        }
        if (a < INT_MIN || b > INT_MAX || b < a || b - a > 100000 || frames.size() > 100000) return std::nullopt;
        for (long f = a; f <= b; ++f) frames.push_back(int(f));
        if (*p == 0) return frames;
        if (*p++ != ',') return std::nullopt;
    }
}

} // namespace alpenglow::cli
