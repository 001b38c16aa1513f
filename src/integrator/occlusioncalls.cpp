// occlusion(): the unoccluded fraction of a hemisphere or cone. Its rays are shadow rays: surfaces attenuate them, and shaders
// run only where opacity is not known in advance.
#include "integrator/occlusioncalls.h"
#include "base/direction.h"
#include "base/exact.h"
#include "bsdf/sampling.h"
#include "geometry/shape.h"
#include "integrator/accumulator.h"
#include "integrator/context.h"
#include "integrator/intersector.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "integrator/surfacepoints.h"
#include "shading/gridpoint.h"
#include "world/raysets.h"

namespace alpenglow::integrator {

OcclusionCalls::OcclusionCalls(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), intersector_(s.intersector), photons_(s.photons), store_(s.store),
      requests_(s.requests), shadows_(s.shadows), surfaces_(s.surfaces) {}

namespace {

/// Rays whose results differ by less are considered equal.
constexpr float kAgree = 1e-3f;

/// The directions of a call.
struct Directions {
    Basis about;
    bool uniform = false;
    float cap = 1, sine2 = 1; ///< 1 - cos of the half angle; its squared sine
    Directions(const Vec3& axis, float half, bool evenly) : about(axis), uniform(evenly) {
        const double a = std::clamp(double(half), 0.0, evenly ? kPi : kPi / 2);
        const float s = float(exact::sin(0.5 * a)), s2 = float(exact::sin(a));
        cap = 2 * s * s;
        sine2 = s2 * s2;
    }
    Vec3 at(const Vec2& e) const {
        if (uniform) return about.toWorld(sampleCone(cap, e));
        const float r2 = e.x * sine2, r = std::sqrt(r2); // cosine-weighted
        const Vec2 d = unitCircle(e.y);
        return about.toWorld({r * d.x, r * d.y, std::sqrt(std::max(0.f, 1 - r2))});
    }
};

} // namespace

const OcclusionCalls::OfShape& OcclusionCalls::ofShape(const geometry::Shape* shape) {
    const scene::Attributes* const a = shape ? &shape->attributes() : nullptr;
    const auto [at, fresh] = ofShapes_.try_emplace(a, OfShape{64, -1});
    if (!fresh || !a) return at->second;
    const auto number = [&](const char* key, float fallback) {
        const scene::Param* p = a->value(key);
        return p && !p->numbers.empty() ? p->numbers[0] : fallback;
    };
    const float samples = number("irradiance:nsamples", 64);
    at->second.samples = samples >= 1 ? int(std::min(samples, 4096.f)) : 1;
    if (const float bias = number("trace:bias", -1); bias > 0) at->second.bias = bias;
    return at->second;
}

int OcclusionCalls::samplesOf(float asked, const geometry::Shape* shape, const SiteInfo& s, const BatchContext& c) {
    if (!(asked >= 1)) return asked > 0 ? 1 : ofShape(shape).samples;
    if (asked > 4096) {
        const auto& files = c.bound->kernel->files();
        const auto& at = s.site->place;
        const SourcePlace place{at.file < int(files.size()) ? files[size_t(at.file)] : "", at.line, at.column};
        diagnostics_.reportOnce("samples:" + place.file + std::to_string(place.line),
                                {Severity::Warning,
                                 Rie::Limit,
                                 place,
                                 "a call requests more samples than the limit of 4096 rays",
                                 "use more samples per pixel instead",
                                 {}});
    }
    return int(std::min(asked, 4096.f));
}

FlippedNormals::Tally* OcclusionCalls::tallyOf(const BatchContext& c, const SiteInfo& s, const ShadePoint& p,
                                               const Vec3& normal) {
    if (!p.shape) return nullptr;
    FlippedNormals::Tally*& t = tallies_[{&s, p.shape}];
    if (!t) {
        const auto& files = c.bound->kernel->files();
        const auto& at = s.site->place;
        t = &world_.turnedAway().of(
            {at.file >= 0 && at.file < int(files.size()) ? files[size_t(at.file)] : "", at.line, at.column},
            s.kind == SiteKind::Trace ? "indirectdiffuse" : s.site->op, *p.shape);
    }
    // The centre of a micropolygon at the silhouette may lie behind it: the viewing direction proves nothing there.
    const bool rim = p.ray && p.ray->sample && p.ray->sample->grid && p.ray->sample->grid->micropolygon;
    const float towards = dot(normal, p.I), least = rim ? 0.5f * length(normal) * length(p.I) : 0;
    if (std::fabs(towards) > least) FlippedNormals::Tally::set(towards > 0 ? t->away : t->facing);
    return t;
}

void OcclusionCalls::noteTurnedAway(const BatchContext& c, const SiteInfo& s, int point, const Vec3& normal) {
    const ShadePoint& p = c.points[size_t(point)];
    if (!p.shape || !p.ray || !p.ray->camera() || c.light || photons_.photonTrace()) return;
    FlippedNormals::Tally& t = *tallyOf(c, s, p, normal);
    if (!(dot(normal, p.I) > 0) || t.facing || t.open) return; // already decided: no more rays
    accel::Ray ray;
    ray.org = surfaces_.leave(c, size_t(point), normal);
    ray.dir = normal;
    ray.time = p.shutter;
    ray.sides = accel::Sides::Both;
    if (p.ray->sample) ray.level = p.ray->sample->level;
    accel::Hit hit;
    if (!intersector_.intersect(ray, hit) || world_.shapes()[hit.shape].get() != p.shape) FlippedNormals::Tally::set(t.open);
}

void OcclusionCalls::hemisphereRays(const BatchContext& c, const SiteInfo& s, const ShadePoint& p, const Vec3& at,
                                    const geometry::SurfacePoint* surface, const std::function<float(int)>& f,
                                    const Color& weight, AccumulatorId target, uint32_t site, uint32_t occurrence,
                                    std::vector<ShadowRay>& out) {
    const RaySite& r = *s.rays;
    const OcclusionSite& o = *s.occlusion;
    const auto number = [&](int row, float fallback) { return row < 0 ? fallback : f(row); };
    const auto triple = [&](int row) { return Vec3(f(row), f(row + 1), f(row + 2)); };
    const Vec3 from = triple(s.rows[0]);
    const Vec3 normal = directionOr(triple(s.rows[1]), surface ? surface->n : Vec3(0, 0, 1));
    const Vec3 towards = o.axis >= 0 ? triple(o.axis) : Vec3();
    const float half = number(o.cone, float(kPi / 2));
    const Directions directions(normal, half > 0 ? half : 0, o.uniform);
    const int count = half > 0 && p.ray ? samplesOf(number(r.samples, 0), p.shape, s, c) : 1;
    ShadowRay ray{};
    ray.target = target;
    ray.time = p.shutter;
    ray.ray = p.ray;
    RayKind kind = kShadowKind;
    kind.set = store_.raySetOf(s, f, p.shape, kind.type, kind.label);
    ray.kind = store_.kindOf(kind);
    const float far = std::min(number(r.maxDistance, 1e38f), number(r.maxHit, 1e38f));
    ray.distance = far >= 0 ? far : 1e38f;
    float bias = number(r.bias, -1);
    if (bias < 0) bias = ofShape(p.shape).bias;
    HemisphereRays h;
    h.site = s.trace.get();
    h.share = 1 / float(count);
    h.fade = {std::max(0.f, number(o.fade.strength, 0)), ray.distance, number(o.fade.mode, 0) != 0};
    h.spread = p.ray ? p.ray->footprint.spread : 0;
    if (surface && p.ray && !c.light && half > 0) h.tally = tallyOf(c, s, p, normal);
    ray.hemisphere = int32_t(hemispheres.size());
    hemispheres.push_back(h);
    ray.contribution = weight * h.share;
    const float base = number(r.base, 0);
    const bool here = surface && length(from - at) <= geometry::roundingError(from) + 4 * surface->pError;
    const size_t begin = out.size();
    const int few = fewer(o, f, count, c);
    // A pair of numbers for each, with no other draws in between
    const bool once = few == count && o.axis < 0 && half > 0 && p.ray;
    if (once) {
        numbers_.clear();
        const Random of = store_.random(*p.ray);
        for (int k = 0; k < count; ++k)
            numbers_.askPair(of.draw(uint32_t(k), uint32_t(count)).numbers(), p.ray->vertex, site, occurrence * 4096);
        numbers_.draw();
    }
    for (int k = 0; k < count; ++k) {
        const Random numbers = p.ray ? store_.random(*p.ray).draw(uint32_t(k), uint32_t(count)) : Random(store_.noSample.numbers);
        const uint32_t vertex = p.ray ? p.ray->vertex : 0;
        int tries = 0;
        const auto pair = [&] {
            return once       ? numbers_.pair(size_t(k))
                   : half > 0 ? numbers.pair(vertex, site, occurrence * 4096 + uint32_t(tries))
                              : Vec2(0, 0);
        };
        do ray.dir = directions.at(pair());
        while (o.axis >= 0 && !(dot(ray.dir, towards) > 0) && dot(towards, towards) > 0 && ++tries < kDrawTries);
        if (tries == kDrawTries) ray.contribution = Color(0); // almost no direction is usable
        else ray.contribution = weight * h.share;
        ray.origin = bias >= 0 ? from + ray.dir * bias
                     : here    ? geometry::offsetOrigin(*surface, ray.dir, length(at - surface->P) + length(from - at))
                               : from + ray.dir * geometry::roundingError(from);
        if (base > 0 && surface && p.ray) {
            const Vec2 e = numbers.pair(childVertex(vertex, site, occurrence), kSampleBase, 0);
            ray.origin += (surface->dPdu * (p.du * (e.x - .5f)) + surface->dPdv * (p.dv * (e.y - .5f))) * base;
        }
        out.push_back(ray);
        if (k + 1 == few && few < count && agree(out, begin, hemispheres.back(), weight)) return;
    }
}

/// Number of rays to send before the rest: all, unless the call allows fewer.
int OcclusionCalls::fewer(const OcclusionSite& o, const std::function<float(int)>& f, int count, const BatchContext& c) const {
    const bool given = o.least >= 0 && f(o.least) >= 1;
    if (c.light || !world_.media().empty() || (o.adaptive >= 0 ? !(f(o.adaptive) > 0) : !given)) return count;
    return std::clamp(given ? int(std::min(f(o.least), 4096.f)) : count / 4, 1, count);
}

/// Traces the rays after `begin`, the first of a call. Returns whether they all agree; the rest is then skipped, which is biased.
/// Their results are added in both cases.
bool OcclusionCalls::agree(std::vector<ShadowRay>& rays, size_t begin, HemisphereRays& of, const Color& weight) {
    const std::span<ShadowRay> first = std::span(rays).subspan(begin);
    std::vector<Color> left(first.size());
    const size_t number = size_t(&of - hemispheres.data());
    shadows_.transmittances(first, left); // shaders on the way may append hemispheres of their own
    const auto [least, most] =
        std::minmax_element(left.begin(), left.end(), [](const Color& a, const Color& b) { return mean(a) < mean(b); });
    const bool same = mean(*most) - mean(*least) < kAgree;
    if (same) {
        const float share = hemispheres[number].share = 1 / float(first.size());
        for (ShadowRay& r : first) r.contribution = r.contribution == Color(0) ? Color(0) : weight * share;
    }
    for (size_t k = 0; k < first.size(); ++k)
        shadows_.settled.push_back({first[k].target, openLight(first[k], left[k], accumulator_.sumsOf(first[k].target)),
                                    LightEvent::Sampled, first[k].ray});
    rays.resize(begin);
    return same;
}

Color OcclusionCalls::openLight(const ShadowRay& r, const Color& transmitted, TraceSums* sums) const {
    const float open = mean(transmitted);
    const HemisphereRays& h = hemispheres[size_t(r.hemisphere)];
    h.open(transmitted);
    if (sums) {
        sums->add(TraceSums::Open, r.dir * (open * h.share));
        if (h.site->map)
            sums->add(TraceSums::Environment, requests_.mapTowards(*h.site, r.dir, h.spread) * transmitted * h.share);
    }
    return r.contribution * open;
}

} // namespace alpenglow::integrator
