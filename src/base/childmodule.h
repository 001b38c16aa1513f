// Modules that read files of strangers with libraries of strangers: they work in a child process with a limit on memory and time,
// so what goes wrong in them ends the child and is an error here. display/foreign.h and models/modelfile.h use it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <sys/types.h>

namespace alpenglow {

/// A descriptor that is closed.
struct Descriptor {
    int fd = -1; ///< -1: none
    Descriptor() = default;
    /// Takes over the descriptor.
    explicit Descriptor(int f) : fd(f) {}
    /// Leaves -1 behind.
    Descriptor(Descriptor&& o) noexcept : fd(o.fd) { o.fd = -1; }
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor();
};

/// How a child ended.
struct ChildResult {
    /// Whether the work was done, or what prevented it. Late: the time limit was reached.
    enum class End { Done, NoChild, NoModule, Failed, Signal, Late } end = End::NoChild;
    Descriptor written; ///< what the module wrote, in memory
    std::string why;    ///< NoChild, NoModule, Failed: in words; may be ""
    int signal = 0;     ///< Signal: which
};

/// What runs in the child: `function` is the module's, `to` where it writes. 0 when it is done, else `why`, of whySize bytes,
/// says what went wrong. No destructor of the program runs after it.
using ChildWork = std::function<int(void* function, int to, char* why, int whySize)>;

/// Loads the module `file` in a child process and runs `work` on its function `name`. `memory`: bytes that the child may take
/// in addition to what this process has; seconds: limits::kProgramSeconds.
ChildResult runChildModule(const std::string& file, const char* name, uint64_t memory, const ChildWork& work);

/// The size of what was written, and all of it from `from` on; false: it could not be read.
size_t writtenBytes(const ChildResult&);
/// Copies `bytes` of it, from byte `from` on, to `to`; false: so many cannot be read.
bool readWritten(const ChildResult&, void* to, size_t bytes, size_t from = 0);

} // namespace alpenglow
