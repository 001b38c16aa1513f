#include "base/largepages.h"
#include <algorithm>
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
    if (first < last) (void)madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE); // a wish: errors change nothing
#else
    (void)from, (void)bytes;
#endif
}

} // namespace alpenglow

#if !defined(__SANITIZE_ADDRESS__) && !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer)
namespace {

/// allocate() until there is memory, as operator new does; large blocks in large pages.
template <class Allocate> void* allocated(size_t bytes, Allocate allocate) {
    for (;;) {
        if (void* p = allocate()) {
            if (bytes >= alpenglow::kLargePage) alpenglow::adviseLargePages(p, bytes);
            return p;
        }
        const std::new_handler handler = std::get_new_handler();
        if (!handler) throw std::bad_alloc();
        handler();
    }
}

} // namespace

// As the library's, of which operator delete stays: it calls free().
void* operator new(size_t bytes) {
    return allocated(bytes, [&] { return std::malloc(bytes ? bytes : 1); });
}
void* operator new(size_t bytes, std::align_val_t alignment) {
    const size_t a = std::max(size_t(alignment), sizeof(void*));
    if (bytes > SIZE_MAX - a) throw std::bad_alloc();
    return allocated(bytes, [&] { return std::aligned_alloc(a, (std::max(bytes, size_t(1)) + a - 1) / a * a); });
}
#endif
