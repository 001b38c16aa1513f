#include "render/heap.h"
#include "render/limits.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace alpenglow::render {

uint64_t ownBytes() {
    unsigned long all = 0, resident = 0, files = 0;
    std::FILE* f = std::fopen("/proc/self/statm", "re");
    if (!f) return 0;
    const bool fine = std::fscanf(f, "%20lu %20lu %20lu", &all, &resident, &files) == 3;
    std::fclose(f);
    return fine ? uint64_t(resident - std::min(resident, files)) * uint64_t(sysconf(_SC_PAGESIZE)) : 0;
}

void fillHeap([[maybe_unused]] size_t bytes, [[maybe_unused]] bool oneThread) {
#if defined(__GLIBC__) && defined(MADV_POPULATE_WRITE)
    constexpr size_t kBlock = size_t(16) << 20; // below the smallest size that the C library may map separately
    mallopt(M_MMAP_THRESHOLD, int(2 * kBlock));
    mallopt(M_TRIM_THRESHOLD, int(2 * limits::kHeapAtOnce));
    if (oneThread) mallopt(M_ARENA_MAX, 1); // else the thread has a heap of its own
    const auto page = uintptr_t(sysconf(_SC_PAGESIZE));
    std::vector<void*> blocks;
    for (size_t left = std::min(bytes, limits::kHeapAtOnce); left > 0; left -= std::min(left, kBlock)) {
        const size_t n = std::min(left, kBlock);
        void* block = std::malloc(n);
        if (!block) break;
        blocks.push_back(block);
        const uintptr_t begin = (uintptr_t(block) + page - 1) / page * page, end = (uintptr_t(block) + n) / page * page;
        if (begin >= end) continue;
        madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
        madvise(reinterpret_cast<void*>(begin), end - begin, MADV_POPULATE_WRITE);
    }
    for (void* block : blocks) std::free(block);
#endif
}

} // namespace alpenglow::render
