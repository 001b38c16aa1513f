// Kernels that wait for rays: starts strips, makes their requests together, resumes them.
#include "integrator/waitingkernels.h"
#include "integrator/accumulator.h"
#include "integrator/batchpool.h"
#include "integrator/context.h"
#include "integrator/gathercalls.h"
#include "integrator/requests.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "integrator/strips.h"
#include "integrator/surfaceshading.h"
#include "integrator/vertexlight.h"
#include <algorithm>

namespace alpenglow::integrator {

WaitingKernels::WaitingKernels(const StageSet& s)
    : Stage(s.context), accumulator(s.accumulator), gathers(s.gathers), requests(s.requests), shadows(s.shadows),
      shading(s.shading), batches_(s.batches), vertexLight_(s.vertexLight) {}

void WaitingKernels::start(const std::shared_ptr<BatchContext>& c, Sched& sched) {
    const auto& kernel = *c->bound->kernel;
    const int n = int(c->points.size());
    for (int first = 0; first < n; first += kernel.lanes()) {
        for (int i = first; i < std::min(first + kernel.lanes(), n); ++i) sched.hold(c->targets[i]);
        void* h = kernel.start(&c->batch->call(), first);
        if (!h) {
            ++counters_.overLimit;
            for (int i = first; i < std::min(first + kernel.lanes(), n); ++i) sched.release(c->targets[i]);
            continue;
        }
        frameOf_[&kernel] = std::max<size_t>(c->frame, 1);
        auto strip = std::make_unique<KernelStrip>(*this, c, h, first, c->rays[first].bounces + c->rays[first].layers);
        c->ran();
        KernelStrip* s = strip.get();
        s->advance(sched, std::move(strip));
    }
    follow(sched);
}

void WaitingKernels::follow(Sched& sched) {
    // Strips of a batch are consecutive: it started them, and they resume in that order.
    std::vector<KernelStrip*> strips;
    strips.swap(waiting);
    for (size_t first = 0, end; first < strips.size(); first = end) {
        const std::shared_ptr<BatchContext> c = strips[first]->context();
        for (end = first; end < strips.size() && strips[end]->context() == c;) ++end;
        const auto together = std::span(strips).subspan(first, end - first);
        if (!vertexLight_.run(*c, together, sched)) {
            for (KernelStrip* s : together) s->ask(sched);
            vertexLight_.gather(*c, sched);
        }
        shadows.flush(sched);
        for (size_t k = first; k < end; ++k) strips[k]->asked(sched);
    }
}

StripMemory WaitingKernels::takeMemory() {
    if (memory_.empty()) return {};
    StripMemory m = std::move(memory_.back());
    memory_.pop_back();
    m.occurrences.clear();
    return m;
}

void WaitingKernels::giveBack(StripMemory m, std::shared_ptr<BatchContext> c) {
    constexpr size_t kMost = 512;
    if (memory_.size() < kMost) memory_.push_back(std::move(m));
    batches_.giveBack(std::move(c));
}

int WaitingKernels::roomFor(const rsl::CompiledKernel& k, const rsl::CompiledKernel* other, const Sched& sched) const {
    size_t frame = 0;
    for (const rsl::CompiledKernel* one : {&k, other})
        if (const auto known = frameOf_.find(one); known != frameOf_.end()) frame = std::max(frame, known->second);
    if (frame == 0) return k.lanes(); // unknown before the first strip
    const size_t most = sched.frameLimit() / 4, left = most - std::min(most, sched.frameBytes());
    return int(std::clamp<size_t>(left / frame, 1, size_t(limits::kSliceRays))) * k.lanes();
}

} // namespace alpenglow::integrator
