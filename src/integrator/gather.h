// What becomes of the lobes that a batch asks light for (Requests::lobes), stage by stage, each an object of its own:
//   LobeSelection  how much each lobe gives back, and the chance that its ray is followed; lights that rays may pass in media
//   LightSampling  points of lights for the points of the batch, and what the lights' kernels send from there
//   Connection     lobes with those points: contributions, with one shadow ray for all lobes of a vertex that can share it
//   LastSkies      at the last vertex of a path: skies that only rays would find
//   GuideScatter   rays toward where caustics come from
//   PhotonScatter  photons that rest, and what paths gather of them
//   ScatterRays    directions of the lobes whose rays are followed, and the rays
// A stage reads what the ones before it wrote and changes nothing else; none looks at two points at a time, so results do not
// depend on who shares the batch.
#pragma once
#include "integrator/connection.h"
#include "integrator/guidescatter.h"
#include "integrator/lastskies.h"
#include "integrator/lightsampling.h"
#include "integrator/lobeselection.h"
#include "integrator/photonscatter.h"
#include "integrator/scatterrays.h"

namespace alpenglow::transport {

class LitSurfaces;
class PhotonStage;

class Gather final : VertexLobes, VertexStage {
public:
    explicit Gather(const StageSet&);
    /// Gathers light over Requests::lobes, all of points of this batch, and takes them. Shadow rays are left in
    /// ShadowRays::queue.
    void run(BatchContext&, Sched&);

private:
    void tellLights();
    LobeSelection selection_;
    LightSampling lightSampling_;
    Connection connection_;
    LastSkies lastSkies_;
    GuideScatter guideScatter_;
    PhotonScatter photonScatter_;
    ScatterRays scatter_;
    LitSurfaces& litSurfaces_;
    PhotonStage& photons_;
};

} // namespace alpenglow::transport
