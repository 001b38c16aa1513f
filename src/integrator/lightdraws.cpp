// Several samples of a light at a vertex: where all rays of a trace() are followed, each lobe takes as many samples of each light
// as it sends rays.
#include "integrator/lightsample.h"
#include "integrator/lightsampling.h"
#include "integrator/shadowrays.h"
#include "services/random.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

/// Whether a lobe of some call site takes several samples of a light.
bool LightSampling::drawsSeveral() const {
    if (rules_.pickOne && !v_.waits) return false;
    return std::any_of(v_.sites.begin(), v_.sites.begin() + long(v_.count), [](const Site& s) {
        return s.lights && !s.lighting &&
               std::any_of(s.options.begin(), s.options.end(), [](const RayOptions& o) { return o.samples > 1; });
    });
}

/// Samples of each light that the lobe of a call site takes at a point.
int LightSampling::drawsOf(const Site& s, size_t point) const {
    return !v_.several || s.lighting || s.options.empty() ? 1 : s.options[point].samples;
}

/// Samples of a light that a point takes: the most of its lobes. Lobes that want fewer take the first ones.
int LightSampling::drawsOf(const BoundLight& light, size_t point) const {
    int most = 1;
    for (size_t k = 0; k < v_.count && v_.several; ++k)
        if (lightsAt(v_.sites[k], light, point)) most = std::max(most, drawsOf(v_.sites[k], point));
    return most;
}

/// Whether the lobe of a call site samples a light at a point.
bool LightSampling::lightsAt(const Site& s, const BoundLight& light, size_t point) const {
    const LobeBlock& l = s.lobes[point / kBlock];
    const size_t i = point % kBlock;
    return (l.lights >> i & 1) && samples(s, light) && !(light.guidable && !(l.chosen[i] > 0));
}

/// Samples a light for the points of v_.lit and v_.litBlocks, as often as they want.
void LightSampling::lightAlone(const BoundLight& light, BatchContext& c, Sched& sched) {
    int draws = 1;
    for (const size_t b : v_.litBlocks)
        for (Lanes left = v_.several ? v_.lit[b] : 0; left; left &= left - 1)
            draws = std::max(draws, drawsOf(light, b * kBlock + size_t(std::countr_zero(left))));
    for (v_.draw = 0; v_.draw < uint32_t(draws); ++v_.draw) {
        if (v_.draw > 0) findLit(&light);
        lightOnce(light, c);
        if (shadows_.queue.size() > kShadowsAtOnce) shadows_.flush(sched);
    }
    v_.draw = 0;
}

/// Draws the numbers of a light's samples at all points, of one stream.
void LightSampling::drawOf(const BoundLight& light, uint32_t stream, std::vector<NumberBlock>& to) const {
    const bool placed = light.kind == LightKind::Area || light.isSky(); // waiting kernels draw these anew for each call
    if (!v_.several) return v_.drawNumbers(stream, to, placed);
    to.resize(v_.blocks);
    for (size_t b = 0; b < v_.blocks; ++b) {
        NumberBlock& n = to[b];
        v_.beginNumbers(b, n);
        if (placed) std::copy_n(v_.vertices[b].lightVertex, kBlock, n.vertex);
        std::fill_n(n.stream, kBlock, stream);
        for (Lanes left = v_.lit[b]; left; left &= left - 1) {
            const int i = std::countr_zero(left);
            nameDraw(v_.rays[b], i, uint32_t(drawsOf(light, b * kBlock + size_t(i))), n, i);
        }
    }
    drawBlocks(to);
}

/// Sets the keys of lane `to` for the current one of `draws` samples of a ray.
void LightSampling::nameDraw(const RayBlock& rays, int lane, uint32_t draws, NumberBlock& n, int to) const {
    const SampleNumbers of = v_.sampleOf(rays, lane).numbers.draw(v_.draw, draws);
    n.low[to] = of.low(), n.high[to] = of.high(), n.index[to] = of.index();
}

/// Whether connection_.dropUnhit() must look at each sample of a light; otherwise no point has samples on backs of emitters.
bool LightSampling::checksHits(const BoundLight& light) const {
    if (light.kind != LightKind::Area) return false;
    return light.channels || std::any_of(v_.sites.begin(), v_.sites.begin() + long(v_.count),
                                         [&](const Site& s) { return s.lights && !s.lighting && (light.mean || s.sets); });
}

} // namespace alpenglow::integrator
