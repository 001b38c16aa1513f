// The program: finds the subcommand, reads its arguments. `alpenglow scene.rib` is `alpenglow render scene.rib`.
#include "base/memory.h"
#include "base/printable.h"
#include "base/processors.h"
#include "cli/command.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <sstream>
#include <unistd.h>

using namespace alpenglow;
using namespace alpenglow::cli;

namespace {

/// Old tools' spellings, made what the parser takes: maketx's -envlatl, numbers like -.5.
std::vector<std::string> normalise(int argc, char** argv, const CLI::App& app) {
    std::vector<std::string> args(argv + 1, argv + argc);
    bool known = false;
    if (!args.empty()) {
        for (const CLI::App* s : app.get_subcommands([](const CLI::App*) { return true; })) known |= s->get_name() == args[0];
        if (!known && args[0] != "-h" && args[0] != "--help" && args[0] != "--version" && args[0] != "--help-all")
            args.insert(args.begin(), "render");
    }
    for (size_t i = 1; i < args.size(); ++i) {
        std::string& a = args[i];
        if (a.size() > 2 && a[0] == '-' && a[1] == '.' && std::isdigit(static_cast<unsigned char>(a[2]))) a.insert(1, "0");
        if (args[0] == "maketx" && a.size() > 2 && a[0] == '-' && std::isalpha(static_cast<unsigned char>(a[1])))
            a.insert(0, "-");
    }
    return args;
}

/// The end of a process that nothing can catch any more: memory that ran out where no exception may pass (kernels, destructors).
[[noreturn]] void onTerminate() {
    try {
        if (std::exception_ptr e = std::current_exception()) std::rethrow_exception(e);
    } catch (const std::bad_alloc&) {
        constexpr char text[] = "alpenglow: out of memory\n";
        [[maybe_unused]] ssize_t n = ::write(STDERR_FILENO, text, sizeof text - 1);
        _exit(kLimit);
    } catch (...) {}
    std::abort();
}

/// Before all others, so that it holds while static data are made.
[[gnu::constructor(101)]] void takeTerminate() { std::set_terminate(onTerminate); }

/// Whether all of standard output has arrived; says why not. A reader that went away (head) needs no message.
bool outputArrived() {
    errno = 0;
    const bool fine = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
    if (!fine && errno != EPIPE)
        std::fprintf(stderr, "alpenglow: cannot write standard output: %s\n", std::strerror(errno ? errno : EIO));
    return fine;
}

int runProgram(int argc, char** argv) {
    int status = kDone;
    CLI::App app("Alpenglow renders RenderMan scenes: RIB in, shaders in RSL as machine code, path-traced pictures out.",
                 "alpenglow");
    app.set_version_flag("--version", "alpenglow " ALPENGLOW_VERSION);
    app.require_subcommand(1);
    app.get_formatter()->column_width(34);
    app.footer(
        "alpenglow scene.rib is the same as alpenglow render scene.rib. alpenglow COMMAND --help tells more.\n\n"
        "Exit status: 0 done; 1 done, but requests failed; 2 wrong use; 3 nothing could be rendered; 4 a limit or memory;\n"
        "5 an output could not be written; 130 interrupted, what was done is saved.");
    addRender(app, &status);
    addEval(app, &status);
    addShade(app, &status);
    addCompile(app, &status);
    addInfo(app, &status);
    addProbe(app, &status);
    addMaketx(app, &status);
    addDiff(app, &status);
    addMerge(app, &status);
    addLsp(app, &status);
    std::vector<std::string> args = normalise(argc, argv, app);
    const bool own = !args.empty() && args.front() == "render"; // has an option for it
    const MemoryLimit limit(own ? 0 : defaultMemoryLimit(), defaultThreads());
    std::reverse(args.begin(), args.end()); // as the parser takes vectors
    try {
        app.parse(args);
    } catch (const CLI::ParseError& e) {
        std::ostringstream out, err; // they name what was given
        const int code = app.exit(e, out, err);
        std::fputs(printable(out.str()).c_str(), stdout);
        std::fputs(printable(err.str()).c_str(), stderr);
        return code == 0 ? kDone : kWrongUse;
    }
    return status;
}

} // namespace

int main(int argc, char** argv) {
    // Write errors are seen where they happen; these would end the process in the middle of a file.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    int status = kDone;
    try {
        status = runProgram(argc, argv);
    } catch (const std::bad_alloc&) {
        std::fputs("alpenglow: out of memory\n", stderr);
        return kLimit;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "alpenglow: %s\n", printable(e.what()).c_str());
        return kNothingRendered;
    }
    if (!outputArrived() && (status == kDone || status == kDoneWithErrors)) status = kOutputFailed;
    return status;
}
