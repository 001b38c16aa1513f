// The program: what a process needs around runProgram().
#include "base/printable.h"
#include "cli/command.h"
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <new>
#include <unistd.h>

using namespace alpenglow;
using namespace alpenglow::cli;

namespace {

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

} // namespace

int main(int argc, char** argv) {
    // Write errors are seen where they happen; these would end the process in the middle of a file.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
#ifdef __GLIBC__
    // Long lists come and go while a scene is made. In pages of their own they go back to the system at once; the C library would
    // keep what lies between others, up to 32 MB at a time.
    mallopt(M_MMAP_THRESHOLD, 4 << 20);
    // Of what lies last in use it keeps this much for the next frame: with its own 128 KiB an animation's frames get half of
    // their pages anew, each time.
    mallopt(M_TRIM_THRESHOLD, 16 << 20);
#endif
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
