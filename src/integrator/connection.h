// Connection: evaluates lobes for light samples and weights them by MIS against sampling the lobe. One shadow ray carries the
// light of all lobes of a vertex that can share it. Reads LightSampling::queries; writes ShadowRays::queue.
#pragma once
#include "bsdf/lobe.h"
#include "integrator/vertexlobes.h"

namespace alpenglow::integrator {

class Accumulator;
class LightPathStates;
class LightSampling;
class MediaStacks;
class MediumEvents;
class ShadowRays;

class Connection final : VertexStage {
public:
    Connection(const StageSet&, const VertexLobes&, LightSampling&);
    void connect();

private:
    /// A lobe and a light sample that reaches it from direction w. `turn`: how many samples have reached the lobe before.
    struct Reached {
        int query, lobe, turn;
        Vec3 w;
        LobeValue value;
    };
    void reach(int query);
    void evaluate();
    bool intersects(const LobeVertex&, int query, const Vec3& w, const Vec3& from, const Vec3& end) const;
    void send(const Reached&);
    Color contribution(const Reached&);
    std::vector<Reached> reached_;
    std::vector<int> turns_; ///< by lobe: light samples that have reached it
    int lastQuery_ = -1;     ///< query of the last shadow ray, which other lobes of its point may share
    LightSampling& lightSampling_;
    Accumulator& accumulator_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    MediumEvents& mediumEvents_;
    ShadowRays& shadows_;
};

} // namespace alpenglow::integrator
