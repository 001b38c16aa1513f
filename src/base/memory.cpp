#include "base/memory.h"
#include "base/controlgroup.h"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer) || __has_feature(thread_sanitizer)
#define ALPENGLOW_SHADOW_MEMORY // sanitizers map terabytes that are never touched
#endif
#endif

namespace alpenglow {
namespace {

/// The number in a file; 0 when there is none ("max").
size_t numberIn(const std::string& file) {
    std::ifstream in(file);
    size_t n = 0;
    return in >> n ? n : 0;
}

/// The smallest limit of the control groups; 0: none.
size_t groupMemory() {
    size_t least = 0;
    for (const std::string& folder : controlGroupFolders("memory"))
        for (const char* file : {"/memory.max", "/memory.limit_in_bytes"}) // of version 2, of version 1
            if (const size_t n = numberIn(folder + file); n && (!least || n < least)) least = n;
    return least;
}

} // namespace

size_t machineMemory() {
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    const size_t machine = pages > 0 && page > 0 ? size_t(pages) * size_t(page) : 0, group = groupMemory();
    return group && (!machine || group < machine) ? group : machine;
}

std::optional<size_t> parseMemorySize(const std::string& s) {
    char* end = nullptr;
    double n = std::strtod(s.c_str(), &end);
    if (end == s.c_str() || !std::isfinite(n)) return {};
    std::string unit = end;
    for (char& c : unit) c = char(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    if (unit.size() > 1 && unit.back() == 'B') unit.pop_back();
    if (unit.size() > 1 && unit.back() == 'I') unit.pop_back();
    constexpr const char* kUnits[] = {"", "K", "M", "G", "T"};
    for (const char* u : kUnits) {
        if (unit == u) return n >= 1 && n < 0x1p62 ? std::optional(size_t(n)) : std::nullopt;
        n *= 1024;
    }
    return {};
}

std::string memorySizeText(size_t bytes) {
    constexpr const char* kUnits[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
    double n = double(bytes);
    int unit = 0;
    while (n >= 1024 && unit < 4) n /= 1024, ++unit;
    char text[40];
    std::snprintf(text, sizeof text, "%.3g %s", n, kUnits[unit]);
    return text;
}

size_t defaultMemoryLimit() { return machineMemory() / 10 * 9; }

MemoryLimit::MemoryLimit([[maybe_unused]] size_t bytes, [[maybe_unused]] int threads) {
#ifndef ALPENGLOW_SHADOW_MEMORY
    rlimit stack{}, data{};
    if (!bytes || getrlimit(RLIMIT_STACK, &stack) != 0 || getrlimit(RLIMIT_DATA, &data) != 0) return;
    // The stack of a thread has the size RLIMIT_STACK, or 2 MiB if that is unlimited; twice, for threads of libraries.
    const size_t each = stack.rlim_cur == RLIM_INFINITY ? size_t(2) << 20 : std::min(size_t(stack.rlim_cur), size_t(64) << 20);
    const rlim_t most = rlim_t(bytes) + rlim_t(2 * each * size_t(std::max(1, threads))), before = data.rlim_cur;
    data.rlim_cur = std::min({most, data.rlim_cur, data.rlim_max}); // RLIM_INFINITY is the largest
    if (setrlimit(RLIMIT_DATA, &data) == 0) before_ = before;
#endif
}

MemoryLimit::~MemoryLimit() {
    rlimit data{};
    if (!before_ || getrlimit(RLIMIT_DATA, &data) != 0) return;
    data.rlim_cur = *before_;
    setrlimit(RLIMIT_DATA, &data);
}

} // namespace alpenglow
