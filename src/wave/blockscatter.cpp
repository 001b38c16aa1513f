// The rays on which paths go on from vertices in blocks.
#include "wave/blockvertices.h"
#include "world/emitterfootprint.h"
#include <algorithm>
#include <bit>

namespace alpenglow::transport {

void BlockVertices::scatter(BatchContext& c, Sched& sched) {
    const bool chooses = count_ > 1 || !c.clear.empty();
    if (chooses) drawNumbers(kChooseLobe << 1 | render::SampleNumbers::kSingle, choices_);
    pairs_.resize(1);
    for (size_t b = 0; b < blocks_; ++b) {
        stages_.pick(vertices_[b], lobesOf(b).data(), int(count_), chooses ? choices_[b].x : nullptr, next_);
        for (size_t i = b * kBlock; i < std::min(points_, (b + 1) * kBlock) && !c.clear.empty(); ++i)
            c.passes[i] = vertices_[b].passes[i % kBlock];
        drawDirections(b);
        if (next_.goes) sendRays(b, c, sched);
    }
}

/// Points whose lobe is that of a site.
static Lanes pickedOf(const ScatterBlock& s, int site) {
    Lanes picked = 0;
    for (int i = 0; i < kBlock; ++i) picked |= Lanes(s.site[i] == site) << i;
    return picked;
}

/// Directions of the lobes that were picked, and what they give back from there.
void BlockVertices::drawDirections(size_t b) {
    const VertexBlock& v = vertices_[b];
    render::NumberBlock& n = pairs_[0];
    std::copy_n(v.low, kBlock, n.low);
    std::copy_n(v.high, kBlock, n.high);
    std::copy_n(v.index, kBlock, n.index);
    std::copy_n(v.vertex, kBlock, n.vertex);
    for (int i = 0; i < kBlock; ++i) n.stream[i] = next_.site[i] < 0 ? 0 : uint32_t(sites_[size_t(next_.site[i])].number) << 1;
    std::fill_n(n.occurrence, kBlock, 0u);
    render::drawBlocks(std::span(pairs_).first(1));
    for (size_t k = 0; k < count_; ++k) {
        const Lanes picked = pickedOf(next_, int(k));
        if (!picked) continue;
        Site& s = sites_[k];
        const LobeBlock& lobe = s.lobes[b];
        s.lanes->sample(lobe.lobe[0], picked, n.x, drawn_[0]);
        stages_.takeDirections(lobe, int(k), s.lighting, drawn_[0], next_);
    }
    for (size_t k = 0; k < count_; ++k) {
        const Lanes picked = pickedOf(next_, int(k)) & next_.goes & ~next_.single;
        if (!picked) continue;
        const LobeBlock& lobe = sites_[k].lobes[b];
        sites_[k].lanes->evaluate(lobe.lobe[0], picked, next_.direction[0], value_[0]);
        stages_.takeValues(lobe, int(k), value_[0], next_);
    }
}

/// Numbers that decide whether paths go on.
void BlockVertices::throwDice(size_t b) {
    const VertexBlock& v = vertices_[b];
    uint32_t keys[kMostSites];
    for (size_t k = 0; k < count_; ++k) keys[k] = uint32_t(sites_[k].number);
    stages_.name(v, keys, next_);
    if (!e_.rules().roulette || std::all_of(v.bounces, v.bounces + kBlock, [](int32_t n) { return n < 3; })) {
        std::fill_n(next_.dice, kBlock, 0.f);
        return;
    }
    render::NumberBlock& n = pairs_[0];
    std::copy_n(next_.vertex, kBlock, n.vertex);
    std::fill_n(n.stream, kBlock, kRoulette << 1 | render::SampleNumbers::kSingle);
    render::drawBlocks(std::span(pairs_).first(1));
    std::copy_n(n.x, kBlock, next_.dice);
}

void BlockVertices::sendRays(size_t b, BatchContext& c, Sched& sched) {
    throwDice(b);
    for (Lanes bad = stages_.extend(vertices_[b], e_.rules().roulette, next_); bad; bad &= bad - 1) {
        const int lane = std::countr_zero(bad);
        e_.notFinite(c, c.rays[b * kBlock + size_t(lane)], uint32_t(sites_[size_t(next_.site[lane])].number));
    }
    for (Lanes left = next_.goes; left; left &= left - 1) sendRay(b, std::countr_zero(left), c, sched);
}

void BlockVertices::sendRay(size_t b, int lane, BatchContext& c, Sched& sched) {
    const size_t point = b * kBlock + size_t(lane);
    const PathRay& from = c.rays[point];
    const ShadePoint& p = c.points[point];
    const Site& s = sites_[size_t(next_.site[lane])];
    const auto row3 = [&](const Row* r) { return Vec3(r[0][lane], r[1][lane], r[2][lane]); };
    const Vec3 w = row3(next_.direction);
    const bool single = next_.single >> lane & 1;
    const int bounces = from.bounces + 1;
    PathRay& r = sched.spawn(bounces + from.layers, c.targets[point], from).payload;
    r.origin = row3(next_.origin);
    r.dir = w;
    r.maxDistance = 1e38f;
    r.weight = row3(next_.weight);
    r.kind = s.rays;
    r.vertex = next_.vertex[lane];
    r.bounces = int16_t(bounces);
    ++(s.diffuse ? r.diffuseBounces : r.specularBounces);
    r.trail = 0;
    r.parted = r.passed = r.first = r.counts = false;
    if (!s.diffuse && s.rays->label == e_.totalReflection_) ++e_.counters.totalReflected;
    else if (!s.diffuse) ++(dot(w, p.surface.n) * dot(from.dir, p.surface.n) > 0 ? e_.counters.refracted : e_.counters.reflected);
    r.extra = -1;
    const float energy = vertices_[b].energyScale[lane];
    if (next_.indirect[lane] != 0 && energy != 1) {
        RayExtra extra;
        extra.indirect = energy;
        r.extra = e_.newExtra(extra);
    }
    const bool sampled = s.lights && !single; // then an emitter that it meets counts with the weight of both
    r.lobePdf = sampled ? next_.pdf[lane] * s.lobes[b].chosen[lane] : -1;
    r.lobeOrigin = p.P;
    r.lobeBinding = sampled ? c.bindings[point] : -1;
    r.footprint = from.footprint.after(length(p.P - from.origin));
    r.footprint.spread = spreadBehind(from, next_.spread[lane]);
    e_.counters.depthMax = std::max(e_.counters.depthMax, bounces);
    ++e_.counters.depthSum; // over camera rays: the mean number of bounces
}

} // namespace alpenglow::transport
