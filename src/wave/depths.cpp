// What deep shadow maps see: along each camera ray the light that is left behind every surface (Lokovic, Veach 2000).
#include "wave/engine.h"

namespace alpenglow::transport {

/// Surfaces are those that camera rays meet; what each takes is the opacity that it has for shadow rays. Shaders that give it
/// run for all rays that have come to one, wave by wave.
bool Engine::seeThrough(std::span<const CameraRay> rays, std::span<SampleResult> out) {
    struct Going { accel::Ray ray; size_t index; Color left{1}; };
    samples_.resize(rays.size());
    std::vector<PathRay> paths(rays.size());
    std::vector<ShadowRay> asked(rays.size());
    std::vector<Going> now, next;
    std::vector<OpacityQuery> met;
    counters.camera += rays.size();
    if (!world_->accel_) return true;
    for (size_t i = 0; i < rays.size(); ++i) {
        out[i].left.clear();
        beginRay(rays[i], i, paths[i]);
        now.push_back({rayOf(paths[i]), i});
        ShadowRay& s = asked[i];
        s.origin = paths[i].origin;
        s.dir = paths[i].dir;
        s.time = now.back().ray.time;
        s.ray = &paths[i];
        s.kind = paths[i].kind;
    }
    const auto takes = [&](Going& g, const Color& opacity, float z) {
        g.left *= Color(1) - opacity;
        if (opacity != Color(0)) out[g.index].left.push_back({z, g.left});
        return maxComponent(g.left) > 0;
    };
    struct Waiting { size_t going; float z; };
    std::vector<Waiting> waiting;
    for (int layers = 0; !now.empty() && layers < limits::kShadowLayers; ++layers) {
        next.clear(), met.clear(), waiting.clear();
        for (Going& g : now) {
            accel::Hit h;
            if (!world_->accel_->intersect(g.ray, h)) continue;
            const int binding = world_->bindingOf_[h.shape];
            world_->goOn(g.ray, h);
            const geometry::SurfacePoint at = world_->accel_->point(h);
            const float z = at.displaced ? at.displacedP.z : at.P.z;
            const Opacity& opacity = world_->bindings_[size_t(binding)].opacityFor(shading::HitMode::Default);
            if (opacity.kernel) {
                met.push_back({binding, h, &asked[g.index], &opacity.kernel});
                waiting.push_back({next.size(), z});
            } else if (!takes(g, opacity.constant, z)) {
                continue;
            }
            next.push_back(g);
        }
        if (!met.empty())
            takeOpacities(met, [&](size_t k, const Color& opacity) { takes(next[waiting[k].going], opacity, waiting[k].z); });
        std::erase_if(next, [](const Going& g) { return !(maxComponent(g.left) > 0); });
        now.swap(next);
        if (stop && *stop) return false;
    }
    counters.depthCap += now.size();
    return true;
}

} // namespace alpenglow::transport
