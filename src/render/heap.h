// The heap of a process that begins as a copy of another.
#pragma once
#include <cstddef>
#include <cstdint>

namespace alpenglow::render {

/// Bytes of memory that this process has now, but for pages of files; 0 when the system does not say.
uint64_t ownBytes();

/// Makes room for about so many bytes at once, limits::kHeapAtOnce at most, for what is allocated next: the system gives pages
/// one by one, when each is touched first, at many times the price. Less where there is no memory for it. What is free stays
/// with the process from here on. oneThread: only one thread will allocate much at a time.
void fillHeap(size_t bytes, bool oneThread);

} // namespace alpenglow::render
