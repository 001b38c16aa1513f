// Volume shaders between a ray's origin and its hit: in-scattered light and transmittance (Ci' = a + slope Ci), and their
// outputs.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class GatherCalls;
class KernelInputs;
struct StageSet;

/// Runs the volume shaders of batches.
class Atmosphere final : Stage {
public:
    explicit Atmosphere(const StageSet&);
    /// Runs a volume shader over points with Ci, Oi, I and P set; their Ci is undefined afterwards. The binding is that of the
    /// surface behind the volume. `surface`, `of`: the batch of the surface shader and the index of each point in it; optional.
    void atmosphereEffects(const Medium&, const SurfaceBinding&, std::vector<ShadePoint>&, std::span<AtmosphereEffect> out,
                           bool wantSlope, BatchContext* surface = nullptr, std::span<const int> of = {});
    /// Sets c.atmosphereEffects of points first to first + count - 1 of a shaded batch.
    void atmosphereOfBatch(BatchContext&, int first, int count, bool wantSlope);
    /// Multiplies the weights of the kernel's light requests by the transmittance of the volume before each point.
    static void scaleRequests(BatchContext&);
    /// Attenuates light of emitters by the atmosphere between them and the lit points. inMedium: LightCall::inMedium.
    void atmosphereOfEmitters(const BoundLight&, std::span<const ShadePoint>, std::span<LightValue>,
                              const std::vector<char>* inMedium);
    /// Sets c.atmosphereEffects for photons: the transmittance of the volume between their origin and their hit, or of the
    /// atmosphere of the surface that they left. By symmetry, the volume shader runs as for an eye at the other end.
    void atmosphereOfPhotons(BatchContext&);

private:
    int running_ = 0; ///< volume kernels that are running, nested
    void keepOutputs(const shading::Batch& volume, BatchContext& surface, std::span<const int> of);
    KernelInputs& inputs_;
    const GatherCalls& gathers_;
};

} // namespace alpenglow::integrator
