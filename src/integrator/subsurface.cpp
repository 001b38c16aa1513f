// subsurface(): what a call says of what lies below, and the walks that follow light there until it comes out. Light enters at a
// surface as if it came evenly from all sides and leaves evenly to all sides, so that what comes in at the end of a walk is what
// diffuse() finds there; in between nothing is left out.
#include "integrator/subsurface.h"
#include "base/exact.h"
#include "lobes/sampling.h"
#include "world/raysets.h"
#include <algorithm>

namespace alpenglow::transport {

namespace {

constexpr int kSamplesElsewhere = 16; ///< of a call under hidden and raytrace

/// By Henyey and Greenstein, about a direction.
Vec3 scattered(const Vec3& dir, float g, const Vec2& u) {
    const double a = std::fabs(double(g)), q = 1 - a + 2 * a * u.x, r = (1 - a) / q;
    const double h = std::clamp(2 * r * r * (1 - u.x) * (1 + a * u.x), 0.0, 2.0); // 1 - cos
    const float s = float(std::sqrt(h * (2 - h)));
    const Vec2 d = unitCircle(u.y);
    const Vec3 w = Basis(g < 0 ? -dir : dir).toWorld({s * d.x, s * d.y, float(1 - h)});
    return w / length(w);
}

} // namespace

int Engine::groupNamed(const std::string& name) { return groups_.try_emplace(name, int(groups_.size()) + 1).first->second; }

const Engine::SubsurfaceOfShape& Engine::subsurfaceOf(const scene::Attributes& a) {
    std::shared_ptr<const SubsurfaceOfShape>& known = subsurfaces_[&a];
    if (known) return *known;
    auto s = std::make_shared<SubsurfaceOfShape>(a);
    const std::string name = attributeText(a, "subsurface:groupname");
    s->group = groupNamed(!name.empty() ? name : '\1' + std::to_string(subsurfaces_.size()));
    known = s;
    return *known;
}

void Engine::requestSubsurface(BatchContext& c, const SiteInfo& s, const ShadePoint& p, const std::function<float(int)>& f,
                               LobeVertex& l) {
    const SubsurfaceSite& site = *s.subsurface;
    const SubsurfaceOfShape& of = subsurfaceOf(p.shape->attributes());
    Below b = belowOf(site, of, f, halfSpaces_);
    b.group = site.group.empty() ? of.group : groupNamed(site.group);
    const float many = of.samples > 0 ? float(of.samples) : rules_.pickOne ? 1 : float(kSamplesElsewhere);
    const float samples = site.samples < 0 ? many : f(site.samples);
    l.samples = samplesOf(std::max(1.f, samples), p.shape, s, c); // not a number: 1
    l.rays = &kSpecularKind; // of one, that walks: --no-indirect leaves what lights bring by it
    l.lights = l.deltaLights = false;
    l.below = int32_t(below_.size());
    const auto triple = [&](int row) { return row < 0 ? Vec3() : Vec3(f(row), f(row + 1), f(row + 2)); };
    b.normal = normalizeOr(triple(site.normal), Vec3());
    b.from = triple(site.point);
    // The facet of a displaced surface, and the point that its shader makes, may lie a micropolygon apart.
    const float apart = p.surface.displaced ? length(p.surface.dPdu) * p.du + length(p.surface.dPdv) * p.dv : 0;
    const float away = length(b.from - p.P);
    b.elsewhere = std::isfinite(away) && away > geometry::roundingError(p.P) + 4 * p.surface.pError + apart;
    below_.push_back(b);
}

void Engine::walk(BatchContext& c, Sched& sched) {
    const std::vector<Below> below = std::exchange(below_, {});
    const std::vector<WalkAsked> asked = std::exchange(walks_, {});
    if (!asked.empty()) Walks(*this, c, asked, below).run(sched);
}

bool Walks::belongs(uint32_t shape, int group) const {
    return e_.subsurfaceOf(e_.world().shapes_[shape]->attributes()).group == group;
}

void Walks::run(Sched& sched) {
    for (size_t i = 0; i < asked_.size(); ++i)
        if (below_[size_t(asked_[i].below)].model == SubsurfaceSite::Model::Walk) start(int(i));
        else probe(int(i));
    while (!walkers_.empty() && !(e_.stop && *e_.stop)) step();
    askSurfaces(sched);
    const auto list = [&](const Exit& x) { return e_.world().bindings_[size_t(e_.world().bindingOf_[x.shape])].lightList; };
    std::stable_sort(exits_.begin(), exits_.end(), [&](const Exit& a, const Exit& b) { return list(a) < list(b); });
    for (size_t first = 0, end; first < exits_.size(); first = end) {
        for (end = first; end < exits_.size() && list(exits_[end]) == list(exits_[first]);) ++end;
        gatherAt(std::span<const Exit>(exits_).subspan(first, end - first), sched);
    }
}

/// At the shaded point, or at the call's. A point beside the surface is put onto it, along the normal; one within stays there.
std::optional<Walks::Entry> Walks::entry(int asked) const {
    const WalkAsked& a = asked_[size_t(asked)];
    const Below& b = below_[size_t(a.below)];
    const ShadePoint& p = c_.points[size_t(a.point)];
    const bool turned = dot(p.surface.n, c_.rays[size_t(a.point)].dir) > 0;
    const Vec3 side = turned ? -p.surface.n : p.surface.n;
    if (!b.elsewhere) {
        const float cosine = dot(b.normal, side); // of one that rounding has turned nothing changes
        return Entry{b.normal == Vec3() || std::fabs(cosine) > 1 - 1e-6f ? side
                     : cosine < 0                                        ? -b.normal
                                                                         : b.normal,
                     p.P, p.surface};
    }
    Entry at{b.normal == Vec3() ? side : b.normal, b.from, {}};
    if (turned && dot(at.out, side) < 0) at.out = -at.out; // seen from behind
    const float beside = 8 * geometry::roundingError(b.from);
    accel::Ray ray = rayOf({asked, b.from + at.out * beside, -at.out, {}, {}, 0}, 1e38);
    accel::Hit hit;
    bool met = e_.meet(ray, hit);
    for (int k = 0; met && !belongs(hit.shape, b.group); ++k) {
        e_.world().goOn(ray, hit);
        met = k < limits::kShadowLayers && e_.meet(ray, hit);
    }
    if (!met) return {};
    const geometry::SurfacePoint s = e_.world().accel_->point(hit);
    const Vec3 n = s.displaced ? s.displacedN : s.n;
    const bool leaves = dot(ray.dir, turned ? -n : n) > 0;
    if (leaves && !(hit.distance < 4 * double(beside))) {
        at.at -= at.out * beside;
        return at;
    }
    if (leaves) at.out = -at.out; // on the surface, by a normal that points inward
    at.at = s.displaced ? s.displacedP : s.P;
    at.surface = s;
    if (s.displaced) at.surface->P = s.displacedP, at.surface->n = s.displacedN;
    return at;
}

/// Into the surface, as light comes through its boundary that is even outside.
void Walks::start(int asked) {
    const WalkAsked& a = asked_[size_t(asked)];
    const Below& b = below_[size_t(a.below)];
    const ShadePoint& p = c_.points[size_t(a.point)];
    const PathRay& ray = c_.rays[size_t(a.point)];
    const std::optional<Entry> entered = entry(asked);
    if (!entered) return; // there is nothing below
    Walker w{asked, {}, {}, a.weight, a.weight, a.vertex};
    const Vec3 outside = sampleCosine(e_.random(ray).pair(a.vertex, kFlight, 0)); // a way out, about the normal
    const double n = b.index, sine2 = (1 - double(outside.z) * outside.z) / (n * n);
    if (!(sine2 < 1)) return; // all of it is reflected
    const double cosine = std::sqrt(1 - sine2);
    const double through = 1 - fresnelInside(cosine, n); // over its mean, by the flux
    const double mean = (1 - e_.halfSpaces_.of(b.index).first()) * n * n;
    w.weight = w.begin = a.weight * float(b.index == 1 ? 1 : through / mean);
    w.dir = Basis(-entered->out).toWorld({float(outside.x / n), float(outside.y / n), float(cosine)});
    w.dir = w.dir / length(w.dir);
    w.at = entered->at;
    if (const auto& on = entered->surface) {
        const Vec3 side = dot(on->n, entered->out) < 0 ? -on->n : on->n;
        if (const float away = dot(w.dir, side); away > 0)
            w.dir -= side * (2 * away); // about a tilted normal: it goes in all the same
        w.at = geometry::offsetOrigin(*on, w.dir, b.elsewhere ? 0 : length(p.P - p.surface.P));
    }
    walkers_.push_back(w);
}

/// How far a walker goes before it scatters: by one channel of what it has left.
double Walks::distance(const Walker& w) const {
    const Below& b = below_[size_t(asked_[size_t(w.asked)].below)];
    const Vec2 u = e_.random(c_.rays[size_t(asked_[size_t(w.asked)].point)]).pair(w.vertex, kFlight, 1);
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

/// What is left of its weight behind a way, over the density with which it has come so far.
void Walks::weigh(Walker& w, double way, bool scatters) const {
    const Below& b = below_[size_t(asked_[size_t(w.asked)].below)];
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
    r.time = e_.world().shutterOf(ray);
    r.sides = accel::Sides::Both;
    if (ray.sample) r.level = ray.sample->level;
    return r;
}

/// One event of each walker.
void Walks::step() {
    const WorldImpl& world = e_.world();
    std::vector<accel::Ray> rays;
    std::vector<double> reach;
    for (const Walker& w : walkers_) {
        reach.push_back(distance(w));
        rays.push_back(rayOf(w, reach.back()));
    }
    std::vector<accel::Hit> hits(rays.size());
    e_.meet(rays, hits);
    going_.clear();
    for (size_t i = 0; i < walkers_.size(); ++i) {
        Walker& w = walkers_[i];
        const int group = below_[size_t(asked_[size_t(w.asked)].below)].group;
        for (int k = 0; hits[i].valid() && !belongs(hits[i].shape, group); ++k) { // what else stands there
            world.goOn(rays[i], hits[i]);
            if (k >= limits::kShadowLayers || !e_.meet(rays[i], hits[i])) hits[i] = {};
        }
        const bool goes = hits[i].valid() ? meet(w, hits[i], reach[i]) : scatter(w, reach[i]);
        w.vertex = childVertex(w.vertex, kFlight, 3);
        if (goes && ++w.steps < limits::kPathDepth) going_.push_back(w);
        else if (goes) ++e_.counters.depthCap;
    }
    walkers_.swap(going_);
}

bool Walks::scatter(Walker& w, double way) {
    if (!(way < 1e30)) return false; // out of an inside that has no end there
    const Below& b = below_[size_t(asked_[size_t(w.asked)].below)];
    weigh(w, way, true);
    const Color left = absolute(w.weight), begin = absolute(w.begin);
    if (!(maxComponent(left) > 0) || !isFinite(left)) return false;
    const Random random = e_.random(c_.rays[size_t(asked_[size_t(w.asked)].point)]);
    if (e_.rules().roulette || w.steps > 64) {
        const auto dice = [&] { return random.one(w.vertex, kRoulette, 0); };
        const float q = rouletteOfPath(left / std::max(maxComponent(begin), 1e-30f), dice);
        if (!(q > 0)) return false;
        w.weight = w.weight / q;
    }
    w.at += w.dir * float(way);
    w.dir = scattered(w.dir, b.anisotropy, random.pair(w.vertex, kFlight, 2));
    return true;
}

/// At the boundary: true where it is reflected, or has come into another part of the same inside.
bool Walks::meet(Walker& w, const accel::Hit& hit, double) {
    const WorldImpl& world = e_.world();
    const WalkAsked& a = asked_[size_t(w.asked)];
    const Below& b = below_[size_t(a.below)];
    geometry::SurfacePoint at = world.accel_->point(hit);
    const Vec3 n = at.displaced ? at.displacedN : at.n;
    weigh(w, hit.distance, false);
    if (!(maxComponent(absolute(w.weight)) > 0) || !isFinite(w.weight)) return false;
    const ShadePoint& p = c_.points[size_t(a.point)];
    const bool turned = dot(p.surface.n, c_.rays[size_t(a.point)].dir) > 0; // seen from behind: so is the rest
    const Vec3 out = turned ? -n : n;
    const double cosine = dot(w.dir, out);
    if (cosine < 0) { // another primitive of the group begins in this one
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
    if (reflected > 0 && e_.random(c_.rays[size_t(a.point)]).one(w.vertex, kFlight, 0) < reflected) {
        w.dir = w.dir - out * float(2 * cosine);
        w.dir = w.dir / length(w.dir);
        w.at = geometry::offsetOrigin(at, w.dir);
        return true;
    }
    exits_.push_back({w.asked, w.weight, w.vertex, hit.shape, at, out});
    return false;
}

void Walks::settleAt(BatchContext& c, std::span<const Exit> exits) {
    const WorldImpl& world = e_.world();
    for (const Exit& x : exits) {
        const WalkAsked& a = asked_[size_t(x.asked)];
        const PathRay& from = c_.rays[size_t(a.point)];
        PathRay& r = c.rays.emplace_back(from);
        r.weight = x.weight;
        r.vertex = childVertex(x.vertex, kFlight, 4);
        r.counts = r.first = false;
        r.dir = -x.out; // as if it had come from outside
        if (e_.photonTrace()) r.trail = shading::kTrailSpread;
        r.footprint = from.footprint.after(length(c_.points[size_t(a.point)].P - from.origin));
        if (r.camera()) r.setStart(0);
        r.passed = false;
        const Vec3 at = x.point.displaced ? x.point.displacedP : x.point.P;
        r.origin = at;
        RayExtra extra;
        extra.share = a.share;
        r.extra = e_.newExtra(extra);
        c.targets.push_back(a.target);
        c.bindings.push_back(world.bindingOf_[x.shape]);
    }
    c.ownsExtras = true;
    c.points.resize(exits.size());
    for (size_t i = 0; i < exits.size(); ++i) {
        const Exit& x = exits[i];
        const PathRay& r = c.rays[i];
        ShadePoint& p = c.points[i] = {};
        p.shape = world.shapes_[x.shape].get();
        p.surface = x.point;
        p.P = p.E = r.origin;
        const Vec3 n = x.point.displaced ? x.point.displacedN : x.point.N;
        p.N = dot(n, x.out) < 0 ? -n : n;
        p.I = -x.out;
        p.shutter = p.surface.time = world.shadesAtOpen_ ? 0 : r.shutter();
        world.tellTime(p);
        p.ray = &r;
    }
}

/// What light brings where walks came out, as diffuse() has it.
void Walks::gatherAt(std::span<const Exit> exits, Sched& sched) {
    static const LobeKind* const kind = findLobe("diffuse");
    const WorldImpl& world = e_.world();
    auto c = e_.takeContext();
    c->engine = &e_;
    c->bound = c_.bound;
    c->binding = &world.bindings_[size_t(world.bindingOf_[exits[0].shape])];
    c->below = true;
    settleAt(*c, exits);
    for (size_t i = 0; i < exits.size(); ++i) {
        const Exit& x = exits[i];
        const ShadePoint& p = c->points[i];
        LobeVertex& l = e_.lobes.emplace_back();
        l.kind = kind;
        l.point = int(i);
        l.weight = Color(1);
        l.target = c->targets[i];
        l.site = kFlight;
        l.directOnly = !e_.rules().pickOne;
        l.share = asked_[size_t(x.asked)].share;
        l.indirect = asked_[size_t(x.asked)].indirect;
        if (world.lightsAsk()) {
            l.lit = int(e_.litValues_.size());
            e_.litValues_.emplace_back().binding = c->bindings[i];
        }
        l.place = e_.lobeRows_.add(*kind, {p.N, x.out, {}, 0});
    }
    e_.gather(*c, sched);
    skies(*c, sched);
    e_.flushShadows(sched);
    e_.giveBack(std::move(c));
}

/// Where no rays are sent a sky is one light that faces the surface, as in light loops.
void Walks::skies(const BatchContext& c, Sched& sched) {
    if (e_.rules().pickOne || !e_.rules().lightsAtRequests) return;
    const WorldImpl& world = e_.world();
    for (int number : world.skies_) {
        const BoundLight& light = world.lights_[size_t(number)];
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
        e_.evaluateLight(light, q, value);
        for (size_t i = 0; i < q.size(); ++i)
            if (value[i].lit)
                e_.deposit(sched, {c.targets[i], c.rays[i].weight * value[i].Cl * value[i].kept(RayType::Diffuse),
                                   LightEvent::Sky, &c.rays[i], e_.extraOf(c.rays[i]).share, light.instance.get()});
    }
}

} // namespace alpenglow::transport
