// Scattering: samples the selected lobes, plays roulette, makes the next rays.
#pragma once
#include "bsdf/lobe.h"
#include "integrator/unshadowed.h"
#include "integrator/vertexlobes.h"

namespace alpenglow::integrator {

class Accumulator;
class GuideRays;
class LightPathStates;
class LobeSelection;
class MediaStacks;
class PhotonScatter;
class PhotonStage;
class SubsurfaceWalks;

/// A lobe whose rays are sent: `count` rays, each with `scale` times its weight. `goes`, `w`: the ray of this iteration;
/// `vertex`: its random number key; `dice`: its roulette number; `drawn`: sampled toward a light. `back`, for photons along
/// narrow lobes: value of the reverse path over the density, which replaces weight and value.
struct LobeRay {
    int point, lobe, count;
    float scale;
    bool goes;
    Vec3 w;
    LobeValue value;
    uint32_t vertex = 0;
    float dice = 0;
    Color back{0};
    bool drawn = false;
    bool again = false; ///< the sample is useless and is redrawn
    bool idle = false;  ///< its ray carries no light and only reports what it hits
};

class ScatterRays final : VertexStage {
public:
    ScatterRays(const StageSet&, const VertexLobes&, LobeSelection&, PhotonScatter&);
    void run(Sched&);
    void draw(int turn); ///< samples directions for one iteration and evaluates the lobes there

    std::vector<LobeRay> sent;

private:
    bool picks(size_t point) const;
    void pick(size_t point, float number);
    void drawAgain(int turn);
    void throwDice(int turn);
    UnshadowedRay unshadowedRay(const LobeVertex&, const Vec3& w) const;
    void sendRay(const LobeRay&, Sched&);
    bool intersectsEmitter(const LobeVertex&, const Vec3& w) const;
    /// Survival probability of the ray; 0: it is not sent.
    float roulette(const LobeVertex&, const LobeRay&, uint16_t& asked, const Color& weight) const;
    render::NumberRows numbers_;
    LobeSelection& selection_;
    PhotonScatter& photonScatter_;
    Accumulator& accumulator_;
    GuideRays& guide_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    PhotonStage& photons_;
    SubsurfaceWalks& subsurface_;
    UnshadowedLight unshadowed_;
};

} // namespace alpenglow::integrator
