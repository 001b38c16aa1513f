// Light transport at the lobes that a batch requests (Requests::lobes), in stages, each an object:
//   LobeSelection  albedo of each lobe, probability of following its ray; light-directed phase sampling in media
//   LightSampling  points on lights for the points of the batch, and the radiance from the lights' kernels there
//   Connection     evaluates lobes for these samples; one shadow ray for all lobes of a vertex that can share it
//   LastSkies      at the last vertex of a path: samples skies that only rays would reach
//   GuideScatter   rays toward the origin of caustics
//   PhotonScatter  stores photons; density estimation for paths
//   ScatterRays    samples the selected lobes and makes the next rays
// A stage reads what earlier stages wrote and changes nothing else. No stage compares points, so results do not depend on the
// other members of the batch.
#pragma once
#include "integrator/connection.h"
#include "integrator/guidescatter.h"
#include "integrator/lastskies.h"
#include "integrator/lightsampling.h"
#include "integrator/lobeselection.h"
#include "integrator/photonscatter.h"
#include "integrator/scatterrays.h"

namespace alpenglow::integrator {

class LitSurfaces;
class PhotonStage;

class VertexSampling final : VertexLobes, VertexStage {
public:
    explicit VertexSampling(const StageSet&);
    /// Transports light over Requests::lobes, all of points of this batch, and removes them. Leaves shadow rays in
    /// ShadowRays::queue.
    void run(BatchContext&, Sched&);

private:
    void tellLights();
    void lastSkies();
    std::vector<LastRay> last_;
    LobeSelection selection_;
    LightSampling lightSampling_;
    Connection connection_;
    GuideScatter guideScatter_;
    PhotonScatter photonScatter_;
    ScatterRays scatter_;
    LastSkies& lastSkies_;
    LitSurfaces& litSurfaces_;
    const LightPathStates& paths_;
    PhotonStage& photons_;
};

} // namespace alpenglow::integrator
