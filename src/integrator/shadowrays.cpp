// Shadow rays: surfaces attenuate by Oi. If Oi is Os or a constant known when the world was built, no shader runs; otherwise the
// opacity-only kernel runs for all rays that hit it, wave by wave.
#include "integrator/shadowrays.h"
#include "base/exact.h"
#include "base/memory.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/context.h"
#include "integrator/intersector.h"
#include "integrator/irradiancerecords.h"
#include "integrator/lightpathstates.h"
#include "integrator/mediastacks.h"
#include "integrator/occlusioncalls.h"
#include "integrator/opacities.h"
#include "integrator/raystore.h"
#include "integrator/segmentevents.h"
#include "integrator/stageset.h"
#include "world/raysets.h"
#include <limits>

namespace alpenglow::integrator {

ShadowRays::ShadowRays(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), segmentEvents_(s.segmentEvents), intersector_(s.intersector),
      records_(s.records), paths_(s.paths), media_(s.media), occlusion_(s.occlusion), opacities_(s.opacities), store_(s.store) {}

namespace {
/// Whether a ray may hit something in a box; false only if it misses the box.
bool passes(const geometry::Bounds& b, const ShadowRay& r) {
    const float error = geometry::roundingError(b.lo) + geometry::roundingError(b.hi) + geometry::roundingError(r.origin);
    double from = 0, to = r.distance;
    for (int k = 0; k < 3; ++k) {
        const double lo = double(b.lo[k]) - error - r.origin[k], hi = double(b.hi[k]) + error - r.origin[k], d = r.dir[k];
        if (std::fabs(d) < 1e-12) {
            if (lo > 0 || hi < 0) return false;
            continue;
        }
        from = std::max(from, std::min(lo / d, hi / d) * (1 - 1e-6));
        to = std::min(to, std::max(lo / d, hi / d) * (1 + 1e-6));
    }
    return from <= to;
}
} // namespace

accel::Ray rayOf(const ShadowRay& s) {
    accel::Ray r;
    r.org = s.origin;
    r.dir = s.dir;
    r.tfar = s.distance;
    r.time = s.time;
    r.mask = visibilityBit(s.kind->type);
    r.sides = s.kind->set.sides;
    r.only = s.kind->set.only;
    if (s.ray && s.ray->sample) r.level = s.ray->sample->level;
    return r;
}

ShadowSegment segmentBetween(const Vec3& a, const Vec3& b, const Vec3& at, const geometry::SurfacePoint* s) {
    const Vec3 all = b - a;
    const float distance = length(all);
    if (!(distance > 0)) return {a, Vec3(0, 0, 1), 0};
    const Vec3 d = all / distance;
    const auto end = [&](const Vec3& x, const Vec3& away) {
        const float near = geometry::roundingError(x);
        if (s && length(x - at) <= near + 4 * s->pError)
            return geometry::offsetOrigin(*s, away, length(at - s->P) + length(x - at));
        return x + away * near;
    };
    const Vec3 from = end(a, d), to = end(b, -d), left = to - from;
    const float l = length(left);
    return dot(left, d) > 0 ? ShadowSegment{from, left / l, l} : ShadowSegment{from, d, 0};
}

bool ShadowRays::intersectsOnlyOpaque(const ShadowRay& r) const {
    if (r.hemisphere >= 0 && occlusion_.hemispheres[size_t(r.hemisphere)].fade.fades())
        return false; // the distance of the surfaces matters
    return !world_.mediaOverrule() && !r.kind->set.only && r.kind->set.mode == shading::HitMode::Default;
}

/// Sets 0 for rays that hit a surface known to be opaque, and 1 for the others.
void ShadowRays::blockedByOpaque(std::span<const ShadowRay> rays, std::span<Color> out) {
    rays_.clear();
    std::vector<size_t> of;
    for (size_t i = 0; i < rays.size(); ++i) {
        out[i] = Color(1);
        if (!intersectsOnlyOpaque(rays[i])) continue;
        rays_.push_back(rayOf(rays[i]));
        rays_.back().only = world_.byOpacity().opaque.data();
        of.push_back(i);
    }
    blocked_.resize(of.size());
    intersector_.occluded(rays_, blocked_);
    for (size_t k = 0; k < of.size(); ++k)
        if (blocked_[k]) out[of[k]] = Color(0);
}

/// The same in scenes where all surfaces are opaque.
void ShadowRays::blockedByAll(std::span<const ShadowRay> rays, std::span<Color> out) {
    if (intersector_.blockInRows(rays, out)) return;
    constexpr size_t kAtOnce = 512; // fits into the cache of a core
    blocked_.resize(std::min(rays.size(), kAtOnce));
    for (size_t first = 0; first < rays.size(); first += kAtOnce) {
        const size_t n = std::min(kAtOnce, rays.size() - first);
        rays_.clear();
        for (const ShadowRay& r : rays.subspan(first, n)) rays_.push_back(rayOf(r));
        intersector_.occluded(rays_, std::span(blocked_).first(n));
        for (size_t i = 0; i < n; ++i) out[first + i] = blocked_[i] ? Color(0) : Color(1);
    }
}

void ShadowRays::transmittances(std::span<const ShadowRay> rays, std::span<Color> out) {
    counters_.shadow += rays.size();
    passSurfaces(rays, out);
    for (SegmentEvent* e : segmentEvents_.events) e->dim(rays, out);
}

/// Transmittance of surfaces and media: surface by surface, for all rays of a wave before their opacity shaders run.
class ShadowRays::Passing {
public:
    Passing(ShadowRays& stage, std::span<const ShadowRay> rays, std::span<Color> out)
        : stage_(stage), world_(stage.world_), rays_(rays), out_(out),
          counts_(stage.paths_.automaton && stage.paths_.automaton->countsStraight()),
          fading_(std::any_of(rays.begin(), rays.end(), [&](const ShadowRay& r) { return fades(r); })),
          taken_(fading_ ? rays.size() : 0, Color(0)), straights_(counts_ ? rays.size() : 0, 0),
          differs_(stage.world_.shadowVisibility().opacity ? rays.size() : 0, 0) {}
    bool fading() const { return fading_; }
    void run();

private:
    struct Going {
        size_t index;
        int layers;
        const shading::Media* media;
        Vec3 begin;
        int medium() const { return media ? media->top() : -1; }
    };
    bool fades(const ShadowRay& r) const {
        return r.hemisphere >= 0 && stage_.occlusion_.hemispheres[size_t(r.hemisphere)].fade.fades();
    }
    void begin();
    void intersect();
    void pass(const Going&, const accel::Ray& behind, const accel::Hit&);
    bool enters(Going&, const SurfaceBinding&, const accel::Hit&, const Vec3& dir);
    void leaves(const Going&);
    void takes(size_t i, const Color& opacity, double distance);

    ShadowRays& stage_;
    const WorldImpl& world_;
    std::span<const ShadowRay> rays_;
    std::span<Color> out_;
    const bool counts_, fading_;
    bool few_ = false;                ///< ways_ and hits_ use the numbers of WorldImpl::byOpacity().few
    std::vector<Color> taken_;        ///< occlusion by distant surfaces that count in part
    std::vector<uint16_t> straights_; ///< ShadowRays::straights_; a member of its own because shaders on the way may send rays
    std::vector<uint8_t> differs_;    ///< ShadowRays::differs_; likewise
    std::vector<MediumPart> parts_;
    std::vector<Going> now_, next_;
    std::vector<accel::Ray> ways_, nextWays_; ///< by now_, next_
    std::vector<accel::Hit> hits_;            ///< by now_
    std::vector<OpacityQuery> met_;
    std::vector<size_t> asks_; ///< of met_: indices in next_
};

void ShadowRays::Passing::takes(size_t i, const Color& opacity, double distance) {
    if (counts_) ++straights_[i];
    if (fading_ && fades(rays_[i]))
        taken_[i] += out_[i] * opacity * stage_.occlusion_.hemispheres[size_t(rays_[i].hemisphere)].fade.at(distance);
    out_[i] *= Color(1) - opacity;
}

/// Starts the rays that opaque surfaces do not block.
void ShadowRays::Passing::begin() {
    stage_.blockedByOpaque(rays_, out_);
    few_ = world_.byOpacity().few &&
           std::all_of(rays_.begin(), rays_.end(), [&](auto& r) { return stage_.intersectsOnlyOpaque(r); });
    for (size_t i = 0; i < rays_.size(); ++i) {
        const bool byOpacity = stage_.intersectsOnlyOpaque(rays_[i]);
        if (byOpacity && out_[i] == Color(0)) continue;
        const Going g{i, 0, rays_[i].media, rays_[i].origin};
        if (byOpacity && (world_.allOpaque() || !passes(world_.byOpacity().clearBounds, rays_[i]))) {
            leaves(g);
            continue;
        }
        now_.push_back(g);
        ways_.push_back(rayOf(rays_[i]));
        if (byOpacity && !few_) ways_.back().only = world_.byOpacity().clear.data();
    }
}

/// The ray reaches its end without another surface.
void ShadowRays::Passing::leaves(const Going& g) {
    const ShadowRay& r = rays_[g.index];
    if (g.medium() >= 0 && r.distance < 1e30f) parts_.push_back({g.medium(), g.index, g.begin, r.origin + r.dir * r.distance});
}

/// Crosses the boundary of a medium. Returns whether a medium of higher priority overrides it.
bool ShadowRays::Passing::enters(Going& g, const SurfaceBinding& b, const accel::Hit& h, const Vec3& dir) {
    geometry::SurfacePoint at;
    world_.accel().point(h, at, 0);
    const Vec3 end = at.displaced ? at.displacedP : at.P;
    if (g.medium() >= 0) parts_.push_back({g.medium(), g.index, g.begin, end});
    const bool overruled = b.overruled(g.media);
    g.media = stage_.media_.beyond(b, g.media, at.n, dir, dir);
    g.begin = end;
    return !overruled;
}

/// Finds the next hit of each ray.
void ShadowRays::Passing::intersect() {
    hits_.resize(now_.size());
    if (few_) stage_.intersector_.intersectFew(ways_, hits_);
    else stage_.intersector_.intersect(ways_, hits_);
    for (size_t i = 0; i < now_.size(); ++i) {
        if (!hits_[i].valid()) {
            leaves(now_[i]);
            continue;
        }
        accel::Ray behind = ways_[i];
        world_.goOn(behind, hits_[i]);
        if (few_) hits_[i].shape = world_.byOpacity().numbers[hits_[i].shape];
        pass(now_[i], behind, hits_[i]);
    }
}

/// Passes a surface, or queues the hit for its opacity shader.
void ShadowRays::Passing::pass(const Going& from, const accel::Ray& behind, const accel::Hit& h) {
    Color& t = out_[from.index];
    if (from.layers >= limits::kShadowLayers) {
        t = Color(0);
        ++stage_.counters_.depthCap;
        return;
    }
    Going g = from;
    ++g.layers;
    const int binding = world_.bindingOf()[h.shape];
    const SurfaceBinding& b = world_.bindings()[size_t(binding)];
    if (world_.media().empty() || enters(g, b, h, behind.dir)) {
        const Opacity& opacity = b.opacityFor(rays_[g.index].kind->set.mode);
        if (opacity.differs && !differs_.empty()) differs_[g.index] = 1;
        if (opacity.kernel) {
            met_.push_back({binding, h, &rays_[g.index], &opacity.kernel});
            asks_.push_back(next_.size());
        } else {
            takes(g.index, opacity.constant, h.distance);
            if (!(maxComponent(t) > 0)) return;
        }
    }
    next_.push_back(g);
    nextWays_.push_back(behind);
}

void ShadowRays::Passing::run() {
    begin();
    const StopFlag* const stop = stage_.context_.stop;
    while (!now_.empty()) {
        next_.clear(), nextWays_.clear(), met_.clear(), asks_.clear();
        intersect();
        stage_.opacities_.takeOpacities(
            met_, [&](size_t k, const Color& opacity) { takes(next_[asks_[k]].index, opacity, met_[k].hit.distance); });
        size_t kept = 0;
        for (size_t i = 0; i < next_.size(); ++i) {
            if (!(maxComponent(out_[next_[i].index]) > 0)) continue;
            next_[kept] = next_[i];
            nextWays_[kept++] = nextWays_[i];
        }
        next_.resize(kept), nextWays_.resize(kept);
        now_.swap(next_), ways_.swap(nextWays_);
        if (stop && *stop) break; // the result is undefined
    }
    for (size_t i = 0; i < taken_.size(); ++i)
        if (fades(rays_[i])) out_[i] = Color(1) - taken_[i];
    stage_.media_.dim(parts_, rays_, out_);
    stage_.straights_ = std::move(straights_);
    stage_.differs_ = std::move(differs_);
}

void ShadowRays::passSurfaces(std::span<const ShadowRay> rays, std::span<Color> out) {
    straights_.clear();
    differs_.clear();
    Passing passing(*this, rays, out);
    if (world_.allOpaque() && world_.media().empty() && !passing.fading()) return blockedByAll(rays, out);
    passing.run();
}

Color ShadowRays::transmittance(const ShadowRay& s) {
    Color t;
    transmittances({&s, 1}, {&t, 1});
    return t;
}

void ShadowRays::transmissionRays(const SiteInfo& s, const ShadePoint& p, const Vec3& at, const geometry::SurfacePoint* surface,
                                  const std::function<float(int)>& f, const Color& weight, AccumulatorId target, uint32_t site,
                                  uint32_t occurrence, std::vector<ShadowRay>& out) {
    const RaySite& r = *s.rays;
    auto point = [&](size_t arg) { return Vec3(f(s.rows[arg]), f(s.rows[arg] + 1), f(s.rows[arg] + 2)); };
    auto number = [&](int row, float fallback) { return row < 0 ? fallback : f(row); };
    const Vec3 a = point(0), b = point(1);
    ShadowRay ray{};
    ray.target = target;
    ray.time = p.shutter;
    ray.ray = p.ray;
    RayKind kind = kShadowKind;
    kind.set = store_.raySetOf(s, f, p.shape, kind.type, kind.label);
    // Sides are seen from the shaded point, at whichever end of the ray it is.
    if (!r.saysSides && length(b - at) < length(a - at)) kind.set.sides = accel::Sides::Back;
    ray.kind = store_.kindOf(kind);
    const float bias = number(r.bias, -1), far = std::min(number(r.maxDistance, 1e38f), number(r.maxHit, 1e38f)),
                cone = number(r.cone, 0);
    const int count = cone > 0 && p.ray ? int(std::clamp(number(r.samples, 1), 1.f, 4096.f)) : 1; // identical rays are sent once
    ray.contribution = weight / float(count);
    for (int k = 0; k < count; ++k) {
        Vec3 end = b;
        if (cone > 0 && p.ray && length(b - a) > 0) { // uniform in a cone around the direction, to the distance of b
            const float half = float(exact::sin(0.5 * std::min(cone, float(kPi)))), cap = 2 * half * half;
            end = a + Basis((b - a) / length(b - a))
                              .toWorld(sampleCone(cap, store_.random(*p.ray)
                                                           .draw(uint32_t(k), uint32_t(count))
                                                           .pair(p.ray->vertex, site, occurrence * 4096))) *
                          length(b - a);
        }
        const ShadowSegment way = segmentBetween(a, end, at, surface);
        ray.origin = bias >= 0 ? a + way.dir * bias : way.origin;
        ray.dir = way.dir;
        ray.distance = bias >= 0 ? std::max(0.f, way.distance - bias) : way.distance;
        if (far >= 0) ray.distance = std::min(ray.distance, far);
        out.push_back(ray);
    }
}

void ShadowRays::flush(Sched& s) {
    for (const Contribution& d : settled) accumulator_.contribute(s, d);
    settled.clear();
    records_.follow(s);
    roulette(s);
    if (queue.empty()) return;
    transmitted_.resize(queue.size());
    transmittances(queue, transmitted_);
    if (!alone.empty()) takeAlone();
    for (size_t i = 0; i < queue.size(); ++i) {
        const ShadowRay& r = queue[i];
        const auto arrives = [&](const Color& contribution, AccumulatorId target, int32_t share, bool areaLight, uint16_t path) {
            const Color light = contribution * transmitted_[i];
            for (int k = path && !straights_.empty() ? straights_[i] : 0; k > 0; --k) path = paths_.next(path, paths_.straight);
            accumulator_.contribute(s, {target, light, LightEvent::Sampled, r.ray, share, nullptr, paths_.next(path, r.light)});
            if (TraceSums* sums = areaLight ? accumulator_.sumsOf(target) : nullptr) sums->add(TraceSums::AreaLight, light);
        };
        if (r.hemisphere >= 0) { // these alone; no other light shares their rays
            if (transmitted_[i] == Color(0) && isFinite(r.contribution)) continue;
            accumulator_.contribute(s, {r.target, occlusion_.openLight(r, transmitted_[i], accumulator_.sumsOf(r.target)),
                                        LightEvent::Sampled, r.ray, r.share, nullptr, paths_.next(r.path, r.light)});
            continue;
        }
        arrives(r.contribution, r.target, r.share, r.areaLight, r.path);
        for (int32_t k = r.more; k >= 0; k = more[size_t(k)].more) {
            const MoreLight& m = more[size_t(k)];
            arrives(m.contribution, m.target, m.share, m.areaLight, m.path);
        }
    }
    for (const auto& [sample, ray] : noted_)
        if (maxComponent(transmitted_[ray]) > 0) context_.seen->push_back(sample);
    noted_.clear();
    queue.clear();
    more.clear();
    occlusion_.hemispheres.clear();
}

void ShadowRays::clear() {
    noted_.clear();
    queue.clear();
    more.clear();
    alone.clear();
}

size_t ShadowRays::bytes() const {
    return bytesOf(queue) + bytesOf(more) + bytesOf(settled) + bytesOf(transmitted_) + bytesOf(rays_) + bytesOf(alone);
}

} // namespace alpenglow::integrator
