// Large memory blocks in large pages. The first touch of a 4 KiB page costs microseconds on virtual machines: a tenth of a simple
// frame, a fifth of one with diced surfaces. So operator new requests 2 MiB pages for blocks that contain some (largepages.cpp).
// Other memory, and memory under sanitizers, is not affected.
#pragma once
#include <cstddef>

namespace alpenglow {

/// Requests large pages for a range that has not been written to. No effect if the system has none.
void adviseLargePages(void* from, size_t bytes);

} // namespace alpenglow
