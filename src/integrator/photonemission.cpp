#include "bsdf/sampling.h"
#include "integrator/emission.h"
#include "integrator/integrator.h"
#include "integrator/intersector.h"
#include "integrator/photonstage.h"
#include "integrator/pipeline.h"
#include <algorithm>

namespace alpenglow::integrator {

struct PhotonEmission::Impl {
    std::shared_ptr<const WorldImpl> world;
    std::unique_ptr<EmissionPlan> plan;
    std::vector<uint8_t> met;
    PhotonUse use;
    PhotonJob job(uint32_t pass, double emitted) const {
        PhotonJob j;
        j.plan = plan.get();
        j.met = met.data();
        j.seed = world->settings().seed;
        j.pass = pass;
        j.caustics = use.caustics;
        j.learns = use.learns;
        j.models = !use.caustics;
        j.width = use.caustics ? use.width : 0;
        j.scale = 1 / emitted;
        return j;
    }
};

PhotonEmission::PhotonEmission(std::shared_ptr<const World> w, const PhotonUse& use, Diagnostics& d)
    : impl_(std::make_unique<Impl>()) {
    impl_->world = std::static_pointer_cast<const WorldImpl>(std::move(w));
    impl_->use = use;
    const Pipeline pipeline(impl_->world, d);
    impl_->plan = std::make_unique<EmissionPlan>(pipeline.stages().lightKernels, use);
    impl_->met = impl_->plan->met(use.caustics);
}
PhotonEmission::~PhotonEmission() = default;
bool PhotonEmission::lights() const { return !impl_->plan->empty(); }
bool PhotonEmission::moves() const { return impl_->plan->moves(); }
double PhotonEmission::power() const {
    double sum = 0;
    for (const EmissionPlan::Light& l : impl_->plan->lights()) sum += l.power;
    return sum;
}
void PhotonEmission::learn(std::span<const StoredPhoton> stored, uint32_t pass, uint32_t emitted) {
    impl_->plan->learn(stored, impl_->job(pass, emitted), emitted);
}
void PhotonEmission::addSeeds(std::span<const StoredPhoton> stored, uint32_t pass, std::vector<CausticSeed>& to,
                              Diagnostics& d) const {
    Pipeline pipeline(impl_->world, d);
    const StageSet& set = pipeline.stages();
    const PhotonJob job = impl_->job(pass, 1);
    const WorldImpl& world = *impl_->world;
    const size_t before = to.size();
    std::vector<PhotonProbe> probes;
    for (const StoredPhoton& p : stored) {
        const float power = luminance(p.photon.power);
        EmissionStart s;
        s.drawn = impl_->plan->draw(job.numbers(p.number));
        if (!p.caustic || !(power > 0) || p.photon.bounces < 1 || s.drawn.light < 0) continue;
        const EmissionPlan::Light& l = impl_->plan->lights()[size_t(s.drawn.light)];
        startPhotons(set.lightKernels, *impl_->plan, l, {&s, 1});
        accel::Ray ray;
        ray.org = s.origin;
        ray.dir = s.dir;
        ray.time = world.shadesAtOpen() ? 0 : s.drawn.time;
        ray.only = job.met;
        ray.sides = accel::Sides::Both;
        accel::Hit hit;
        if (!set.intersector.intersect(ray, hit)) continue;
        const geometry::Bounds b = world.shapes()[hit.shape]->bounds();
        const bool distant = l.light->kind == LightKind::Distant;
        CausticSeed& seed = to.emplace_back();
        seed.light = l.number;
        seed.pass = pass;
        seed.number = p.number;
        seed.bounces = p.photon.bounces;
        seed.start = distant ? s.origin : s.dir;
        constexpr float kOfSize = 5e-4f; // differences lose kOfSize squared to curvature, 1e-7 / kOfSize to rounding
        seed.step =
            std::clamp(kOfSize * length(b.hi - b.lo) / (distant ? 1 : hit.t), distant ? 1e-5f : 5e-5f, distant ? 1e3f : 1e-3f);
        seed.P = p.photon.P;
        seed.dir = -p.photon.direction();
        seed.side = SurfaceTree::sideOf(photonmap::unpackUnit(p.photon.normal));
        seed.power = power;
        const Vec3 at = distant ? s.origin : s.dir;
        const Basis f(s.dir);
        for (const Vec3& by : {Vec3(0.f), f.t * seed.step, f.u * seed.step}) {
            PhotonProbe& probe = probes.emplace_back();
            probe.light = l.number;
            probe.origin = distant ? at + by : s.origin;
            probe.dir = distant ? s.dir : normalize(at + by);
            probe.time = s.drawn.time;
            probe.numbers = job.numbers(p.number);
            probe.bounces = seed.bounces;
        }
    }
    std::vector<ProbeEnd> ends(probes.size());
    if (!pipeline.probe(job, probes, ends, nullptr)) return;
    for (size_t i = before; i < to.size(); ++i) {
        const ProbeEnd* const e = &ends[3 * (i - before)];
        CausticSeed& seed = to[i];
        const auto at = [&](const ProbeEnd& end) {
            return end.origin + end.dir * (dot(seed.P - end.origin, e->dir) / dot(end.dir, e->dir));
        };
        if (!e->arrives) {
            seed.light = -1;
            continue;
        }
        seed.dir = e->dir;
        for (int k = 0; k < 2; ++k)
            if (e[k + 1].arrives) seed.columns[k] = (at(e[k + 1]) - at(*e)) / seed.step;
    }
    to.erase(std::remove_if(to.begin() + long(before), to.end(), [](const CausticSeed& s) { return s.light < 0; }), to.end());
}

void PhotonEmission::markPhotonLights() const {
    impl_->world->photons()->lightsOfPasses = impl_->plan->emits();
    impl_->world->photons()->widthOfPasses = impl_->use.width;
}

struct PhotonEmission::Thread::Impl {
    const PhotonEmission::Impl& of;
    Pipeline pipeline;
    Impl(const PhotonEmission::Impl& i, Diagnostics& d) : of(i), pipeline(i.world, d) {}
};
PhotonEmission::Thread::Thread(const PhotonEmission& e, Diagnostics& d) : impl_(std::make_unique<Impl>(*e.impl_, d)) {}
PhotonEmission::Thread::~Thread() = default;
bool PhotonEmission::Thread::emit(uint32_t pass, uint32_t first, uint32_t count, double emitted, std::vector<StoredPhoton>& out,
                                  const StopFlag* stop) {
    return impl_->pipeline.emit(impl_->of.job(pass, emitted), first, count, out, stop);
}
float PhotonEmission::Thread::travel() const {
    const PhotonTrace* t = impl_->pipeline.stages().photons.photonTrace();
    return std::max(t ? t->fastest : 0, impl_->of.plan->travel());
}
const Counters& PhotonEmission::Thread::counters() const { return impl_->pipeline.counters(); }

} // namespace alpenglow::integrator
