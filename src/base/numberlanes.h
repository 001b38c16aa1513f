// Random numbers of many samples at once: the numbers of SampleNumbers with the same bits, in one call over lanes. Compiled for
// 4, 8 and 16 lanes and selected once by processor.
#pragma once
#include "base/numberblock.h"
#include "base/sampler.h"
#include <span>
#include <vector>

namespace alpenglow {

/// A list of requests for random numbers: first request all, then draw(), then read; clear() starts again in the same memory.
class NumberRows {
public:
    /// Requests s.get2(vertex, site, occurrence): pair(i) for the i-th request since clear().
    void askPair(const SampleNumbers& s, uint32_t vertex, uint32_t site, uint32_t occurrence) {
        ask(s, vertex, site << 1, occurrence);
    }
    /// Requests s.get1(vertex, site, occurrence): one(i).
    void askOne(const SampleNumbers& s, uint32_t vertex, uint32_t site, uint32_t occurrence) {
        ask(s, vertex, site << 1 | SampleNumbers::kSingle, occurrence);
    }
    /// Computes the numbers of all requests since clear().
    void draw();
    /// The result of request i, of two numbers in [0, 1); valid after draw().
    Vec2 pair(size_t i) const { return {blocks_[i / kSize].x[i % kSize], blocks_[i / kSize].y[i % kSize]}; }
    /// The result of request i, of one number; valid after draw().
    float one(size_t i) const { return blocks_[i / kSize].x[i % kSize]; }
    /// Number of requests.
    size_t size() const { return count_; }
    /// Forgets all requests; memory is kept.
    void clear() { count_ = 0; }

private:
    static constexpr size_t kSize = NumberBlock::kSize;
    void ask(const SampleNumbers& s, uint32_t vertex, uint32_t stream, uint32_t occurrence) {
        if (count_ == blocks_.size() * kSize) blocks_.emplace_back();
        NumberBlock& b = blocks_[count_ / kSize];
        const size_t lane = count_++ % kSize;
        b.low[lane] = s.low_, b.high[lane] = s.high_, b.index[lane] = s.index_;
        b.vertex[lane] = vertex, b.stream[lane] = stream, b.occurrence[lane] = occurrence;
    }
    std::vector<NumberBlock> blocks_;
    size_t count_ = 0;
};

/// Draws the numbers of complete blocks, with the widest lanes that this processor has.
void drawBlocks(std::span<NumberBlock>);

} // namespace alpenglow
