// Memory limits of a run.
#pragma once
#include <cstddef>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow {

/// Memory in bytes available to this process: the machine's, or less if a control group (a container, a batch system) limits it.
/// 0: unknown.
size_t machineMemory();

/// One of the renderer's own limits (base/limits.h) was reached, as opposed to the machine's memory. The thrower, or a caller
/// that gives up because of it, has reported it.
class LimitReached : public std::bad_alloc {
public:
    const char* what() const noexcept override { return "a limit was reached"; }
};

/// Parses "512M", "4G", "1.5G", "300000K" or bytes; powers of 1024. Returns nothing if it is not a size above zero.
std::optional<size_t> parseMemorySize(const std::string&);

/// "3.6 GiB", for messages.
std::string memorySizeText(size_t bytes);

/// Memory that a vector holds, in bytes, without what its elements hold.
template <class T> size_t bytesOf(const std::vector<T>& v) { return v.capacity() * sizeof(T); }

/// Default memory limit of a run: nine tenths of machineMemory(), to leave room for the system. 0: unlimited.
size_t defaultMemoryLimit();

/// Limits the data of this process (heap and private mappings, of all libraries) during its lifetime: larger allocations fail
/// with std::bad_alloc. Stacks of `threads` threads, which are mostly untouched, are excluded. Never raises an existing limit
/// (ulimit -d). 0 bytes: no limit.
class MemoryLimit {
public:
    /// Sets the limit; the destructor restores the old one.
    MemoryLimit(size_t bytes, int threads);
    ~MemoryLimit();
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;

private:
    std::optional<unsigned long> before_; ///< the limit to restore
};

} // namespace alpenglow
