#include "render/engine.h"

namespace alpenglow::render {
namespace {

class IntegratorTracer final : public Tracer {
public:
    IntegratorTracer(std::shared_ptr<const world::World> w, Diagnostics& d) : integrator_(std::move(w), d) {}
    bool trace(std::span<const integrator::CameraRay> rays, std::span<integrator::SampleResult> results,
               const StopFlag* stop) override {
        return integrator_.trace(rays, results, stop);
    }
    const integrator::Counters& counters() const override { return integrator_.counters(); }
    bool seesNothing(std::span<const geometry::Plane> sides) const override { return integrator_.seesNothing(sides); }
    bool unfinished() const override { return integrator_.unfinished(); }

private:
    integrator::Integrator integrator_;
};

} // namespace

Engine transportEngine() {
    return {[](const std::shared_ptr<const scene::Frame>& f, const world::Settings& s, Diagnostics& d) {
                return integrator::buildWorld(f, s, d);
            },
            [](std::shared_ptr<const world::World> w, Diagnostics& d) -> std::unique_ptr<Tracer> {
                return std::make_unique<IntegratorTracer>(std::move(w), d);
            }};
}

} // namespace alpenglow::render
