// How much memory a run may take (reliability: bounded memory).
#pragma once
#include <cstddef>
#include <new>
#include <optional>
#include <string>

namespace alpenglow {

/// Bytes of memory that this process can have: the machine's, or less where a control group (a container, a batch system) bounds
/// it. 0: not known.
size_t machineMemory();

/// One of the renderer's own limits (base/limits.h) was reached, not the end of the machine's memory. Who throws it, or gives up
/// because of it, has reported what reached it.
class LimitReached : public std::bad_alloc {
public:
    const char* what() const noexcept override { return "a limit was reached"; }
};

/// "512M", "4G", "1.5G", "300000K" or bytes; powers of 1024. Nothing: no size, or none above zero.
std::optional<size_t> parseMemorySize(const std::string&);

/// "3.6 GiB", for messages.
std::string memorySizeText(size_t bytes);

/// What a run may take when the user does not say: nine tenths of machineMemory(), which leave room for the system. 0: unlimited.
size_t defaultMemoryLimit();

/// Bounds the data of this process (heap and private mappings, of all libraries) while it lives: what goes beyond fails as
/// std::bad_alloc. Stacks of `threads` threads, of which most is never touched, are not counted. A bound that is there already
/// (ulimit -d) is never raised. 0 bytes: no bound.
class MemoryLimit {
public:
    MemoryLimit(size_t bytes, int threads);
    ~MemoryLimit();
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;

private:
    std::optional<unsigned long> before_; ///< the bound that comes back
};

} // namespace alpenglow
