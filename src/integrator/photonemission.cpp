#include "integrator/integrator.h"
#include "integrator/photonstage.h"
#include "integrator/pipeline.h"

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
