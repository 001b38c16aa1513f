// Guide, point by point: which lobe of a point the guide helps, and the rays that it sends. Reads Requests::lobes behind
// LobeSelection; writes LobeVertex::guide and rays.
#pragma once
#include "integrator/guiderays.h"
#include "integrator/vertexlobes.h"

namespace alpenglow::transport {

class LightPathStates;
class LobeSelection;
class MediaStacks;

class GuideScatter final : VertexStage {
public:
    GuideScatter(const StageSet&, const VertexLobes&, const LobeSelection&);
    void run(Sched&);

private:
    /// The lobe of a point that gives back most and whose own ray could be guided; -1: none.
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

} // namespace alpenglow::transport
