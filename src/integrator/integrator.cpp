// Builds a world with the integrator's kernels, and traces rays by a pipeline.
#include "integrator/integrator.h"
#include "integrator/gridshading.h"
#include "integrator/kernelevaluator.h"
#include "integrator/pipeline.h"
#include "services/table.h"
#include <optional>

namespace alpenglow::integrator {

std::shared_ptr<const World> buildWorld(const std::shared_ptr<const scene::Frame>& frame, const Settings& settings,
                                        Diagnostics& d) {
    return World::build(frame, settings, services::serviceTable(), makeKernelEvaluator, d);
}

struct Integrator::Impl {
    Pipeline pipeline;
    std::optional<GridShading> grids;
    Impl(std::shared_ptr<const WorldImpl> w, Diagnostics& d) : pipeline(std::move(w), d) {
        if (GridShading::takes(pipeline.world())) grids.emplace(pipeline);
    }
    bool depths(std::span<const CameraRay> rays, std::span<SampleResult> out, const StopFlag* stop) {
        if (grids) return grids->depths(rays, out, stop);
        std::vector<CameraRay> all(rays.begin(), rays.end());
        for (CameraRay& r : all) r.depths = true;
        if (!pipeline.trace(all, out, stop)) return false;
        for (SampleResult& r : out) {
            r.z = r.transmittance.empty() ? 1e38f : r.transmittance.front().z;
            r.zSecond = 1e38f;
            r.transmittance.clear();
        }
        return true;
    }
};
Integrator::Integrator(std::shared_ptr<const World> w, Diagnostics& d)
    : impl_(std::make_unique<Impl>(std::static_pointer_cast<const WorldImpl>(std::move(w)), d)) {}
Integrator::~Integrator() = default;
bool Integrator::trace(std::span<const CameraRay> r, std::span<SampleResult> out, const StopFlag* stop) {
    if (!r.empty() && r[0].depthOnly) return impl_->depths(r, out, stop);
    if (impl_->grids && !r.empty() && !r[0].grid && !r[0].depths && !r[0].records) return impl_->grids->trace(r, out, stop);
    return impl_->pipeline.trace(r, out, stop);
}
bool Integrator::seesNothing(std::span<const geometry::Plane> sides) const {
    return impl_->grids && impl_->grids->emptyIsBlack() && !sides.empty() && !impl_->pipeline.world().accel().reachesInto(sides);
}
bool Integrator::unfinished() const { return impl_->pipeline.unfinished(); }
const Counters& Integrator::counters() const { return impl_->pipeline.counters(); }

} // namespace alpenglow::integrator
