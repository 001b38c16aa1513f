// Photons at vertices: stored at lobes that are not deltas, continued along a lobe; and density estimation for paths.
#include "integrator/photonscatter.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/batchpool.h"
#include "integrator/guiderays.h"
#include "integrator/intersector.h"
#include "integrator/kernelinputs.h"
#include "integrator/lightkernels.h"
#include "integrator/lightpathstates.h"
#include "integrator/lobeselection.h"
#include "integrator/photonjob.h"
#include "integrator/photonstage.h"
#include "integrator/requests.h"
#include "integrator/scatterrays.h"
#include "integrator/shadowrays.h"
#include "integrator/transparency.h"

namespace alpenglow::integrator {

PhotonScatter::PhotonScatter(const StageSet& s, const VertexLobes& v, LobeSelection& selection, ScatterRays& scatter)
    : VertexStage(s, v), selection_(selection), scatter_(scatter), accumulator_(s.accumulator), batches_(s.batches),
      guide_(s.guide), intersector_(s.intersector), inputs_(s.inputs), paths_(s.paths), photons_(s.photons), shadows_(s.shadows),
      transparency_(s.transparency) {}

/// Whether a lobe receives light from all directions of its point, so that photons can be gathered for it. Surfaces only.
bool PhotonScatter::spreads(const LobeVertex& l) const { return !l.delta && !l.narrow && !c_->between && seesAll(l); }
bool PhotonScatter::mirrors(const LobeVertex& l) const {
    return (l.delta || l.narrow) && l.below < 0 && !l.ownsTarget && seesAll(l);
}
/// Decided by what both a photon and a path know: the roughness, and that the lobe is the same from either of its directions.
/// This holds for microfacets and for highlights around the mirror direction. A highlight around another direction, as by
/// refraction, has paths that only one of both finds. Shaders that move P are excluded, as they cannot run twice (lookBack()).
bool PhotonScatter::isNarrow(const LobeVertex& l, float below, const Vec3& in) const {
    const BsdfBatch& rows = requests_.rows;
    if (l.delta || l.below >= 0 || c_->between || !(rows.spread(l.place) < below)) return false;
    if (c_->binding->moveS || c_->bound->kernel->facts().suspends) return false;
    constexpr float kSame = 1e-3f; // between unit directions
    if (l.kind->has(kAxisIsMirror)) {
        const bool has = rows.row(l.place, kRowHasHorizon) != 0;
        const Vec3 n = has ? rows.triple(l.place, kRowHorizon) : normalize(c_->points[size_t(l.point)].N);
        return length(rows.triple(l.place, kRowAxis) - (in - n * (2 * dot(in, n)))) < kSame;
    }
    if (!l.kind->has(kSameFromBoth)) return false;
    return length(rows.triple(l.place, kRowWo) + in) < kSame;
}
/// Whether photons carry this light, so that it must not be sampled: it arrives via this lobe at a point that gathers photons.
bool PhotonScatter::leftToPhotons(const LobeVertex& l, const BoundLight& light) const {
    return l.narrow && (rayOf(l).trail & shading::kTrailSpread) && !photons_.photonTrace() && mirrors(l) &&
           world_.photons_->lightsOfPasses[size_t(&light - world_.lights_.data())];
}
bool PhotonScatter::seesAll(const LobeVertex& l) const {
    const shading::RaySet& set = l.rays->set;
    return !l.elsewhere && !set.only && !(l.maxDistance < 1e37f) && set.mode == shading::HitMode::Default &&
           set.sides == accel::Sides::Front && world_.bindings_[size_t(c_->bindings[size_t(l.point)])].photons.intersectsBoth;
}

uint8_t PhotonScatter::trailBehind(const LobeVertex& l) const {
    const uint8_t trail = rayOf(l).trail;
    if (photons_.photonTrace()) return mirrors(l) ? trail : uint8_t(shading::kTrailSpread);
    if (l.guide) return l.guide;
    if (guide_.on()) return mirrorsPath(l) ? GuideRays::trailBehindMirror(rayOf(l)) : 0; // then no photons are gathered
    if (spreads(l)) return shading::kTrailSpread;
    return mirrors(l) && (trail & shading::kTrailSpread) ? shading::kTrailSpread | shading::kTrailMirrored : 0;
}

void PhotonScatter::restPhotons() {
    PhotonTrace& t = *photons_.photonTrace();
    for (size_t point = 0; world_.moves_ && point < c_->points.size(); ++point)
        if (const ShadePoint& p = c_->points[point]; p.shape)
            t.fastest = std::max(t.fastest, length(p.shape->velocity(p.surface)));
    for (size_t point = 0; point < c_->points.size(); ++point) {
        if (begin_[point] == begin_[point + 1]) continue;
        const ShadePoint& p = c_->points[point];
        const PathRay& from = c_->rays[point];
        Color given(0);
        bool spread = false;
        for (int i : lobesOf(point)) {
            LobeVertex& l = requests_.lobes[size_t(i)];
            if (!l.delta && !l.narrow) {
                spread = true;
                given += l.weight * l.albedo;
            }
            // Paths that walk below a surface gather at their exit; photons of maps are stored at their exit.
            spread |= l.below >= 0 && t.job->caustics;
            if (t.job->caustics && !mirrors(l)) l.followed = false; // its probability is not given to another lobe
        }
        const bool caustic = from.bounces > 0 && !(from.trail & shading::kTrailSpread);
        const Color power = t.power[size_t(from.sample->path)] * from.weight * leftOfPhoton(*c_, point) * float(t.job->scale);
        if (!spread || c_->between || (t.job->caustics && !caustic) || !isFinite(power) || !(maxComponent(power) > 0)) continue;
        StoredPhoton s;
        const Vec3& n = p.surface.displaced ? p.surface.displacedN : p.surface.n;
        s.photon.P = p.surface.displaced ? p.surface.displacedP : p.surface.P;
        s.photon.power = {std::max(power.x, 0.f), std::max(power.y, 0.f), std::max(power.z, 0.f)};
        s.photon.from = photonmap::packUnit(-from.dir);
        s.photon.normal = photonmap::packUnit(dot(n, from.dir) > 0 ? -n : n);
        for (int k = 0; k < 3; ++k) s.photon.reflected[k] = uint8_t(std::clamp(given[k], 0.f, 1.f) * 255 + .5f);
        s.photon.bounces = uint8_t(std::min<int>(from.bounces, 255));
        s.number = t.first + uint32_t(from.sample->path);
        s.binding = c_->bindings[point];
        s.caustic = caustic;
        s.way = from.lobeOrigin - s.photon.P;
        s.time = from.sample->shutter;
        t.out->push_back(s);
    }
}

/// Outgoing direction of a photon, and the factor of its power beyond the lobe's weight. A photon along the normal reveals no
/// index of refraction: its shader sees it from a slightly tilted direction (PhotonStage::tilt), and the outgoing direction is
/// corrected here.
float PhotonScatter::photonWay(const LobeVertex& l, Vec3& w) const {
    const ShadePoint& p = c_->points[size_t(l.point)];
    const PathRay& from = rayOf(l);
    const Vec3 n = p.surface.displaced ? p.surface.displacedN : p.surface.n, N = normalize(p.N);
    if (l.narrow) return safeCosine(dot(w, n)) / safeCosine(dot(from.dir, n));
    const Vec3 in = normalize(p.I), tilt = in - from.dir;
    const float factor = photonFactor(requests_.rows.rowsAt(l.place), *l.kind, l.delta, -in, w, n, N);
    if (l.delta && length(tilt) > kLeastTilt / 4) {
        const Vec3 aside = tilt - N * dot(tilt, N);
        const float si = sine(in, N), index = si > 0 ? sine(w, N) / si : 1;
        w = normalize(w - aside * index);
    }
    return factor;
}

/// Whether a lobe that samples lights is lit by the light from which a photon has just arrived.
bool PhotonScatter::lit(const LobeVertex& l) const {
    const PathRay& ray = rayOf(l);
    if (ray.bounces > 0 || !l.lights || l.elsewhere || l.delta) return true;
    return world_.bindings_[size_t(c_->bindings[size_t(l.point)])].lights.contains(
        photons_.photonTrace()->from[size_t(ray.sample->path)].light);
}

/// Whether a path samples the light from which a photon arrives here, at any depth.
bool PhotonScatter::sampledByPaths(const LobeVertex& l) const {
    return photons_.photonTrace() && rayOf(l).bounces == 0 && l.narrow && l.lights && !l.elsewhere;
}

/// A path runs in reverse, and the depth limits of its surfaces count from its end: each leaves some bounces to the vertices that
/// a photon meets after it.
std::optional<PhotonDepths> PhotonScatter::depthsBehind(const LobeVertex& l, const SurfaceBinding& b) const {
    const PhotonDepths before = PhotonDepths::of(rayOf(l));
    if (sampledByPaths(l)) return before;
    const bool diffuse = l.rays->type == RayType::Diffuse;
    const auto left = [](int until, int most, bool takes) {
        const int now = std::min(until, most < 0 ? PhotonDepths::kAll : std::min(most, PhotonDepths::kAll - 1));
        return now == PhotonDepths::kAll ? now : now - takes;
    };
    const PhotonDepths d{left(before.diffuse, b.maxDiffuse, diffuse), left(before.specular, b.maxSpecular, !diffuse)};
    if (d.diffuse < 0 || d.specular < 0) return {};
    return d;
}

/// The batch as seen by paths from where the photons go; requests of its shader are appended to Requests::lobes.
std::shared_ptr<BatchContext> PhotonScatter::shadeBack(std::span<LobeRay* const> turned, Sched& sched) {
    auto c = batches_.take();
    c->extrasOf = nullptr; // the extras of the rays belong to the batch
    c->binding = c_->binding;
    c->bound = c_->bound;
    c->displaced = c_->displaced;
    c->points = c_->points;
    c->rays = c_->rays;
    c->targets = c_->targets;
    c->bindings = c_->bindings;
    for (size_t i = 0; i < c->points.size(); ++i) c->points[i].ray = &c->rays[i];
    for (const LobeRay* s : turned) { // seen from the photon's next hit: shaders may query its distance
        const PathRay& from = c_->rays[size_t(s->point)];
        accel::Ray way;
        way.org = origin(requests_.lobes[size_t(s->lobe)], s->w);
        way.dir = s->w;
        way.time = world_.shutterOf(from);
        way.only = photons_.photonTrace()->job->met;
        way.sides = accel::Sides::Both;
        way.level = from.sample->level;
        accel::Hit hit;
        ShadePoint& p = c->points[size_t(s->point)];
        p.I = s->w * -(intersector_.intersect(way, hit) ? hit.t : length(p.I));
        p.E = p.P - p.I;
        c->rays[size_t(s->point)].dir = -s->w;
    }
    inputs_.fill(*c);
    if (c->displaced) c->batch->tell(*c->displaced->batch);
    c->bound->kernel->run(&c->batch->call());
    c->ran();
    const size_t settled = shadows_.settled.size();
    requests_.requestPairs(*c, nullptr, sched);
    shadows_.settled.erase(shadows_.settled.begin() + long(std::min(settled, shadows_.settled.size())), shadows_.settled.end());
    requests_.rows.prepare();
    return c;
}

/// Paths reach narrow highlights and rough glass from the other side, and their shaders' results may depend on that side: Fresnel
/// reflectance, the direction of refraction, which call is made. So a photon that such a lobe sends on carries the value of all
/// narrow lobes of its point, with the shader run from where the photon goes; the lobes as the photon found them only sample the
/// direction, with the density of all of them.
void PhotonScatter::lookBack(Sched& sched) {
    std::vector<LobeRay*> turned;
    for (LobeRay& s : scatter_.sent)
        if (s.goes && requests_.lobes[size_t(s.lobe)].narrow) turned.push_back(&s);
    if (turned.empty()) return;
    BsdfBatch& rows = requests_.rows;
    const size_t had = requests_.lobes.size();
    const auto c = shadeBack(turned, sched);
    std::vector<Color> sum(c->points.size(), Color(0));
    std::vector<std::vector<int>> seen(c->points.size());
    for (size_t k = had; k < requests_.lobes.size(); ++k) {
        LobeVertex& l = requests_.lobes[k];
        l.albedo = rows.albedo(l.place);
        l.delta = rows.delta(l.place);
        l.narrow = isNarrow(l, photons_.photonTrace()->job->width, normalize(c->points[size_t(l.point)].I));
        if (l.lobeOfShader)
            for (int i = 0; i < 3; ++i) sum[size_t(l.point)][i] += std::fabs(l.weight[i]) * l.albedo;
        if (l.narrow && mirrors(l) && lit(l)) seen[size_t(l.point)].push_back(int(k));
    }
    const auto draws = [&](int i) { // a ray of its own may have gone this way
        const LobeVertex& l = requests_.lobes[size_t(i)];
        return l.narrow && l.followed && l.chosen > 0;
    };
    for (LobeRay* s : turned) { // of one point
        s->goes = !seen[size_t(s->point)].empty();
        for (int k : seen[size_t(s->point)]) rows.ask(requests_.lobes[size_t(k)].place, -c_->rays[size_t(s->point)].dir);
        for (int i : lobesOf(size_t(s->point)))
            if (i != s->lobe && draws(i)) rows.ask(requests_.lobes[size_t(i)].place, s->w);
    }
    rows.evaluate();
    for (LobeRay* s : turned) {
        if (!s->goes) continue;
        const PathRay& ray = c_->rays[size_t(s->point)];
        const float kept = ray.bounces == 0 ? photons_.photonTrace()->from[size_t(ray.sample->path)].kept : 1;
        const float energy = selection_.energyScale(size_t(s->point), sum[size_t(s->point)], transparency_.clearAt(*c, s->point));
        Color back(0);
        for (int k : seen[size_t(s->point)]) {
            const LobeVertex& l = requests_.lobes[size_t(k)];
            back += l.weight * rows.value(l.place).colour * ((l.lobeOfShader ? energy : 1) * (l.rays->fromTrace ? 1 : kept));
        }
        float density = 0;
        for (int i : lobesOf(size_t(s->point)))
            if (draws(i)) {
                const LobeVertex& l = requests_.lobes[size_t(i)];
                density += l.chosen * (i == s->lobe ? s->value.pdf : rows.value(l.place).pdf);
            }
        s->back = density > 0 ? back / density : Color(0);
    }
    requests_.lobes.erase(requests_.lobes.begin() + long(had), requests_.lobes.end());
    batches_.giveBack(c);
}

void PhotonScatter::takePhotons(Sched& sched) {
    for (size_t point = 0; point < c_->points.size(); ++point) {
        if (begin_[point] == begin_[point + 1]) continue;
        const PathRay& ray = c_->rays[point];
        const photonmap::PhotonGrid* grid = photons_.passOf(ray);
        if (!grid || grid->size() == 0) continue;
        const ShadePoint& p = c_->points[point];
        const Vec3& n = p.surface.displaced ? p.surface.displacedN : p.surface.n;
        const Vec3& at = p.surface.displaced ? p.surface.displacedP : p.surface.P;
        const float time = ray.shutter(), perArea = 1 / (float(kPi) * grid->radius() * grid->radius() * grid->lasts(time));
        near_.clear();
        grid->within(at, time, [&](const photonmap::Photon& photon) {
            if (!(std::fabs(dot(photonmap::unpackUnit(photon.normal), n)) > 0.7f)) return;
            const Vec3 w = photon.direction();
            near_.push_back({w, photon.power * (perArea / safeCosine(dot(w, n)))});
        });
        if (near_.empty()) continue;
        for (int i : lobesOf(point)) {
            const LobeVertex& l = requests_.lobes[size_t(i)];
            if (!l.followed || !spreads(l)) continue;
            const Color weight = l.lobeOfShader ? l.weight * selection_.indirectScale[point] : l.weight;
            const Color light = (l.ownsTarget ? weight : weight * ray.weight) * givenBack(l);
            accumulator_.contribute(sched, {l.target, light, LightEvent::Photons, &ray, shareOf(l), nullptr,
                                            paths_.atPhotons(paths_.atLobe(l, p, ray, near_[0].from))});
        }
    }
}

/// Light of near_ that a lobe reflects.
Color PhotonScatter::givenBack(const LobeVertex& l) {
    BsdfBatch& rows = requests_.rows;
    Color sum(0);
    if (l.kind->has(kLambert)) { // the most frequent case
        const Vec3 axis = rows.triple(l.place, kRowAxis);
        for (const Near& photon : near_) sum += photon.light * std::max(dot(axis, photon.from), 0.f);
        return sum * float(1 / kPi);
    }
    for (const Near& photon : near_) {
        rows.ask(l.place, photon.from);
        rows.evaluate();
        sum += photon.light * rows.value(l.place).colour;
    }
    return sum;
}

} // namespace alpenglow::integrator
