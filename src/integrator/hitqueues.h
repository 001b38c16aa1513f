// Hits wait by group (one program, one list of lights) until there are enough to fill the lanes of its kernel. Their rays and
// targets wait with them.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

struct StageSet;
class WaitingKernels;

class HitQueues final : Stage {
public:
    explicit HitQueues(const StageSet&);
    /// A hit to the queue of its group. Those of rays that take primitives as they are have groups behind the others. Of a kernel
    /// that waits no more points are taken than its frames have room for: the others are followed again, later.
    void add(const Sched::Task&, const accel::Hit&, Sched&);
    /// Moves the hits of a group to a batch.
    void take(size_t group, BatchContext&);
    void clear();
    /// Groups that are to be shaded now; `all`: those that have any hits.
    std::vector<size_t> ready(bool all) const;
    bool empty() const { return groups_.empty(); }
    bool full() const;      ///< more hits wait than stay in the cache of a core
    size_t longest() const; ///< the group with the most hits

private:
    struct Queue {
        std::vector<accel::Hit> hits;
        std::vector<PathRay> rays;
        std::vector<TargetId> targets;
        bool waits = false; ///< its kernel waits for rays; then
        size_t room = 0;    ///< so many of its points may be shaded now
    };
    std::vector<Queue> queues_;  ///< by SurfaceBinding::group, then for rays that take primitives as they are
    std::vector<size_t> groups_; ///< that have hits
    size_t waiting_ = 0;         ///< hits
    WaitingKernels& waitingKernels_;
};

} // namespace alpenglow::transport
