// Where a ray ends without a shader of its own: light of emitters and sky, and what goes on through surfaces.
#include "integrator/medium.h"
#include "lobes/sampling.h"
#include "world/skytable.h"
#include <algorithm>

namespace alpenglow::transport {

void Engine::passThrough(const SurfaceBinding& b, const PathRay& ray, TargetId target, const ShadePoint& p,
                         const Color& transparency, float chance, uint32_t asked, Sched& sched) {
    if (ray.quiet) return;
    const Color t = transparency / chance;
    PathRay r = ray;
    const RayExtra& had = extraOf(ray);
    r.weight = (had.fade.fades() || had.indirect != 1 ? had.whole : ray.weight) * t;
    float chosen = 1;
    const Settings& set = world_->settings_;
    // What a camera ray shows behind a surface is always followed, so that opacity, depth and AOVs are exact.
    if (rules_.roulette && ray.bounces > 0) {
        const int depth = ray.bounces + ray.layers + 1;
        auto dice = [&] { return random(ray).one(ray.vertex, kPassThrough, 0); };
        float q = 1;
        if (asked > 0) { // one more of what the kernel has asked for
            r.asked = uint16_t(std::min<uint32_t>(std::max<uint32_t>(ray.asked, asked + 1), 0xffff));
            q = std::min(rouletteWaiting(ray.bounces, ray.asked, asked, 1), maxComponent(transparency));
            if (q < 1 && dice() >= q) q = 0;
        } else if (set.localRoulette) {
            q = rouletteLocal(depth, t, depth > 3 ? dice() : 0);
        } else if (depth > 3) {
            const Color left(std::fabs(r.weight.x), std::fabs(r.weight.y), std::fabs(r.weight.z));
            q = world_->lightTraces_ > 0 ? rouletteLocal(depth, left, dice()) : rouletteOfPath(r.weight, dice);
        }
        if (!(q > 0)) return;
        r.weight = r.weight / q;
        chosen = q;
    }
    const float travelled = length(p.P - ray.origin);
    r.goOnAt(geometry::offsetOrigin(p.surface, ray.dir));
    r.maxDistance = ray.maxDistance - travelled;
    r.footprint = ray.footprint.after(travelled);
    r.first = false;
    r.path = pathEvent(ray.path, straight_);
    r.media = mediaBeyond(b, ray.media, p.surface.n, ray.dir, ray.dir);
    tellLost(r.media, p);
    if (photonTrace_ && (ray.medium() >= 0 || r.medium() >= 0)) { // from here on in another volume
        r.lobeBinding = int(&b - world_->bindings_.data());
        r.lobeOrigin = p.P;
    }
    r.parted |= ray.medium() >= 0 || r.medium() >= 0;
    r.vertex = childVertex(ray.vertex, 0xfffff, 0);
    ++r.layers;
    if (r.layers > limits::kPathDepth / 32 || !(r.maxDistance > 0)) {
        ++counters.depthCap;
        return;
    }
    if (ray.extra >= 0) {
        RayExtra extra = extraOf(ray);
        extra.part = extra.part * t / chosen;
        extra.way += travelled;
        r.extra = newExtra(extra);
    }
    sched.spawn(r.bounces + r.layers, target, r);
}

void Engine::misses(std::span<const Sched::Task* const> tasks, Sched& sched) {
    for (const Sched::Task* t : tasks) // the map of a trace()
        if (const PathRay& r = t->payload; maxComponent(extraOf(r).environment) > 0) {
            deposit(sched, {t->target, r.weight * extraOf(r).environment, LightEvent::Map, &r, extraOf(r).share, nullptr,
                            pathEvent(r.path, map_)});
            if (TraceSums* sums = sumsOf(t->target)) sums->add(TraceSums::Environment, r.weight * extraOf(r).environment);
        }
    if (photonTrace_ || tasks.empty()) return;
    std::vector<ShadePoint> q;
    std::vector<const Sched::Task*> of;
    std::vector<LightValue> value;
    for (const int number : world_->skies_) {
        const BoundLight& l = world_->lights_[size_t(number)];
        if (l.kind == LightKind::Ambient) continue; // ambient() asks for it
        // Outside of path a sky is a light of loops, or a background of rays.
        if (!rules_.emissionCounts && (l.kind != LightKind::Environment || l.strategy != LightStrategy::Trace)) continue;
        q.clear();
        of.clear();
        litBy_.clear();
        for (const Sched::Task* t : tasks) {
            const PathRay& r = t->payload;
            if (!l.seenBy(*r.kind)) continue;
            // A lobe that samples lights: those that are off for its surface do not light it by chance either.
            if (r.lobeBinding >= 0 && !world_->bindings_[size_t(r.lobeBinding)].lights.contains(number)) continue;
            if (bringsPhotons(r, number)) continue;
            ShadePoint& p = q.emplace_back();
            p.Ps = r.origin;
            p.P = r.origin + r.dir;
            p.N = -r.dir;
            p.shutter = world_->shadesAtOpen_ ? 0 : r.shutter();
            world_->tellTime(p);
            p.ray = &r;
            of.push_back(t);
            litBy_.push_back(extraOf(r).lit);
        }
        value.assign(q.size(), {});
        LitSurface lit;
        if (l.asksSurface) lit = litBy(litBy_);
        evaluateLight(l, q, value, {.lit = l.asksSurface ? &lit : nullptr});
        for (size_t i = 0; i < of.size(); ++i)
            if (value[i].lit) {
                const PathRay& r = of[i]->payload;
                const bool weighed = r.bounces > 0 && !r.kind->fromTrace; // met by a lobe of a lighting shadeop
                float weight = weighed ? value[i].kept(r.type()) : 1.f;
                if (l.sky && r.lobePdf >= 0) { // its lobe has sampled this sky
                    float pdf = l.sky->pdf(r.dir);
                    if (rules_.pickOne && r.lobeBinding >= 0) pdf *= chanceOf(number, r.lobeBinding, r.lobeOrigin, r.bounces - 1);
                    weight *= world_->settings_.lightOnly ? 0 : misWeight(r.lobePdf, pdf);
                }
                const Color light = r.weight * value[i].Cl * weight;
                deposit(sched,
                        {of[i]->target, light, LightEvent::Sky, &r, extraOf(r).share, l.instance.get(), atLight(r.path, l)});
            }
    }
}

void Engine::emission(std::span<const Met> met, Sched& sched) {
    const Settings& set = world_->settings_;
    std::vector<ShadePoint> q;
    std::vector<LightValue> value;
    for (size_t first = 0, end; first < met.size(); first = end) {
        q.clear();
        litBy_.clear();
        for (end = first; end < met.size() && met[end].light == met[first].light; ++end) {
            const PathRay& r = *met[end].point->ray;
            q.push_back(*met[end].point);
            ShadePoint& p = q.back();
            p.P = meetsAt(p.surface);
            p.N = p.surface.n;
            p.Ps = r.lobePdf >= 0 ? r.lobeOrigin : r.volumeBegin();
            litBy_.push_back(extraOf(r).lit);
        }
        const BoundLight& light = world_->lights_[size_t(met[first].light)];
        value.assign(q.size(), {});
        LitSurface lit;
        if (light.asksSurface) lit = litBy(litBy_);
        std::vector<char> inMedium;
        if (!world_->media_.empty())
            for (size_t i = first; i < end; ++i) inMedium.push_back(met[i].point->ray->medium() >= 0);
        evaluateLight(light, q, value,
                      {.lit = light.asksSurface ? &lit : nullptr, .inMedium = inMedium.empty() ? nullptr : &inMedium});
        for (size_t i = 0; i < inMedium.size(); ++i) {
            if (!inMedium[i] || !value[i].lit) continue;
            const PathRay& r = *met[first + i].point->ray;
            if (world_->media_[size_t(r.medium())].homogeneous) continue; // its flight has gone through it
            const MediumPart part{r.medium(), 0, r.volumeBegin(), met[first + i].point->P};
            ShadowRay way{};
            way.ray = &r;
            way.time = world_->shutterOf(r);
            dim({&part, 1}, {&way, 1}, {&value[i].Cl, 1});
        }
        for (size_t i = first; i < end; ++i) {
            const LightValue& v = value[i - first];
            const ShadePoint& p = *met[i].point;
            const PathRay& r = *p.ray;
            if (v.lit && !isFinite(v.Cl)) notFinite(&r, "Cl", light.instance.get());
            if (!v.lit || v.Cl == Color(0) || !isFinite(v.Cl) || bringsPhotons(r, met[i].light)) continue;
            float weight = 1;
            if (r.lobePdf >= 0 && light.emitter && light.importance) {
                float pdf = light.emitter->pdf(p.shape, p.surface, r.lobeOrigin);
                if (rules_.pickOne && r.lobeBinding >= 0)
                    pdf *= chanceOf(met[i].light, r.lobeBinding, r.lobeOrigin, r.bounces - 1);
                weight = set.lightOnly ? 0 : misWeight(r.lobePdf, pdf);
            }
            if (const FreeFlight& flown = extraOf(r).flown; flown.medium >= 0 && r.lobeBinding >= 0)
                weight *= MediumFlights::shareOfDistance(*this, flown, light);
            if (r.bounces > 0 && !r.kind->fromTrace) weight *= v.kept(r.type());
            deposit(sched, {met[i].target, r.weight * v.Cl * weight, LightEvent::Met, &r, extraOf(r).share, light.instance.get(),
                            atLight(r.path, light)});
            if (TraceSums* sums = sumsOf(met[i].target); sums && maxComponent(extraOf(r).part) > 0)
                sums->add(TraceSums::AreaLight, r.weight * v.Cl * weight);
        }
    }
}

} // namespace alpenglow::transport
