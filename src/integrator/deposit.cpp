// Light that reaches a target. All of it comes through here.
#include "integrator/engine.h"

namespace alpenglow::transport {

void Engine::deposit(Sched& sched, const Deposit& d) {
    if (!isFinite(d.light) && d.event != LightEvent::Output) // of those the target keeps count
        return notFinite(d.path, d.event == LightEvent::Sampled ? "light that is sampled" : "light", d.of);
    sched.add(d.target, d.light);
    depositPart(sched, d.path, d.end, d.light);
    for (int32_t share = d.share; share >= 0; share = shares_[size_t(share)].next)
        sched.add(shares_[size_t(share)].target, d.light * shares_[size_t(share)].ratio);
}

void Engine::depositPart(Sched& sched, const PathRay* path, uint16_t end, const Color& light) {
    if (end == 0 || !path || !path->sample || !isFinite(light)) return;
    const size_t parts = size_t(lightPaths_->parts());
    sched.add(partTargets_[size_t(path->sample->path) * parts + size_t(lightPaths_->part(end))], light);
}

} // namespace alpenglow::transport
