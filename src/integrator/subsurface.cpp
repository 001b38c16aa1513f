// subsurface(): walks below surfaces until light exits. Light enters a surface uniformly from all directions and leaves
// uniformly, so the light at the end of a walk is what diffuse() finds there; the walk itself is exact.
#include "integrator/subsurface.h"
#include "base/exact.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/batchpool.h"
#include "integrator/context.h"
#include "integrator/displacement.h"
#include "integrator/intersector.h"
#include "integrator/kernelinputs.h"
#include "integrator/lightkernels.h"
#include "integrator/litsurfaces.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "integrator/subsurfacewalks.h"
#include "integrator/vertexlight.h"
#include "world/raysets.h"
#include <algorithm>

namespace alpenglow::integrator {

Walks::Walks(const StageSet& s, BatchContext& c, std::span<const WalkAsked> asked, std::span<const SubsurfaceMedium> media)
    : Stage(s.context), c_(c), asked_(asked), media_(media), accumulator_(s.accumulator), batches_(s.batches),
      displacement_(s.displacement), intersector_(s.intersector), inputs_(s.inputs), lightKernels_(s.lightKernels),
      litSurfaces_(s.litSurfaces), photons_(s.photons), store_(s.store), requests_(s.requests), shadows_(s.shadows),
      subsurface_(s.subsurface), vertexLight_(s.vertexLight) {}

namespace {

/// Samples the Henyey-Greenstein phase function around a direction.
Vec3 scattered(const Vec3& dir, float g, const Vec2& u) {
    const double a = std::fabs(double(g)), q = 1 - a + 2 * a * u.x, r = (1 - a) / q;
    const double h = std::clamp(2 * r * r * (1 - u.x) * (1 + a * u.x), 0.0, 2.0); // 1 - cos
    const float s = float(std::sqrt(h * (2 - h)));
    const Vec2 d = unitCircle(u.y);
    const Vec3 w = Basis(g < 0 ? -dir : dir).toWorld({s * d.x, s * d.y, float(1 - h)});
    return w / length(w);
}

} // namespace

bool Walks::belongs(uint32_t shape, int group) const {
    return subsurface_.ofShape(world_.shapes()[shape]->attributes()).group == group;
}

void Walks::run(Sched& sched) {
    for (size_t i = 0; i < asked_.size(); ++i)
        if (media_[size_t(asked_[i].subsurface)].model == SubsurfaceSite::Model::Walk) start(int(i));
        else probe(int(i));
    while (!walkers_.empty() && !(context_.stop && *context_.stop)) step();
    askSurfaces(sched);
    const auto list = [&](const Exit& x) { return world_.bindings()[size_t(world_.bindingOf()[x.shape])].lightList; };
    std::stable_sort(exits_.begin(), exits_.end(), [&](const Exit& a, const Exit& b) { return list(a) < list(b); });
    for (size_t first = 0, end; first < exits_.size(); first = end) {
        for (end = first; end < exits_.size() && list(exits_[end]) == list(exits_[first]);) ++end;
        gatherAt(std::span<const Exit>(exits_).subspan(first, end - first), sched);
    }
}

/// The entry at the shaded point, or at the call's point. A point off the surface is moved onto it along the normal; a point
/// inside stays.
std::optional<Walks::Entry> Walks::entry(int asked) const {
    const WalkAsked& a = asked_[size_t(asked)];
    const SubsurfaceMedium& b = media_[size_t(a.subsurface)];
    const ShadePoint& p = c_.points[size_t(a.point)];
    const bool turned = dot(p.surface.n, c_.rays[size_t(a.point)].dir) > 0;
    const Vec3 side = turned ? -p.surface.n : p.surface.n;
    if (!b.ownOrigin) {
        const float cosine = dot(b.normal, side); // a normal reversed by rounding has no effect
        return Entry{b.normal == Vec3() || std::fabs(cosine) > 1 - 1e-6f ? side
                     : cosine < 0                                        ? -b.normal
                                                                         : b.normal,
                     p.P, p.surface};
    }
    Entry at{b.normal == Vec3() ? side : b.normal, b.from, {}};
    if (turned && dot(at.out, side) < 0) at.out = -at.out; // seen from behind
    const float offset = 8 * geometry::roundingError(b.from);
    accel::Ray ray = rayOf({asked, b.from + at.out * offset, -at.out, {}, {}, 0}, 1e38);
    accel::Hit hit;
    bool met = intersector_.intersect(ray, hit);
    for (int k = 0; met && !belongs(hit.shape, b.group); ++k) {
        world_.goOn(ray, hit);
        met = k < limits::kShadowLayers && intersector_.intersect(ray, hit);
    }
    if (!met) return {};
    const geometry::SurfacePoint s = world_.accel().point(hit);
    const Vec3 n = s.displaced ? s.displacedN : s.n;
    const bool leaves = dot(ray.dir, turned ? -n : n) > 0;
    if (leaves && !(hit.distance < 4 * double(offset))) {
        at.at -= at.out * offset;
        return at;
    }
    if (leaves) at.out = -at.out; // on the surface, with a normal that points inward
    at.at = s.displaced ? s.displacedP : s.P;
    at.surface = s;
    if (s.displaced) at.surface->P = s.displacedP, at.surface->n = s.displacedN;
    return at;
}

/// Starts a walk: samples a direction of uniform light refracted into the surface.
void Walks::start(int asked) {
    const WalkAsked& a = asked_[size_t(asked)];
    const SubsurfaceMedium& b = media_[size_t(a.subsurface)];
    const ShadePoint& p = c_.points[size_t(a.point)];
    const PathRay& ray = c_.rays[size_t(a.point)];
    const std::optional<Entry> entered = entry(asked);
    if (!entered) return; // there is no interior
    Walker w{asked, {}, {}, a.weight, a.weight, a.vertex};
    const Vec3 outside =
        sampleCosine(store_.random(ray).pair(a.vertex, kSegmentEvent, 0)); // a direction outside, around the normal
    const double n = b.index, sine2 = (1 - double(outside.z) * outside.z) / (n * n);
    if (!(sine2 < 1)) return; // total reflection
    const double cosine = std::sqrt(1 - sine2);
    const double through = 1 - fresnelInside(cosine, n); // relative to its mean over the flux
    const double mean = (1 - subsurface_.albedoInversions.of(b.index).first()) * n * n;
    w.weight = w.begin = a.weight * float(b.index == 1 ? 1 : through / mean);
    w.dir = Basis(-entered->out).toWorld({float(outside.x / n), float(outside.y / n), float(cosine)});
    w.dir = w.dir / length(w.dir);
    w.at = entered->at;
    if (const auto& on = entered->surface) {
        const Vec3 side = dot(on->n, entered->out) < 0 ? -on->n : on->n;
        if (const float away = dot(w.dir, side); away > 0) w.dir -= side * (2 * away); // a tilted normal: enters all the same
        w.at = geometry::offsetOrigin(*on, w.dir, b.ownOrigin ? 0 : length(p.P - p.surface.P));
    }
    walkers_.push_back(w);
}

/// Samples the distance to the next scattering by one channel of the walker's weight.
double Walks::distance(const Walker& w) const {
    const SubsurfaceMedium& b = media_[size_t(asked_[size_t(w.asked)].subsurface)];
    const Vec2 u = store_.random(c_.rays[size_t(asked_[size_t(w.asked)].point)]).pair(w.vertex, kSegmentEvent, 1);
    const Color part = absolute(w.weight);
    double at = double(u.x) * (double(part.x) + part.y + part.z);
    int channel = 2;
    for (int k = 0; k < 2 && channel == 2; ++k)
        if (at < part[k]) channel = k;
        else at -= part[k];
    while (channel > 0 && !(part[channel] > 0)) --channel;
    const double sigma = b.extinction[channel];
    return sigma > 0 ? -exact::log(1 - std::min(double(u.y), 1 - 0x1p-24)) / sigma : INFINITY;
}

/// Updates a walker's weight after a distance: transmittance over the density of all channels.
void Walks::weigh(Walker& w, double way, bool scatters) const {
    const SubsurfaceMedium& b = media_[size_t(asked_[size_t(w.asked)].subsurface)];
    const Color part = absolute(w.weight);
    const double sum = double(part.x) + part.y + part.z;
    double left[3], density = 0;
    for (int k = 0; k < 3; ++k) {
        left[k] = exact::exp(-double(b.extinction[k]) * way);
        density += part[k] / sum * left[k] * (scatters ? double(b.extinction[k]) : 1);
    }
    for (int k = 0; k < 3; ++k)
        w.weight[k] = density > 0 ? float(w.weight[k] * (left[k] * (scatters ? double(b.scattering[k]) : 1) / density)) : 0;
}

accel::Ray Walks::rayOf(const Walker& w, double length) const {
    accel::Ray r;
    r.org = w.at;
    r.dir = w.dir;
    r.tfar = float(std::min(length, 1e38));
    const PathRay& ray = c_.rays[size_t(asked_[size_t(w.asked)].point)];
    r.time = world_.shutterOf(ray);
    r.sides = accel::Sides::Both;
    if (ray.sample) r.level = ray.sample->level;
    return r;
}

/// Advances each walker by one event.
void Walks::step() {
    const WorldImpl& world = world_;
    std::vector<accel::Ray> rays;
    std::vector<double> reach;
    for (const Walker& w : walkers_) {
        reach.push_back(distance(w));
        rays.push_back(rayOf(w, reach.back()));
    }
    std::vector<accel::Hit> hits(rays.size());
    intersector_.intersect(rays, hits);
    going_.clear();
    for (size_t i = 0; i < walkers_.size(); ++i) {
        Walker& w = walkers_[i];
        const int group = media_[size_t(asked_[size_t(w.asked)].subsurface)].group;
        for (int k = 0; hits[i].valid() && !belongs(hits[i].shape, group); ++k) { // skips unrelated geometry
            world.goOn(rays[i], hits[i]);
            if (k >= limits::kShadowLayers || !intersector_.intersect(rays[i], hits[i])) hits[i] = {};
        }
        const bool goes = hits[i].valid() ? intersect(w, hits[i], reach[i]) : scatter(w, reach[i]);
        w.vertex = childVertex(w.vertex, kSegmentEvent, 3);
        if (goes && ++w.steps < limits::kPathDepth) going_.push_back(w);
        else if (goes) ++counters_.depthCap;
    }
    walkers_.swap(going_);
}

bool Walks::scatter(Walker& w, double way) {
    if (!(way < 1e30)) return false; // leaves an interior without a boundary
    const SubsurfaceMedium& b = media_[size_t(asked_[size_t(w.asked)].subsurface)];
    weigh(w, way, true);
    const Color left = absolute(w.weight), begin = absolute(w.begin);
    if (!(maxComponent(left) > 0) || !isFinite(left)) return false;
    const Random random = store_.random(c_.rays[size_t(asked_[size_t(w.asked)].point)]);
    if (rules_.roulette || w.steps > 64) {
        const auto dice = [&] { return random.one(w.vertex, kRoulette, 0); };
        const float q = rouletteOfPath(left / std::max(maxComponent(begin), 1e-30f), dice);
        if (!(q > 0)) return false;
        w.weight = w.weight / q;
    }
    w.at += w.dir * float(way);
    w.dir = scattered(w.dir, b.anisotropy, random.pair(w.vertex, kSegmentEvent, 2));
    return true;
}

/// At the boundary: returns true if the walker is reflected, or enters another part of the same interior.
bool Walks::intersect(Walker& w, const accel::Hit& hit, double) {
    const WorldImpl& world = world_;
    const WalkAsked& a = asked_[size_t(w.asked)];
    const SubsurfaceMedium& b = media_[size_t(a.subsurface)];
    geometry::SurfacePoint at = world.accel().point(hit);
    const Vec3 n = at.displaced ? at.displacedN : at.n;
    weigh(w, hit.distance, false);
    if (!(maxComponent(absolute(w.weight)) > 0) || !isFinite(w.weight)) return false;
    const ShadePoint& p = c_.points[size_t(a.point)];
    const bool turned = dot(p.surface.n, c_.rays[size_t(a.point)].dir) > 0; // seen from behind, as is everything else
    const Vec3 out = turned ? -n : n;
    const double cosine = dot(w.dir, out);
    if (cosine < 0) { // another primitive of the group begins inside this one
        ++w.inside;
        w.at = geometry::offsetOrigin(at, w.dir);
        return true;
    }
    if (w.inside > 1) {
        --w.inside;
        w.at = geometry::offsetOrigin(at, w.dir);
        return true;
    }
    const double reflected = b.index == 1 ? 0 : fresnelInside(std::min(cosine, 1.0), b.index);
    if (reflected > 0 && store_.random(c_.rays[size_t(a.point)]).one(w.vertex, kSegmentEvent, 0) < reflected) {
        w.dir = w.dir - out * float(2 * cosine);
        w.dir = w.dir / length(w.dir);
        w.at = geometry::offsetOrigin(at, w.dir);
        return true;
    }
    exits_.push_back({w.asked, w.weight, w.vertex, hit.shape, at, out});
    return false;
}

void Walks::enterAt(BatchContext& c, std::span<const Exit> exits) {
    const WorldImpl& world = world_;
    for (const Exit& x : exits) {
        const WalkAsked& a = asked_[size_t(x.asked)];
        const PathRay& from = c_.rays[size_t(a.point)];
        PathRay& r = c.rays.emplace_back(from);
        r.weight = x.weight;
        r.vertex = childVertex(x.vertex, kSegmentEvent, 4);
        r.counts = r.first = false;
        r.dir = -x.out; // as if it came from outside
        if (photons_.photonTrace()) r.trail = shading::kTrailSpread;
        r.footprint = from.footprint.after(length(c_.points[size_t(a.point)].P - from.origin));
        if (r.camera()) r.setStart(0);
        r.passed = false;
        const Vec3 at = x.point.displaced ? x.point.displacedP : x.point.P;
        r.origin = at;
        RayExtra extra;
        extra.share = a.share;
        r.extra = store_.newExtra(extra);
        c.targets.push_back(a.target);
        c.bindings.push_back(world.bindingOf()[x.shape]);
    }
    c.extrasOf = &store_;
    c.points.resize(exits.size());
    for (size_t i = 0; i < exits.size(); ++i) {
        const Exit& x = exits[i];
        const PathRay& r = c.rays[i];
        ShadePoint& p = c.points[i] = {};
        p.shape = world.shapes()[x.shape].get();
        p.surface = x.point;
        p.P = p.E = r.origin;
        const Vec3 n = x.point.displaced ? x.point.displacedN : x.point.N;
        p.N = dot(n, x.out) < 0 ? -n : n;
        p.I = -x.out;
        p.shutter = p.surface.time = world.shadesAtOpen() ? 0 : r.shutter();
        world.setTime(p);
        p.ray = &r;
    }
}

/// Gathers light at the exits as diffuse() does.
void Walks::gatherAt(std::span<const Exit> exits, Sched& sched) {
    auto c = batches_.take();
    c->bound = c_.bound;
    c->binding = &world_.bindings()[size_t(world_.bindingOf()[exits[0].shape])];
    c->subsurface = true;
    enterAt(*c, exits);
    std::vector<float> indirect;
    for (const Exit& x : exits) indirect.push_back(asked_[size_t(x.asked)].indirect);
    vertexLight_.runExits(*c, indirect, sched);
    skies(*c, sched);
    shadows_.flush(sched);
    batches_.giveBack(std::move(c));
}

/// If no rays are sent, a sky is one light that faces the surface, as in light loops.
void Walks::skies(const BatchContext& c, Sched& sched) {
    if (rules_.pickOne || !rules_.lightsAtRequests) return;
    const WorldImpl& world = world_;
    for (int number : world.skies()) {
        const BoundLight& light = world.lights()[size_t(number)];
        if (light.kind != LightKind::Environment || !light.kernel || !c.binding->lights.contains(number)) continue;
        std::vector<ShadePoint> q(c.points.size());
        for (size_t i = 0; i < q.size(); ++i) {
            const ShadePoint& p = c.points[i];
            q[i].Ps = p.P;
            q[i].Ns = p.N;
            q[i].lit = &p.surface;
            q[i].P = p.P + p.N;
            q[i].N = -p.N;
            q[i].shutter = p.shutter;
            q[i].time = p.time;
            q[i].ray = p.ray;
        }
        std::vector<LightValue> value(q.size());
        lightKernels_.evaluateLight(light, q, value);
        for (size_t i = 0; i < q.size(); ++i)
            if (value[i].lit)
                accumulator_.contribute(sched,
                                        {c.targets[i], c.rays[i].weight * value[i].Cl * value[i].kept(RayType::Diffuse),
                                         LightEvent::Sky, &c.rays[i], store_.extraOf(c.rays[i]).share, light.instance.get()});
    }
}

} // namespace alpenglow::integrator
