// Lobe selection: albedo of each lobe, the energy rule, the probability of following its ray; light-directed phase sampling in
// media. Reads Requests::lobes; writes LobeVertex::albedo, delta, chosen, followed, last, beside.
#pragma once
#include "integrator/vertexlobes.h"

namespace alpenglow::integrator {

class Accumulator;
class LightKernels;
class MediaStacks;
class MediumEvents;
class PhotonScatter;
class PhotonStage;
class Transparency;
class VertexLight;

/// Sampled directions for the estimate of an albedo.
inline constexpr uint32_t kAlbedoDraws = 8;

/// Whether the output "albedo" of lobes of this kind that are no deltas has no closed form.
inline bool albedoIsMeasured(const LobeKind& k, const RayKind& rays) { return k.distribution || rays.type != RayType::Diffuse; }

class LobeSelection final : VertexStage {
public:
    LobeSelection(const StageSet&, const VertexLobes&, PhotonScatter&);
    void choose();
    void measureAlbedos();  ///< estimates albedos without a closed form, for AOVs
    void lightDirections(); ///< selects lights for light-directed sampling (lightdirected.cpp)
    /// Factor for indirect light by the energy rule: reflected plus transmitted light must not exceed the incident light.
    float energyScale(size_t point, const Color& reflected, const Color& clear);

    std::vector<float> indirectScale; ///< by point: factor for the rays of lighting shadeops
    std::vector<float> passes;        ///< by point: probability that the ray continues behind the surface

private:
    void choosePoint(size_t point);
    bool tooDeep(const LobeVertex&, const PathRay&, const SurfaceBinding&) const;
    bool albedoIsMeasured(const LobeVertex&) const; ///< once `delta` is set
    void lightDirection(size_t point);
    std::vector<int> aimed_; ///< lobes that sample toward a light
    render::NumberRows numbers_;
    PhotonScatter& photonScatter_;
    Accumulator& accumulator_;
    MediaStacks& media_;
    MediumEvents& mediumEvents_;
    PhotonStage& photons_;
    Transparency& transparency_;
    VertexLight& vertexLight_;
};

} // namespace alpenglow::integrator
