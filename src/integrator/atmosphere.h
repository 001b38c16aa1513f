// Volume shaders over what rays met: what they add, what they leave of light (Ci = a + slope Ci), and their outputs.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

class KernelInputs;
struct StageSet;

class Atmosphere final : Stage {
public:
    explicit Atmosphere(const StageSet&);
    /// Runs a volume shader over points with Ci, Oi, I, P set. The points' Ci is void afterwards. The binding is that of what was
    /// met. `surface`, `of`: the run of the surface shader, and the points' numbers there; may be missing.
    void haze(const Medium&, const SurfaceBinding&, std::vector<ShadePoint>&, std::span<Haze> out, bool wantSlope,
              BatchContext* surface = nullptr, std::span<const int> of = {});
    /// Fills c.haze for points first to first + count - 1 of a shaded batch.
    void hazeOfBatch(BatchContext&, int first, int count, bool wantSlope);
    /// What the volumes before the points of a batch leave of the light that its kernel has asked for: scales the weights.
    static void scaleRequests(BatchContext&);
    /// Takes from the light of emitters what their atmosphere takes between them and the lit points.
    /// inMedium: LightCall::inMedium.
    void hazeOfEmitters(const BoundLight&, std::span<const ShadePoint>, std::span<LightValue>, const std::vector<char>* inMedium);
    /// Fills c.haze: what the way of each photon loses, which an eye would see the other way round from here. That is in the
    /// volume between, or in the atmosphere of the surface that the photon comes from.
    void hazeOfPhotons(BatchContext&);

private:
    int running_ = 0; ///< runs of volumes' kernels, one within the other
    void keepOutputs(const shading::Batch& volume, BatchContext& surface, std::span<const int> of);
    KernelInputs& inputs_;
};

} // namespace alpenglow::transport
