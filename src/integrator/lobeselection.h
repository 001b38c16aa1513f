// Select: how much each lobe gives back, the energy rule, the chance that its ray is followed; in media, lights that its rays may
// pass. Reads Requests::lobes; writes LobeVertex::albedo, delta, chosen, followed, last, beside.
#pragma once
#include "integrator/vertexlobes.h"

namespace alpenglow::transport {

class Accumulator;
class LightKernels;
class MediaStacks;
class MediumFlights;
class PhotonScatter;
class PhotonStage;
class Transparency;
class VertexLight;

class LobeSelection final : VertexStage {
public:
    LobeSelection(const StageSet&, const VertexLobes&, PhotonScatter&);
    void choose();
    void measureAlbedos(); ///< of lobes that AOVs show and that have no closed form
    void besideLights();   ///< finds lights beside rays of lobes (beside.cpp)
    /// The factor of indirect light with which no more leaves than arrives.
    float energyScale(size_t point, const Color& reflected, const Color& clear);

    std::vector<float> indirectScale; ///< by point: of the rays of lighting shadeops
    std::vector<float> passes;        ///< by point: the chance that its ray goes on behind it

private:
    void choosePoint(size_t point);
    bool tooDeep(const LobeVertex&, const PathRay&, const SurfaceBinding&) const;
    bool albedoIsMeasured(const LobeVertex&) const; ///< once `delta` is known
    void besideLight(size_t point);
    std::vector<int> aimed_; ///< lobes with a light beside their rays
    render::NumberRows numbers_;
    PhotonScatter& photonScatter_;
    Accumulator& accumulator_;
    MediaStacks& media_;
    MediumFlights& mediumFlights_;
    PhotonStage& photons_;
    Transparency& transparency_;
    VertexLight& vertexLight_;
};

} // namespace alpenglow::transport
