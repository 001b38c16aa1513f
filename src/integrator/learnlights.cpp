// Learns guides for light samples (world/lightguide.h) from the light samples of some paths that are not those of the picture.
#include "integrator/integrator.h"
#include "integrator/pipeline.h"
#include "integrator/shadowrays.h"
#include "world/lightguide.h"
#include "world/procedurals.h"
#include <algorithm>

namespace alpenglow::integrator {

namespace {

constexpr size_t kAtOnce = 1024;       ///< paths traced together: their rays fit into the cache of a core
constexpr double kLeastFollowing = .3; ///< with fewer samples where a guide is used it is not worth its look-ups
constexpr size_t kFewest = 40;         ///< samples of a light

bool mayTrace(const WorldImpl& w) {
    if (hasDeferred(w)) return false; // the world may be replaced while rays are traced
    const auto bakes = [](const SiteInfo& s) { return s.kind == SiteKind::Bake || s.kind == SiteKind::Bake3d; };
    return std::none_of(w.bindings().begin(), w.bindings().end(), [&](const SurfaceBinding& b) { // they would be baked, too
        return b.surfaceS && std::any_of(b.surfaceS.sites.begin(), b.surfaceS.sites.end(), bakes);
    });
}

bool mayGuide(const WorldImpl& w, const BoundLight& l) {
    if (!l.kernel || !l.importance || l.mean || l.inAtmosphere || l.instance->moving) return false;
    return l.isSky() || (l.kind == LightKind::Area && l.emitter && l.emitter->followsDirections() && !w.accel().hasSolids());
}

LightDomain domainOf(const BoundLight& l) { return l.isSky() ? LightDomain() : LightDomain(l.emitter->flat()[0]); }

} // namespace

bool mayTraceBefore(const World& world) {
    const auto* w = dynamic_cast<const WorldImpl*>(&world); // null: a picture that is known, as tests have it
    return w && w->canTrace() && w->settings().hider == Hider::Path && mayTrace(*w);
}

bool mayGuideLights(const World& world) {
    if (!mayTraceBefore(world)) return false;
    const auto& w = static_cast<const WorldImpl&>(world);
    if (!w.photons()) return false;
    for (const WorldImpl::LightList& l : w.lightLists())
        if (l.ofAll || !l.chooser.empty()) return false;
    return std::any_of(w.lights().begin(), w.lights().end(), [&](const BoundLight& l) { return mayGuide(w, l); });
}

void forgetLights(const World& world) { static_cast<const WorldImpl&>(world).photons()->lightGuides.clear(); }

bool learnLights(const std::shared_ptr<const World>& world, std::span<const CameraRay> rays, Diagnostics& d, const StopFlag* stop,
                 LightGuideFigures& f) {
    const auto of = std::static_pointer_cast<const WorldImpl>(world);
    Pipeline pipeline(of, d);
    std::vector<SeenSample> seen;
    pipeline.stages().context.seen = &seen;
    std::vector<SampleResult> results(std::min(rays.size(), kAtOnce));
    for (size_t first = 0; first < rays.size(); first += kAtOnce) {
        const auto some = rays.subspan(first, std::min(kAtOnce, rays.size() - first));
        if (!pipeline.trace(some, std::span(results).first(some.size()), stop)) return false;
    }
    std::vector<std::vector<SeenLight>> by(of->lights().size());
    std::vector<Vec3> blocked;
    for (const SeenSample& s : seen)
        if (s.light == SeenSample::kBlocked) blocked.push_back(s.seen.P);
        else if (mayGuide(*of, of->lights()[size_t(s.light)]) && std::isfinite(s.seen.weight) &&
                 (s.seen.pdf > 0 || of->lights()[size_t(s.light)].guidable))
            by[size_t(s.light)].push_back(s.seen);
    f = {};
    LightGuides guides(by.size());
    for (size_t i = 0; i < by.size(); ++i) {
        if (by[i].size() < kFewest) continue;
        const BoundLight& l = of->lights()[i];
        const auto guide = l.guidable ? std::make_shared<const LightGuide>(domainOf(l), by[i], blocked)
                                      : std::make_shared<const LightGuide>(domainOf(l), by[i]);
        f.samples += by[i].size();
        f.cells += guide->cells();
        const auto follows = std::count_if(by[i].begin(), by[i].end(), [&](const SeenLight& s) { return guide->find(s.P); });
        if (!(double(follows) > kLeastFollowing * double(by[i].size()))) continue;
        ++f.lights;
        f.used += guide->used();
        guides[i] = guide;
    }
    if (f.lights == 0) guides.clear();
    of->photons()->lightGuides = std::move(guides);
    return true;
}

} // namespace alpenglow::integrator
