// Batches and their memory, used again: a slice makes several, of some hundred kilobytes.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

class RayStore;
struct StageSet;

class BatchPool final : Stage {
public:
    explicit BatchPool(const StageSet&);
    std::shared_ptr<BatchContext> take();
    void giveBack(std::shared_ptr<BatchContext>); ///< kept when nobody else has it
    /// Gives back a batch whose points are shaded: its targets wait for it no longer.
    void finish(std::shared_ptr<BatchContext>, Sched&);

private:
    std::vector<std::shared_ptr<BatchContext>> pool_;
    RayStore& store_;
};

} // namespace alpenglow::transport
