// Caustic guide, point by point: selects the lobe of a point that gets a guide ray, and sends the ray. Reads Requests::lobes
// after LobeSelection; writes LobeVertex::guide and rays.
#pragma once
#include "integrator/guiderays.h"
#include "integrator/vertexlobes.h"

namespace alpenglow::integrator {

class LightPathStates;
class LobeSelection;
class MediaStacks;

class GuideScatter final : VertexStage {
public:
    GuideScatter(const StageSet&, const VertexLobes&, const LobeSelection&);
    void run(Sched&);

private:
    /// The lobe of a point with the largest contribution among those that can be guided; -1: none.
    int guidedLobe(size_t point) const;
    bool mayGuide(const LobeVertex&) const;
    struct Sent {
        int lobe;
        Vec3 w;
    };
    std::vector<Sent> sent_;
    const LobeSelection& selection_;
    GuideRays& guide_;
    const LightPathStates& paths_;
    MediaStacks& media_;
};

} // namespace alpenglow::integrator
