// Skies at the last vertices of paths, for vertices in blocks (lastskies.h).
#include "integrator/blockrequests.h"
#include "integrator/surfacepoints.h"
#include <algorithm>
#include <bit>
#include <numeric>

namespace alpenglow::integrator {

/// Samples lobes whose rays a depth limit ends, of those that sample lights.
void BlockVertices::lastSkies(BatchContext& c) {
    ends_.clear();
    for (size_t k = 0; k < count_; ++k)
        for (size_t b = 0; b < blocks_; ++b)
            if (const LobeBlock& l = sites_[k].lobes[b]; l.ended & l.lights & vertices_[b].points) endLobe(sites_[k], b, c);
    if (ends_.empty()) return;
    surfaces_.pointsOfRows(c);
    lastSkies_.send(c, ends_);
}

void BlockVertices::endLobe(const Site& s, size_t b, const BatchContext& c) {
    const VertexBlock& v = vertices_[b];
    const LobeBlock& l = s.lobes[b];
    Lanes some = l.ended & l.lights & v.points;
    render::NumberBlock n;
    beginNumbers(b, n);
    std::fill_n(n.stream, kBlock, uint32_t(s.number) << 1);
    for (size_t i = 0; i < size_t(kBlock) && b * kBlock + i < points_; ++i)
        n.occurrence[i] = s.occurrenceAt(b * kBlock + i) * 4096;
    render::drawBlocks({&n, 1});
    s.draw(b, some, n, drawn_);
    requested_->drawAgain(s, b, some);
    for (int i = 0; i < kBlock; ++i)
        if (drawn_[kRowDrawn][i] == 0) some &= ~(1u << i);
    size_t points[kBlock];
    std::iota(points, points + kBlock, b * kBlock);
    s.lanes->evaluate(l.lobe[0], some, drawn_[kRowDirection], value_[0]);
    s.addLightDirected(some, &drawn_[kRowDirection], points, value_[kRowPdf]);
    for (; some; some &= some - 1) {
        const int i = std::countr_zero(some);
        const float pdf = value_[kRowPdf][i];
        if (!(pdf > 0)) continue;
        const size_t point = points[i];
        const auto row3 = [&](const float(*r)[kBlock]) { return Vec3(r[0][i], r[1][i], r[2][i]); };
        const Vec3 w = row3(&drawn_[kRowDirection]);
        const Color weight = row3(l.weight) * (row3(&value_[kRowColour]) / pdf) * row3(v.weight);
        LastRay& ray = ends_.emplace_back(int(point), &s.raysAt(point), originOf(s, point, w), w, weight, c.targets[point]);
        ray.maxDistance = s.options.empty() ? 1e38f : s.options[point].maxDistance;
        ray.share = shareOf(s, point, c.rays[point]);
        ray.lit = toldAt(point);
        ray.path = pathOf(s, false, point, w, c);
    }
}

} // namespace alpenglow::integrator
