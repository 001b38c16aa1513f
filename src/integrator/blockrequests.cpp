// Requests that were made point by point (Requests::lobes), to rows of lobes.
#include "base/memory.h"
#include "integrator/accumulator.h"
#include "integrator/blockvertices.h"
#include "integrator/kernelinputs.h"
#include "integrator/occlusioncalls.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "services/random.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

/// Whether requests can share a site: what a site holds once is the same.
static bool shareSite(const BlockLobes& s, const LobeVertex& l) {
    return s.number == int(l.site) && s.kind == l.kind && s.lighting == l.lobeOfShader && s.walks == (l.below >= 0) &&
           s.diffuse == (l.rays->type == RayType::Diffuse);
}

bool BlockVertices::takesRequests(const BatchContext& c) const {
    if (!usable_ || !plain_[size_t(world_.bindings_[size_t(c.bindings[0])].lightList)] || photons_.photonTrace()) return false;
    const bool photons = world_.photons_ && std::any_of(c.rays.begin(), c.rays.end(), [&](const PathRay& r) {
                             return world_.photons_->pass(r.sample->sample) != nullptr;
                         });
    const SurfaceBinding& b = world_.bindings_[size_t(c.bindings[0])];
    const auto hasOptions = [](const LobeVertex& l) {
        return l.samples != 1 || l.bias >= 0 || l.base > 0 || l.elsewhere || l.importance != 1 || l.maxDistance < 1e38f ||
               l.fade.fades();
    };
    if (!world_.lightLists_[size_t(b.lightList)].chooser.empty() &&
        std::any_of(requests_.lobes.begin(), requests_.lobes.end(), hasOptions))
        return false;
    return !photons && std::all_of(requests_.lobes.begin(), requests_.lobes.end(), [&](const LobeVertex& l) {
        const shading::RaySet& set = l.rays->set;
        const bool plain = !set.only && set.sides == accel::Sides::Front && set.mode == shading::HitMode::Default;
        const bool several = l.trace && (l.ownsTarget || !rules_.pickOne) && l.samples > 1;
        return !l.lights || (plain && !several);
    });
}

bool BlockVertices::runRequests(BatchContext& c, Sched& sched) {
    if (requests_.lobes.empty()) return true;
    if (!takesRequests(c)) return false;
    begin(c, requests_.lobes[0].ownsTarget);
    requested_.swap(requests_.lobes);
    std::vector<AccumulatorId> targets = c.targets;
    before_.assign(waits_ ? points_ : 0, 0);
    for (const LobeVertex& l : requested_) {
        targets[size_t(l.point)] = l.target;
        if (waits_) before_[size_t(l.point)] = l.before;
        several_ |= l.ownsTarget && l.samples > 1;
    }
    c.targets.swap(targets);
    loadVertices(c);
    takeRequests(c);
    requests_.clear();
    followLobes(c, sched);
    c.targets.swap(targets);
    counters_.inBlocks += points_;
    return true;
}

void BlockVertices::takeRequests(BatchContext& c) {
    count_ = 0;
    std::vector<std::vector<const LobeVertex*>> of(points_);
    for (const LobeVertex& l : requested_) of[size_t(l.point)].push_back(&l);
    for (size_t point = 0; point < points_; ++point) {
        size_t next = 0; // a point's requests keep their order
        for (const LobeVertex* l : of[point]) {
            const size_t at = siteOf(*l, next, c);
            sites_[at].requests[point] = l;
            next = at + 1;
        }
        if (waits_ && !of[point].empty()) {
            const LobeVertex& l = *of[point][0];
            VertexBlock& v = vertices_[point / kBlock];
            v.lightVertex[point % kBlock] = childVertex(v.vertex[point % kBlock], kLightPoint + l.site, l.occurrence);
        }
    }
    apart_.assign(requests_.apartAt.empty() ? 0 : blocks_, 0);
    for (const int point : requests_.apartAt) apart_[size_t(point) / kBlock] |= 1u << point % kBlock;
    requests_.apartAt.clear();
    for (size_t k = 0; k < count_; ++k) {
        for (const LobeVertex* l : sites_[k].requests)
            if (l) takeRequest(sites_[k], *l);
        readOptions(sites_[k]);
    }
}

/// The first site from `next` on that takes the request; a new one is put there if none does.
size_t BlockVertices::siteOf(const LobeVertex& l, size_t next, const BatchContext& c) {
    for (size_t k = next; k < count_; ++k)
        if (shareSite(sites_[k], l) && !sites_[k].requests[size_t(l.point)]) return k;
    if (l.site < c.bound->sites.size() && (count_ + 1) * blocks_ * sizeof(LobeBlock) > limits::kRequestBytes)
        endTooManyRequests(c, *c.bound->sites[l.site].site);
    if (count_ == sites_.size()) sites_.emplace_back();
    std::rotate(sites_.begin() + long(next), sites_.begin() + long(count_), sites_.begin() + long(count_) + 1);
    ++count_;
    Site& s = sites_[next];
    s.begin(blocks_);
    s.number = int(l.site);
    s.info = l.site < c.bound->sites.size() ? &c.bound->sites[l.site] : nullptr;
    s.kind = l.kind;
    s.lanes = &lanes_.lobes[l.kind->index];
    s.rays = l.rays;
    s.lighting = l.lobeOfShader;
    s.lights = false;
    s.diffuse = l.rays->type == RayType::Diffuse;
    s.walks = l.below >= 0;
    s.requests.assign(blocks_ * kBlock, nullptr);
    return next;
}

/// Copies a request to its lane.
void BlockVertices::takeRequest(Site& s, const LobeVertex& l) {
    const size_t i = size_t(l.point) % kBlock;
    LobeBlock& b = s.lobes[size_t(l.point) / kBlock];
    for (int q = 0; q < 3; ++q) b.weight[q][i] = l.weight[q];
    for (int r = 0; r < kLobeRows; ++r) b.lobe[r][i] = requests_.rows.row(l.place, r);
    b.asked |= 1u << i;
    b.elsewhere |= Lanes(l.elsewhere) << i;
    const bool indirect = world_.settings_.indirect || l.rays->type != RayType::Diffuse || l.below >= 0;
    b.stays |= Lanes(l.directOnly || !indirect) << i;
    s.lights |= l.lights;
    if (l.occurrence > 0) {
        s.occurrence.resize(points_);
        s.occurrence[size_t(l.point)] = l.occurrence;
        repeats_ = true;
    }
}

void BlockVertices::readOptions(Site& s) {
    const bool some = !rules_.pickOne || moved_ || std::any_of(s.requests.begin(), s.requests.end(), [](const LobeVertex* l) {
        return l && (l->samples != 1 || l->bias >= 0 || l->base > 0 || l->elsewhere || l->importance != 1 ||
                     l->maxDistance < 1e38f || l->fade.fades());
    });
    if (!some) return;
    s.options.assign(points_, {});
    for (const LobeVertex* l : s.requests)
        if (l)
            s.options[size_t(l->point)] = {l->bias, l->maxDistance, l->importance, l->samples,
                                           l->fade, l->elsewhere,   l->from,       l->base};
}

/// Before the rays of a block are sent: removes those that carry only emission and miss all emitters, and adds the light that
/// they would see without occlusion to the sums of their calls.
void BlockVertices::examine(size_t b, BatchContext& c) {
    for (Lanes left = next_.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const size_t point = b * kBlock + size_t(i);
        const Site& s = sites_[size_t(next_.site[i])];
        const LobeVertex* const l = s.requestAt(point);
        if (!l || !l->trace) continue;
        const Vec3 w(next_.direction[0][i], next_.direction[1][i], next_.direction[2][i]);
        if (l->trace->onlyLights && !(l->base > 0) && !intersectsEmitter(*l, point, w)) {
            next_.goes &= ~(1u << i);
            continue;
        }
        TraceSums* const sums = l->trace->sums ? accumulator_.sumsOf(l->target) : nullptr;
        if (!sums) continue;
        const bool lamps = l->lights && (l->elsewhere || (next_.single >> i & 1)); // light samples estimate the others
        unshadowed_.add(c, *l, lamps, originOf(s, point, w), w, throughputOf(i),
                        l->trace->map ? l->tint * requests_.mapTowards(*l->trace, w, c.rays[point].footprint.spread) : Color(0),
                        *sums);
    }
}

/// Factor of the light that the next ray of a lane finds.
Color BlockVertices::throughputOf(int i) const {
    const Color colour(next_.colour[0][i], next_.colour[1][i], next_.colour[2][i]);
    const float pdf = next_.pdf[i];
    const Color f = next_.single >> i & 1 ? colour : pdf > 0 ? colour / pdf : Color(0);
    return Color(next_.request[0][i], next_.request[1][i], next_.request[2][i]) * (f * next_.scale[i]);
}

/// Whether a ray could hit the bounding sphere of an emitter.
bool BlockVertices::intersectsEmitter(const LobeVertex& l, size_t point, const Vec3& w) const {
    if (!l.lights) return false;
    const VertexBlock& v = vertices_[point / kBlock];
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

/// Draws directions again at points where a lobe had none, for calls that return a mean over directions. Sets idle_.
void BlockVertices::drawAgain(const Site& s, size_t b, Lanes picked) {
    for (Lanes left = s.requests.empty() ? 0 : picked; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const size_t point = b * kBlock + size_t(i);
        const LobeVertex& l = *s.requests[point];
        if (drawn_[kRowDrawn][i] != 0 || s.lobes[b].lobe[kRowDelta][i] != 0 || !l.trace) continue;
        if (!l.trace->axis && !(l.trace->openness && l.ownsTarget)) continue;
        if (!l.trace->axis) idle_ |= 1u << i;
        const uint32_t vertex = childVertex(vertices_[b].vertex[i], l.site, l.occurrence * 4096 + turn_);
        const Random random(sampleOf(rays_[b], i).numbers);
        for (int tries = 1; tries < kDrawTries && drawn_[kRowDrawn][i] == 0; ++tries) {
            const Vec2 u = random.pair(vertex, kDrawAgain, uint32_t(tries));
            alignas(64) Row numbers[2], drawn[kDrawnRows];
            numbers[0][i] = u.x, numbers[1][i] = u.y;
            s.lanes->sample(s.lobes[b].lobe[0], 1u << i, numbers[0], drawn[0]);
            for (int r = 0; r < kDrawnRows; ++r) drawn_[r][i] = drawn[r][i];
        }
    }
}

/// Sets what only rays of such requests carry.
void BlockVertices::addToRay(const LobeVertex& l, RayExtra& extra, int i, const BatchContext& c) {
    const PathRay& from = c.rays[size_t(l.point)];
    const Vec3 w(next_.direction[0][i], next_.direction[1][i], next_.direction[2][i]);
    extra.lit = l.lit;
    if (l.trace && l.trace->map) extra.environment = l.tint * requests_.mapTowards(*l.trace, w, from.footprint.spread);
    if (!l.ownsTarget || !l.trace || !l.trace->sums) return;
    extra.part = Color(1.f / (float(l.samples) * survived_[i]));
    if (TraceSums* of = accumulator_.sumsOf(l.target)) of->add(TraceSums::Open, w * mean(extra.part));
}

} // namespace alpenglow::integrator
