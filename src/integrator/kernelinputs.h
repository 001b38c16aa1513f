// Inputs of kernels from points, parameters by binding, and what kernels call back while they run.
#pragma once
#include "answers/answers.h"
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include <array>

namespace alpenglow::transport {

struct StageSet;

/// Whether a call only notes what it asks for: trace() and transmission() always do, the shadeops of lobes only where the
/// integrator estimates them.
inline bool isRequest(SiteKind k, bool path) {
    return k == SiteKind::Trace || k == SiteKind::Transmission || k == SiteKind::Occlusion || k == SiteKind::Subsurface ||
           k == SiteKind::Gather || (path && k >= SiteKind::Ambient && k <= SiteKind::LightVisibility);
}

class KernelInputs final : Stage {
public:
    explicit KernelInputs(const StageSet&);
    void fill(BatchContext&);                   ///< the inputs of a batch from its points
    void bind(rsl::KernelCall&, BatchContext&); ///< what the kernel calls back
    void viewsOf(const BatchContext&);          ///< the instances of a batch's points, which are few: views, viewOf
    const WorldImpl& world() const { return world_; }
    Diagnostics& diagnostics() const { return diagnostics_; }
    bool beginsAnew() const { return context_.beginsAnew; }

    std::vector<shading::InstanceView> views;
    std::vector<uint32_t> viewOf; ///< by point
    Answers answers;

private:
    const shading::ParameterRows* parametersOf(int binding, const shading::BatchPlan&);
    /// By binding, the last two that were asked for: of the kernels for one binding and for several.
    std::vector<std::array<std::unique_ptr<const shading::ParameterRows>, 2>> parameters_;
    std::vector<int> slotOf_; ///< by binding: its place in views, else -1
};

} // namespace alpenglow::transport
