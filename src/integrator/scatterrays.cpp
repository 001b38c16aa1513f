#include "integrator/scatterrays.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/guidescatter.h"
#include "integrator/mediastacks.h"
#include "integrator/photonflight.h"
#include "integrator/photongather.h"
#include "integrator/raystore.h"
#include "integrator/singlerequests.h"
#include "integrator/stageset.h"
#include "integrator/subsurfacewalks.h"
#include "integrator/surfacepoints.h"
#include "services/random.h"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

namespace alpenglow::integrator {

ScatterRays::ScatterRays(const StageSet& s, const VertexStages& v)
    : VertexStage(s, v), accumulator_(s.accumulator), guided_(v.guide), flight_(v.flight), gathered_(v.gather), single_(v.single),
      media_(s.media), store_(s.store), subsurface_(s.subsurface), surfaces_(s.surfaces) {
    if (rules_.roulette) playsRoulette();
    endsTrees_ = !world_.settings().localRoulette && world_.lightTraces() > 0;
}

void ScatterRays::playsRoulette() { roulette_ = world_.settings().localRoulette ? Roulette::Local : Roulette::Throughput; }

void ScatterRays::run(BatchContext& c, Sched& sched) {
    v_.turn = 0;
    if (!rules_.pickOne || v_.sendsSeveral) {
        v_.pairs.resize(1);
        for (size_t b = 0; b < v_.blocks; ++b) scatterAll(b, c, sched);
        return;
    }
    const bool chooses = !c.between && (v_.count > 1 || !c.clear.empty()); // in a medium each point has one lobe
    if (chooses) v_.drawNumbers(kChooseLobe << 1 | SampleNumbers::kSingle, v_.choices, false);
    v_.pairs.resize(1);
    for (size_t b = 0; b < v_.blocks; ++b) {
        stages_.pick(v_.vertices[b], v_.lobesOf(b).data(), int(v_.count), chooses ? v_.choices[b].x : v_.whole, v_.next);
        for (size_t i = b * kBlock; i < std::min(v_.points, (b + 1) * kBlock) && !c.clear.empty(); ++i)
            c.passes[i] = v_.vertices[b].passes[i % kBlock];
        drawDirections(b);
        if (v_.next.goes) sendRays(b, c, sched);
    }
}

/// Follows all lobes, each with as many rays as it asks for.
void ScatterRays::scatterAll(size_t b, BatchContext& c, Sched& sched) {
    const RayBlock incoming = v_.rays[b];
    for (size_t k = 0; k < v_.count; ++k) {
        const LobeBlock& l = v_.sites[k].lobes[b];
        Lanes left = l.asked & v_.vertices[b].points;
        for (int i = 0; i < kBlock; ++i) left &= ~(Lanes(!(l.chosen[i] > 0)) << i);
        for (v_.turn = 0; left; ++v_.turn) {
            for (int i = 0; i < kBlock; ++i) {
                const bool goes = left >> i & 1;
                const int samples = goes ? v_.sites[k].samplesAt(b * kBlock + size_t(i)) : 1;
                v_.next.site[i] = goes ? int32_t(k) : -1;
                v_.next.scale[i] = 1 / float(samples);
                if (int(v_.turn) + 1 >= samples) left &= ~(1u << i);
            }
            v_.next.goes = v_.next.single = 0;
            drawDirections(b);
            if (v_.next.goes) sendRays(b, c, sched);
            v_.rays[b] = incoming;
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
void ScatterRays::drawDirections(size_t b) {
    size_t points[kBlock];
    std::iota(points, points + kBlock, b * kBlock);
    NumberBlock& n = v_.pairs[0];
    v_.beginNumbers(b, n);
    for (int i = 0; i < kBlock; ++i) {
        n.stream[i] = 0;
        if (v_.next.site[i] < 0) continue;
        const Site& s = v_.sites[size_t(v_.next.site[i])];
        n.stream[i] = uint32_t(s.number) << 1;
        n.occurrence[i] = s.occurrenceAt(b * kBlock + size_t(i)) * 4096;
        const auto samples = uint32_t(rules_.pickOne && !v_.waits ? 1 : s.samplesAt(b * kBlock + size_t(i)));
        if (samples == 1) continue;
        const SampleNumbers of = v_.sampleOf(v_.rays[b], i).numbers.draw(v_.turn, samples);
        n.low[i] = of.low(), n.high[i] = of.high(), n.index[i] = of.index();
    }
    drawBlocks(std::span(v_.pairs).first(1));
    v_.idle = 0;
    for (size_t k = 0; k < v_.count; ++k) {
        const Lanes picked = pickedOf(v_.next, int(k));
        if (!picked) continue;
        Site& s = v_.sites[k];
        const LobeBlock& lobe = s.lobes[b];
        s.draw(b, picked, n, v_.drawn);
        single_.drawAgain(s, b, picked);
        stages_.takeDirections(lobe, int(k), s.lighting, v_.drawn[0], v_.next);
    }
    for (size_t k = 0; k < v_.count; ++k) {
        const Lanes picked = pickedOf(v_.next, int(k)) & v_.next.goes & ~v_.next.single;
        if (!picked) continue;
        const LobeBlock& lobe = v_.sites[k].lobes[b];
        v_.sites[k].lanes->evaluate(lobe.lobe[0], picked, v_.next.direction[0], v_.value[0]);
        v_.sites[k].addLightDirected(picked, v_.next.direction, points, v_.value[kRowPdf]);
        for (Lanes left = v_.idle & picked; left; left &= left - 1)
            for (int q = 0; q < 3; ++q) v_.value[kRowColour + q][std::countr_zero(left)] = 0;
        stages_.takeValues(lobe, int(k), v_.value[0], v_.next);
    }
}

/// Draws the roulette numbers.
void ScatterRays::throwDice(size_t b) {
    const VertexBlock& v = v_.vertices[b];
    keys_.clear();
    for (size_t k = 0; k < v_.count; ++k) keys_.push_back(uint32_t(v_.sites[k].number));
    stages_.name(v, keys_.data(), v_.next);
    for (int i = 0; i < kBlock && (v_.turn > 0 || v_.repeats); ++i) { // further calls in loops, further rays of a call
        if (v_.next.site[i] < 0) continue;
        const Site& s = v_.sites[size_t(v_.next.site[i])];
        if (const uint32_t before = s.occurrenceAt(b * kBlock + size_t(i)) * 4096 + v_.turn)
            v_.next.vertex[i] = childVertex(v.vertex[i], uint32_t(s.number), before);
    }
    if (roulette_ == Roulette::None ||
        (!v_.waits && std::all_of(v.bounces, v.bounces + kBlock, [](int32_t n) { return n < 3; }))) {
        std::fill_n(v_.next.dice, kBlock, 0.f);
        return;
    }
    NumberBlock& n = v_.pairs[0];
    if (v_.sendsSeveral) v_.beginNumbers(b, n); // directions had numbers of their own for each ray
    std::copy_n(v_.next.vertex, kBlock, n.vertex);
    std::fill_n(n.stream, kBlock, kRoulette << 1 | SampleNumbers::kSingle);
    std::fill_n(n.occurrence, kBlock, 0u);
    drawBlocks(std::span(v_.pairs).first(1));
    std::copy_n(n.x, kBlock, v_.next.dice);
}

void ScatterRays::sendRays(size_t b, BatchContext& c, Sched& sched) {
    if (v_.single) single_.examine(b, c);
    throwDice(b);
    const bool trees = rules_.roulette && !v_.waits && endsTrees_;
    for (Lanes bad = stages_.extend(v_.vertices[b], v_.waits || trees ? Roulette::None : roulette_, v_.next); bad;
         bad &= bad - 1) {
        const int lane = std::countr_zero(bad);
        accumulator_.notFinite(c, c.rays[b * kBlock + size_t(lane)], uint32_t(v_.sites[size_t(v_.next.site[lane])].number));
    }
    std::fill_n(v_.survived, kBlock, 1.f);
    if (v_.waits && rules_.roulette) endByChance(b);
    if (trees) endTrees(b);
    walkBelow(b, c);
    if (!v_.next.goes) return;
    makeRays(b, c);
    spawn(v_.rays[b], sched);
}

/// Roulette by throughput where lights send rays, too: it ends the tree of rays.
void ScatterRays::endTrees(size_t b) {
    for (Lanes left = v_.next.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const auto leftOf = [&](int q) { return std::fabs(v_.next.weight[q][i]); };
        const float q = rouletteLocal(v_.vertices[b].bounces[i] + 1, {leftOf(0), leftOf(1), leftOf(2)}, v_.next.dice[i]);
        if (!(q > 0)) v_.next.goes &= ~(1u << i);
        for (int k = 0; k < 3; ++k) v_.next.weight[k][i] = v_.next.weight[k][i] / q;
    }
}

/// Roulette for rays of a waiting kernel, by the number of rays that it requests.
void ScatterRays::endByChance(size_t b) {
    RayBlock& r = v_.rays[b];
    for (Lanes left = v_.next.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const uint32_t known = r.flags[i] & kAskedBits, before = v_.before[b * kBlock + size_t(i)];
        const auto count = uint32_t(v_.sites[size_t(v_.next.site[i])].samplesAt(b * kBlock + size_t(i)));
        r.flags[i] = (r.flags[i] & ~kAskedBits) | std::min<uint32_t>(std::max(known, before + count), kAskedBits);
        const float q = v_.survived[i] = rouletteWaiting(v_.vertices[b].bounces[i], known, before, count);
        if (q < 1 && !(v_.next.dice[i] < q)) v_.next.goes &= ~(1u << i);
        for (int k = 0; k < 3; ++k) v_.next.weight[k][i] = v_.next.weight[k][i] / q;
    }
}

/// Turns rays of subsurface() into walks.
void ScatterRays::walkBelow(size_t b, BatchContext& c) {
    for (Lanes left = v_.next.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const Site& s = v_.sites[size_t(v_.next.site[i])];
        if (!s.walks) continue;
        surfaces_.pointsOfRows(c);
        const size_t point = b * kBlock + size_t(i);
        const LobeVertex* const request = s.requestAt(point);
        v_.next.goes &= ~(1u << i);
        subsurface_.walks.push_back({int(point),
                                     request ? request->subsurface : int32_t(subsurface_.media.size()),
                                     {v_.next.weight[0][i], v_.next.weight[1][i], v_.next.weight[2][i]},
                                     c.targets[point],
                                     v_.next.vertex[i],
                                     v_.shareOf(s, point, c.rays[point]),
                                     v_.vertices[b].energyScale[i]});
        const float* const rows = request ? nullptr : s.rows[b] + i;
        if (rows)
            subsurface_.media.push_back(
                subsurface_.mediumOf(*s.info, c.points[point], [&](int row) { return rows[size_t(row) * size_t(s.stride)]; }));
    }
}

void ScatterRays::makeRays(size_t b, BatchContext& c) {
    turnRays(b, c);
    applyOptions(b, c);
    keepLobes(b, c);
}

/// Moves the rays of a block on from its vertices.
void ScatterRays::turnRays(size_t b, BatchContext& c) {
    const VertexBlock& v = v_.vertices[b];
    RayBlock& r = v_.rays[b];
    alignas(64) Row towards, from;
    for (int i = 0; i < kBlock; ++i) {
        const auto dotOfNormal = [&](const Row* w) { return w[0][i] * v.n[0][i] + w[1][i] * v.n[1][i] + w[2][i] * v.n[2][i]; };
        towards[i] = dotOfNormal(v_.next.direction);
        from[i] = dotOfNormal(r.direction);
        const float x = v.P[0][i] - r.origin[0][i], y = v.P[1][i] - r.origin[1][i], z = v.P[2][i] - r.origin[2][i];
        r.width[i] = r.width[i] + r.spread[i] * std::sqrt(x * x + y * y + z * z);
        r.spread[i] = std::max(r.spread[i], v_.next.spread[i] * 0.5f);
    }
    for (int q = 0; q < 3; ++q) {
        std::copy_n(v.P[q], kBlock, r.lobeOrigin[q]);
        std::copy_n(v_.next.origin[q], kBlock, r.origin[q]);
        std::copy_n(v_.next.direction[q], kBlock, r.direction[q]);
        std::copy_n(v_.next.weight[q], kBlock, r.weight[q]);
    }
    std::fill_n(r.maxDistance, kBlock, 1e38f);
    std::copy_n(v_.next.vertex, kBlock, r.vertex);
    Counters& n = counters_;
    for (Lanes left = v_.next.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const Site& s = v_.sites[size_t(v_.next.site[i])];
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

/// Applies the parameters to the next rays of a block.
void ScatterRays::applyOptions(size_t b, const BatchContext& c) {
    const auto some = [](const Site& s) { return !s.options.empty(); };
    if (std::none_of(v_.sites.begin(), v_.sites.begin() + long(v_.count), some)) return;
    RayBlock& r = v_.rays[b];
    for (Lanes left = v_.next.goes; left; left &= left - 1) {
        const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
        const Site& s = v_.sites[size_t(v_.next.site[i])];
        if (s.options.empty()) continue;
        const Vec3 origin = v_.originOf(s, point, {v_.next.direction[0][i], v_.next.direction[1][i], v_.next.direction[2][i]});
        for (int q = 0; q < 3; ++q) r.origin[q][i] = origin[q];
        r.maxDistance[i] = s.options[point].maxDistance;
        r.importance[i] *= s.options[point].importance;
        if (!(s.options[point].base > 0)) continue;
        const ShadePoint& p = c.points[point]; // the ray starts anywhere in the footprint
        const Vec2 at = store_.random(c.rays[point]).pair(v_.next.vertex[i], kSampleBase, 0);
        const Vec3 off =
            (p.surface.dPdu * (p.du * (at.x - .5f)) + p.surface.dPdv * (p.dv * (at.y - .5f))) * s.options[point].base;
        for (int q = 0; q < 3; ++q) r.origin[q][i] += off[q];
    }
}

/// Stores in the rays of a block what MIS needs of the lobes that sampled them.
void ScatterRays::keepLobes(size_t b, BatchContext& c) {
    RayBlock& r = v_.rays[b];
    const VertexBlock& v = v_.vertices[b];
    const bool flies = flight_.on();
    for (int i = 0; i < kBlock; ++i) r.flags[i] = (r.flags[i] & kAskedBits) | (v_.waits ? kFirstBit : 0); // clears the trail
    for (Lanes left = v_.next.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const size_t point = b * kBlock + size_t(i);
        const Site& s = v_.sites[size_t(v_.next.site[i])];
        const LobeVertex* const request = s.requestAt(point);
        const uint64_t kind = reinterpret_cast<uintptr_t>(&s.raysAt(point));
        r.kind[0][i] = uint32_t(kind), r.kind[1][i] = uint32_t(kind >> 32);
        const bool sampled = s.lightsAt(point) &&
                             !((v_.next.single | s.lobes[b].ownOrigin) >> i & 1); // then emission that it hits is weighted by MIS
        r.pdf[i] = sampled && rules_.lightsAtRequests ? v_.next.pdf[i] * s.lobes[b].chosen[i] : -1;
        r.binding[i] = sampled ? c.bindings[point] : -1;
        if (const uint16_t path = uint16_t(r.path[i])) {
            const Vec3 w(v_.next.direction[0][i], v_.next.direction[1][i], v_.next.direction[2][i]);
            r.path[i] += v_.pathOf(s, v_.next.single >> i & 1, point, w, c) - uint32_t(path);
        }
        if (!world_.media().empty() && !c.between) {
            const Vec3 w(v_.next.direction[0][i], v_.next.direction[1][i], v_.next.direction[2][i]);
            const auto media = reinterpret_cast<uintptr_t>(media_.towards(c, int(point), w));
            r.media[0][i] = uint32_t(media), r.media[1][i] = uint32_t(uint64_t(media) >> 32);
        }
        r.extra[i] = -1;
        const int32_t share = v_.shareOf(s, point, c.rays[point]);
        const float indirect = flies // then the ray's weight includes it
                                   ? 1
                                   : (v_.next.indirect[i] == 0 ? 1 : v.energyScale[i]) * v_.indirectOf(s, point);
        const bool fades = !s.options.empty() && s.options[point].fade.fades();
        const int lit = v_.litSurfaceAt(point);
        if (indirect == 1 && share < 0 && !c.between && !fades && lit < 0 && !request) continue;
        RayExtra extra;
        extra.lit = lit;
        if (fades) extra.fade = s.options[point].fade;
        if (c.between) extra.flown = c.flown[point];
        extra.indirect = indirect;
        extra.share = share;
        if (request && !flies) single_.addToRay(*request, extra, i, c);
        r.extra[i] = store_.newExtra(extra);
    }
    guided_.keep(b, c);
    gathered_.keep(b, c);
}

void ScatterRays::spawn(const RayBlock& rays, Sched& sched) {
    if (sched.plain()) {
        sched.spawned(size_t(stages_.store(&rays, kTaskWords, v_.next.goes, sched.room(kBlock, 1))));
        return;
    }
    std::array<Sched::Task, kBlock + 1> tasks;
    const int count = stages_.store(&rays, kTaskWords, v_.next.goes, tasks.data());
    for (int k = 0; k < count; ++k) sched.spawn(tasks[size_t(k)]);
}

} // namespace alpenglow::integrator
