// The output "albedo": a sum over the lobes of a camera ray's point.
#include "integrator/accumulator.h"
#include "integrator/lobeselection.h"
#include "services/random.h"
#include <algorithm>

namespace alpenglow::integrator {

/// Sampled directions for the estimate of an albedo.
constexpr uint32_t kAlbedoDraws = 8;

/// Whether the output "albedo" of lobes of this kind that are no deltas has no closed form.
static bool albedoIsMeasured(const LobeKind& k, const RayKind& rays) { return k.distribution || rays.type != RayType::Diffuse; }

/// An unbiased estimate from sampled directions, one in a lane.
static Color measuredAlbedo(const BlockLobes& s, const PathRay& ray, size_t point) {
    const LobeBlock& l = s.lobes[point / kBlock];
    const size_t i = point % kBlock;
    constexpr int kDraws = int(kAlbedoDraws);
    constexpr Lanes all = (1u << kDraws) - 1;
    static_assert(kDraws <= kBlock);
    alignas(64) Row lobe[kLobeRows];
    alignas(64) float drawn[kDrawnRows][kBlock], value[kValueRows][kBlock];
    for (int r = 0; r < kLobeRows; ++r) std::fill_n(lobe[r], kBlock, l.lobe[r][i]);
    NumberBlock n;
    for (int k = 0; k < kBlock; ++k) {
        const SampleNumbers of = ray.sample->numbers.draw(uint32_t(k % kDraws), kAlbedoDraws);
        n.low[k] = of.low(), n.high[k] = of.high(), n.index[k] = of.index(), n.vertex[k] = ray.vertex;
    }
    std::fill_n(n.stream, kBlock, kAlbedo << 1);
    std::fill_n(n.occurrence, kBlock, uint32_t(s.number) * 4096 + s.occurrenceAt(point));
    drawBlocks({&n, 1});
    s.lanes->sample(lobe[0], all, n.x, drawn[0]);
    s.lanes->evaluate(lobe[0], all, drawn[kRowDirection], value[0]);
    Color sum(0);
    for (int k = 0; k < kDraws; ++k) {
        const float pdf = drawn[kRowDrawn][k] != 0 ? value[kRowPdf][k] : 0;
        if (pdf > 0) sum += Color(value[kRowColour][k], value[kRowColour + 1][k], value[kRowColour + 2][k]) / pdf;
    }
    return sum / float(kDraws);
}

void LobeSelection::showAlbedo(BatchContext& c) {
    if (c.lightOutput) return;
    for (size_t point = 0; point < v_.points; ++point) {
        const PathRay& ray = c.rays[point];
        if (!ray.counts) continue;
        const size_t b = point / kBlock, i = point % kBlock;
        Color exact(0);
        std::vector<Color> measured;
        for (size_t k = 0; k < v_.count; ++k) {
            const LobeBlock& l = v_.sites[k].lobes[b];
            if (!(l.asked >> i & 1)) continue;
            const Color weight(l.weight[0][i], l.weight[1][i], l.weight[2][i]);
            if (l.lobe[kRowDelta][i] != 0 || v_.sites[k].walks || !albedoIsMeasured(*v_.sites[k].kind, v_.sites[k].raysAt(point)))
                exact += weight * l.lobe[kRowAlbedo][i];
            else measured.push_back(ray.weight * weight * measuredAlbedo(v_.sites[k], ray, point));
        }
        Color& albedo = accumulator_.results[size_t(ray.sample->path)]->albedo;
        albedo += ray.weight * exact;
        for (const Color& seen : measured)
            if (isFinite(seen)) albedo += seen;
    }
}

} // namespace alpenglow::integrator
