// The flag by which one thread asks others to stop.
#pragma once
#include <atomic>
#include <cstdint>

namespace alpenglow {

/// 0: go on; anything else: stop soon. Loads and stores are relaxed: a flag carries nothing but itself. Kernels read the four
/// bytes at its address, and a signal handler may set it (it is free of locks).
class StopFlag {
public:
    /// Read and written like an integer; all three are atomic.
    constexpr StopFlag(int32_t v = 0) : value_(v) {}
    operator int32_t() const { return value_.load(std::memory_order_relaxed); }
    StopFlag& operator=(int32_t v) {
        value_.store(v, std::memory_order_relaxed);
        return *this;
    }

private:
    std::atomic<int32_t> value_;
};
static_assert(sizeof(StopFlag) == sizeof(int32_t) && std::atomic<int32_t>::is_always_lock_free);

} // namespace alpenglow
