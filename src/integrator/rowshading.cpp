#include "integrator/rowshading.h"
#include "integrator/accumulator.h"
#include "integrator/ambientlight.h"
#include "integrator/cameraoutputs.h"
#include "integrator/context.h"
#include "integrator/gathercalls.h"
#include "integrator/gridrays.h"
#include "integrator/kernelinputs.h"
#include "integrator/lightpathstates.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/segmentevents.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "integrator/surfacepoints.h"
#include "integrator/surfaceshading.h"
#include "integrator/transparency.h"
#include "integrator/vertexlight.h"
#include "world/blocksite.h"
#include <algorithm>

namespace alpenglow::integrator {

RowShading::RowShading(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), ambient_(s.ambient), vertexLight_(s.vertexLight),
      cameraOutputs_(s.cameraOutputs), segmentEvents_(s.segmentEvents), gathers_(s.gathers), inputs_(s.inputs), paths_(s.paths),
      photons_(s.photons), store_(s.store), requests_(s.requests), shadows_(s.shadows), surfaces_(s.surfaces),
      shading_(s.shading), transparency_(s.transparency) {
    takes_.assign(!world_.moves() && world_.media().empty() ? size_t(world_.groups()) : 0, 1);
    for (const SurfaceBinding& b : world_.bindings())
        if (size_t(b.group) < takes_.size()) takes_[size_t(b.group)] &= takes(b);
}

/// Whether a kernel's only callbacks are requests, which are interpreted after it has run, and texture lookups, which need no
/// point.
static bool needsNoPoints(const BoundKernel& k) {
    const auto& facts = k.kernel->facts();
    return !facts.suspends && !facts.lightLoops && k.plan->readsSurfaceRows() &&
           std::all_of(k.sites.begin(), k.sites.end(), [&](const SiteInfo& s) {
               return isRequest(s.kind, k.path) || s.kind == SiteKind::Texture || s.kind == SiteKind::Environment;
           });
}

bool RowShading::takes(const SurfaceBinding& b) const {
    for (const BoundKernel* k : {&b.surfaceS, &b.surfaceV})
        if (*k && !(vertexLight_.takes(*k) && needsNoPoints(*k))) return false;
    return b.surfaceS && b.areaLight < 0 && !b.moveS && !b.displacementS && !b.atmosphere.shader && b.lightOutputs.empty() &&
           b.inLightOutputs.empty() && !b.matte && b.surface && !b.surface->moving;
}

bool RowShading::shade(BatchContext& c, Sched& sched) {
    if (!segmentEvents_.events.empty() || photons_.photonTrace() || !gathers_.gathered.empty() ||
        !accumulator_.traceSums.empty() || !vertexLight_.takesRays(c))
        return false;
    // Rays with "falloff", that gather photons of maps, or whose call requests distance and normal of the hit, need the point.
    for (const PathRay& r : c.rays)
        if (r.kind->gathersPhotons || (r.extra >= 0 && store_.extraOf(r).fade.fades()) ||
            (r.first && !(r.counts && sched.plain())))
            return false;
    c.points.clear();
    run(c);
    c.opaque = isOpaque(*c.batch);
    if (!c.opaque) {
        surfaces_.pointsOfRows(c);
        transparency_.setTransparency(c);
    }
    store_.keepIndirect(c);
    if (!vertexLight_.run(c, sched)) {
        c.emits.clear();
        c.arena.clear();
        c.emitted = 0;
        return false;
    }
    count(c);
    requestOthers(c, sched);
    shadows_.flush(sched);
    const bool asks = !world_.wanted().empty() || world_.settings().firstSeen;
    const bool outputs = asks && std::any_of(c.rays.begin(), c.rays.end(), [](auto& r) { return r.counts; });
    if (c.opaque && !outputs) {
        finish(c, sched);
    } else {
        surfaces_.pointsOfRows(c);
        shading_.finish(c, 0, int(c.rays.size()), sched);
    }
    return true;
}

/// Runs the kernel over the hits.
void RowShading::run(BatchContext& c) {
    surfaces_.placeSurfaces(c);
    const size_t n = c.hits.size();
    c.shapes.resize(n);
    c.ways.resize(8 * n);
    for (size_t i = 0; i < n; ++i) {
        const PathRay& r = c.rays[i];
        c.shapes[i] = world_.shapes()[c.hits[i].shape].get();
        const Vec3 begin = r.begin(), I = c.surfaces[i].P - begin;
        for (int q = 0; q < 3; ++q) {
            c.ways[size_t(q) * n + i] = I[q];
            c.ways[size_t(3 + q) * n + i] = r.camera() ? 0 : begin[q];
        }
        if (!world_.needs().footprints) continue;
        const float rate = r.camera() ? world_.bindings()[size_t(c.bindings[i])].shadingRate : 1;
        const Vec2 size = stepsAt(r, c.surfaces[i], rate);
        c.ways[6 * n + i] = size.x;
        c.ways[7 * n + i] = size.y;
    }
    c.binding = &world_.bindings()[size_t(c.bindings[0])];
    const bool same = std::all_of(c.bindings.begin(), c.bindings.end(), [&](int b) { return b == c.bindings[0]; });
    c.bound = same && !c.binding->usesObjectSpace ? &c.binding->surfaceS : &c.binding->surfaceV;
    inputs_.viewsOf(c);
    if (!c.batch) c.batch = std::make_shared<shading::Batch>();
    const std::span<const float> ways(c.ways);
    const shading::SurfaceRows rows{
        std::span(c.surfaces).first(n), c.shapes,           ways.first(3 * n), ways.subspan(3 * n, 3 * n),
        ways.subspan(6 * n, n),         ways.subspan(7 * n)};
    c.batch->assign(c.bound->kernel, *c.bound->plan, rows, inputs_.views, inputs_.viewOf, world_);
    inputs_.bind(c.batch->call(), c);
    c.bound->kernel->run(&c.batch->call());
    c.ran();
}

/// Interprets requests other than lobes: shadows and ambient light.
void RowShading::requestOthers(BatchContext& c, Sched& sched) {
    const auto other = [&](const EmitRecord& e) {
        const SiteKind k = c.bound->sites[size_t(e.site)].kind;
        return k == SiteKind::Ambient ? ambient_.lights : asksShadows(k) || k == SiteKind::LightVisibility;
    };
    if (std::none_of(c.emits.begin(), c.emits.end(), other)) return;
    surfaces_.pointsOfRows(c);
    requests_.requestPairs(c, nullptr, sched, false);
    if (!ambient_.asked.empty()) ambient_.gather(c);
}

void RowShading::count(const BatchContext& c) {
    const uint64_t n = c.rays.size(), lanes = uint64_t(c.bound->kernel->lanes());
    Counters& of = counters_;
    of.points += n;
    of.inRows += n;
    ++of.batches;
    of.lanesUsed += n;
    of.lanesRun += (n + lanes - 1) / lanes * lanes;
}

/// Row version of SurfaceShading::finish() for opaque surfaces: their own light, and outputs of camera rays.
void RowShading::finish(BatchContext& c, Sched& sched) {
    const shading::Batch& b = *c.batch;
    const int ci = b.plan().Ci;
    const Color opacity(1);
    for (size_t i = 0; i < c.rays.size(); ++i) {
        const PathRay& ray = c.rays[i];
        const Color shown = ci >= 0 ? b.color(ci, int(i)) : Color(0);
        const ShaderInstance* of = world_.bindings()[size_t(c.bindings[i])].surface.get();
        if (!isFinite(shown)) accumulator_.notFinite(&ray, "Ci", of);
        else if (!(shown == Color(0)))
            accumulator_.contribute(sched, {c.targets[i], ray.weight * shown, LightEvent::Surface, &ray,
                                            store_.extraOf(ray).share, of, paths_.next(ray.path, paths_.object)});
        if (!ray.counts) continue;
        cameraOutputs_.see(ray, opacity, c.surfaces[i].P.z, false);
    }
}

} // namespace alpenglow::integrator
