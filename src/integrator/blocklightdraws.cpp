// Several samples of a light at a vertex in blocks: where all rays of a trace() are followed, each lobe takes as many samples of
// each light as it sends rays.
#include "integrator/blockvertices.h"
#include "integrator/lightsample.h"
#include "integrator/shadowrays.h"
#include "services/random.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

/// Whether a lobe of some call site takes several samples of a light.
bool BlockVertices::drawsSeveral() const {
    if (rules_.pickOne && !waits_) return false;
    return std::any_of(sites_.begin(), sites_.begin() + long(count_), [](const Site& s) {
        return s.lights && !s.lighting &&
               std::any_of(s.options.begin(), s.options.end(), [](const RayOptions& o) { return o.samples > 1; });
    });
}

/// Samples of each light that the lobe of a call site takes at a point.
int BlockVertices::drawsOf(const Site& s, size_t point) const {
    return !several_ || s.lighting || s.options.empty() ? 1 : s.options[point].samples;
}

/// Samples of a light that a point takes: the most of its lobes. Lobes that want fewer take the first ones.
int BlockVertices::drawsOf(const BoundLight& light, size_t point) const {
    int most = 1;
    for (size_t k = 0; k < count_ && several_; ++k)
        if (lightsAt(sites_[k], light, point)) most = std::max(most, drawsOf(sites_[k], point));
    return most;
}

/// Whether the lobe of a call site samples a light at a point.
bool BlockVertices::lightsAt(const Site& s, const BoundLight& light, size_t point) const {
    const LobeBlock& l = s.lobes[point / kBlock];
    const size_t i = point % kBlock;
    return (l.lights >> i & 1) && samples(s, light) && !(light.guidable && !(l.chosen[i] > 0));
}

/// Samples a light for the points of lit_ and litBlocks_, as often as they want.
void BlockVertices::lightAlone(const BoundLight& light, BatchContext& c, Sched& sched) {
    int draws = 1;
    for (const size_t b : litBlocks_)
        for (Lanes left = several_ ? lit_[b] : 0; left; left &= left - 1)
            draws = std::max(draws, drawsOf(light, b * kBlock + size_t(std::countr_zero(left))));
    for (draw_ = 0; draw_ < uint32_t(draws); ++draw_) {
        if (draw_ > 0) findLit(&light);
        lightOnce(light, c);
        if (shadows_.queue.size() > kShadowsAtOnce) shadows_.flush(sched);
    }
    draw_ = 0;
}

/// Draws the numbers of a light's samples at all points, of one stream.
void BlockVertices::drawOf(const BoundLight& light, uint32_t stream, std::vector<render::NumberBlock>& to) const {
    const bool placed = light.kind == LightKind::Area || light.isSky(); // waiting kernels draw these anew for each call
    if (!several_) return drawNumbers(stream, to, placed);
    to.resize(blocks_);
    for (size_t b = 0; b < blocks_; ++b) {
        render::NumberBlock& n = to[b];
        beginNumbers(b, n);
        if (placed) std::copy_n(vertices_[b].lightVertex, kBlock, n.vertex);
        std::fill_n(n.stream, kBlock, stream);
        for (Lanes left = lit_[b]; left; left &= left - 1) {
            const int i = std::countr_zero(left);
            nameDraw(rays_[b], i, uint32_t(drawsOf(light, b * kBlock + size_t(i))), n, i);
        }
    }
    render::drawBlocks(to);
}

/// Sets the keys of lane `to` for the current one of `draws` samples of a ray.
void BlockVertices::nameDraw(const RayBlock& rays, int lane, uint32_t draws, render::NumberBlock& n, int to) const {
    const render::SampleNumbers of = sampleOf(rays, lane).numbers.draw(draw_, draws);
    n.low[to] = of.low(), n.high[to] = of.high(), n.index[to] = of.index();
}

} // namespace alpenglow::integrator
