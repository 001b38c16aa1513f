#include "base/largepages.h"
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <sys/mman.h>

namespace alpenglow {

namespace {
constexpr uintptr_t kLargePage = uintptr_t(2) << 20, kPage = 4096;
}

void adviseLargePages(void* from, size_t bytes) {
#ifdef MADV_HUGEPAGE
    const uintptr_t first = (reinterpret_cast<uintptr_t>(from) + kPage - 1) & ~(kPage - 1);
    const uintptr_t last = (reinterpret_cast<uintptr_t>(from) + bytes) & ~(kPage - 1);
    if (first < last) (void)madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE); // a hint: errors have no effect
#else
    (void)from, (void)bytes;
#endif
}

} // namespace alpenglow

#if !defined(__SANITIZE_ADDRESS__) && !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer)
namespace {

/// As operator new: calls its handler until there is memory. Blocks start where malloc() puts them: aligning to large pages would
/// take two more megabytes of address space each, which --memory-limit counts.
void* allocated(size_t bytes, size_t alignment) {
    if (bytes > PTRDIFF_MAX - alignment) throw std::bad_alloc();
    for (;;) {
        void* p = alignment <= alignof(max_align_t)
                      ? std::malloc(std::max(bytes, size_t(1)))
                      : std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
        if (p && bytes >= alpenglow::kLargePage) alpenglow::adviseLargePages(p, bytes);
        if (p) return p;
        const std::new_handler handler = std::get_new_handler();
        if (!handler) throw std::bad_alloc();
        handler();
    }
}

} // namespace

// operator delete remains the library's: it calls free().
void* operator new(size_t bytes) { return allocated(bytes, alignof(max_align_t)); }
void* operator new(size_t bytes, std::align_val_t alignment) { return allocated(bytes, size_t(alignment)); }
#endif
