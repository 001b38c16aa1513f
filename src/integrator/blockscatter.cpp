// Continuation rays of paths from vertices in blocks.
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/blockflight.h"
#include "integrator/blockguide.h"
#include "integrator/blockphotons.h"
#include "integrator/blockrequests.h"
#include "integrator/blockvertices.h"
#include "integrator/lightpathstates.h"
#include "integrator/mediastacks.h"
#include "integrator/raystore.h"
#include "integrator/vertexlight.h"
#include "services/random.h"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

namespace alpenglow::integrator {

void BlockVertices::scatter(BatchContext& c, Sched& sched) {
    turn_ = 0;
    if (!rules_.pickOne || sendsSeveral_) {
        pairs_.resize(1);
        for (size_t b = 0; b < blocks_; ++b) scatterAll(b, c, sched);
        return;
    }
    const bool chooses = !c.between && (count_ > 1 || !c.clear.empty()); // in a medium each point has one lobe
    if (chooses) drawNumbers(kChooseLobe << 1 | render::SampleNumbers::kSingle, choices_, false);
    pairs_.resize(1);
    for (size_t b = 0; b < blocks_; ++b) {
        stages_.pick(vertices_[b], lobesOf(b).data(), int(count_), chooses ? choices_[b].x : whole_, next_);
        for (size_t i = b * kBlock; i < std::min(points_, (b + 1) * kBlock) && !c.clear.empty(); ++i)
            c.passes[i] = vertices_[b].passes[i % kBlock];
        drawDirections(b);
        if (next_.goes) sendRays(b, c, sched);
    }
}

/// Follows all lobes, each with as many rays as it asks for.
void BlockVertices::scatterAll(size_t b, BatchContext& c, Sched& sched) {
    const RayBlock incoming = rays_[b];
    for (size_t k = 0; k < count_; ++k) {
        const LobeBlock& l = sites_[k].lobes[b];
        Lanes left = l.asked & vertices_[b].points;
        for (int i = 0; i < kBlock; ++i) left &= ~(Lanes(!(l.chosen[i] > 0)) << i);
        for (turn_ = 0; left; ++turn_) {
            for (int i = 0; i < kBlock; ++i) {
                const bool goes = left >> i & 1;
                const int samples = goes ? sites_[k].samplesAt(b * kBlock + size_t(i)) : 1;
                next_.site[i] = goes ? int32_t(k) : -1;
                next_.scale[i] = 1 / float(samples);
                if (int(turn_) + 1 >= samples) left &= ~(1u << i);
            }
            next_.goes = next_.single = 0;
            drawDirections(b);
            if (next_.goes) sendRays(b, c, sched);
            rays_[b] = incoming;
        }
    }
}

/// Points that picked the lobe of a call site.
static Lanes pickedOf(const ScatterBlock& s, int site) {
    Lanes picked = 0;
    for (int i = 0; i < kBlock; ++i) picked |= Lanes(s.site[i] == site) << i;
    return picked;
}

/// Samples the directions of the picked lobes and evaluates the lobes there.
void BlockVertices::drawDirections(size_t b) {
    size_t points[kBlock];
    std::iota(points, points + kBlock, b * kBlock);
    render::NumberBlock& n = pairs_[0];
    beginNumbers(b, n);
    for (int i = 0; i < kBlock; ++i) {
        n.stream[i] = 0;
        if (next_.site[i] < 0) continue;
        const Site& s = sites_[size_t(next_.site[i])];
        n.stream[i] = uint32_t(s.number) << 1;
        n.occurrence[i] = s.occurrenceAt(b * kBlock + size_t(i)) * 4096;
        const auto samples = uint32_t(rules_.pickOne && !waits_ ? 1 : s.samplesAt(b * kBlock + size_t(i)));
        if (samples == 1) continue;
        const render::SampleNumbers of = sampleOf(rays_[b], i).numbers.draw(turn_, samples);
        n.low[i] = of.low(), n.high[i] = of.high(), n.index[i] = of.index();
    }
    render::drawBlocks(std::span(pairs_).first(1));
    idle_ = 0;
    for (size_t k = 0; k < count_; ++k) {
        const Lanes picked = pickedOf(next_, int(k));
        if (!picked) continue;
        Site& s = sites_[k];
        const LobeBlock& lobe = s.lobes[b];
        s.draw(b, picked, n, drawn_);
        requested_->drawAgain(s, b, picked);
        stages_.takeDirections(lobe, int(k), s.lighting, drawn_[0], next_);
    }
    for (size_t k = 0; k < count_; ++k) {
        const Lanes picked = pickedOf(next_, int(k)) & next_.goes & ~next_.single;
        if (!picked) continue;
        const LobeBlock& lobe = sites_[k].lobes[b];
        sites_[k].lanes->evaluate(lobe.lobe[0], picked, next_.direction[0], value_[0]);
        sites_[k].addLightDirected(picked, next_.direction, points, value_[kRowPdf]);
        for (Lanes left = idle_ & picked; left; left &= left - 1)
            for (int q = 0; q < 3; ++q) value_[kRowColour + q][std::countr_zero(left)] = 0;
        stages_.takeValues(lobe, int(k), value_[0], next_);
    }
}

/// Draws the roulette numbers.
void BlockVertices::throwDice(size_t b) {
    const VertexBlock& v = vertices_[b];
    keys_.clear();
    for (size_t k = 0; k < count_; ++k) keys_.push_back(uint32_t(sites_[k].number));
    stages_.name(v, keys_.data(), next_);
    for (int i = 0; i < kBlock && (turn_ > 0 || repeats_); ++i) { // further calls in loops, further rays of a call
        if (next_.site[i] < 0) continue;
        const Site& s = sites_[size_t(next_.site[i])];
        if (const uint32_t before = s.occurrenceAt(b * kBlock + size_t(i)) * 4096 + turn_)
            next_.vertex[i] = childVertex(v.vertex[i], uint32_t(s.number), before);
    }
    if (roulette_ == Roulette::None || (!waits_ && std::all_of(v.bounces, v.bounces + kBlock, [](int32_t n) { return n < 3; }))) {
        std::fill_n(next_.dice, kBlock, 0.f);
        return;
    }
    render::NumberBlock& n = pairs_[0];
    if (sendsSeveral_) beginNumbers(b, n); // directions had numbers of their own for each ray
    std::copy_n(next_.vertex, kBlock, n.vertex);
    std::fill_n(n.stream, kBlock, kRoulette << 1 | render::SampleNumbers::kSingle);
    std::fill_n(n.occurrence, kBlock, 0u);
    render::drawBlocks(std::span(pairs_).first(1));
    std::copy_n(n.x, kBlock, next_.dice);
}

void BlockVertices::sendRays(size_t b, BatchContext& c, Sched& sched) {
    if (!requested_->empty()) requested_->examine(b, c);
    throwDice(b);
    const bool trees = rules_.roulette && !waits_ && endsTrees_;
    for (Lanes bad = stages_.extend(vertices_[b], waits_ || trees ? Roulette::None : roulette_, next_); bad; bad &= bad - 1) {
        const int lane = std::countr_zero(bad);
        accumulator_.notFinite(c, c.rays[b * kBlock + size_t(lane)], uint32_t(sites_[size_t(next_.site[lane])].number));
    }
    std::fill_n(survived_, kBlock, 1.f);
    if (waits_ && rules_.roulette) endByChance(b);
    if (trees) endTrees(b);
    walkBelow(b, c);
    if (!next_.goes) return;
    turnRays(b, c);
    applyOptions(b, c);
    keepLobes(b, c);
    spawn(rays_[b], sched);
}

/// Roulette by throughput where lights send rays, too: it ends the tree of rays.
void BlockVertices::endTrees(size_t b) {
    for (Lanes left = next_.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const auto leftOf = [&](int q) { return std::fabs(next_.weight[q][i]); };
        const float q = rouletteLocal(vertices_[b].bounces[i] + 1, {leftOf(0), leftOf(1), leftOf(2)}, next_.dice[i]);
        if (!(q > 0)) next_.goes &= ~(1u << i);
        for (int k = 0; k < 3; ++k) next_.weight[k][i] = next_.weight[k][i] / q;
    }
}

/// Moves the rays of a block on from its vertices.
void BlockVertices::turnRays(size_t b, BatchContext& c) {
    const VertexBlock& v = vertices_[b];
    RayBlock& r = rays_[b];
    alignas(64) Row towards, from;
    for (int i = 0; i < kBlock; ++i) {
        const auto dotOfNormal = [&](const Row* w) { return w[0][i] * v.n[0][i] + w[1][i] * v.n[1][i] + w[2][i] * v.n[2][i]; };
        towards[i] = dotOfNormal(next_.direction);
        from[i] = dotOfNormal(r.direction);
        const float x = v.P[0][i] - r.origin[0][i], y = v.P[1][i] - r.origin[1][i], z = v.P[2][i] - r.origin[2][i];
        r.width[i] = r.width[i] + r.spread[i] * std::sqrt(x * x + y * y + z * z);
        r.spread[i] = std::max(r.spread[i], next_.spread[i] * 0.5f);
    }
    for (int q = 0; q < 3; ++q) {
        std::copy_n(v.P[q], kBlock, r.lobeOrigin[q]);
        std::copy_n(next_.origin[q], kBlock, r.origin[q]);
        std::copy_n(next_.direction[q], kBlock, r.direction[q]);
        std::copy_n(next_.weight[q], kBlock, r.weight[q]);
    }
    std::fill_n(r.maxDistance, kBlock, 1e38f);
    std::copy_n(next_.vertex, kBlock, r.vertex);
    Counters& n = counters_;
    for (Lanes left = next_.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const Site& s = sites_[size_t(next_.site[i])];
        const int bounces = v.bounces[i] + 1;
        r.depth[i] = bounces + int16_t(r.specular[i] >> 16);
        r.bounces[i] += 1 + (uint32_t(s.diffuse) << 16);
        r.path[i] += uint32_t(c.between) << 16;
        r.specular[i] = (r.specular[i] & 0xffff0000u) | uint16_t(r.specular[i] + !s.diffuse);
        n.depthMax = std::max(n.depthMax, bounces);
        n.depthSum += 1; // over camera rays: mean number of bounces
        if (s.diffuse) continue;
        if (s.raysAt(b * kBlock + size_t(i)).label == context_.totalReflection) ++n.totalReflected;
        else ++(towards[i] * from[i] > 0 ? n.refracted : n.reflected);
    }
}

/// Stores in the rays of a block what MIS needs of the lobes that sampled them.
void BlockVertices::keepLobes(size_t b, BatchContext& c) {
    RayBlock& r = rays_[b];
    const VertexBlock& v = vertices_[b];
    for (int i = 0; i < kBlock; ++i) r.flags[i] = (r.flags[i] & kAskedBits) | (waits_ ? kFirstBit : 0); // clears the trail
    for (Lanes left = next_.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const Site& s = sites_[size_t(next_.site[i])];
        const LobeVertex* const request = s.requestAt(b * kBlock + size_t(i));
        const uint64_t kind = reinterpret_cast<uintptr_t>(&s.raysAt(b * kBlock + size_t(i)));
        r.kind[0][i] = uint32_t(kind), r.kind[1][i] = uint32_t(kind >> 32);
        const bool sampled = s.lightsAt(b * kBlock + size_t(i)) &&
                             !((next_.single | s.lobes[b].elsewhere) >> i & 1); // then emission that it hits is weighted by MIS
        r.pdf[i] = sampled && rules_.lightsAtRequests ? next_.pdf[i] * s.lobes[b].chosen[i] : -1;
        r.binding[i] = sampled ? c.bindings[b * kBlock + size_t(i)] : -1;
        if (const uint16_t path = uint16_t(r.path[i])) {
            const Vec3 w(next_.direction[0][i], next_.direction[1][i], next_.direction[2][i]);
            r.path[i] += pathOf(s, next_.single >> i & 1, b * kBlock + size_t(i), w, c) - uint32_t(path);
        }
        if (!world_.media_.empty() && !c.between) {
            const Vec3 w(next_.direction[0][i], next_.direction[1][i], next_.direction[2][i]);
            const auto media = reinterpret_cast<uintptr_t>(media_.towards(c, int(b * kBlock + size_t(i)), w));
            r.media[0][i] = uint32_t(media), r.media[1][i] = uint32_t(uint64_t(media) >> 32);
        }
        r.extra[i] = -1;
        const size_t point = b * kBlock + size_t(i);
        const int32_t share = shareOf(s, point, c.rays[point]);
        const float indirect = flight_->on() // then the ray's weight includes it
                                   ? 1
                                   : (next_.indirect[i] == 0 ? 1 : v.energyScale[i]) * indirectOf(s, point);
        const bool fades = !s.options.empty() && s.options[b * kBlock + size_t(i)].fade.fades();
        const int lit = toldAt(point);
        if (indirect == 1 && share < 0 && !c.between && !fades && lit < 0 && !request) continue;
        RayExtra extra;
        extra.lit = lit;
        if (fades) extra.fade = s.options[b * kBlock + size_t(i)].fade;
        if (c.between) extra.flown = c.flown[b * kBlock + size_t(i)];
        extra.indirect = indirect;
        extra.share = share;
        if (request && !flight_->on()) requested_->addToRay(*request, extra, i, c);
        r.extra[i] = store_.newExtra(extra);
    }
    guided_->keep(b, c);
    gathered_->keep(b, c);
}

void BlockVertices::spawn(const RayBlock& rays, Sched& sched) {
    if (sched.plain()) {
        sched.spawned(size_t(stages_.store(&rays, kTaskWords, next_.goes, sched.room(kBlock, 1))));
        return;
    }
    std::array<Sched::Task, kBlock + 1> tasks;
    const int count = stages_.store(&rays, kTaskWords, next_.goes, tasks.data());
    for (int k = 0; k < count; ++k) sched.spawn(tasks[size_t(k)]);
}

} // namespace alpenglow::integrator
