// Deep shadow maps: transmittance along camera rays, behind every surface and within media (Lokovic and Veach 2000).
#include "integrator/depthrays.h"
#include "base/exact.h"
#include "integrator/context.h"
#include "integrator/intersector.h"
#include "integrator/mediastacks.h"
#include "integrator/opacities.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

DepthRays::DepthRays(const StageSet& s)
    : Stage(s.context), intersector_(s.intersector), media_(s.media), opacities_(s.opacities) {}

namespace {

/// Largest fraction of the light that a step within a medium removes, if there are enough steps.
constexpr float kAtmosphereStep = 1 / 64.f;
constexpr int kAtmosphereSteps = 64;

/// Ends of steps of equal attenuation along a homogeneous segment with transmittance `left`, as fractions of its length.
std::vector<float> atmosphereSteps(const Color& left) {
    const float least = std::clamp(std::min({left.x, left.y, left.z}), 1e-4f, 1.f);
    const int count = std::clamp(int((1 - least) / kAtmosphereStep) + 1, 1, kAtmosphereSteps);
    std::vector<float> ends;
    for (int k = 1; k < count; ++k) {
        const double l = exact::log(double(least));
        ends.push_back(float(exact::log(1 - (1 - double(least)) * k / count) / l));
    }
    ends.push_back(1);
    return ends;
}

/// A segment of a camera ray within a medium; its sample, and its index among the rays in flight.
struct AtmosphereSegment {
    int medium;
    size_t sample, going;
    Vec3 from, to;
};

/// Appends the segments within media up to a hit.
void enterMedia(const WorldImpl& world, const shading::Media* m, const Vec3& begin, const accel::Hit& h, size_t sample,
                size_t going, std::vector<AtmosphereSegment>& ways) {
    if (!m || m->top() < 0) return;
    const geometry::SurfacePoint at = world.accel().point(h);
    ways.push_back({m->top(), sample, going, begin, at.displaced ? at.displacedP : at.P});
}

/// Appends the transmittance within the segments; `left`, by segment: on entry before it, on exit behind it.
void seeAtmosphere(MediaStacks& media, std::span<const AtmosphereSegment> ways, std::span<const ShadowRay> asked,
                   std::span<SampleResult> out, std::span<Color> left) {
    // First the transmittance of each whole segment: it determines the number of steps.
    std::vector<ShadowRay> rays;
    std::vector<MediumPart> parts;
    for (const AtmosphereSegment& w : ways) {
        parts.push_back({w.medium, rays.size(), w.from, w.to});
        rays.push_back(asked[w.sample]);
    }
    std::vector<Color> whole(rays.size(), Color(1)), some;
    media.dim(parts, rays, whole);
    rays.clear(), parts.clear();
    std::vector<float> z;
    std::vector<size_t> of;
    for (size_t i = 0; i < ways.size(); ++i) {
        float begin = 0;
        for (const float end : atmosphereSteps(whole[i])) {
            const AtmosphereSegment& w = ways[i];
            const Vec3 way = w.to - w.from;
            parts.push_back({w.medium, rays.size(), w.from + way * begin, w.from + way * end});
            rays.push_back(asked[w.sample]);
            z.push_back((w.from + way * (.5f * (begin + end))).z); // the middle: the error of the staircase has mean 0
            of.push_back(i);
            begin = end;
        }
    }
    some.assign(rays.size(), Color(1));
    media.dim(parts, rays, some);
    for (size_t k = 0; k < some.size(); ++k) {
        Color& l = left[of[k]];
        if (some[k] == Color(1)) continue;
        l *= some[k];
        out[ways[of[k]].sample].transmittance.push_back({z[k], l});
    }
}

} // namespace

/// Traces camera rays through the surfaces that they hit; each attenuates by its opacity for shadow rays. Opacity shaders run for
/// all rays that have reached a surface, wave by wave.
class DepthRays::Looking {
public:
    Looking(DepthRays& stage, std::span<SampleResult> out) : stage_(stage), world_(stage.world_), out_(out) {}
    void add(const PathRay&); ///< the next camera ray, which must not move
    bool run();

private:
    struct Going {
        accel::Ray ray;
        size_t index;
        const shading::Media* media;
        Vec3 begin;
        Color transmittance{1};
    };
    struct Waiting {
        size_t going;
        float z;
        const scene::Attributes* surface;
    };
    bool takes(Going&, const Color& opacity, float z, const scene::Attributes* surface);
    void intersect();
    void pass(Going&, const accel::Hit&);
    DepthRays& stage_;
    const WorldImpl& world_;
    std::span<SampleResult> out_;
    std::vector<ShadowRay> asked_; ///< by ray, for the opacity shaders
    std::vector<Going> now_, next_;
    std::vector<accel::Hit> hits_; ///< by now_
    std::vector<OpacityQuery> met_;
    std::vector<Waiting> waiting_; ///< rays in met_: index in next_, and depth
    std::vector<AtmosphereSegment> ways_;
    std::vector<Color> inAtmosphere_;
};

void DepthRays::Looking::add(const PathRay& path) {
    out_[asked_.size()].transmittance.clear();
    now_.push_back({stage_.intersector_.rayOf(path), asked_.size(), path.media, path.origin});
    ShadowRay& s = asked_.emplace_back();
    s.origin = path.origin;
    s.dir = path.dir;
    s.time = now_.back().ray.time;
    s.ray = &path;
    s.kind = path.kind;
}

bool DepthRays::Looking::takes(Going& g, const Color& opacity, float z, const scene::Attributes* surface) {
    g.transmittance *= Color(1) - opacity;
    if (opacity != Color(0)) out_[g.index].transmittance.push_back({z, g.transmittance, surface});
    return maxComponent(g.transmittance) > 0;
}

/// Finds the next surface of each ray and applies the media before it.
void DepthRays::Looking::intersect() {
    hits_.assign(now_.size(), {});
    ways_.clear();
    for (size_t i = 0; i < now_.size(); ++i)
        if (stage_.intersector_.intersect(now_[i].ray, hits_[i]) && !world_.media().empty())
            enterMedia(world_, now_[i].media, now_[i].begin, hits_[i], now_[i].index, i, ways_);
    if (ways_.empty()) return;
    inAtmosphere_.clear();
    for (const AtmosphereSegment& w : ways_) inAtmosphere_.push_back(now_[w.going].transmittance);
    seeAtmosphere(stage_.media_, ways_, asked_, out_, inAtmosphere_);
    for (size_t k = 0; k < ways_.size(); ++k) now_[ways_[k].going].transmittance = inAtmosphere_[k];
}

void DepthRays::Looking::pass(Going& g, const accel::Hit& h) {
    const int binding = world_.bindingOf()[h.shape];
    const SurfaceBinding& b = world_.bindings()[size_t(binding)];
    world_.goOn(g.ray, h);
    const geometry::SurfacePoint at = world_.accel().point(h);
    const Vec3& P = at.displaced ? at.displacedP : at.P;
    if (!world_.media().empty()) {
        const bool overruled = b.overruled(g.media);
        g.media = stage_.media_.beyond(b, g.media, at.n, g.ray.dir, g.ray.dir);
        g.begin = P;
        if (overruled) return next_.push_back(g);
    }
    const Opacity& opacity = b.opacityFor(shading::HitMode::Default);
    const scene::Attributes* own = &world_.shapes()[h.shape]->attributes(); // bindings are shared by shapes of other names
    if (opacity.kernel) {
        met_.push_back({binding, h, &asked_[g.index], &opacity.kernel});
        waiting_.push_back({next_.size(), P.z, own});
    } else if (!takes(g, opacity.constant, P.z, own)) {
        return;
    }
    next_.push_back(g);
}

bool DepthRays::Looking::run() {
    const StopFlag* const stop = stage_.context_.stop;
    for (int layers = 0; !now_.empty() && layers < limits::kShadowLayers; ++layers) {
        next_.clear(), met_.clear(), waiting_.clear();
        intersect();
        for (size_t i = 0; i < now_.size(); ++i)
            if (hits_[i].valid() && maxComponent(now_[i].transmittance) > 0) pass(now_[i], hits_[i]);
        if (!met_.empty())
            stage_.opacities_.takeOpacities(met_, [&](size_t k, const Color& opacity) {
                const Waiting& w = waiting_[k];
                takes(next_[w.going], opacity, w.z, w.surface);
            });
        std::erase_if(next_, [](const Going& g) { return !(maxComponent(g.transmittance) > 0); });
        now_.swap(next_);
        if (stop && *stop) return false;
    }
    stage_.counters_.depthCap += now_.size();
    return true;
}

bool DepthRays::seeThrough(std::span<const CameraRay> rays, std::span<SampleResult> out,
                           const std::function<void(const CameraRay&, size_t, PathRay&)>& begin) {
    counters_.camera += rays.size();
    if (!world_.canTrace()) return true;
    std::vector<PathRay> paths(rays.size());
    Looking looking(*this, out);
    for (size_t i = 0; i < rays.size(); ++i) {
        begin(rays[i], i, paths[i]);
        looking.add(paths[i]);
    }
    return looking.run();
}

} // namespace alpenglow::integrator
