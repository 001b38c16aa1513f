#include "integrator/lastvertices.h"
#include "base/numberlanes.h"
#include "integrator/singlerequests.h"
#include "integrator/stageset.h"
#include "integrator/surfacepoints.h"
#include <algorithm>
#include <bit>
#include <numeric>

namespace alpenglow::integrator {

LastVertices::LastVertices(const StageSet& s, const VertexStages& v)
    : VertexStage(s, v), lastSkies_(s.lastSkies), single_(v.single), surfaces_(s.surfaces) {}

/// Samples lobes whose rays a depth limit ends, of those that sample lights.
void LastVertices::run(BatchContext& c) {
    ends_.clear();
    for (size_t k = 0; k < v_.count; ++k)
        for (size_t b = 0; b < v_.blocks; ++b)
            if (const LobeBlock& l = v_.sites[k].lobes[b]; l.ended & l.lights & v_.vertices[b].points) endLobe(v_.sites[k], b, c);
    if (ends_.empty()) return;
    surfaces_.pointsOfRows(c);
    lastSkies_.send(c, ends_);
}

void LastVertices::endLobe(const Site& s, size_t b, const BatchContext& c) {
    const VertexBlock& v = v_.vertices[b];
    const LobeBlock& l = s.lobes[b];
    Lanes some = l.ended & l.lights & v.points;
    NumberBlock n;
    v_.beginNumbers(b, n);
    std::fill_n(n.stream, kBlock, uint32_t(s.number) << 1);
    for (size_t i = 0; i < size_t(kBlock) && b * kBlock + i < v_.points; ++i)
        n.occurrence[i] = s.occurrenceAt(b * kBlock + i) * 4096;
    drawBlocks({&n, 1});
    s.draw(b, some, n, v_.drawn);
    single_.drawAgain(s, b, some);
    for (int i = 0; i < kBlock; ++i)
        if (v_.drawn[kRowDrawn][i] == 0) some &= ~(1u << i);
    size_t points[kBlock];
    std::iota(points, points + kBlock, b * kBlock);
    s.lanes->evaluate(l.lobe[0], some, v_.drawn[kRowDirection], v_.value[0]);
    s.addLightDirected(some, &v_.drawn[kRowDirection], points, v_.value[kRowPdf]);
    for (; some; some &= some - 1) {
        const int i = std::countr_zero(some);
        const float pdf = v_.value[kRowPdf][i];
        if (!(pdf > 0)) continue;
        const size_t point = points[i];
        const auto row3 = [&](const float(*r)[kBlock]) { return Vec3(r[0][i], r[1][i], r[2][i]); };
        const Vec3 w = row3(&v_.drawn[kRowDirection]);
        const Color weight = row3(l.weight) * (row3(&v_.value[kRowColour]) / pdf) * row3(v.weight);
        LastRay& ray = ends_.emplace_back(int(point), &s.raysAt(point), v_.originOf(s, point, w), w, weight, c.targets[point]);
        ray.maxDistance = s.options.empty() ? 1e38f : s.options[point].maxDistance;
        ray.share = v_.shareOf(s, point, c.rays[point]);
        ray.lit = v_.litSurfaceAt(point);
        ray.path = v_.pathOf(s, false, point, w, c);
    }
}

} // namespace alpenglow::integrator
