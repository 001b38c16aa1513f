// A pool of batches. A slice makes several batches of some hundred kilobytes, so their memory is reused.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class RayStore;
struct StageSet;

/// Lends batches; they return when the last user drops them.
class BatchPool final : Stage {
public:
    explicit BatchPool(const StageSet&);
    /// An empty batch.
    std::shared_ptr<BatchContext> take();
    void giveBack(std::shared_ptr<BatchContext>); ///< reused if no one else holds it
    /// Returns a batch whose points are shaded and releases its hold on their targets.
    void finish(std::shared_ptr<BatchContext>, Sched&);
    size_t bytes() const; ///< memory of the batches that wait to be used again

private:
    std::vector<std::shared_ptr<BatchContext>> pool_;
    RayStore& store_;
};

} // namespace alpenglow::integrator
