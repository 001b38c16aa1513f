#include "integrator/vertexblocks.h"
#include "base/numberlanes.h"
#include <algorithm>

namespace alpenglow::integrator {

VertexBlocks::VertexBlocks() { std::fill_n(whole_, kBlock, 1.f); }

std::span<LobeBlock*> VertexBlocks::lobesOf(size_t b) {
    block_.clear();
    for (size_t k = 0; k < count_; ++k) block_.push_back(&sites_[k].lobes[b]);
    return block_;
}

void VertexBlocks::beginNumbers(size_t b, render::NumberBlock& n) const {
    const VertexBlock& v = vertices_[b];
    std::copy_n(v.low, kBlock, n.low);
    std::copy_n(v.high, kBlock, n.high);
    std::copy_n(v.index, kBlock, n.index);
    std::copy_n(v.vertex, kBlock, n.vertex);
    std::fill_n(n.occurrence, kBlock, 0u);
}

void VertexBlocks::drawNumbers(uint32_t stream, std::vector<render::NumberBlock>& to, bool ofLights) const {
    to.resize(blocks_);
    for (size_t b = 0; b < blocks_; ++b) {
        beginNumbers(b, to[b]);
        if (ofLights) std::copy_n(vertices_[b].lightVertex, kBlock, to[b].vertex);
        std::fill_n(to[b].stream, kBlock, stream);
    }
    render::drawBlocks(to);
}

} // namespace alpenglow::integrator
