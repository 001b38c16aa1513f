// Queues of hits by group (same program, same list of lights) until there are enough to fill the lanes of the group's kernel.
// Rays and targets are queued with them.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

struct StageSet;
class WaitingKernels;

/// Collects hits for kernels.
class HitQueues final : Stage {
public:
    explicit HitQueues(const StageSet&);
    /// Queues a hit. Rays with "hitmode" "primitive" have groups of their own, after the others. For a waiting kernel no more
    /// points are accepted than its frames have memory for; the other rays are traced again later.
    void add(const Sched::Task&, const accel::Hit&, Sched&);
    /// Moves the hits of a group into a batch.
    void take(size_t group, BatchContext&);
    /// Drops all hits.
    void clear();
    /// Groups to shade now; `all`: every group that has hits.
    std::vector<size_t> ready(bool all) const;
    /// No hit waits.
    bool empty() const { return groups_.empty(); }
    bool full() const;      ///< more hits are queued than fit into the cache of a core
    size_t longest() const; ///< the group with the most hits
    size_t bytes() const;   ///< memory that it holds

private:
    struct Queue {
        std::vector<accel::Hit> hits;
        std::vector<PathRay> rays;
        std::vector<AccumulatorId> targets;
        bool waits = false; ///< its kernel waits for rays; if so,
        size_t room = 0;    ///< so many of its points may be shaded now
    };
    std::vector<Queue> queues_;  ///< by SurfaceBinding::group, then those for "hitmode" "primitive"
    std::vector<size_t> groups_; ///< groups that have hits
    size_t waiting_ = 0;         ///< number of queued hits
    WaitingKernels& waitingKernels_;
};

} // namespace alpenglow::integrator
