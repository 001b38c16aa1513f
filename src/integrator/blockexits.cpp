// Subsurface scattering for vertices in blocks: walks that lobes select, and the light at their exits.
#include "integrator/blockflight.h"
#include "integrator/subsurfacewalks.h"
#include "integrator/surfacepoints.h"
#include "services/random.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

/// Turns rays of subsurface() into walks.
void BlockVertices::walkBelow(size_t b, BatchContext& c) {
    for (Lanes left = next_.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const Site& s = sites_[size_t(next_.site[i])];
        if (!s.walks) continue;
        surfaces_.pointsOfRows(c);
        const size_t point = b * kBlock + size_t(i);
        const LobeVertex* const request = s.requestAt(point);
        next_.goes &= ~(1u << i);
        subsurface_.walks.push_back({int(point),
                                     request ? request->below : int32_t(subsurface_.below.size()),
                                     {next_.weight[0][i], next_.weight[1][i], next_.weight[2][i]},
                                     c.targets[point],
                                     next_.vertex[i],
                                     shareOf(s, point, c.rays[point]),
                                     vertices_[b].energyScale[i]});
        const float* const rows = request ? nullptr : s.rows[b] + i;
        if (rows)
            subsurface_.below.push_back(
                subsurface_.mediumOf(*s.info, c.points[point], [&](int row) { return rows[size_t(row) * size_t(s.stride)]; }));
    }
}

void BlockVertices::runExits(BatchContext& c, std::span<const float> indirect, Sched& sched) {
    begin(c, false);
    loadVertices(c);
    indirect_ = indirect;
    beginExits(c);
    followLobes(c, sched);
}

/// Sets the lobes: diffuse about the normal.
void BlockVertices::beginExits(const BatchContext& c) {
    static const LobeKind* const kind = findLobe("diffuse");
    count_ = 1;
    if (sites_.empty()) sites_.emplace_back();
    Site& s = sites_[0];
    s.number = kSegmentEvent;
    s.info = nullptr;
    s.kind = kind;
    s.lanes = &lanes_.lobes[kind->index];
    s.rays = &kDiffuseKind;
    s.lighting = s.lights = s.diffuse = true;
    s.begin(blocks_);
    if (moved_) s.options.assign(points_, {});
    for (size_t b = 0; b < blocks_; ++b) {
        LobeBlock& l = s.lobes[b];
        l.asked = vertices_[b].points;
        std::fill_n(l.lobe[kRowA], kBlock, 0.f);
        std::fill_n(l.lobe[kRowHasHorizon], kBlock, 0.f);
        for (size_t i = 0; i < size_t(kBlock); ++i) {
            const ShadePoint& p = c.points[std::min(b * kBlock + i, points_ - 1)];
            for (int q = 0; q < 3; ++q) l.weight[q][i] = 1, l.lobe[kRowAxis + q][i] = p.N[q], l.lobe[kRowWo + q][i] = -p.I[q];
        }
    }
}

} // namespace alpenglow::integrator
