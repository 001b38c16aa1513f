#include "integrator/singlerequests.h"
#include "base/memory.h"
#include "integrator/accumulator.h"
#include "integrator/kernelinputs.h"
#include "integrator/occlusioncalls.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"
#include "integrator/vertexloading.h"
#include "services/random.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

/// Whether requests can share a site: what a site holds once is the same.
static bool shareSite(const BlockLobes& s, const LobeVertex& l) {
    return s.number == int(l.site) && s.kind == l.kind && s.lighting == l.lobeOfShader && s.walks == (l.subsurface >= 0) &&
           s.diffuse == (l.rays->type == RayType::Diffuse);
}

SingleRequests::SingleRequests(const StageSet& s, const VertexStages& v)
    : VertexStage(s, v), lanes_(lobeLanes(lobeWidth())), unshadowed_(s), accumulator_(s.accumulator), loading_(v.loading),
      requests_(s.requests) {}

void SingleRequests::load(BatchContext& c) {
    loading_.begin(c, !requests_.lobes.empty() && requests_.lobes[0].ownsTarget);
    v_.single = true;
    lobes_.swap(requests_.lobes);
    v_.before.assign(v_.waits ? v_.points : 0, 0);
    for (const LobeVertex& l : lobes_) {
        if (v_.waits) v_.before[size_t(l.point)] = l.before;
        v_.sendsSeveral |= l.ownsTarget && l.samples > 1;
    }
    loading_.loadVertices(c);
    take(c);
    requests_.clear();
}

void SingleRequests::take(BatchContext& c) {
    v_.count = 0;
    std::vector<std::vector<const LobeVertex*>> of(v_.points);
    for (const LobeVertex& l : lobes_) of[size_t(l.point)].push_back(&l);
    for (size_t point = 0; point < v_.points; ++point) {
        size_t next = 0; // a point's requests keep their order
        for (const LobeVertex* l : of[point]) {
            const size_t at = siteOf(*l, next, c);
            v_.sites[at].requests[point] = l;
            next = at + 1;
        }
        if (v_.waits && !of[point].empty()) {
            const LobeVertex& l = *of[point][0];
            VertexBlock& v = v_.vertices[point / kBlock];
            v.lightVertex[point % kBlock] = childVertex(v.vertex[point % kBlock], kLightPoint + l.site, l.occurrence);
        }
    }
    v_.apart.assign(requests_.apartAt.empty() ? 0 : v_.blocks, 0);
    for (const int point : requests_.apartAt) v_.apart[size_t(point) / kBlock] |= 1u << point % kBlock;
    requests_.apartAt.clear();
    for (size_t k = 0; k < v_.count; ++k) {
        for (const LobeVertex* l : v_.sites[k].requests)
            if (l) takeRequest(v_.sites[k], *l);
        readOptions(v_.sites[k]);
    }
}

/// The first site from `next` on that takes the request; a new one is put there if none does.
size_t SingleRequests::siteOf(const LobeVertex& l, size_t next, const BatchContext& c) {
    for (size_t k = next; k < v_.count; ++k)
        if (shareSite(v_.sites[k], l) && !v_.sites[k].requests[size_t(l.point)]) return k;
    if (l.site < c.bound->sites.size() && (v_.count + 1) * v_.blocks * sizeof(LobeBlock) > limits::kRequestBytes)
        endTooManyRequests(c, *c.bound->sites[l.site].site);
    if (v_.count == v_.sites.size()) v_.sites.emplace_back();
    std::rotate(v_.sites.begin() + long(next), v_.sites.begin() + long(v_.count), v_.sites.begin() + long(v_.count) + 1);
    ++v_.count;
    Site& s = v_.sites[next];
    s.begin(v_.blocks);
    s.number = int(l.site);
    s.info = l.site < c.bound->sites.size() ? &c.bound->sites[l.site] : nullptr;
    s.kind = l.kind;
    s.lanes = &lanes_.lobes[l.kind->index];
    s.rays = l.rays;
    s.lighting = l.lobeOfShader;
    s.lights = false;
    s.diffuse = l.rays->type == RayType::Diffuse;
    s.walks = l.subsurface >= 0;
    s.requests.assign(v_.blocks * kBlock, nullptr);
    return next;
}

/// Copies a request to its lane.
void SingleRequests::takeRequest(Site& s, const LobeVertex& l) {
    const size_t i = size_t(l.point) % kBlock;
    LobeBlock& b = s.lobes[size_t(l.point) / kBlock];
    for (int q = 0; q < 3; ++q) b.weight[q][i] = l.weight[q];
    for (int r = 0; r < kLobeRows; ++r) b.lobe[r][i] = requests_.rows.row(l.place, r);
    b.asked |= 1u << i;
    b.ownOrigin |= Lanes(l.ownOrigin) << i;
    s.lights |= l.lights;
    const shading::RaySet& set = l.rays->set;
    s.sets |= l.trace && (set.only || set.sides != accel::Sides::Front || set.mode != shading::HitMode::Default);
    if (l.occurrence > 0) {
        s.occurrence.resize(v_.blocks * kBlock);
        s.occurrence[size_t(l.point)] = l.occurrence;
        v_.repeats = true;
    }
}

void SingleRequests::readOptions(Site& s) {
    const bool some = !rules_.pickOne || v_.moved || std::any_of(s.requests.begin(), s.requests.end(), [](const LobeVertex* l) {
        return l && (l->samples != 1 || l->bias >= 0 || l->base > 0 || l->ownOrigin || l->importance != 1 ||
                     l->maxDistance < 1e38f || l->fade.fades());
    });
    if (!some) return;
    s.options.assign(v_.blocks * kBlock, {});
    for (const LobeVertex* l : s.requests)
        if (l)
            s.options[size_t(l->point)] = {l->bias, l->maxDistance, l->importance, l->samples,
                                           l->fade, l->ownOrigin,   l->from,       l->base};
}

void SingleRequests::examine(size_t b, BatchContext& c) {
    for (Lanes left = v_.next.goes; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const size_t point = b * kBlock + size_t(i);
        const Site& s = v_.sites[size_t(v_.next.site[i])];
        const LobeVertex* const l = s.requestAt(point);
        if (!l || !l->trace) continue;
        const Vec3 w(v_.next.direction[0][i], v_.next.direction[1][i], v_.next.direction[2][i]);
        if (l->trace->onlyLights && !(l->base > 0) && !intersectsEmitter(*l, point, w)) {
            v_.next.goes &= ~(1u << i);
            continue;
        }
        TraceSums* const sums = l->trace->sums ? accumulator_.sumsOf(l->target) : nullptr;
        if (!sums) continue;
        UnshadowedRay ray;
        ray.point = int(point);
        ray.rays = l->rays;
        ray.origin = v_.originOf(s, point, w);
        ray.direction = w;
        ray.maxDistance = l->maxDistance;
        ray.bringsEmission = l->lights && (l->ownOrigin || (v_.next.single >> i & 1));
        ray.lit = l->ownOrigin ? l->from : c.points[point].P;
        ray.litSurface = v_.litSurfaceAt(point);
        const float spread = c.rays[point].footprint.spread;
        const Color environment = l->trace->map ? l->tint * requests_.mapTowards(*l->trace, w, spread) : Color(0);
        unshadowed_.add(c, ray, throughputOf(i), environment, *sums);
    }
}

/// Factor of the light that the next ray of a lane finds.
Color SingleRequests::throughputOf(int i) const {
    const Color colour(v_.next.colour[0][i], v_.next.colour[1][i], v_.next.colour[2][i]);
    const float pdf = v_.next.pdf[i];
    const Color f = v_.next.single >> i & 1 ? colour : pdf > 0 ? colour / pdf : Color(0);
    return Color(v_.next.request[0][i], v_.next.request[1][i], v_.next.request[2][i]) * (f * v_.next.scale[i]);
}

/// Whether a ray could hit the bounding sphere of an emitter.
bool SingleRequests::intersectsEmitter(const LobeVertex& l, size_t point, const Vec3& w) const {
    if (!l.lights) return false;
    const VertexBlock& v = v_.vertices[point / kBlock];
    const size_t i = point % kBlock;
    const Vec3 from = l.ownOrigin ? l.from : Vec3(v.P[0][i], v.P[1][i], v.P[2][i]);
    const float error = 1e-3f * (1 + length(from)) + std::fabs(l.bias);
    if (world_.lights().size() > 64) return true; // sending the ray costs less than testing all of them
    return std::any_of(world_.lights().begin(), world_.lights().end(), [&](const BoundLight& light) {
        if (light.kind != LightKind::Area || !light.emitter || light.emitter->empty()) return false;
        const Vec3 to = light.centre - from;
        const float along = std::max(dot(to, w), 0.f), reach = light.radius * 1.001f + error;
        const Vec3 off = to - w * along;
        return !(dot(off, off) > reach * reach);
    });
}

void SingleRequests::drawAgain(const Site& s, size_t b, Lanes picked) {
    for (Lanes left = s.requests.empty() ? 0 : picked; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const size_t point = b * kBlock + size_t(i);
        const LobeVertex& l = *s.requests[point];
        if (v_.drawn[kRowDrawn][i] != 0 || s.lobes[b].lobe[kRowDelta][i] != 0 || !l.trace) continue;
        if (!l.trace->axis && !(l.trace->openness && l.ownsTarget)) continue;
        if (!l.trace->axis) v_.idle |= 1u << i;
        const uint32_t vertex = childVertex(v_.vertices[b].vertex[i], l.site, l.occurrence * 4096 + v_.turn);
        const Random random(v_.sampleOf(v_.rays[b], i).numbers);
        for (int tries = 1; tries < kDrawTries && v_.drawn[kRowDrawn][i] == 0; ++tries) {
            const Vec2 u = random.pair(vertex, kDrawAgain, uint32_t(tries));
            alignas(64) Row numbers[2], drawn[kDrawnRows];
            numbers[0][i] = u.x, numbers[1][i] = u.y;
            s.lanes->sample(s.lobes[b].lobe[0], 1u << i, numbers[0], drawn[0]);
            for (int r = 0; r < kDrawnRows; ++r) v_.drawn[r][i] = drawn[r][i];
        }
    }
}

void SingleRequests::addToRay(const LobeVertex& l, RayExtra& extra, int i, const BatchContext& c) {
    const PathRay& from = c.rays[size_t(l.point)];
    const Vec3 w(v_.next.direction[0][i], v_.next.direction[1][i], v_.next.direction[2][i]);
    if (l.trace && l.trace->map) extra.environment = l.tint * requests_.mapTowards(*l.trace, w, from.footprint.spread);
    if (!l.ownsTarget || !l.trace || !l.trace->sums) return;
    extra.part = Color(1.f / (float(l.samples) * v_.survived[i]));
    if (TraceSums* of = accumulator_.sumsOf(l.target)) of->add(TraceSums::Open, w * mean(extra.part));
}

} // namespace alpenglow::integrator
