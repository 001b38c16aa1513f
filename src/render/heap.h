// Heap memory of forked processes.
#pragma once
#include <cstddef>
#include <cstdint>

namespace alpenglow::render {

/// Private memory of this process in bytes, without pages of files; 0 if the system does not tell.
uint64_t ownBytes();

/// Allocates about so many bytes at once, at most limits::kHeapAtOnce, for later allocations: page by page, at first touch, the
/// system takes many times longer. Allocates less if memory is short. Freed memory stays with the process from here on.
/// oneThread: only one thread will allocate much at a time.
void fillHeap(size_t bytes, bool oneThread);

} // namespace alpenglow::render
