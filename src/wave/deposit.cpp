// Light that reaches a target. All of it comes through here.
#include "wave/engine.h"

namespace alpenglow::transport {

void Engine::deposit(Sched& sched, const Deposit& d) {
    if (!isFinite(d.light) && d.event != LightEvent::Output) // of those the target keeps count
        return notFinite(d.path, d.event == LightEvent::Sampled ? "light that is sampled" : "light", d.of);
    sched.add(d.target, d.light);
    for (int32_t share = d.share; share >= 0; share = shares_[size_t(share)].next)
        sched.add(shares_[size_t(share)].target, d.light * shares_[size_t(share)].ratio);
}

} // namespace alpenglow::transport
