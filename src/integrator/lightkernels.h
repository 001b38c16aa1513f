// Light samples: lights' kernels, in batches for the points that they light. Area lights: at points on the emitter. A kernel that
// asks for rays is answered in place, to the end (nestedtrace.h).
#pragma once
#include "answers/answers.h"
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

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

class LightKernels final : Stage, public Tracer {
public:
    explicit LightKernels(const StageSet&);
    /// Light arriving at queries from one light; for area lights `samples[i]` is the point on the emitter.
    void evaluateLight(const BoundLight&, std::vector<ShadePoint>& queries, std::span<LightValue> out,
                       const LightCall& = {}) override;
    void shadowLight(const KernelRun&, const BoundLight&, int first, uint32_t draw, std::span<const ShadePoint>,
                     std::span<const int> laneOf, std::span<LightValue>) override;
    /// What a light said of its shadow; nonsense is reported once and left out.
    void takeShadowSays(LightValue&, const BoundLight&, float radius, float samples);
    /// Probability that a light is among those that are sampled at a point of the binding at `at`, after so many bounces.
    float chanceOf(int light, int binding, const Vec3& at, int bounces) const;
    const WorldImpl& world() const { return world_; }

private:
    void runWaiting(BatchContext&); ///< a kernel that waits for rays, strip by strip
    /// Adds what a light's kernel asks for beside its Cl: shadows. The queries are not in the batch.
    void addPairs(BatchContext&, std::vector<ShadePoint>& queries, std::span<LightValue>);
    /// What a transmission() or trace() of a light's kernel gives at a point that it lights, followed to the end at once.
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

} // namespace alpenglow::transport
