// Vertices in blocks: from the requests of a kernel to lobes, and the probabilities of following them.
#include "integrator/accumulator.h"
#include "integrator/blockflight.h"
#include "integrator/blockguide.h"
#include "integrator/blockphotons.h"
#include "integrator/blockrequests.h"
#include "integrator/chosenlights.h"
#include "integrator/lightpathstates.h"
#include "integrator/occlusioncalls.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"
#include "integrator/subsurfacewalks.h"
#include "integrator/surfacepoints.h"
#include "integrator/vertexlight.h"
#include "services/random.h"
#include "world/blocksite.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

static Lanes firstPoints(size_t n) { return n >= size_t(kBlock) ? 0xffffu : (1u << n) - 1; }

BlockVertices::BlockVertices(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), batches_(s.batches), inputs_(s.inputs), lastSkies_(s.lastSkies),
      lightKernels_(s.lightKernels), litSurfaces_(s.litSurfaces), paths_(s.paths), media_(s.media), mediumEvents_(s.mediumEvents),
      occlusion_(s.occlusion), photons_(s.photons), store_(s.store), shadows_(s.shadows), subsurface_(s.subsurface),
      surfaces_(s.surfaces), vertexLight_(s.vertexLight), stages_(stages()), lanes_(lobeLanes(lobeWidth())) {
    const Settings& set = world_.settings_;
    if (rules_.roulette) roulette_ = set.localRoulette ? Roulette::Local : Roulette::Throughput;
    endsTrees_ = !set.localRoulette && world_.lightTraces_ > 0;
    noSample_ = &store_.noSample;
    guided_ = std::make_unique<Guided>(*this, s.guide);
    requested_ = std::make_unique<Requested>(*this, s);
    gathered_ = std::make_unique<Photons>(*this, s);
    flight_ = std::make_unique<Flight>(*this, s);
    if (!world_.accel_) return; // not a complete world
    for (const BoundLight& l : world_.lights_) inRows_.push_back(inRows(l, l.kernel));
    chosen_ = std::make_unique<ChosenLights>(*this);
}

BlockVertices::~BlockVertices() = default;

bool BlockVertices::takesRays(const BatchContext& c) const {
    return world_.settings_.rowRequests && std::none_of(c.rays.begin(), c.rays.end(), [&](const PathRay& r) {
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
    return w.traceSubsets_ && std::any_of(kernel.sites.begin(), kernel.sites.end(), traces);
}

bool BlockVertices::takes(const BatchContext& c) const {
    if (!asksBlocks(c) || c.aside || c.between || c.below || tracesSets(world_, *c.bound)) return false;
    return takesRays(c);
}

bool BlockVertices::takes(const BoundKernel& kernel) const {
    return world_.settings_.rowRequests && rules_.pickOne && kernel.blocks && !tracesSets(world_, kernel);
}

bool BlockVertices::run(BatchContext& c, Sched& sched) { return (c.emits.empty() && !flight_->on()) || follow(c, sched, false); }

bool BlockVertices::follow(BatchContext& c, Sched& sched, bool waits) {
    begin(c, waits);
    if (!loadVertices(c) || !findSites(c) || !request(c)) return false;
    if (flight_->on()) flight_->takeModels(c, false);
    followLobes(c, sched);
    return true;
}

void BlockVertices::runModels(BatchContext& c, Sched& sched) {
    begin(c, false);
    count_ = 0;
    loadVertices(c);
    flight_->takeModels(c, true);
    followLobes(c, sched);
}

void BlockVertices::begin(const BatchContext& c, bool waits) {
    waits_ = waits;
    indirect_ = {};
    apart_.clear();
    loops_.clear();
    repeats_ = sendsSeveral_ = several_ = checksHits_ = false;
    moved_ = nullptr;
    requested_->clear();
    told_.clear();
    given_.clear();
    onlySite_ = -1;
    draw_ = 0;
    ignored_ = 0;
    points_ = c.rays.size();
    blocks_ = (points_ + kBlock - 1) / kBlock;
    vertices_.resize(std::max(vertices_.size(), blocks_));
    rays_.resize(std::max(rays_.size(), blocks_));
}

void BlockVertices::followLobes(BatchContext& c, Sched& sched) {
    prepare();
    if (flight_->on()) return flight_->follow(c, sched);
    if (world_.lightsAsk()) tellLights(c);
    gathered_->mark(c);
    select(c);
    counters_.ignored += ignored_;
    if (!world_.media_.empty() && !c.between) surfaces_.pointsOfRows(c); // to find the side on which rays continue
    if (world_.settings_.firstSeen && !waits_ && !c.between) showAlbedo(c);
    lightDirections(c);
    light(c, sched);
    if (rules_.emissionCounts && lastSkies_.any()) lastSkies(c);
    guided_->run(c, sched);
    gathered_->take(c, sched);
    scatter(c, sched);
    if (!subsurface_.below.empty()) subsurface_.walk(c, sched); // may run further batches in blocks
}

/// Copies points and rays from structures to rows.
bool BlockVertices::loadVertices(const BatchContext& c) {
    for (size_t b = 0; b < blocks_; ++b) {
        const size_t first = b * kBlock, n = std::min(points_ - first, size_t(kBlock));
        RayBlock& rays = rays_[b];
        stages_.load(&c.rays[first], int(sizeof(PathRay)), int(n), kRayWords, rays.origin);
        for (size_t k = 0; k < size_t(kBlock); ++k) rays.target[k] = c.targets[first + std::min(k, n - 1)];
        takeRays(rays, c.between);
        guided_->mark(b, c);
        if (c.between) loadFlown(b, c);
        else if (!loadPoints(b, c)) return false;
        for (int i = 0; waits_ && requested_->empty() && i < kBlock; ++i) // light samples of the call
            vertices_[b].lightVertex[i] = childVertex(vertices_[b].vertex[i], kLightPoint + uint32_t(c.emits[0].site), 0);
    }
    return true;
}

/// Copies ray data that paths need into a block.
void BlockVertices::takeRays(const RayBlock& rays, bool between) {
    VertexBlock& v = vertices_[size_t(&rays - rays_.data())];
    v.last = 0;
    for (int k = 0; k < kBlock; ++k) {
        v.bounces[k] = int16_t(rays.bounces[k]);
        v.last |= Lanes(v.bounces[k] - int16_t(rays.path[k] >> 16) - between >= world_.maxDepth_)
                  << k; // scattering in media does not count
    }
    v.deep[0] = v.deep[1] = v.last;
    for (int k = 0; k < kBlock; ++k) {
        if (int16_t(rays.path[k] >> 16) >= limits::kPathDepth) v.deep[0] |= 1u << k, v.deep[1] |= 1u << k;
        const PathSample& sample = sampleOf(rays, k);
        v.low[k] = sample.numbers.low();
        v.high[k] = sample.numbers.high();
        v.index[k] = sample.numbers.index();
    }
    v.waits = waits_;
    for (int q = 0; q < 3; ++q) std::copy_n(waits_ ? whole_ : rays.weight[q], kBlock, v.weight[q]); // relative to its target
    std::copy_n(rays.vertex, kBlock, v.vertex);
    std::copy_n(rays.vertex, kBlock, v.lightVertex);
}

/// Applies the depth limits of a surface to the lobes of a point.
void BlockVertices::endRays(size_t b, int lane, const SurfaceBinding& s, bool between) {
    if (s.maxDiffuse < 0 && s.maxSpecular < 0) return;
    const RayBlock& r = rays_[b];
    const int scattered = int16_t(r.path[lane] >> 16) + between;
    const int diffuse = int16_t(r.bounces[lane] >> 16) - scattered, specular = int16_t(r.specular[lane]);
    for (const int isDiffuse : {0, 1}) {
        const bool deep = (s.maxDiffuse >= 0 && diffuse + isDiffuse > s.maxDiffuse) ||
                          (s.maxSpecular >= 0 && specular + !isDiffuse > s.maxSpecular);
        vertices_[b].deep[isDiffuse] |= Lanes(deep) << lane;
    }
}

bool BlockVertices::loadPoints(size_t b, const BatchContext& c) {
    VertexBlock& v = vertices_[b];
    const size_t first = b * kBlock, n = std::min(points_ - first, size_t(kBlock));
    v.points = firstPoints(n);
    v.through = !c.clear.empty();
    const bool rows = c.points.empty();
    for (size_t k = 0; k < size_t(kBlock); ++k) {
        const size_t i = first + std::min(k, n - 1); // repeats the last point
        const SurfaceBinding& s = world_.bindings_[size_t(c.bindings[i])];
        const geometry::SurfacePoint& p = rows ? c.surfaces[i] : c.points[i].surface;
        const Vec3& P = rows ? p.P : c.points[i].P;
        if (!(P == p.P)) moved_ = &c;
        if (s.matte && c.rays[i].camera()) v.points &= ~(1u << k);
        endRays(b, int(k), s, false);
        for (int q = 0; q < 3; ++q) {
            v.P[q][k] = P[q];
            v.n[q][k] = p.n[q];
            v.I[q][k] = rows ? c.ways[size_t(q) * points_ + i] : c.points[i].I[q];
            v.clear[q][k] = v.beyond[q][k] = v.through ? c.clear[i][q] : 0;
        }
        v.error[k] = p.pError;
        v.bias[k] = s.bias;
    }
    return !moved_ || !requested_->empty();
}

/// Counts the calls of a strip at each call site: in a loop one follows another.
class BlockVertices::CallCount {
public:
    explicit CallCount(const BatchContext& c) : of_(c.bound->sites.size()) {}
    /// Whether a call is the first one of its strip.
    bool begins(const EmitRecord& e) {
        if (e.first == first_) return false;
        first_ = e.first;
        std::fill(of_.begin(), of_.end(), 0u);
        return true;
    }
    /// How many calls of the strip at this call site came before.
    uint32_t next(const EmitRecord& e) { return of_[size_t(e.site)]++; }

private:
    std::vector<uint32_t> of_;
    int first_ = -1;
};

/// Finds the requesting call sites in the order of the calls; a call site in a loop once for each turn. Returns false if points
/// differ in that order, or there are too many.
bool BlockVertices::findSites(const BatchContext& c) {
    count_ = 0;
    CallCount calls(c);
    size_t next = 0; // index after the position of the previous call
    for (const EmitRecord& e : c.emits) {
        if (!c.bound->sites[size_t(e.site)].block) continue;
        if (calls.begins(e)) next = 0;
        const uint32_t nth = calls.next(e);
        size_t at = 0;
        while (at < count_ && !(sites_[at].number == e.site && sites_[at].nth == nth)) ++at;
        if (at < count_) {
            if (at < next) return false;
            next = at + 1;
            continue;
        }
        if (count_ == sites_.size()) sites_.emplace_back();
        std::rotate(sites_.begin() + long(next), sites_.begin() + long(count_), sites_.begin() + long(count_) + 1);
        beginSite(sites_[next], e.site, c);
        sites_[next++].nth = nth;
        ++count_;
    }
    return true;
}

/// Whether arguments of a call are read point by point.
static bool readsRows(const BlockLobes& s) {
    return s.walks || s.info->kind == SiteKind::Trace || !s.info->outputs.empty(); // outputs: lights query them
}

/// Whether the rays of a trace() hit other surfaces, or other sides, than rays of lighting shadeops.
static bool hasRaySet(const BlockLobes& s) {
    const shading::RaySet& set = s.rays->set;
    return !s.lighting && (set.only || set.sides != accel::Sides::Front || set.mode != shading::HitMode::Default);
}

void BlockVertices::beginSite(Site& s, int number, const BatchContext& c) {
    s.number = number;
    s.info = &c.bound->sites[size_t(number)];
    s.kind = s.info->lobe;
    s.lanes = &lanes_.lobes[s.kind->index];
    s.lighting = s.info->kind != SiteKind::Trace;
    s.lights = (s.lighting && s.info->kind != SiteKind::Subsurface) || s.info->rowLights >= 0;
    if (s.lighting) s.rays = s.info->kind == SiteKind::Diffuse ? &kDiffuseKind : &kSpecularKind;
    else
        s.rays = store_.kindOf({s.info->rays->rays, true, s.info->rays->set, s.info->label,
                                s.info->trace->hemisphere && world_.globalMaps_, s.lights, s.info->trace->apart});
    s.diffuse = s.rays->type == RayType::Diffuse;
    s.begin(blocks_);
    s.walks = s.info->kind == SiteKind::Subsurface;
    s.apart = s.info->kind == SiteKind::Trace && s.info->trace->apart;
    s.direct = s.info->kind == SiteKind::Diffuse && s.info->trace && s.info->trace->apart;
    s.sets = hasRaySet(s);
    s.rows.assign(readsRows(s) ? blocks_ : 0, nullptr);
}

bool BlockVertices::request(BatchContext& c) {
    CallCount calls(c);
    for (size_t k = 0; k < count_; ++k)
        if (sites_[k].nth > 0) loops_.try_emplace(sites_[k].number, points_, 0u);
    repeats_ = !loops_.empty();
    for (const EmitRecord& e : c.emits) {
        if (!c.bound->sites[size_t(e.site)].block) continue;
        calls.begins(e);
        const uint32_t nth = calls.next(e);
        const auto site =
            std::find_if(sites_.begin(), sites_.end(), [&](const Site& s) { return s.number == e.site && s.nth == nth; });
        if (const auto loop = loops_.find(e.site); loop != loops_.end()) countCalls(*site, e, c, loop->second);
        if (!requestOf(*site, e, c)) return false;
    }
    for (size_t k = 0; k < count_; ++k) { // strips narrower than a block: their rows are now contiguous
        Site& s = sites_[k];
        for (size_t b = 0; b < blocks_ && !s.narrow.empty(); ++b) {
            const Lanes asked = std::exchange(s.lobes[b].asked, 0) & vertices_[b].points;
            const size_t rows = s.narrow.size() / (blocks_ * kBlock);
            if (readsRows(s)) s.rows[b] = s.narrow.data() + (b * rows + 3) * kBlock, s.stride = kBlock;
            if (stages_.request(vertices_[b], *s.info->block, s.narrow.data() + b * rows * kBlock, kBlock, asked, s.lobes[b]))
                return false;
        }
        if (!waits_) noteHemispheres(s, c);
        if (!readOptions(s, c)) return false;
    }
    return true;
}

/// Notes the points of indirectdiffuse(), and normals that face away from the camera there.
void BlockVertices::noteHemispheres(const Site& s, BatchContext& c) {
    if (s.apart) apart_.resize(blocks_);
    for (size_t b = 0; b < blocks_ && s.apart; ++b) apart_[b] |= s.lobes[b].asked;
    if (s.info->kind != SiteKind::Trace || !s.info->trace->hemisphere) return;
    for (size_t b = 0; b < blocks_; ++b)
        for (Lanes left = s.lobes[b].asked; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left)), point = b * kBlock + i;
            if (!c.rays[point].camera()) continue;
            surfaces_.pointsOfRows(c);
            const float(*axis)[kBlock] = &s.lobes[b].lobe[kRowAxis];
            occlusion_.noteTurnedAway(c, *s.info, int(point), {axis[0][i], axis[1][i], axis[2][i]});
        }
}

/// Counts the calls with a weight in a loop. before: by point, those of earlier turns.
void BlockVertices::countCalls(Site& s, const EmitRecord& e, const BatchContext& c, std::vector<uint32_t>& before) {
    s.occurrence.resize(points_);
    const float* weight = c.arena.data() + e.offset;
    for (uint64_t left = e.mask; left; left &= left - 1) {
        const size_t lane = size_t(std::countr_zero(left)), point = size_t(e.first) + lane, lanes = size_t(e.lanes);
        if (point >= points_) return;
        s.occurrence[point] = before[point];
        before[point] += weight[lane] != 0 || weight[lanes + lane] != 0 || weight[2 * lanes + lane] != 0;
    }
}

/// Reads the request of a call site at the points of a strip.
bool BlockVertices::requestOf(Site& s, const EmitRecord& e, const BatchContext& c) {
    const float* rows = c.arena.data() + e.offset;
    if (e.lanes >= kBlock) {
        for (int at = 0; at < e.lanes && size_t(e.first + at) < points_; at += kBlock) {
            const size_t b = size_t(e.first + at) / kBlock;
            const Lanes asked = Lanes(e.mask >> at) & vertices_[b].points;
            if (readsRows(s)) s.rows[b] = rows + 3 * e.lanes + at, s.stride = e.lanes;
            if (asked && stages_.request(vertices_[b], *s.info->block, rows + at, e.lanes, asked, s.lobes[b])) return false;
        }
        return true;
    }
    const size_t count = size_t(rowsOfArguments(*s.info)) + 3, b = size_t(e.first) / kBlock, at = size_t(e.first) % kBlock;
    s.narrow.resize(count * blocks_ * kBlock);
    for (size_t r = 0; r < count; ++r)
        std::copy_n(rows + r * size_t(e.lanes), e.lanes, s.narrow.data() + (b * count + r) * kBlock + at);
    s.lobes[b].asked |= Lanes(e.mask) << at;
    return true;
}

void BlockVertices::prepare() {
    for (size_t k = 0; k < count_; ++k) {
        Site& s = sites_[k];
        for (size_t b = 0; b < blocks_; ++b) {
            LobeBlock& l = s.lobes[b];
            if (!l.asked) {
                std::fill_n(l.chosen, kBlock, 0.f);
                continue;
            }
            s.lanes->prepare(l.lobe[0], l.asked);
            for (int i = 0; s.lights && i < kBlock; ++i)
                l.lights |= Lanes((l.asked & ~vertices_[b].guided & ~l.elsewhere) >> i & (l.lobe[kRowDelta][i] == 0)) << i;
            for (int i = 0; !s.requests.empty() && i < kBlock; ++i)
                if (const LobeVertex* r = s.requests[b * kBlock + size_t(i)]; r && !r->lights) l.lights &= ~(1u << i);
        }
    }
}

void BlockVertices::select(const BatchContext& c) {
    std::vector<SiteRules> of(count_);
    for (size_t k = 0; k < count_; ++k) of[k] = {sites_[k].lighting, sites_[k].diffuse, sites_[k].walks};
    // Sums of outputs need not conserve energy.
    const SelectRules rules{of.data(), world_.settings_.unbiased || c.aside, !rules_.pickOne};
    for (size_t k = 0; k < count_; ++k) {
        const bool still = (!world_.settings_.indirect && sites_[k].diffuse) || (c.below && !rules_.pickOne);
        for (size_t b = 0; b < blocks_ && still && !sites_[k].walks; ++b) sites_[k].lobes[b].stays = ~Lanes(0);
    }
    for (size_t b = 0; b < blocks_; ++b) {
        const Selected found = stages_.select(vertices_[b], lobesOf(b).data(), int(count_), rules);
        counters_.depthCap += uint64_t(std::popcount(found.cut & vertices_[b].points));
        for (size_t k = 0; k < count_; ++k)
            for (Lanes left = sites_[k].lobes[b].failed & vertices_[b].points; left; left &= left - 1)
                accumulator_.notFinite(c, c.rays[b * kBlock + size_t(std::countr_zero(left))], uint32_t(sites_[k].number));
        for (const bool more : {true, false})
            for (Lanes left = more ? found.bright : found.brightWithClear; left; left &= left - 1)
                vertexLight_.tellScaled(world_.bindings_[size_t(c.bindings[b * kBlock + size_t(std::countr_zero(left))])], more);
    }
}

} // namespace alpenglow::integrator
