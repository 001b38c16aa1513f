// What lights that ask are told about the surfaces that they light: outputs, displacement.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/vertex.h"

namespace alpenglow::transport {

struct StageSet;

class LitSurfaces final : Stage {
public:
    explicit LitSurfaces(const StageSet&);
    /// For queries of a light; `of`, by query, numbers in `values`. It must outlive the result.
    LitSurface litBy(std::span<const int> of) const;
    /// What outputs of the surface are now, for lights that ask; of a kernel that waits they stay as they were at the call.
    void tellOutputs(LitValues&, const BatchContext&, size_t point) const;

    std::vector<LitValues> values; ///< of what runs now; only where lights ask for outputs of surfaces
};

} // namespace alpenglow::transport
