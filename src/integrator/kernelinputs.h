// Inputs of kernels from points, parameters by binding, and the callbacks of running kernels.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "services/services.h"
#include <array>

namespace alpenglow::integrator {

struct StageSet;

/// Fills the inputs of kernels.
class KernelInputs final : Stage {
public:
    explicit KernelInputs(const StageSet&);
    void fill(BatchContext&);                   ///< fills the inputs of a batch from its points
    void bind(rsl::KernelCall&, BatchContext&); ///< sets the callbacks of the kernel
    void viewsOf(const BatchContext&);          ///< the distinct instances of a batch's points, to views and viewOf
    /// The world of the frame.
    const WorldImpl& world() const { return world_; }
    /// For warnings of kernels.
    Diagnostics& diagnostics() const { return diagnostics_; }
    /// Emitted pairs of earlier strips are void.
    bool beginsAnew() const { return context_.beginsAnew; }

    std::vector<shading::InstanceView> views; ///< by instance in the batch
    std::vector<uint32_t> viewOf;             ///< by point
    Services answers;                         ///< of this thread

private:
    const shading::ParameterRows* parametersOf(int binding, const shading::BatchPlan&);
    /// By binding: the last two in use, for kernels of one binding and of several.
    std::vector<std::array<std::unique_ptr<const shading::ParameterRows>, 2>> parameters_;
    std::vector<int> slotOf_; ///< by binding: index in views, or -1
};

/// Ends a call whose kernel requests more rays than fit into limits::kRequestBytes. Throws LimitReached, which Pipeline::trace()
/// answers with fewer points at a time; reports the error if there is only one point.
[[noreturn]] void endTooManyRequests(const BatchContext&, const rsl::ir::Site&);

} // namespace alpenglow::integrator
