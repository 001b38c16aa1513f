// Large blocks of memory in large pages. A page of four kilobytes that is touched first costs microseconds on virtual machines:
// a tenth of a simple frame, a fifth of one whose surfaces are diced. So operator new asks for pages of two megabytes for blocks
// that hold some (largepages.cpp); what malloc() hands out otherwise, and memory under sanitizers, is as the system has it.
#pragma once
#include <cstddef>

namespace alpenglow {

/// Asks the system for large pages in a range that nobody has written to yet. Where it has none nothing changes.
void adviseLargePages(void* from, size_t bytes);

} // namespace alpenglow
