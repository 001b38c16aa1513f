#include "integrator/kernelinputs.h"
#include "integrator/context.h"
#include "integrator/lightkernels.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

KernelInputs::KernelInputs(const StageSet& s)
    : Stage(s.context), answers(world_, diagnostics_, &s.lightKernels, s.context.building) {}

/// The parameters of a binding's surface in the order of a plan.
const shading::ParameterRows* KernelInputs::parametersOf(int binding, const shading::BatchPlan& plan) {
    parameters_.resize(world_.bindings().size());
    auto& known = parameters_[size_t(binding)];
    for (const auto& rows : known)
        if (rows && rows->plan() == &plan) return rows.get();
    std::swap(known[0], known[1]);
    known[0] = std::make_unique<const shading::ParameterRows>(plan, world_.bindings()[size_t(binding)].surface->parameters);
    return known[0].get();
}

/// Collects the distinct instances of a batch's points: views and viewOf.
void KernelInputs::viewsOf(const BatchContext& c) {
    views.clear();
    viewOf.clear();
    slotOf_.resize(world_.bindings().size(), -1);
    for (int b : c.bindings) {
        int& slot = slotOf_[size_t(b)];
        if (slot < 0) {
            const InstanceRef& i = world_.bindings()[size_t(b)].surface;
            slot = int(views.size());
            views.push_back(i->view());
            views.back().rows = parametersOf(b, *c.bound->plan);
        }
        viewOf.push_back(uint32_t(slot));
    }
    for (int b : c.bindings) slotOf_[size_t(b)] = -1;
}

/// Fills the inputs of a batch from its points.
void KernelInputs::fill(BatchContext& c) {
    viewsOf(c);
    if (!c.batch) c.batch = std::make_shared<shading::Batch>();
    c.batch->assign(c.bound->kernel, *c.bound->plan, c.points, views, viewOf, world_);
    bind(c.batch->call(), c);
}

} // namespace alpenglow::integrator
