// Light over the lobes that a batch requests (Requests::lobes): runs the stages of VertexSampling (vertexsampling.h), then the
// subsurface walks.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include <set>

namespace alpenglow::integrator {

class AmbientLight;
class BlockVertices;
class VertexSampling;
class Requests;
struct StageSet;
class SubsurfaceWalks;

class VertexLight final : Stage {
public:
    explicit VertexLight(const StageSet&);
    ~VertexLight();
    /// Transports light over the lobes, all of points of this batch, and removes them. Leaves shadow rays in their queue.
    void gather(BatchContext&, Sched&);
    /// Warns once per shader that its indirect light is scaled down. more: its reflectance alone exceeds 1.
    void tellScaled(const SurfaceBinding&, bool more);

private:
    const StageSet& set_;
    std::unique_ptr<VertexSampling> gather_; ///< reused for its memory
    /// Shaders already reported: reflectance over 1; reflectance plus transparency over 1.
    std::set<const void*> tamed_, tamedClear_;
    AmbientLight& ambient_;
    BlockVertices& blocks_;
    Requests& requests_;
    SubsurfaceWalks& subsurface_;
};

} // namespace alpenglow::integrator
