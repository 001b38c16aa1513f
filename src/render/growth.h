// Tracks which pixels of a band are finished while others are still traced.
#pragma once
#include "render/samplebuffer.h"
#include <atomic>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace alpenglow::render {

/// One thread reads; each worker reports its tasks, each once.
class Growth {
public:
    /// Tasks are the tiles of buffer.sampled(), with this side in pixels, in reading order. `part`: the pixels to reconstruct.
    Growth(const SampleBuffer& buffer, const Window& part, int side);
    /// Tasks are groups of `each` of these pixels; their neighbours do not matter.
    Growth(const SampleBuffer& buffer, std::vector<std::pair<int, int>> pixels, size_t each);
    /// Reports that a task is finished. Any thread.
    void over(size_t task) {
        over_[task].store(1, std::memory_order_release);
        count_.fetch_add(1, std::memory_order_relaxed);
    }
    /// Whether tasks have finished since the last take(). Fast.
    bool grown() const { return count_.load(std::memory_order_relaxed) != taking_; }
    /// Calls f(buffer, rectangle) for all pixels that have become complete.
    void take(const std::function<void(const SampleBuffer&, const Window&)>& f);

private:
    bool ready(size_t task) const;
    Window tileOf(size_t task) const;
    const SampleBuffer& buffer_;
    Window part_;
    int side_ = 0, columns_ = 0, rows_ = 0; ///< of tiles
    std::vector<std::pair<int, int>> pixels_;
    size_t each_ = 0, tasks_ = 0;
    std::unique_ptr<std::atomic<uint8_t>[]> over_;
    std::vector<uint8_t> taken_; ///< by task
    std::atomic<size_t> count_{0};
    size_t taking_ = 0; ///< count_ at the last take()
};

} // namespace alpenglow::render
