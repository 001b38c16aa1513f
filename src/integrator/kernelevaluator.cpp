#include "integrator/kernelevaluator.h"
#include "integrator/engine.h"

namespace alpenglow::transport {

namespace {

class KernelEvaluator final : public Evaluator {
public:
    KernelEvaluator(const WorldImpl& world, Diagnostics& d, const StopFlag* stop)
        : engine_(std::shared_ptr<const WorldImpl>(std::shared_ptr<const WorldImpl>{}, &world), d) {
        engine_.stop = stop;
    }
    void run(const BoundKernel& k, const SurfaceBinding* of, std::vector<ShadePoint>& points, const shading::InstanceView& view,
             const std::function<void(const shading::Batch&)>& take) override {
        BatchContext c;
        c.engine = &engine_;
        c.bound = &k;
        c.binding = of;
        c.points.swap(points); // lent
        c.batch = std::make_shared<shading::Batch>();
        c.batch->assign(k.kernel, *k.plan, c.points, {&view, 1}, {}, engine_.world());
        engine_.bindCall(c.batch->call(), c);
        k.kernel->run(&c.batch->call());
        c.ran();
        take(*c.batch);
        points.swap(c.points);
    }
    void light(const BoundLight& l, std::vector<ShadePoint>& points, std::span<LightValue> out) override {
        engine_.evaluateLight(l, points, out);
    }

private:
    Engine engine_;
};

} // namespace

std::unique_ptr<Evaluator> makeKernelEvaluator(const WorldImpl& world, Diagnostics& d, const StopFlag* stop) {
    return std::make_unique<KernelEvaluator>(world, d, stop);
}

} // namespace alpenglow::transport
