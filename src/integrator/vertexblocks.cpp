#include "integrator/vertexblocks.h"
#include "base/memory.h"
#include "base/numberlanes.h"
#include "integrator/lightpathstates.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"
#include "integrator/surfacepoints.h"
#include <algorithm>

namespace alpenglow::integrator {

VertexBlocks::VertexBlocks(const StageSet& s) : Stage(s.context), paths_(s.paths), store_(s.store), surfaces_(s.surfaces) {
    std::fill_n(whole, kBlock, 1.f);
}

size_t VertexBlocks::bytes() const {
    size_t sum = sizeof(*this) + bytesOf(vertices) + bytesOf(rays) + bytesOf(lights) + bytesOf(queries) + bytesOf(asked) +
                 bytesOf(values) + bytesOf(pairs) + bytesOf(choices) + bytesOf(sites);
    for (const Site& s : sites) sum += bytesOf(s.lobes) + bytesOf(s.narrow) + bytesOf(s.options) + bytesOf(s.requests);
    return sum;
}

VertexStage::VertexStage(const StageSet& s, const VertexStages& v) : Stage(s.context), v_(v.blocks), stages_(lanes::stages()) {}

std::span<LobeBlock*> VertexBlocks::lobesOf(size_t b) {
    block_.clear();
    for (size_t k = 0; k < count; ++k) block_.push_back(&sites[k].lobes[b]);
    return block_;
}

void VertexBlocks::beginNumbers(size_t b, NumberBlock& n) const {
    const VertexBlock& v = vertices[b];
    std::copy_n(v.low, kBlock, n.low);
    std::copy_n(v.high, kBlock, n.high);
    std::copy_n(v.index, kBlock, n.index);
    std::copy_n(v.vertex, kBlock, n.vertex);
    std::fill_n(n.occurrence, kBlock, 0u);
}

void VertexBlocks::drawNumbers(uint32_t stream, std::vector<NumberBlock>& to, bool ofLights) const {
    to.resize(blocks);
    for (size_t b = 0; b < blocks; ++b) {
        beginNumbers(b, to[b]);
        if (ofLights) std::copy_n(vertices[b].lightVertex, kBlock, to[b].vertex);
        std::fill_n(to[b].stream, kBlock, stream);
    }
    drawBlocks(to);
}

/// Origin of a ray of a lobe in direction w.
Vec3 VertexBlocks::originOf(const Site& s, size_t point, const Vec3& w) const {
    const VertexBlock& v = vertices[point / kBlock];
    const size_t i = point % kBlock;
    const Vec3 P(v.P[0][i], v.P[1][i], v.P[2][i]), n(v.n[0][i], v.n[1][i], v.n[2][i]);
    if (!s.options.empty()) {
        const RayOptions& o = s.options[point];
        const Vec3 at = o.ownOrigin ? o.from : P;
        if (o.bias >= 0) return at + w * o.bias;
        if (o.ownOrigin) return at + w * geometry::roundingError(at);
    }
    if (moved) return surfaces_.leave(*moved, point, w);
    return v.bias[i] > 0 ? P + w * v.bias[i] : geometry::offsetOrigin(P, n, v.error[i], w);
}

uint16_t VertexBlocks::pathOf(const Site& s, bool delta, size_t point, const Vec3& w, const BatchContext& c) const {
    if (waits || !paths_.automaton) return 0;
    return paths_.atLobe(*s.kind, s.raysAt(point), delta, c.points[point], c.rays[point], w);
}

} // namespace alpenglow::integrator
