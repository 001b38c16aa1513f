#include "integrator/guiderays.h"
#include "base/hash.h"
#include "bsdf/sampling.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"
#include "services/random.h"
#include "world/emitterfootprint.h"
#include <algorithm>

namespace alpenglow::integrator {

GuideRays::GuideRays(const StageSet& s) : Stage(s.context), store_(s.store) {
    // A waiting kernel decides by the results of its rays; in other kernels only lobes of trace() can be deltas.
    const auto mirrors = [](const BoundKernel& k) {
        return k && !k.kernel->facts().suspends &&
               std::any_of(k.sites.begin(), k.sites.end(), [](const SiteInfo& s) { return s.kind == SiteKind::Trace; });
    };
    for (const SurfaceBinding& b : world_.bindings()) ends_.push_back(!mirrors(b.surfaceS));
}

void GuideRays::aim(std::span<const Query> queries, Aim* aims) const {
    const CausticGuide& g = *guide();
    SurfaceTree::Point points[SurfaceTree::kTogether];
    const CausticGuide::Cell* cells[SurfaceTree::kTogether];
    size_t of[SurfaceTree::kTogether], count = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const Query& q = queries[i];
        aims[i] = {};
        if (!g.maySend(q.brings)) continue;
        points[count] = {q.P, SurfaceTree::sideOf(dot(q.n, q.in) > 0 ? -q.n : q.n)};
        of[count++] = i;
    }
    g.find({points, count}, cells);
    for (size_t k = 0; k < count; ++k) {
        Aim& a = aims[of[k]];
        a.side = points[k].side;
        a.cell = cells[k];
        if (a.cell) a.code = g.codeFor(*a.cell, queries[of[k]].brings);
    }
}

/// A uniform number for a ray's vertex by hash; its tenths are equidistributed over the samples of a pixel.
static double hashOf(const SampleNumbers& n, const PathRay& from, uint64_t use) {
    const uint64_t key = (uint64_t(n.high()) << 32 | n.low()) ^ mix64(uint64_t(from.vertex) << 32 | n.index());
    return double(mix64(key ^ use) >> 11) * 0x1p-53;
}

bool GuideRays::draws(const PathRay& from, const Aim& a, const Vec3& P, Vec3& w) const {
    if (!a.code) return false;
    const SampleNumbers& numbers = store_.random(from).numbers();
    if (a.code > 1 && hashOf(numbers, from, kGuideRay) >= double(CausticGuide::chanceOf(a.code))) return false;
    w = guide()->draw(*a.cell, P, Random(numbers).pair(from.vertex, kGuideRay, 0));
    return true;
}

void GuideRays::send(const Lobe& l, const Aim& a, const Vec3& w, const LobeValue& value, const Vec3& origin, uint16_t path,
                     const shading::Media* media, Sched& sched) {
    const float density = CausticGuide::chanceOf(a.code) * guide()->density(*a.cell, l.P, w);
    if (!(density > 0) || !(maxComponent(value.colour) > 0)) return;
    const float kept = misWeight(density, value.pdf * l.chosen);
    Color weight = l.from.weight * (l.weight * (value.colour * (kept / density * l.indirect)));
    if (!isFinite(weight) || weight == Color(0)) return;
    const int bounces = l.from.bounces + 1;
    const uint32_t vertex = childVertex(l.from.vertex, kGuideRay, 0);
    if (rules_.roulette && bounces > 3) {
        const auto dice = [&] { return store_.random(l.from).one(vertex, kRoulette, 0); };
        const float q = world_.settings().localRoulette ? rouletteLocal(bounces, l.weight, dice()) : rouletteOfPath(weight, dice);
        if (!(q > 0)) return;
        weight = weight / q;
    }
    PathRay& r = sched.spawn(bounces + l.from.layers, l.target, l.from).payload;
    r.weight = weight;
    r.vertex = vertex;
    r.bounces = int16_t(bounces);
    ++(l.kind->type == RayType::Diffuse ? r.diffuseBounces : r.specularBounces);
    r.origin = origin;
    r.dir = w;
    r.path = path;
    r.maxDistance = l.maxDistance;
    r.kind = l.kind;
    r.trail = uint8_t(shading::kTrailSpread | shading::kGuided * shading::kTrailGuide);
    r.media = media;
    r.crossedMedium = r.passed = r.counts = r.first = false;
    r.importance *= l.importance;
    RayExtra extra;
    extra.share = l.share;
    r.extra = store_.newExtra(extra);
    r.lobePdf = -1;
    r.lobeOrigin = l.P;
    r.lobeBinding = -1;
    r.footprint = l.from.footprint.after(length(l.P - l.from.origin));
    r.footprint.spread = spreadBehind(l.from, l.spread);
    ++counters_.guided;
}

float GuideRays::pdfBehindMirror(const PathRay& from) const {
    if (from.guided() || !(from.trail & shading::kTrailSpread)) return -1;
    if (from.trail & shading::kTrailMirrored) return from.lobePdf;
    const int code = from.guideCode();
    if (!code) return -1;
    const CausticGuide::Cell* cell = guide()->find(from.lobeOrigin, from.trail / shading::kTrailSide);
    if (!cell) return -1;
    const float density = CausticGuide::chanceOf(code) * guide()->density(*cell, from.lobeOrigin, from.dir);
    return -std::max(misWeight(from.lobePdf, density), 1e-30f); // < 0: no light is sampled at a mirror
}

bool GuideRays::bringsNothing(const PathRay& r, int binding) const {
    return r.guided() && ends(binding) &&
           !((r.trail & shading::kTrailMirrored) && world_.bindings()[size_t(binding)].areaLight >= 0);
}

} // namespace alpenglow::integrator
