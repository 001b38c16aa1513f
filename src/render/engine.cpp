#include "render/engine.h"

namespace alpenglow::render {
namespace {

class IntegratorTracer final : public Tracer {
public:
    IntegratorTracer(std::shared_ptr<const transport::World> w, Diagnostics& d) : integrator_(std::move(w), d) {}
    bool trace(std::span<const transport::CameraRay> rays, std::span<transport::SampleResult> results,
               const StopFlag* stop) override {
        return integrator_.trace(rays, results, stop);
    }
    const transport::Counters& counters() const override { return integrator_.counters(); }
    bool seesNothing(std::span<const geometry::Plane> sides) const override { return integrator_.seesNothing(sides); }
    void tally(transport::BounceTally* t) override { integrator_.tally(t); }
    bool unfinished() const override { return integrator_.unfinished(); }

private:
    transport::Integrator integrator_;
};

} // namespace

Engine transportEngine() {
    return {[](std::shared_ptr<const scene::Frame> f, const transport::Settings& s, Diagnostics& d) {
                return transport::buildWorld(std::move(f), s, d);
            },
            [](std::shared_ptr<const transport::World> w, Diagnostics& d) -> std::unique_ptr<Tracer> {
                return std::make_unique<IntegratorTracer>(std::move(w), d);
            }};
}

} // namespace alpenglow::render
