#include "integrator/guidescatter.h"
#include "integrator/lightpathstates.h"
#include "integrator/mediastacks.h"
#include "integrator/stageset.h"
#include <algorithm>
#include <bit>
#include <numeric>

namespace alpenglow::integrator {

static_assert(kBlock <= int(SurfaceTree::kTogether));

GuideScatter::GuideScatter(const StageSet& s, const VertexStages& v) : VertexStage(s, v), guide_(s.guide), media_(s.media) {}

void GuideScatter::mark(size_t block, const BatchContext& c) {
    VertexBlock& v = v_.vertices[block];
    v.guided = 0;
    if (!on()) return;
    for (size_t i = block * kBlock; i < std::min(v_.points, (block + 1) * kBlock); ++i)
        v.guided |= Lanes(c.rays[i].guided()) << i % kBlock;
}

/// The call site of the lobe that reflects most, and what the guide is asked; -1: none.
int GuideScatter::siteOf(size_t block, int i, const BatchContext& c, GuideRays::Query& q) const {
    const VertexBlock& v = v_.vertices[block];
    int site = -1;
    float most = 0;
    const auto weightOf = [&](const LobeBlock& l) { return Color(l.weight[0][i], l.weight[1][i], l.weight[2][i]); };
    for (size_t k = 0; k < v_.count; ++k) {
        const LobeBlock& l = v_.sites[k].lobes[block];
        if (!(l.lights >> i & 1) || !(l.chosen[i] > 0)) continue;
        const Site& s = v_.sites[k];
        const size_t point = block * kBlock + size_t(i);
        const RayOptions* const options = s.options.empty() ? nullptr : &s.options[point];
        if (!(v_.indirectOf(s, point) > 0) || s.raysAt(point).gathersPhotons) continue;
        if (options && (options->fade.fades() || options->base > 0)) continue;
        const float gives = luminance(absolute(weightOf(l))) * l.lobe[kRowAlbedo][i];
        if (gives > most) site = int(k), most = gives;
    }
    if (site < 0) return site;
    const LobeBlock& l = v_.sites[size_t(site)].lobes[block];
    const PathRay& from = c.rays[block * kBlock + size_t(i)];
    q = {{v.P[0][i], v.P[1][i], v.P[2][i]},
         {v.n[0][i], v.n[1][i], v.n[2][i]},
         from.dir,
         luminance(absolute(from.weight * weightOf(l))) * l.lobe[kRowAlbedo][i]};
    return site;
}

/// Directions of the guide rays of some points of a block; returns the points that have one.
Lanes GuideScatter::draw(size_t block, Lanes left, const BatchContext& c) {
    GuideRays::Query queries[kBlock];
    GuideRays::Aim aims[kBlock];
    int lane[kBlock];
    size_t count = 0;
    for (; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        points_[block * kBlock + size_t(i)].site = siteOf(block, i, c, queries[count]);
        lane[count] = i;
        count += points_[block * kBlock + size_t(i)].site >= 0;
    }
    guide_.aim({queries, count}, aims);
    Lanes drawn = 0;
    for (size_t k = 0; k < count; ++k) {
        const size_t at = block * kBlock + size_t(lane[k]);
        points_[at].aim = aims[k];
        Vec3 w;
        if (!guide_.draws(c.rays[at], aims[k], queries[k].P, w)) continue;
        for (int q = 0; q < 3; ++q) w_[q][lane[k]] = w[q];
        drawn |= 1u << lane[k];
    }
    return drawn;
}

void GuideScatter::run(BatchContext& c, Sched& sched) {
    if (!on() || v_.waits || c.between) return;
    points_.assign(v_.blocks * kBlock, {});
    for (size_t block = 0; block < v_.blocks; ++block) {
        const VertexBlock& v = v_.vertices[block];
        const Lanes drawn = draw(block, v.points & ~v.guided & ~(v.deep[0] & v.deep[1]), c);
        for (size_t k = 0; k < v_.count && drawn; ++k) {
            Lanes of = 0;
            for (Lanes left = drawn; left; left &= left - 1)
                of |= Lanes(points_[block * kBlock + size_t(std::countr_zero(left))].site == int(k)) << std::countr_zero(left);
            if (of) send(block, int(k), of, c, sched);
        }
    }
}

void GuideScatter::send(size_t block, int site, Lanes of, BatchContext& c, Sched& sched) {
    const VertexBlock& v = v_.vertices[block];
    const Site& s = v_.sites[size_t(site)];
    const LobeBlock& l = s.lobes[block];
    alignas(64) float value[kValueRows][kBlock];
    s.lanes->evaluate(l.lobe[0], of, w_[0], value[0]);
    size_t points[kBlock];
    std::iota(points, points + kBlock, block * kBlock);
    s.addLightDirected(of, w_, points, value[kRowPdf]);
    for (; of; of &= of - 1) {
        const int i = std::countr_zero(of);
        const size_t at = block * kBlock + size_t(i);
        const PathRay& from = c.rays[at];
        const Vec3 w(w_[0][i], w_[1][i], w_[2][i]), P(v.P[0][i], v.P[1][i], v.P[2][i]), n(v.n[0][i], v.n[1][i], v.n[2][i]);
        const LobeValue f{
            {value[kRowColour][i], value[kRowColour + 1][i], value[kRowColour + 2][i]}, value[kRowFcos][i], value[kRowPdf][i]};
        const RayOptions options = s.options.empty() ? RayOptions() : s.options[at];
        const uint16_t path = from.path ? v_.pathOf(s, false, at, w, c) : uint16_t(0);
        guide_.send({from,
                     c.targets[at],
                     P,
                     {l.weight[0][i], l.weight[1][i], l.weight[2][i]},
                     (s.lighting ? v.energyScale[i] : 1) * v_.indirectOf(s, at),
                     l.chosen[i],
                     l.lobe[kRowSpread][i],
                     &s.raysAt(at),
                     v_.shareOf(s, at, from),
                     options.importance,
                     options.maxDistance},
                    points_[at].aim, w, f, v_.originOf(s, at, w), path,
                    world_.media().empty() ? from.media : media_.towards(c, int(at), w), sched);
    }
}

void GuideScatter::keep(size_t block, const BatchContext& c) {
    if (!on()) return;
    RayBlock& r = v_.rays[block];
    for (Lanes left = v_.next.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const size_t at = block * kBlock + size_t(i);
        uint8_t trail = 0;
        if (v_.next.single >> i & 1) {
            if (v_.waits) continue;
            trail = GuideRays::trailBehindMirror(c.rays[at]);
            r.pdf[i] = guide_.pdfBehindMirror(c.rays[at]);
        } else if (!v_.waits && !c.between && points_[at].site == v_.next.site[i]) {
            trail = points_[at].aim.trail();
        }
        r.flags[i] |= uint32_t(trail) << 24;
    }
}

} // namespace alpenglow::integrator
