#include "integrator/vertexlight.h"
#include "integrator/ambientlight.h"
#include "integrator/chosenlights.h"
#include "integrator/connection.h"
#include "integrator/guidescatter.h"
#include "integrator/lastskies.h"
#include "integrator/lastvertices.h"
#include "integrator/lightsampling.h"
#include "integrator/loberequests.h"
#include "integrator/lobeselection.h"
#include "integrator/photonflight.h"
#include "integrator/photongather.h"
#include "integrator/photonstage.h"
#include "integrator/requests.h"
#include "integrator/scatterrays.h"
#include "integrator/singlerequests.h"
#include "integrator/specularlights.h"
#include "integrator/stageset.h"
#include "integrator/strips.h"
#include "integrator/subsurfacewalks.h"
#include "integrator/surfacepoints.h"
#include "integrator/vertexloading.h"
#include "services/random.h"
#include "world/blocksite.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

struct VertexLight::Parts {
    explicit Parts(const StageSet&);
    VertexBlocks blocks;
    VertexStages set;
    VertexLoading loading;
    LobeRequests requests;
    SingleRequests single;
    LobeSelection selection;
    LightSampling lights;
    Connection connection;
    LastVertices last;
    GuideScatter guide;
    SpecularLights specular;
    PhotonGather gather;
    PhotonFlight flight;
    ScatterRays scatter;
};

VertexLight::Parts::Parts(const StageSet& s)
    : blocks(s), set{blocks, loading, requests, single, selection, lights, connection, last, guide, gather, flight, scatter},
      loading(s, set), requests(s, set), single(s, set), selection(s, set), lights(s, set), connection(s, set), last(s, set),
      guide(s, set), specular(s, set), gather(s, set), flight(s, set), scatter(s, set) {}

VertexLight::VertexLight(const StageSet& s)
    : Stage(s.context), parts_(std::make_unique<Parts>(s)), set_(s), ambient_(s.ambient), lastSkies_(s.lastSkies),
      photons_(s.photons), subsurface_(s.subsurface), surfaces_(s.surfaces) {}

VertexLight::~VertexLight() = default;

const VertexStages& VertexLight::stages() const { return parts_->set; }

bool VertexLight::takesRays(const BatchContext& c) const {
    return world_.settings().rowRequests && std::none_of(c.rays.begin(), c.rays.end(), [&](const PathRay& r) {
               return r.quiet || r.scattered >= limits::kPathDepth;
           });
}

/// Whether blocks can process all lobes that the kernel has requested at the points of the batch, with a weight that is not 0.
static bool asksBlocks(const BatchContext& c) {
    const BoundKernel& kernel = *c.bound;
    if (kernel.blocks || kernel.kernel->facts().suspends) return kernel.blocks;
    return std::all_of(c.emits.begin(), c.emits.end(), [&](const EmitRecord& e) {
        const SiteInfo& s = kernel.sites[size_t(e.site)];
        if (s.block || !asksLobes(s.kind) || !isRequest(s.kind, kernel.path)) return true;
        const float* weight = c.arena.data() + e.offset;
        for (uint64_t left = e.mask; left; left &= left - 1)
            for (int q = 0, lane = std::countr_zero(left); q < 3; ++q)
                if (weight[q * e.lanes + lane] != 0) return false;
        return true;
    });
}

/// Whether rays of a kernel hit the set of shapes that the surface names (Attribute "grouping" "tracesubset").
static bool tracesSets(const WorldImpl& w, const BoundKernel& kernel) {
    const auto traces = [](const SiteInfo& s) { return s.kind == SiteKind::Trace; };
    return w.traceSubsets() && std::any_of(kernel.sites.begin(), kernel.sites.end(), traces);
}

bool VertexLight::takes(const BatchContext& c) const {
    if (!asksBlocks(c) || c.lightOutput || c.between || c.subsurface || tracesSets(world_, *c.bound)) return false;
    return takesRays(c);
}

bool VertexLight::takes(const BoundKernel& kernel) const {
    return world_.settings().rowRequests && rules_.pickOne && kernel.blocks && !tracesSets(world_, kernel);
}

/// Reads the requests of a batch in rows. Returns false if they must be made one by one.
bool VertexLight::readRows(BatchContext& c, bool waits) {
    parts_->loading.begin(c, waits);
    return parts_->loading.loadVertices(c) && parts_->requests.read(c);
}

bool VertexLight::run(BatchContext& c, Sched& sched) {
    return (c.emits.empty() && !parts_->flight.on()) || follow(c, sched, false);
}

bool VertexLight::follow(BatchContext& c, Sched& sched, bool waits) {
    if (!readRows(c, waits)) return false;
    if (parts_->flight.on()) parts_->flight.takeModels(c, false);
    followLobes(c, sched);
    return true;
}

void VertexLight::gather(BatchContext& c, Sched& sched) {
    if (!ambient_.asked.empty()) ambient_.gather(c);
    if (set_.requests.lobes.empty() && !parts_->flight.on()) return;
    std::vector<AccumulatorId> targets = c.targets;
    for (const LobeVertex& l : set_.requests.lobes) targets[size_t(l.point)] = l.target;
    c.targets.swap(targets);
    parts_->single.load(c);
    if (parts_->flight.on() && !c.between && !c.subsurface) parts_->flight.takeModels(c, false);
    followLobes(c, sched);
    c.targets.swap(targets);
}

void VertexLight::read(BatchContext& c, Sched& sched) {
    if (takes(c) && readRows(c, false)) return parts_->selection.prepare();
    set_.requests.requestPairs(c, nullptr, sched);
    parts_->single.load(c);
    parts_->selection.prepare();
}

void VertexLight::runModels(BatchContext& c, Sched& sched) {
    parts_->loading.begin(c, false);
    parts_->blocks.count = 0;
    parts_->loading.loadVertices(c);
    parts_->flight.takeModels(c, true);
    followLobes(c, sched);
}

void VertexLight::runMedium(BatchContext& c, const Homogeneous& h, std::span<const Vec3> lightDirected, Sched& sched) {
    parts_->loading.begin(c, false);
    parts_->loading.loadVertices(c);
    beginMedium(lightDirected, h.anisotropy);
    followLobes(c, sched);
}

void VertexLight::runExits(BatchContext& c, std::span<const float> indirect, Sched& sched) {
    parts_->loading.begin(c, false);
    parts_->loading.loadVertices(c);
    parts_->blocks.indirect = indirect;
    beginExits(c);
    followLobes(c, sched);
}

void VertexLight::followLobes(BatchContext& c, Sched& sched) {
    Parts& p = *parts_;
    p.selection.prepare();
    if (p.flight.on()) return p.flight.follow(c, sched);
    if (world_.lightsAsk()) p.lights.recordLitSurfaces(c);
    p.gather.mark(c);
    p.selection.select(c);
    counters_.ignored += p.blocks.ignored;
    if (!world_.media().empty() && !c.between) surfaces_.pointsOfRows(c); // to find the side on which rays continue
    if (world_.settings().firstSeen && !p.blocks.waits && !c.between) p.selection.showAlbedo(c);
    p.selection.lightDirections(c);
    p.lights.run(c, sched);
    if (rules_.emissionCounts && lastSkies_.any()) p.last.run(c);
    p.guide.run(c, sched);
    p.specular.run(c);
    p.gather.take(c, sched);
    p.scatter.run(c, sched);
    if (!subsurface_.media.empty()) subsurface_.walk(c, sched); // may light further batches here
}

bool VertexLight::needsPoints(const SurfaceBinding& b) const { return parts_->flight.on() || parts_->lights.needsPoints(b); }

bool VertexLight::lightMedium(const BatchContext& c, const Homogeneous& h, const BoundLight& light,
                              std::vector<BlockLit>& found) {
    if (!rules_.pickOne) return false;
    VertexBlocks& v = parts_->blocks;
    parts_->loading.begin(c, false);
    parts_->loading.loadVertices(c);
    beginMedium({}, h.anisotropy);
    parts_->selection.prepare();
    if (!parts_->lights.sampleInRows(light, c)) return false;
    const BlockLobes& s = v.sites[0];
    for (size_t b = 0; b < v.blocks; ++b) {
        const LightBlock& l = v.lights[b];
        if (l.asked) s.lanes->evaluate(s.lobes[b].lobe[0], l.asked, l.w[0], v.value[0]);
        for (Lanes left = l.asked; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
            BlockLit& to = found.emplace_back();
            to.point = point;
            to.w = {l.w[0][i], l.w[1][i], l.w[2][i]};
            if (l.emitter) to.end = {l.end[0][i], l.end[1][i], l.end[2][i]};
            to.Cl = {l.Cl[0][i], l.Cl[1][i], l.Cl[2][i]};
            to.density = l.density[i], to.far = l.far[i], to.kept = l.keptDiffuse[i], to.phase = v.value[kRowFcos][i];
            const int32_t says = v.queryAt.empty() ? -1 : v.queryAt[point];
            to.shadowRadius = says < 0 ? 0 : v.values[size_t(says)].shadowRadius;
            if (says >= 0) to.L = v.values[size_t(says)].L;
        }
    }
    return true;
}

/// Sets the lobes; near a light, those with light-directed sampling.
void VertexLight::beginMedium(std::span<const Vec3> lightDirected, float anisotropy) {
    VertexBlocks& v = parts_->blocks;
    static const LobeKind* const kKinds[] = {findLobe("henyey-greenstein"), findLobe("henyey-greenstein-toward-light")};
    v.count = std::any_of(lightDirected.begin(), lightDirected.end(), [](const Vec3& l) { return l != Vec3(0); }) ? 2 : 1;
    v.sites.resize(std::max(v.sites.size(), v.count));
    for (size_t k = 0; k < v.count; ++k) {
        BlockLobes& s = v.sites[k];
        s.number = kSegmentEvent;
        s.info = nullptr;
        s.kind = kKinds[k];
        s.lanes = &lobeLanes(lobeWidth()).lobes[s.kind->index];
        s.rays = &kDiffuseKind;
        s.lighting = s.lights = s.diffuse = true;
        s.begin(v.blocks);
        for (size_t b = 0; b < v.blocks; ++b) {
            LobeBlock& l = s.lobes[b];
            for (int q = 0; q < 3; ++q) {
                std::fill_n(l.weight[q], kBlock, 1.f);
                std::copy_n(v.rays[b].direction[q], kBlock, l.lobe[kRowAxis + q]);
            }
            std::fill_n(l.lobe[kRowA], kBlock, anisotropy);
        }
    }
    for (size_t i = 0; i < v.points; ++i) {
        const bool near = !lightDirected.empty() && lightDirected[i] != Vec3(0);
        LobeBlock& l = v.sites[near].lobes[i / kBlock];
        l.asked |= 1u << i % kBlock;
        for (int q = 0; q < 3 && near; ++q) l.lobe[kRowWo + q][i % kBlock] = lightDirected[i][q];
    }
}

/// Sets the lobes: diffuse about the normal.
void VertexLight::beginExits(const BatchContext& c) {
    VertexBlocks& v = parts_->blocks;
    static const LobeKind* const kind = findLobe("diffuse");
    v.count = 1;
    if (v.sites.empty()) v.sites.emplace_back();
    BlockLobes& s = v.sites[0];
    s.number = kSegmentEvent;
    s.info = nullptr;
    s.kind = kind;
    s.lanes = &lobeLanes(lobeWidth()).lobes[kind->index];
    s.rays = &kDiffuseKind;
    s.lighting = s.lights = s.diffuse = true;
    s.begin(v.blocks);
    if (v.moved) s.options.assign(v.blocks * kBlock, {});
    for (size_t b = 0; b < v.blocks; ++b) {
        LobeBlock& l = s.lobes[b];
        l.asked = v.vertices[b].points;
        std::fill_n(l.lobe[kRowA], kBlock, 0.f);
        std::fill_n(l.lobe[kRowHasHorizon], kBlock, 0.f);
        for (size_t i = 0; i < size_t(kBlock); ++i) {
            const ShadePoint& p = c.points[std::min(b * kBlock + i, v.points - 1)];
            for (int q = 0; q < 3; ++q) l.weight[q][i] = 1, l.lobe[kRowAxis + q][i] = p.N[q], l.lobe[kRowWo + q][i] = -p.I[q];
        }
    }
}

/// Whether the strips of a batch all make the same first request, for one ray each, at nearly all points of the batch.
bool VertexLight::takes(const BatchContext& c, std::span<KernelStrip* const> strips) const {
    if (world_.traceSubsets() || c.lightOutput || c.between || c.subsurface || !c.clear.empty() || c.points.empty() ||
        photons_.photonTrace() || !takesRays(c))
        return false;
    size_t asked = 0;
    for (const KernelStrip* s : strips) {
        const StripRequest r = s->request();
        const SiteInfo& site = c.bound->sites[size_t(r.site)];
        if (r.site != strips[0]->request().site || !site.block || site.kind != SiteKind::Trace || r.gather) return false;
        for (const int lane : r.memory->laneOf) {
            const int samples = site.rays->samples;
            const bool several =
                site.trace->hemisphere || (samples >= 0 && r.memory->in[size_t(samples) * size_t(r.lanes) + size_t(lane)] > 1);
            if (several || r.memory->occurrences[size_t(r.site) * 64 + size_t(lane)] != 0) return false;
        }
        asked += r.memory->laneOf.size();
    }
    return 2 * asked >= c.points.size();
}

bool VertexLight::run(BatchContext& c, std::span<KernelStrip* const> strips, Sched& sched) {
    VertexBlocks& v = parts_->blocks;
    if (!takes(c, strips)) return false;
    std::vector<EmitRecord> emits;
    std::vector<float> arena;
    std::vector<AccumulatorId> targets = c.targets;
    v.before.assign(c.points.size(), 0);
    for (const KernelStrip* s : strips) { // as a kernel that does not wait emits it: weight 1, then the arguments
        const StripRequest r = s->request();
        EmitRecord& e = emits.emplace_back();
        e.site = r.site, e.first = r.first, e.lanes = r.lanes, e.offset = arena.size();
        arena.insert(arena.end(), 3 * size_t(r.lanes), 1.f);
        arena.insert(arena.end(), r.memory->in.begin(), r.memory->in.end());
        arena.resize(e.offset + size_t(rowsOfArguments(c.bound->sites[size_t(r.site)]) + 3) * size_t(r.lanes));
        for (size_t k = 0; k < r.memory->laneOf.size(); ++k) {
            const size_t lane = size_t(r.memory->laneOf[k]), point = size_t(r.first) + lane;
            e.mask |= uint64_t(1) << lane;
            targets[point] = r.memory->ids[k];
            v.before[point] = r.asked[lane];
        }
    }
    c.emits.swap(emits), c.arena.swap(arena), c.targets.swap(targets);
    const bool done = follow(c, sched, true);
    c.emits.swap(emits), c.arena.swap(arena), c.targets.swap(targets);
    if (!done) return false;
    for (KernelStrip* s : strips) {
        uint64_t lobes = 0;
        counters_.inRows += s->request().memory->laneOf.size();
        for (int lane = 0; lane < s->request().lanes; ++lane) {
            const size_t point = size_t(s->request().first + lane);
            if (point < v.points && v.count > 0)
                lobes |= uint64_t(v.sites[0].lobes[point / kBlock].asked >> point % kBlock & 1) << lane;
        }
        s->noteAsked(lobes);
    }
    return true;
}

} // namespace alpenglow::integrator
