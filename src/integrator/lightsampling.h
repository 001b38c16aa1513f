// Light sampling: points on lights for the points of the batch, and the radiance from the lights' kernels, one kernel call a
// light. In scenes with many lights each point chooses some at random (world/lightchooser.h), and lights with the same program
// share a call.
#pragma once
#include "integrator/vertexlobes.h"

namespace alpenglow::integrator {

class Connection;
class KernelInputs;
class LightKernels;
class LitSurfaces;
class MediaStacks;
class PhotonScatter;
class ShadowRays;

/// Sample `nth` of `of` samples that a point takes of a light. Lobes that request fewer use the first ones.
struct LightDraw {
    int nth = 0, of = 1;
};
/// Queries to lights for points of the batch, answered by one kernel call; parallel arrays.
struct LightQueries {
    std::vector<ShadePoint> at; ///< point on the light; the first `count` are in use
    std::vector<int> point;     ///< index in the batch
    std::vector<const BoundLight*> light;
    std::vector<float> chance; ///< probability of sampling the light there
    std::vector<float> spread; ///< spread of the lobes that it serves; < 0: all lobes of the point
    std::vector<LightDraw> draw;
    std::vector<Emitter::Sample> drawn;
    std::vector<LightValue> value;
    size_t count = 0;
    ShadePoint& add(int point, const BoundLight&, float chance, LightDraw);
    void dropLast();
    void clear();
};

class LightSampling final : VertexStage {
public:
    LightSampling(const StageSet&, const VertexLobes&, Connection&, PhotonScatter&);
    void run(Sched&);
    /// Whether a lobe samples this light. trace() samples emitters only, and none that illuminance loops handle.
    bool samples(const LobeVertex&, const BoundLight&) const;
    int lightSamples(const LobeVertex&) const; ///< samples of each light that a lobe takes: as many as its rays

    LightQueries queries; ///< read by Connection

private:
    bool chooseLights(const WorldImpl::LightList&, const std::vector<int>& on, std::vector<int>& touched);
    void lightOf(const BoundLight&, std::span<const std::pair<int, float>> chosen, const BoundKernel* shared, Sched&);
    void askWanted(const BoundKernel* shared, Sched&);
    void guidedSkies(const WorldImpl::LightList&, Sched&);
    int want(const BoundLight&, std::span<const std::pair<int, float>> chosen, int first);
    void placeWanted();
    bool place(ShadePoint&, Emitter::Sample&, const BoundLight&, size_t& number) const;
    void queriesByWidth(size_t point, const BoundLight&);
    void askLights(const BoundKernel* shared);
    struct Wanted {
        const BoundLight* light;
        int point;
        float chance;
        LightDraw draw;
    };
    std::vector<Wanted> wanted_; ///< points that sample a light, and the probability of choosing it there
    std::vector<std::vector<std::pair<int, float>>> chosenAt_; ///< many lights: by index in the list, points and probabilities
    std::vector<int> chosen_;                                  ///< indices in the list that were chosen
    std::vector<std::vector<int>> ofGroup_;                    ///< many lights: by group, indices in the list
    render::NumberRows numbers_;
    Connection& connection_;
    PhotonScatter& photonScatter_;
    KernelInputs& inputs_;
    LightKernels& lightKernels_;
    LitSurfaces& litSurfaces_;
    MediaStacks& media_;
    ShadowRays& shadows_;
};

} // namespace alpenglow::integrator
