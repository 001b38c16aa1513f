// Light over the lobes that a batch requested one by one (Requests::lobes).
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include <set>

namespace alpenglow::integrator {

class AmbientLight;
class BlockVertices;
struct StageSet;

class VertexLight final : Stage {
public:
    explicit VertexLight(const StageSet&);
    /// Transports light over the lobes, all of points of this batch, and removes them. Leaves shadow rays in their queue.
    void gather(BatchContext&, Sched&);
    /// Warns once per shader that its indirect light is scaled down. more: its reflectance alone exceeds 1.
    void tellScaled(const SurfaceBinding&, bool more);

private:
    /// Shaders already reported: reflectance over 1; reflectance plus transparency over 1.
    std::set<const void*> tamed_, tamedClear_;
    AmbientLight& ambient_;
    BlockVertices& blocks_;
};

} // namespace alpenglow::integrator
