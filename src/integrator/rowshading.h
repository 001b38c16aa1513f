// Batches of groups whose kernel only requests light and reads no more than where rays met surfaces (shading::SurfaceRows): from
// hits to the rows of the kernel and of the blocks (blockvertices.h), with no structure a point.
#pragma once
#include "integrator/blockvertices.h"

namespace alpenglow::transport {

class RowShading {
public:
    RowShading(Engine&, BlockVertices&);
    /// Whether hits of a group may be shaded so: SurfaceBinding::group, or one of those behind them.
    bool takes(size_t group) const { return group < takes_.size() && takes_[group]; }
    /// Shades the hits of a batch, and sends what goes on. False: only their rays and hits are as they were, and they must be
    /// shaded by points.
    bool shade(BatchContext&, Sched&);

private:
    bool takes(const SurfaceBinding&) const;
    void run(BatchContext&);
    void count(const BatchContext&);
    void requestOthers(BatchContext&, Sched&);
    void finish(BatchContext&, Sched&);

    Engine& e_;
    BlockVertices& blocks_;
    const WorldImpl& world_;
    std::vector<char> takes_; ///< by group
};

} // namespace alpenglow::transport
