// Homogeneous scattering media: events of rays along their segments.
#include "integrator/medium.h"
#include "base/exact.h"
#include "integrator/accumulator.h"
#include "integrator/atmosphere.h"
#include "integrator/batchpool.h"
#include "integrator/context.h"
#include "integrator/lightkernels.h"
#include "integrator/lightpathstates.h"
#include "integrator/litsurfaces.h"
#include "integrator/mediastacks.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/segmentevents.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "integrator/vertexlight.h"
#include <algorithm>

namespace alpenglow::integrator {

MediumEvents::MediumEvents(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), atmosphere_(s.atmosphere), batches_(s.batches),
      segmentEvents_(s.segmentEvents), lightKernels_(s.lightKernels), litSurfaces_(s.litSurfaces), paths_(s.paths),
      media_(s.media), store_(s.store), requests_(s.requests), shadows_(s.shadows), vertexLight_(s.vertexLight) {}

namespace {

/// Distance to the surface, in reduced mean free paths (similarity: by 1 - g), from which almost no path returns.
constexpr double kDeepInside = 300;
constexpr float kThin = 2; ///< length of a FreeFlight::thin segment, mean free paths
/// So deep inside a path scatters at least so often; at twice the depth half as often.
constexpr double kScatteredForCertain = 64;

/// (1 - exp(-x)) / x.
double meanLeft(double x) { return x < 1e-5 ? 1 - 0.5 * x : (1 - exact::exp(-x)) / x; }

/// Probability of scattering again for a path of this weight. Without absorption only the way out ends a path, which is too far
/// from deep inside: there a path survives its k-th scattering with probability in proportion to 1 / k. Light that returns or
/// hits a lamp after k events falls by k^-1.5, so both the number of events and the variance stay bounded.
double chanceDeepInside(const Homogeneous& h, const Color& weight, float toSurface, int scattered) {
    const Color sigma = h.extinction(), left = absolute(weight);
    double least = INFINITY;
    for (int k = 0; k < 3; ++k)
        if (left[k] > 1e-3f * maxComponent(left)) least = std::min(least, double(sigma[k]));
    const double deep = least * toSurface * (1 - std::max(0.f, h.anisotropy));
    if (!(deep > kDeepInside)) return 1;
    const double certain = std::max(1., kScatteredForCertain * kDeepInside / deep);
    return scattered <= certain ? 1 : 1 - 1. / scattered;
}

} // namespace

void MediumEvents::addOpacity(const PathRay& r, const Color& c) {
    accumulator_.results[size_t(r.sample->path)]->opacity += r.weight * c;
}

/// Adds emission of the medium along the segment.
void MediumEvents::glow(const RaySegment& f, const Homogeneous& h, Sched& sched) {
    if (!(maxComponent(h.emission) > 0)) return;
    Color c;
    for (int k = 0; k < 3; ++k) c[k] = float(h.emission[k] * f.length * meanLeft(double(h.extinction()[k]) * f.length));
    accumulator_.contribute(sched, {f.target, f.ray->weight * c, LightEvent::Surface, f.ray, store_.extraOf(*f.ray).share});
}

bool MediumEvents::leaks(const RaySegment& f) {
    const size_t medium = size_t(f.ray->medium());
    if (counters_.media.size() <= medium) counters_.media.resize(medium + 1);
    MediumSegments& count = counters_.media[medium];
    ++count.all;
    if (f.point) return false;
    ++count.lost;
    return true;
}

/// Samples the events on a segment up to a surface; returns the scattering point, if any.
std::optional<MediumEvents::Crossing> MediumEvents::cross(RaySegment& f, size_t flight, Vec2 u, Sched& sched) {
    const PathRay& ray = *f.ray;
    const Homogeneous& h = *world_.media()[size_t(ray.medium())].homogeneous;
    const Color before = ray.weight, left = h.transmittance(f.length);
    glow(f, h, sched);
    const bool both = ray.counts; // keeps opacity and depth of camera rays exact
    if (both) addOpacity(ray, Color(1) - left);
    Color part(std::fabs(before.x), std::fabs(before.y), std::fabs(before.z));
    const float sum = part.x + part.y + part.z;
    f.transmittance = left;
    if (!(maxComponent(h.scattering) > 0) || !(sum > 0) || !std::isfinite(sum) || !(f.length > 0)) return {};
    part = part / sum;
    Crossing c{flight, {}, before * store_.extraOf(ray).indirect};
    c.way.origin = ray.origin;
    c.way.dir = ray.dir;
    c.way.length = f.length;
    c.way.medium = ray.medium();
    c.way.extinction = h.extinction();
    c.way.thin = mean(c.way.extinction) * f.length < kThin;
    double survives = 0, drawn = 0;
    double at = u.x;
    int channel = 2;
    for (int k = 0; k < 2 && channel == 2; ++k)
        if (at < part[k]) channel = k;
        else at -= part[k];
    while (!(part[channel] > 0)) --channel; // rounding
    for (int k = 0; k < 3; ++k) {
        const double sigma = c.way.extinction[k];
        survives += part[k] * left[k];
        c.way.chance[k] = both ? part[k] / (f.length * meanLeft(sigma * f.length)) : part[k] * sigma;
    }
    const double sigma = c.way.extinction[channel], y = std::min(double(u.y), 1 - 0x1p-24);
    if (both) {
        const double ends = sigma * f.length * meanLeft(sigma * f.length); // 1 - exp(-sigma length)
        drawn = sigma * f.length < 1e-6 ? y * f.length : -exact::log(1 - y * ends) / sigma;
        c.stops = true;
        drawn = std::min(drawn, double(f.length));
    } else {
        drawn = sigma > 0 ? -exact::log(1 - y) / sigma : INFINITY;
        c.stops = drawn < f.length;
        if (!c.stops) f.transmittance = left / float(survives);
        else f.over = true;
    }
    c.way.t = float(std::min(drawn, double(f.length)));
    return c;
}

/// Continues behind a surface that bounds no volume here.
void MediumEvents::pass(RaySegment& f, Sched& sched) {
    const PathRay& ray = *f.ray;
    const ShadePoint& p = *f.point;
    PathRay r = ray;
    const RayExtra& extra = store_.extraOf(ray);
    r.weight = (extra.fade.fades() ? extra.whole : ray.weight) * f.transmittance;
    if (const int medium = ray.medium(); medium >= 0 && !world_.media()[size_t(medium)].homogeneous) {
        std::vector<ShadePoint> at(1, p); // its shader runs up to here
        at[0].ray = &ray;
        if (ray.crossedMedium) at[0].I = p.P - ray.volumeBegin();
        at[0].Ci = at[0].Oi = Color(0);
        AtmosphereEffect h;
        atmosphere_.atmosphereEffects(world_.media()[size_t(medium)], world_.bindings()[size_t(f.binding)], at, {&h, 1}, true);
        if (isFinite(h.shown))
            accumulator_.contribute(sched, {f.target, r.weight * h.shown, LightEvent::Surface, &ray, store_.extraOf(ray).share});
        if (ray.counts && isFinite(h.opacity)) addOpacity(ray, h.opacity);
        for (int k = 0; k < 3; ++k) r.weight[k] *= std::isfinite(h.slope[k]) ? std::max(h.slope[k], 0.f) : 0;
    }
    const float travelled = length(p.P - ray.origin);
    r.goOnAt(geometry::offsetOrigin(p.surface, ray.dir));
    r.maxDistance = ray.maxDistance - travelled;
    r.footprint = ray.footprint.after(travelled);
    r.media = media_.beyond(world_.bindings()[size_t(f.binding)], ray.media, p.surface.n, ray.dir, ray.dir);
    media_.reportLost(r.media, p);
    r.crossedMedium = true;
    r.vertex = childVertex(ray.vertex, kSegmentEvent, 1);
    ++r.layers;
    if (r.layers > limits::kPathDepth / 32 || !(r.maxDistance > 0)) {
        ++counters_.depthCap;
        f.over = true;
        return;
    }
    segmentEvents_.spawn(f, r, sched, travelled);
}

void MediumEvents::happen(std::span<RaySegment> segmentEvents, Sched& sched) {
    const WorldImpl& w = world_;
    const auto crosses = [&](const RaySegment& f) {
        const int medium = f.over ? -1 : f.ray->medium();
        return medium >= 0 && w.media()[size_t(medium)].homogeneous;
    };
    numbers_.clear();
    for (const RaySegment& f : segmentEvents) // other lights than those that its lobe sampled
        if (crosses(f))
            numbers_.askPair(store_.random(*f.ray).numbers(), childVertex(f.ray->vertex, kSegmentEvent, 6), kSegmentEvent, 0);
    numbers_.draw();
    std::vector<Crossing>& crossings = crossings_;
    crossings.clear();
    size_t number = 0;
    for (size_t i = 0; i < segmentEvents.size(); ++i) {
        RaySegment& f = segmentEvents[i];
        if (crosses(f)) {
            const Vec2 u = numbers_.pair(number++);
            if (!leaks(f))
                if (const auto c = cross(f, i, u, sched)) crossings.push_back(*c);
        }
        if (!f.over && f.point && w.bindings()[size_t(f.binding)].overruled(f.ray->media)) pass(f, sched);
    }
    const auto before = [](const Crossing& a, const Crossing& b) { return a.way.medium < b.way.medium; };
    if (!std::is_sorted(crossings.begin(), crossings.end(), before)) std::stable_sort(crossings.begin(), crossings.end(), before);
    for (size_t first = 0, end; first < crossings.size(); first = end) { // of one medium, so with one list of lights
        for (end = first; end < crossings.size() && crossings[end].way.medium == crossings[first].way.medium;) ++end;
        const auto of = std::span<const Crossing>(crossings).subspan(first, end - first);
        if (rules_.lightsAtRequests) nearLights(segmentEvents, of, sched);
        scatter(segmentEvents, of, sched);
    }
}

Vec3 MediumEvents::lightDirection(const Medium& m, const PathRay& r, const Vec3& from, float* away) const {
    const WorldImpl& w = world_;
    if (!rules_.lightsAtRequests || w.settings().mediumSampling == MediumSampling::Distance) return {};
    const WorldImpl::LightList& list = w.lightLists()[size_t(w.bindings()[size_t(m.binding)].lightList)];
    const LightChooser& chooser = w.chooserOf(list);
    const std::vector<int>& on = w.sampledOf(list);
    const uint32_t vertex = childVertex(r.vertex, kSegmentEvent, 3);
    LightChooser::Chosen chosen;
    for (size_t k = 0; k < on.size() && chooser.empty(); ++k) chosen.emplace_back(int(k), 1.f);
    if (!chooser.empty()) chooser.choose(from, store_.random(r).one(vertex, kChooseLight, 0), chosen);
    const Color sigma = m.homogeneous->extinction();
    const double reach = 12 / (double(sigma.x) + sigma.y + sigma.z); // four mean free paths: beyond them little light is left
    std::vector<std::pair<Vec3, float>> near;
    for (const auto& [k, chance] : chosen) {
        const int light = on[size_t(k)];
        const BoundLight& l = w.lights()[size_t(light)];
        if (!l.placed || (list.ofAll && !list.lights.contains(light))) continue;
        const Vec3 to = l.place - from;
        const double far = length(Vec3d(to));
        if (far < reach && far > double(l.extent)) near.emplace_back(to / float(far), float(far));
    }
    if (near.empty()) return {};
    const size_t k = near.size() == 1 ? 0 : size_t(store_.random(r).one(vertex, kLightPoint, 0) * float(near.size()));
    const auto& [direction, distance] = near[std::min(k, near.size() - 1)];
    if (away) *away = distance;
    return direction;
}

/// Points of scattering gather light like surfaces, by the phase function.
void MediumEvents::scatter(std::span<RaySegment> segmentEvents, std::span<const Crossing> crossings, Sched& sched) {
    auto c = batches_.take();
    const Medium& m = world_.media()[size_t(crossings[0].way.medium)];
    c->bound = &m.kernel;
    c->binding = &world_.bindings()[size_t(m.binding)];
    c->between = true;
    c->points.clear(); // points of the previous batch
    lights_.clear();
    for (const Crossing& x : crossings) {
        if (!x.stops) continue;
        const RaySegment& f = segmentEvents[x.flight];
        PathRay& r = c->rays.emplace_back(*f.ray);
        const Vec3d left = x.way.transmittanceAt(x.way.t);
        const double density = x.way.density(left);
        for (int k = 0; k < 3; ++k)
            r.weight[k] = density > 0 ? float(x.weight[k] * m.homogeneous->scattering[k] * (left[k] / density)) : 0;
        r.vertex = childVertex(f.ray->vertex, kSegmentEvent, 0);
        r.counts = r.first = false;
        if (rules_.roulette) {
            const double q = chanceDeepInside(*m.homogeneous, r.weight, f.length, r.scattered + 1);
            if (q < 1 && store_.random(r).one(childVertex(r.vertex, kSegmentEvent, 7), kRoulette, 0) >= q) {
                c->rays.pop_back();
                continue;
            }
            r.weight = r.weight / float(q);
        }
        c->targets.push_back(f.target);
        c->bindings.push_back(m.binding);
        c->flown.push_back(x.way);
        lights_.push_back(lightDirection(m, r, r.origin + r.dir * x.way.t));
    }
    if (!c->rays.empty()) gather(*c, m, sched);
    shadows_.flush(sched); // before their rays are freed
    batches_.giveBack(std::move(c));
}

/// Gathers light at points in a medium. lights_: by point, lightDirection().
void MediumEvents::gather(BatchContext& c, const Medium& m, Sched& sched) {
    if (vertexLight_.needsPoints(*c.binding)) placePoints(c, m);
    vertexLight_.runMedium(c, *m.homogeneous, lights_, sched);
}

void MediumEvents::placePoints(BatchContext& c, const Medium& m) const {
    c.points.resize(c.rays.size());
    for (size_t i = 0; i < c.rays.size(); ++i) {
        const PathRay& r = c.rays[i];
        ShadePoint& p = c.points[i];
        p.shape = m.shape;
        p.P = p.surface.P = r.origin + r.dir * c.flown[i].t;
        p.N = p.surface.N = p.surface.Ng = -r.dir; // surface.n is 0: no sides
        p.I = p.P - r.begin();
        p.E = r.origin;
        p.shutter = p.surface.time = world_.shadesAtOpen() ? 0 : r.shutter();
        world_.setTime(p);
        p.ray = &r;
    }
}

} // namespace alpenglow::integrator
