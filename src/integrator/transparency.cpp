#include "integrator/transparency.h"
#include "bsdf/sampling.h"
#include "integrator/context.h"
#include "integrator/guiderays.h"
#include "integrator/lightpathstates.h"
#include "integrator/mediastacks.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

Transparency::Transparency(const StageSet& s)
    : Stage(s.context), guide_(s.guide), paths_(s.paths), media_(s.media), photons_(s.photons), store_(s.store) {}

bool isOpaque(const shading::Batch& b) {
    const int oi = b.plan().Oi;
    for (int k = 0; k < 3 && oi >= 0; ++k)
        for (const float o : b.row(oi, k))
            if (o != 1) return false;
    return true;
}

Color Transparency::leftBehind(const BatchContext& c, int i) const {
    // An atmosphere continues behind a transparent surface, as if it were absent. A medium ends there, and another one begins.
    if (world_.media().empty() || c.atmosphereEffects.empty() || !c.atmosphereEffects[size_t(i)].on) return Color(1);
    const PathRay& ray = c.rays[size_t(i)];
    const SurfaceBinding& binding = world_.bindings()[size_t(c.bindings[size_t(i)])];
    const bool ends =
        ray.medium() >= 0 ||
        binding.beyond(ray.media ? *ray.media : shading::Media(), c.points[size_t(i)].surface.n, ray.dir, ray.dir).top() >= 0;
    return ends ? c.atmosphereEffects[size_t(i)].slope : Color(1);
}

Color Transparency::clearAt(const BatchContext& c, int i) const {
    if (photons_.photonTrace() && photons_.photonTrace()->job->models)
        if (const PhotonModel m = world_.bindings()[size_t(c.bindings[size_t(i)])].photons.model; m != PhotonModel::Shader)
            return Color(m == PhotonModel::Transparent) * leftBehind(c, i);
    const shading::Batch& b = *c.batch;
    const int oi = b.plan().Oi;
    if (oi < 0) return Color(0);
    Color clear = (Color(1) - b.color(oi, i)) * leftBehind(c, i);
    for (int k = 0; k < 3; ++k) clear[k] = clear[k] > 0 ? std::min(clear[k], 1.f) : 0; // not a number: opaque
    return clear;
}

/// Sets the transparency at each point, for the choice of the continuation.
void Transparency::setTransparency(BatchContext& c) {
    c.clear.resize(c.points.size());
    for (size_t i = 0; i < c.points.size(); ++i) c.clear[i] = clearAt(c, int(i));
    c.passes.assign(c.points.size(), 1.f);
}

/// A surface with Sides 1 is invisible from behind. Photons travel in reverse: those from the front are scattered, and also pass
/// straight on for viewers behind; those from behind are scattered only.
Color Transparency::goesOn(const BatchContext& c, int i) const {
    const ShadePoint& p = c.points[size_t(i)];
    if (photons_.photonTrace() && p.shape->oneSided() && dot(c.rays[size_t(i)].dir, intersectsNormal(p.surface)) < 0)
        return leftBehind(c, i);
    return c.clear.empty() ? clearAt(c, i) : c.clear[size_t(i)];
}

void Transparency::continueBehind(const SurfaceBinding& b, const PathRay& ray, AccumulatorId target, const ShadePoint& p,
                                  const Color& transparency, float chance, uint32_t asked, Sched& sched) {
    if (ray.quiet) return;
    const Color t = transparency / chance;
    PathRay r = ray;
    const RayExtra& had = store_.extraOf(ray);
    r.weight = (had.fade.fades() || had.indirect != 1 ? had.whole : ray.weight) * t;
    float chosen = 1;
    const Settings& set = world_.settings();
    // Camera rays always continue behind surfaces, so that opacity, depth and AOVs are exact.
    if (rules_.roulette && ray.bounces > 0) {
        const int depth = ray.bounces + ray.layers + 1;
        auto dice = [&] { return store_.random(ray).one(ray.vertex, kPassThrough, 0); };
        float q = 1;
        if (asked > 0) { // one more of the rays that the kernel requested
            r.asked = uint16_t(std::min<uint32_t>(std::max<uint32_t>(ray.asked, asked + 1), 0xffff));
            q = std::min(rouletteWaiting(ray.bounces, ray.asked, asked, 1), maxComponent(transparency));
            if (q < 1 && dice() >= q) q = 0;
        } else if (set.localRoulette) {
            q = rouletteLocal(depth, t, depth > 3 ? dice() : 0);
        } else if (depth > 3) {
            const Color left(std::fabs(r.weight.x), std::fabs(r.weight.y), std::fabs(r.weight.z));
            q = world_.lightTraces() > 0 ? rouletteLocal(depth, left, dice()) : rouletteOfPath(r.weight, dice);
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
    if (r.passed) r.shadowDiffers |= b.opacity.differs;
    guide_.continueBehind(r, int(&b - world_.bindings().data()));
    r.path = paths_.next(ray.path, paths_.straight);
    r.media = media_.beyond(b, ray.media, p.surface.n, ray.dir, ray.dir);
    media_.reportLost(r.media, p);
    if (photons_.photonTrace() && (ray.medium() >= 0 || r.medium() >= 0)) { // from here on in another volume
        r.lobeBinding = int(&b - world_.bindings().data());
        r.lobeOrigin = p.P;
    }
    r.crossedMedium |= ray.medium() >= 0 || r.medium() >= 0;
    r.vertex = childVertex(ray.vertex, 0xfffff, 0);
    ++r.layers;
    if (r.layers > limits::kPathDepth / 32 || !(r.maxDistance > 0)) {
        ++counters_.depthCap;
        return;
    }
    if (ray.extra >= 0) {
        RayExtra extra = store_.extraOf(ray);
        extra.part = extra.part * t / chosen;
        extra.way += travelled;
        r.extra = store_.newExtra(extra);
    }
    sched.spawn(r.bounces + r.layers, target, r);
}

} // namespace alpenglow::integrator
