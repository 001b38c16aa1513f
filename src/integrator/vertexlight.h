// Light over the lobes that a batch asks for (Requests::lobes): Gather does it, stage by stage (gather.h), then walks go below.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include <set>

namespace alpenglow::transport {

class AmbientLight;
class Gather;
class Requests;
struct StageSet;
class SubsurfaceWalks;

class VertexLight final : Stage {
public:
    explicit VertexLight(const StageSet&);
    ~VertexLight();
    /// Gathers light over the lobes, all of points of this batch, and takes them. Shadow rays are left in their queue.
    void gather(BatchContext&, Sched&);
    /// Says once of a shader that its indirect light is scaled down. more: it reflects more than it receives by itself.
    void tellScaled(const SurfaceBinding&, bool more);

private:
    const StageSet& set_;
    std::unique_ptr<Gather> gather_; ///< its memory is used again
    /// Shaders that were named because they reflect more than they receive; with what comes through.
    std::set<const void*> tamed_, tamedClear_;
    AmbientLight& ambient_;
    Requests& requests_;
    SubsurfaceWalks& subsurface_;
};

} // namespace alpenglow::transport
