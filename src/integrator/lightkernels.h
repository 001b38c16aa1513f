// Runs light shaders in batches for the points that they light; area lights at points on the emitter. If the kernel waits for
// rays, they are traced to the end at once (nestedtrace.h).
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "services/services.h"

namespace alpenglow::integrator {

class Accumulator;
class Atmosphere;
class BatchPool;
class GatherCalls;
class KernelInputs;
class MediaStacks;
class NestedTrace;
class OcclusionCalls;
class RayStore;
class ShadowRays;
struct StageSet;

/// Runs the kernels of lights.
class LightKernels final : Stage, public LightEvaluator {
public:
    explicit LightKernels(const StageSet&);
    /// Light from one light at the queries; for area lights `samples[i]` is the point on the emitter.
    void evaluateLight(const BoundLight&, std::vector<ShadePoint>& queries, std::span<LightValue> out,
                       const LightCall& = {}) override;
    void shadowLight(const KernelRun&, const BoundLight&, int first, uint32_t draw, std::span<const ShadePoint>,
                     std::span<const int> laneOf, std::span<LightValue>) override;
    /// Applies the shadow parameters that a light sets; reports invalid values once and ignores them.
    void takeShadowSays(LightValue&, const BoundLight&, float radius, float samples);
    /// Probability that a light is among those sampled at a point `at` of the binding, after `bounces` bounces.
    float chanceOf(int light, int binding, const Vec3& at, int bounces) const;
    /// The world of the frame.
    const WorldImpl& world() const { return world_; }

private:
    void runWaiting(BatchContext&); ///< runs a kernel that waits for rays, strip by strip
    /// Counts a run for the light, or for all of a LightGroup (LightCall::of).
    void countRuns(const BoundLight&, std::span<const BoundLight* const> group);
    /// Adds the requests of a light's kernel other than Cl: shadows. The queries are not in the batch.
    void addPairs(BatchContext&, std::vector<ShadePoint>& queries, std::span<LightValue>);
    /// Result of a transmission() or trace() of a light's kernel at a point that it lights; the ray is traced to the end at once.
    shading::TargetValue followRay(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row,
                                   uint32_t occurrence, TraceSums* sums = nullptr);
    void gather(BatchContext&, const SiteInfo&, int first, std::span<uint32_t> asked);
    Atmosphere& atmosphere_;
    BatchPool& batches_;
    GatherCalls& gathers_;
    KernelInputs& inputs_;
    MediaStacks& media_;
    NestedTrace& nested_;
    OcclusionCalls& occlusion_;
    RayStore& store_;
    ShadowRays& shadows_;
};

} // namespace alpenglow::integrator
