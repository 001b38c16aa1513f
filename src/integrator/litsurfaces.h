// Values of lit surfaces that light shaders query: outputs, displacement.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/vertex.h"

namespace alpenglow::integrator {

struct StageSet;

class LitSurfaces final : Stage {
public:
    explicit LitSurfaces(const StageSet&);
    /// For the queries of a light; `of`, by query: index in `values`. This object must outlive the result.
    LitSurface litBy(std::span<const int> of) const;
    /// Records current output values of a surface for lights that query them; for a waiting kernel, the values at the call.
    void tellOutputs(LitValues&, const BatchContext&, size_t point) const;

    std::vector<LitValues> values; ///< for the current batch; filled only if lights query surfaces
};

} // namespace alpenglow::integrator
