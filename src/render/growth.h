// Which pixels of a band nobody works at any more, while others are still traced.
#pragma once
#include "render/samplebuffer.h"
#include <atomic>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace alpenglow::render {

/// One thread asks; tasks are told to be over by those that do them, each once.
class Growth {
public:
    /// Tasks are the tiles of buffer.sampled(), of so many pixels a side, in reading order. `part`: what is reconstructed.
    Growth(const SampleBuffer& buffer, const Window& part, int side);
    /// Tasks are so many of these pixels each, alone: what lies beside them does not count.
    Growth(const SampleBuffer& buffer, std::vector<std::pair<int, int>> pixels, size_t each);
    /// A task is over. Any thread.
    void over(size_t task) {
        over_[task].store(1, std::memory_order_release);
        count_.fetch_add(1, std::memory_order_relaxed);
    }
    /// Whether more tasks are over than at the last take(). Quick.
    bool grown() const { return count_.load(std::memory_order_relaxed) != taking_; }
    /// Calls f(buffer, rectangle) for what can be reconstructed now and could not before.
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
