// Where a path ends by its depth limit: shadow rays to the skies that only rays of lobes would reach.
#pragma once
#include "integrator/scatterrays.h"

namespace alpenglow::integrator {

class LightKernels;
class LitSurfaces;
class ShadowRays;

class LastSkies final : VertexStage {
public:
    LastSkies(const StageSet&, const VertexLobes&, ScatterRays&);
    void run();

private:
    void lastSky(int light);
    ScatterRays& scatter_;
    Accumulator& accumulator_;
    LightKernels& lightKernels_;
    const LightPathStates& paths_;
    LitSurfaces& litSurfaces_;
    MediaStacks& media_;
    ShadowRays& shadows_;
};

} // namespace alpenglow::integrator
