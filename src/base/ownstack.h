// A stack of its own for work that nests deeply, so that recursion never reaches the end of the thread's stack.
#pragma once
#include <functional>

namespace alpenglow {

/// Runs `body` at once, on the same thread, on a new stack of 8 MiB, of which only what is used takes memory. Exceptions of the
/// body come out here. Where no such stack can be had (memory, address space), throws std::bad_alloc and does not run it.
void onOwnStack(const std::function<void()>& body);

} // namespace alpenglow
