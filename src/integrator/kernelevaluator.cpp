#include "integrator/kernelevaluator.h"
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/kernelinputs.h"
#include "integrator/lightkernels.h"
#include "integrator/pipeline.h"

namespace alpenglow::integrator {

namespace {

class KernelEvaluator final : public Evaluator {
public:
    KernelEvaluator(const WorldImpl& world, Diagnostics& d, const StopFlag* stop, bool building)
        : pipeline_(std::shared_ptr<const WorldImpl>(std::shared_ptr<const WorldImpl>{}, &world), d, building) {
        pipeline_.stages().context.stop = stop;
    }
    void run(const BoundKernel& k, const SurfaceBinding* of, std::vector<ShadePoint>& points, const shading::InstanceView& view,
             const std::function<void(const shading::Batch&)>& take) override {
        BatchContext c;
        c.bound = &k;
        c.binding = of;
        c.points.swap(points); // swapped back below
        c.batch = std::make_shared<shading::Batch>();
        c.batch->assign(k.kernel, *k.plan, c.points, {&view, 1}, {}, pipeline_.world());
        pipeline_.stages().inputs.bind(c.batch->call(), c);
        k.kernel->run(&c.batch->call());
        c.ran();
        take(*c.batch);
        points.swap(c.points);
    }
    void light(const BoundLight& l, std::vector<ShadePoint>& points, std::span<LightValue> out) override {
        pipeline_.stages().lightKernels.evaluateLight(l, points, out);
    }

private:
    Pipeline pipeline_;
};

} // namespace

std::unique_ptr<Evaluator> makeKernelEvaluator(const WorldImpl& world, Diagnostics& d, const StopFlag* stop, bool building) {
    return std::make_unique<KernelEvaluator>(world, d, stop, building);
}

} // namespace alpenglow::integrator
