#include "integrator/hitqueues.h"
#include "base/memory.h"
#include "integrator/context.h"
#include "integrator/stageset.h"
#include "integrator/waitingkernels.h"

namespace alpenglow::integrator {

namespace {
constexpr size_t kBatchPoints = 256;  ///< a group with so many hits is shaded without waiting for more
constexpr size_t kWaitingHits = 4096; ///< for all groups, at most: their memory fits into the cache of a core
} // namespace

HitQueues::HitQueues(const StageSet& s) : Stage(s.context), waitingKernels_(s.waitingKernels) {}

void HitQueues::add(const Sched::Task& task, const accel::Hit& hit, Sched& sched) {
    const PathRay& r = task.payload;
    const SurfaceBinding& b = world_.bindings()[size_t(world_.bindingOf()[hit.shape])];
    const bool primitive = world_.primitiveHit() && b.asPrimitive(r.kind->set.mode, r.type());
    const size_t g = size_t(b.group) + (primitive ? size_t(world_.groups()) : 0);
    if (queues_.empty()) queues_.resize(size_t(world_.groups()) * (world_.primitiveHit() ? 2 : 1));
    Queue& q = queues_[g];
    if (q.hits.empty()) {
        const rsl::CompiledKernel& k = *(primitive ? world_.primitiveHit() : b.surfaceS).kernel;
        q.waits = k.facts().suspends;
        if (q.waits) q.room = size_t(waitingKernels_.roomFor(k, primitive ? nullptr : b.surfaceV.kernel.get(), sched));
        groups_.push_back(g);
    } else if (q.waits && q.hits.size() >= q.room) {
        // A waiting kernel shades no more points than its frames have memory for; the other rays are traced again later.
        --context_.raysOf(r.type());
        sched.spawn(task);
        return;
    }
    q.hits.push_back(hit);
    q.rays.push_back(r);
    q.targets.push_back(task.target);
    sched.hold(task.target);
    ++waiting_;
}

void HitQueues::take(size_t group, BatchContext& c) {
    Queue& q = queues_[group];
    std::erase(groups_, group);
    waiting_ -= q.hits.size();
    c.rays.swap(q.rays);
    c.targets.swap(q.targets);
    c.hits.swap(q.hits);
    for (const accel::Hit& h : c.hits) c.bindings.push_back(world_.bindingOf()[h.shape]);
}

void HitQueues::clear() {
    queues_.clear();
    groups_.clear();
    waiting_ = 0;
}

std::vector<size_t> HitQueues::ready(bool all) const {
    std::vector<size_t> some;
    for (size_t g : groups_)
        if (all || queues_[g].waits || queues_[g].hits.size() >= kBatchPoints) some.push_back(g);
    return some;
}

bool HitQueues::full() const { return waiting_ > kWaitingHits; }

size_t HitQueues::bytes() const {
    size_t sum = 0;
    for (const Queue& q : queues_) sum += bytesOf(q.hits) + bytesOf(q.rays) + bytesOf(q.targets);
    return sum;
}

size_t HitQueues::longest() const {
    return *std::max_element(groups_.begin(), groups_.end(),
                             [&](size_t a, size_t b) { return queues_[a].hits.size() < queues_[b].hits.size(); });
}

} // namespace alpenglow::integrator
