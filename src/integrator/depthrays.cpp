// What deep shadow maps see: along each camera ray the light that is left behind every surface, and within media (Lokovic, Veach
// 2000).
#include "base/exact.h"
#include "integrator/engine.h"

namespace alpenglow::transport {

namespace {

/// A step of light within a medium takes no more than this part of what comes to it, as long as there are enough of them.
constexpr float kHazeStep = 1 / 64.f;
constexpr int kHazeSteps = 64;

/// Where steps of equal light end on a way through a medium that leaves `left` of it, were it the same all along: parts of the
/// way.
std::vector<float> hazeSteps(const Color& left) {
    const float least = std::clamp(std::min({left.x, left.y, left.z}), 1e-4f, 1.f);
    const int count = std::clamp(int((1 - least) / kHazeStep) + 1, 1, kHazeSteps);
    std::vector<float> ends;
    for (int k = 1; k < count; ++k) {
        const double l = exact::log(double(least));
        ends.push_back(float(exact::log(1 - (1 - double(least)) * k / count) / l));
    }
    ends.push_back(1);
    return ends;
}

/// A part of a camera ray within a medium; its sample, and its number among those that are on their way.
struct HazyWay {
    int medium;
    size_t sample, going;
    Vec3 from, to;
};

/// A way through a medium up to a hit.
void enterMedia(const Engine& e, const shading::Media* m, const Vec3& begin, const accel::Hit& h, size_t sample, size_t going,
                std::vector<HazyWay>& ways) {
    if (!m || m->top() < 0) return;
    const geometry::SurfacePoint at = e.world().accel_->point(h);
    ways.push_back({m->top(), sample, going, begin, at.displaced ? at.displacedP : at.P});
}

/// Adds what is left within them; `left`, by way: what comes to it, and then what leaves it.
void seeHaze(Engine& e, std::span<const HazyWay> ways, std::span<const ShadowRay> asked, std::span<SampleResult> out,
             std::span<Color> left) {
    // All of each way first: it says how finely to cut.
    std::vector<ShadowRay> rays;
    std::vector<Engine::MediumPart> parts;
    for (const HazyWay& w : ways) {
        parts.push_back({w.medium, rays.size(), w.from, w.to});
        rays.push_back(asked[w.sample]);
    }
    std::vector<Color> whole(rays.size(), Color(1)), some;
    e.dim(parts, rays, whole);
    rays.clear(), parts.clear();
    std::vector<float> z;
    std::vector<size_t> of;
    for (size_t i = 0; i < ways.size(); ++i) {
        float begin = 0;
        for (const float end : hazeSteps(whole[i])) {
            const HazyWay& w = ways[i];
            const Vec3 way = w.to - w.from;
            parts.push_back({w.medium, rays.size(), w.from + way * begin, w.from + way * end});
            rays.push_back(asked[w.sample]);
            z.push_back((w.from + way * (.5f * (begin + end))).z); // the middle: the staircase is as often above as below
            of.push_back(i);
            begin = end;
        }
    }
    some.assign(rays.size(), Color(1));
    e.dim(parts, rays, some);
    for (size_t k = 0; k < some.size(); ++k) {
        Color& l = left[of[k]];
        if (some[k] == Color(1)) continue;
        l *= some[k];
        out[ways[of[k]].sample].left.push_back({z[k], l});
    }
}

} // namespace

/// Surfaces are those that camera rays meet; what each takes is the opacity that it has for shadow rays. Shaders that give it
/// run for all rays that have come to one, wave by wave.
bool Engine::seeThrough(std::span<const CameraRay> rays, std::span<SampleResult> out) {
    struct Going {
        accel::Ray ray;
        size_t index;
        const shading::Media* media;
        Vec3 begin;
        Color left{1};
    };
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
        now.push_back({rayOf(paths[i]), i, paths[i].media, paths[i].origin});
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
    struct Waiting {
        size_t going;
        float z;
    };
    std::vector<Waiting> waiting;
    const bool media = !world_->media_.empty();
    std::vector<HazyWay> ways;
    std::vector<Color> hazy;
    for (int layers = 0; !now.empty() && layers < limits::kShadowLayers; ++layers) {
        next.clear(), met.clear(), waiting.clear(), ways.clear();
        std::vector<accel::Hit> hits(now.size());
        for (size_t i = 0; i < now.size(); ++i)
            if (meet(now[i].ray, hits[i]) && media) enterMedia(*this, now[i].media, now[i].begin, hits[i], now[i].index, i, ways);
        if (!ways.empty()) {
            hazy.clear();
            for (const HazyWay& w : ways) hazy.push_back(now[w.going].left);
            seeHaze(*this, ways, asked, out, hazy);
            for (size_t k = 0; k < ways.size(); ++k) now[ways[k].going].left = hazy[k];
        }
        for (size_t i = 0; i < now.size(); ++i) {
            Going& g = now[i];
            const accel::Hit& h = hits[i];
            if (!h.valid() || !(maxComponent(g.left) > 0)) continue;
            const int binding = world_->bindingOf_[h.shape];
            world_->goOn(g.ray, h);
            const geometry::SurfacePoint at = world_->accel_->point(h);
            const float z = at.displaced ? at.displacedP.z : at.P.z;
            if (media) {
                const SurfaceBinding& b = world_->bindings_[size_t(binding)];
                const bool overruled = b.overruled(g.media);
                g.media = mediaBeyond(b, g.media, at.n, g.ray.dir, g.ray.dir);
                g.begin = at.displaced ? at.displacedP : at.P;
                if (overruled) {
                    next.push_back(g);
                    continue;
                }
            }
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
