// Scatter: directions of the lobes whose rays are followed, roulette, the next rays.
#pragma once
#include "integrator/vertexlobes.h"
#include "lobes/lobe.h"

namespace alpenglow::transport {

class Accumulator;
class Connection;
class GuideRays;
class LightPathStates;
class LobeSelection;
class MediaStacks;
class PhotonScatter;
class PhotonStage;
class SubsurfaceWalks;

/// A lobe whose rays are sent: `count` of them, each with `scale` times its weight. `goes`, `w`: the ray of this turn.
/// `vertex`: of that ray; `dice`: the number of its roulette; `drawn`: beside a light.
/// `back`, of photons along narrow lobes: what the other way gives back, over the density, in the place of weight and value.
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
    bool again = false; ///< its draw brings nothing, and another is made
    bool idle = false;  ///< its ray brings no light: it tells what is in the way
};

class ScatterRays final : VertexStage {
public:
    ScatterRays(const StageSet&, const VertexLobes&, LobeSelection&, Connection&, PhotonScatter&);
    void run(Sched&);
    void draw(int turn); ///< directions of the rays of one turn, and what their lobes give back from there

    std::vector<LobeRay> sent;

private:
    bool picks(size_t point) const;
    void pick(size_t point, float number);
    void drawAgain(int turn);
    void throwDice(int turn);
    void sendRay(const LobeRay&, Sched&);
    bool meetsEmitter(const LobeVertex&, const Vec3& w) const;
    /// The chance with which the ray goes on; 0: it does not.
    float roulette(const LobeVertex&, const LobeRay&, uint16_t& asked, const Color& weight) const;
    render::NumberRows numbers_;
    LobeSelection& selection_;
    Connection& connection_;
    PhotonScatter& photonScatter_;
    Accumulator& accumulator_;
    GuideRays& guide_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    PhotonStage& photons_;
    SubsurfaceWalks& subsurface_;
};

} // namespace alpenglow::transport
