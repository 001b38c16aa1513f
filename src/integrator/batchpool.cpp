#include "integrator/batchpool.h"
#include "base/memory.h"
#include "integrator/context.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

BatchPool::BatchPool(const StageSet& s) : Stage(s.context), store_(s.store) {}

void BatchPool::finish(std::shared_ptr<BatchContext> c, Sched& sched) {
    for (size_t i = 0; i < c->targets.size() && !sched.plain(); ++i) sched.release(c->targets[i]);
    giveBack(std::move(c));
}

std::shared_ptr<BatchContext> BatchPool::take() {
    if (pool_.empty()) return std::make_shared<BatchContext>();
    auto c = std::move(pool_.back());
    pool_.pop_back();
    return c;
}

size_t BatchPool::bytes() const {
    size_t sum = 0;
    for (const auto& c : pool_)
        sum += sizeof(BatchContext) + bytesOf(c->points) + bytesOf(c->rays) + bytesOf(c->bindings) + bytesOf(c->targets) +
               bytesOf(c->hits) + bytesOf(c->surfaces) + bytesOf(c->shapes) + bytesOf(c->ways) + bytesOf(c->emits) +
               bytesOf(c->arena) + bytesOf(c->flown);
    return sum;
}

void BatchPool::giveBack(std::shared_ptr<BatchContext> c) {
    constexpr size_t kMost = 64;
    if (c.use_count() != 1 || pool_.size() >= kMost) return; // a strip still uses it
    if (c->batch.use_count() != 1) c->batch.reset();
    store_.freeExtras(*c);
    c->forget(); // points are kept: SurfacePoints overwrites them
    c->targets.clear();
    c->hits.clear();
    c->emits.clear();
    c->emitted = 0;
    c->failure = nullptr;
    c->arena.clear();
    c->atmosphereEffects.clear();
    c->depths.clear();
    c->flown.clear();
    c->clear.clear();
    c->passes.clear();
    c->opaque = c->indirectKept = false;
    c->requestSite = -1;
    pool_.push_back(std::move(c));
}

} // namespace alpenglow::integrator
