// Requests that were made point by point (Requests::lobes), to rows of lobes.
#include "integrator/blockrequests.h"
#include "base/memory.h"
#include "integrator/accumulator.h"
#include "integrator/blockflight.h"
#include "integrator/kernelinputs.h"
#include "integrator/occlusioncalls.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "services/random.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

/// Whether requests can share a site: what a site holds once is the same.
static bool shareSite(const BlockLobes& s, const LobeVertex& l) {
    return s.number == int(l.site) && s.kind == l.kind && s.lighting == l.lobeOfShader && s.walks == (l.below >= 0) &&
           s.diffuse == (l.rays->type == RayType::Diffuse);
}

BlockVertices::Requested::Requested(BlockVertices& b, const StageSet& s)
    : b_(b), world_(b.world_), requests_(s.requests), unshadowed_(s) {}

void BlockVertices::runRequests(BatchContext& c, Sched& sched) { requested_->run(c, sched); }

void BlockVertices::Requested::run(BatchContext& c, Sched& sched) {
    if (requests_.lobes.empty() && !b_.flight_->on()) return;
    std::vector<AccumulatorId> targets = c.targets;
    for (const LobeVertex& l : requests_.lobes) targets[size_t(l.point)] = l.target;
    c.targets.swap(targets);
    load(c);
    if (b_.flight_->on() && !c.between && !c.below) b_.flight_->takeModels(c, false);
    b_.followLobes(c, sched);
    c.targets.swap(targets);
}

void BlockVertices::Requested::load(BatchContext& c) {
    b_.begin(c, !requests_.lobes.empty() && requests_.lobes[0].ownsTarget);
    lobes_.swap(requests_.lobes);
    b_.before_.assign(b_.waits_ ? b_.points_ : 0, 0);
    for (const LobeVertex& l : lobes_) {
        if (b_.waits_) b_.before_[size_t(l.point)] = l.before;
        b_.sendsSeveral_ |= l.ownsTarget && l.samples > 1;
    }
    b_.loadVertices(c);
    take(c);
    requests_.clear();
}

void BlockVertices::Requested::take(BatchContext& c) {
    b_.count_ = 0;
    std::vector<std::vector<const LobeVertex*>> of(b_.points_);
    for (const LobeVertex& l : lobes_) of[size_t(l.point)].push_back(&l);
    for (size_t point = 0; point < b_.points_; ++point) {
        size_t next = 0; // a point's requests keep their order
        for (const LobeVertex* l : of[point]) {
            const size_t at = siteOf(*l, next, c);
            b_.sites_[at].requests[point] = l;
            next = at + 1;
        }
        if (b_.waits_ && !of[point].empty()) {
            const LobeVertex& l = *of[point][0];
            VertexBlock& v = b_.vertices_[point / kBlock];
            v.lightVertex[point % kBlock] = childVertex(v.vertex[point % kBlock], kLightPoint + l.site, l.occurrence);
        }
    }
    b_.apart_.assign(requests_.apartAt.empty() ? 0 : b_.blocks_, 0);
    for (const int point : requests_.apartAt) b_.apart_[size_t(point) / kBlock] |= 1u << point % kBlock;
    requests_.apartAt.clear();
    for (size_t k = 0; k < b_.count_; ++k) {
        for (const LobeVertex* l : b_.sites_[k].requests)
            if (l) takeRequest(b_.sites_[k], *l);
        readOptions(b_.sites_[k]);
    }
}

/// The first site from `next` on that takes the request; a new one is put there if none does.
size_t BlockVertices::Requested::siteOf(const LobeVertex& l, size_t next, const BatchContext& c) {
    for (size_t k = next; k < b_.count_; ++k)
        if (shareSite(b_.sites_[k], l) && !b_.sites_[k].requests[size_t(l.point)]) return k;
    if (l.site < c.bound->sites.size() && (b_.count_ + 1) * b_.blocks_ * sizeof(LobeBlock) > limits::kRequestBytes)
        endTooManyRequests(c, *c.bound->sites[l.site].site);
    if (b_.count_ == b_.sites_.size()) b_.sites_.emplace_back();
    std::rotate(b_.sites_.begin() + long(next), b_.sites_.begin() + long(b_.count_), b_.sites_.begin() + long(b_.count_) + 1);
    ++b_.count_;
    Site& s = b_.sites_[next];
    s.begin(b_.blocks_);
    s.number = int(l.site);
    s.info = l.site < c.bound->sites.size() ? &c.bound->sites[l.site] : nullptr;
    s.kind = l.kind;
    s.lanes = &b_.lanes_.lobes[l.kind->index];
    s.rays = l.rays;
    s.lighting = l.lobeOfShader;
    s.lights = false;
    s.diffuse = l.rays->type == RayType::Diffuse;
    s.walks = l.below >= 0;
    s.requests.assign(b_.blocks_ * kBlock, nullptr);
    return next;
}

/// Copies a request to its lane.
void BlockVertices::Requested::takeRequest(Site& s, const LobeVertex& l) {
    const size_t i = size_t(l.point) % kBlock;
    LobeBlock& b = s.lobes[size_t(l.point) / kBlock];
    for (int q = 0; q < 3; ++q) b.weight[q][i] = l.weight[q];
    for (int r = 0; r < kLobeRows; ++r) b.lobe[r][i] = requests_.rows.row(l.place, r);
    b.asked |= 1u << i;
    b.elsewhere |= Lanes(l.elsewhere) << i;
    const bool indirect = world_.settings_.indirect || b_.flight_->on() || // Flight::limitDepths()
                          l.rays->type != RayType::Diffuse || l.below >= 0;
    b.stays |= Lanes(l.directOnly || !indirect) << i;
    s.lights |= l.lights;
    const shading::RaySet& set = l.rays->set;
    s.sets |= l.trace && (set.only || set.sides != accel::Sides::Front || set.mode != shading::HitMode::Default);
    if (l.occurrence > 0) {
        s.occurrence.resize(b_.points_);
        s.occurrence[size_t(l.point)] = l.occurrence;
        b_.repeats_ = true;
    }
}

void BlockVertices::Requested::readOptions(Site& s) {
    const bool some =
        !b_.rules_.pickOne || b_.moved_ || std::any_of(s.requests.begin(), s.requests.end(), [](const LobeVertex* l) {
            return l && (l->samples != 1 || l->bias >= 0 || l->base > 0 || l->elsewhere || l->importance != 1 ||
                         l->maxDistance < 1e38f || l->fade.fades());
        });
    if (!some) return;
    s.options.assign(b_.points_, {});
    for (const LobeVertex* l : s.requests)
        if (l)
            s.options[size_t(l->point)] = {l->bias, l->maxDistance, l->importance, l->samples,
                                           l->fade, l->elsewhere,   l->from,       l->base};
}

void BlockVertices::Requested::examine(size_t b, BatchContext& c) {
    for (Lanes left = b_.next_.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const size_t point = b * kBlock + size_t(i);
        const Site& s = b_.sites_[size_t(b_.next_.site[i])];
        const LobeVertex* const l = s.requestAt(point);
        if (!l || !l->trace) continue;
        const Vec3 w(b_.next_.direction[0][i], b_.next_.direction[1][i], b_.next_.direction[2][i]);
        if (l->trace->onlyLights && !(l->base > 0) && !intersectsEmitter(*l, point, w)) {
            b_.next_.goes &= ~(1u << i);
            continue;
        }
        TraceSums* const sums = l->trace->sums ? b_.accumulator_.sumsOf(l->target) : nullptr;
        if (!sums) continue;
        UnshadowedRay ray;
        ray.point = int(point);
        ray.rays = l->rays;
        ray.origin = b_.originOf(s, point, w);
        ray.direction = w;
        ray.maxDistance = l->maxDistance;
        ray.bringsEmission = l->lights && (l->elsewhere || (b_.next_.single >> i & 1));
        ray.lit = l->elsewhere ? l->from : c.points[point].P;
        ray.told = b_.toldAt(point);
        const float spread = c.rays[point].footprint.spread;
        const Color environment = l->trace->map ? l->tint * requests_.mapTowards(*l->trace, w, spread) : Color(0);
        unshadowed_.add(c, ray, throughputOf(i), environment, *sums);
    }
}

/// Factor of the light that the next ray of a lane finds.
Color BlockVertices::Requested::throughputOf(int i) const {
    const Color colour(b_.next_.colour[0][i], b_.next_.colour[1][i], b_.next_.colour[2][i]);
    const float pdf = b_.next_.pdf[i];
    const Color f = b_.next_.single >> i & 1 ? colour : pdf > 0 ? colour / pdf : Color(0);
    return Color(b_.next_.request[0][i], b_.next_.request[1][i], b_.next_.request[2][i]) * (f * b_.next_.scale[i]);
}

/// Whether a ray could hit the bounding sphere of an emitter.
bool BlockVertices::Requested::intersectsEmitter(const LobeVertex& l, size_t point, const Vec3& w) const {
    if (!l.lights) return false;
    const VertexBlock& v = b_.vertices_[point / kBlock];
    const size_t i = point % kBlock;
    const Vec3 from = l.elsewhere ? l.from : Vec3(v.P[0][i], v.P[1][i], v.P[2][i]);
    const float error = 1e-3f * (1 + length(from)) + std::fabs(l.bias);
    if (world_.lights_.size() > 64) return true; // sending the ray costs less than testing all of them
    return std::any_of(world_.lights_.begin(), world_.lights_.end(), [&](const BoundLight& light) {
        if (light.kind != LightKind::Area || !light.emitter || light.emitter->empty()) return false;
        const Vec3 to = light.centre - from;
        const float along = std::max(dot(to, w), 0.f), reach = light.radius * 1.001f + error;
        const Vec3 off = to - w * along;
        return !(dot(off, off) > reach * reach);
    });
}

void BlockVertices::Requested::drawAgain(const Site& s, size_t b, Lanes picked) {
    for (Lanes left = s.requests.empty() ? 0 : picked; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const size_t point = b * kBlock + size_t(i);
        const LobeVertex& l = *s.requests[point];
        if (b_.drawn_[kRowDrawn][i] != 0 || s.lobes[b].lobe[kRowDelta][i] != 0 || !l.trace) continue;
        if (!l.trace->axis && !(l.trace->openness && l.ownsTarget)) continue;
        if (!l.trace->axis) b_.idle_ |= 1u << i;
        const uint32_t vertex = childVertex(b_.vertices_[b].vertex[i], l.site, l.occurrence * 4096 + b_.turn_);
        const Random random(b_.sampleOf(b_.rays_[b], i).numbers);
        for (int tries = 1; tries < kDrawTries && b_.drawn_[kRowDrawn][i] == 0; ++tries) {
            const Vec2 u = random.pair(vertex, kDrawAgain, uint32_t(tries));
            alignas(64) Row numbers[2], drawn[kDrawnRows];
            numbers[0][i] = u.x, numbers[1][i] = u.y;
            s.lanes->sample(s.lobes[b].lobe[0], 1u << i, numbers[0], drawn[0]);
            for (int r = 0; r < kDrawnRows; ++r) b_.drawn_[r][i] = drawn[r][i];
        }
    }
}

void BlockVertices::Requested::addToRay(const LobeVertex& l, RayExtra& extra, int i, const BatchContext& c) {
    const PathRay& from = c.rays[size_t(l.point)];
    const Vec3 w(b_.next_.direction[0][i], b_.next_.direction[1][i], b_.next_.direction[2][i]);
    if (l.trace && l.trace->map) extra.environment = l.tint * requests_.mapTowards(*l.trace, w, from.footprint.spread);
    if (!l.ownsTarget || !l.trace || !l.trace->sums) return;
    extra.part = Color(1.f / (float(l.samples) * b_.survived_[i]));
    if (TraceSums* of = b_.accumulator_.sumsOf(l.target)) of->add(TraceSums::Open, w * mean(extra.part));
}

} // namespace alpenglow::integrator
