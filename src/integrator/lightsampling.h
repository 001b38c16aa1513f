// Light samples: points on lights for the points of the batch, and what the lights' kernels send from there, a kernel call a
// light. Of many lights some are chosen at each point (world/lightchooser.h), and those of one program share a call.
#pragma once
#include "integrator/vertexlobes.h"

namespace alpenglow::transport {

class Connection;
class KernelInputs;
class LightKernels;
class LitSurfaces;
class MediaStacks;
class PhotonScatter;
class ShadowRays;

/// Sample `nth` of `of` that a point takes of a light. Lobes that ask for fewer have the first ones.
struct LightDraw {
    int nth = 0, of = 1;
};
/// What lights are asked for at points of the batch, one kernel call; row by row a query.
struct LightQueries {
    std::vector<ShadePoint> at; ///< the light's point; the first `count` are used
    std::vector<int> point;     ///< of the batch
    std::vector<const BoundLight*> light;
    std::vector<float> chance; ///< that the light is sampled there
    std::vector<float> spread; ///< of the lobes that it is for; < 0: for all of its point
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
    /// Whether a lobe asks this light for samples. trace() knows emitters only, and not those that are illuminance's.
    bool samples(const LobeVertex&, const BoundLight&) const;
    int lightSamples(const LobeVertex&) const; ///< of each light, where the lobe sends as many rays

    LightQueries queries; ///< that Connection reads

private:
    bool chooseLights(const WorldImpl::LightList&, const std::vector<int>& on, std::vector<int>& touched);
    void lightOf(const BoundLight&, std::span<const std::pair<int, float>> chosen, const BoundKernel* shared, Sched&);
    void askWanted(const BoundKernel* shared, Sched&);
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
    std::vector<Wanted> wanted_; ///< points that ask for a light, and the chance that it was chosen there
    std::vector<std::vector<std::pair<int, float>>> chosenAt_; ///< many lights: by light of the list, points and chances
    std::vector<int> chosen_;                                  ///< places in the list that have some
    std::vector<std::vector<int>> ofGroup_;                    ///< many lights: by group, places in the list
    render::NumberRows numbers_;
    Connection& connection_;
    PhotonScatter& photonScatter_;
    KernelInputs& inputs_;
    LightKernels& lightKernels_;
    LitSurfaces& litSurfaces_;
    MediaStacks& media_;
    ShadowRays& shadows_;
};

} // namespace alpenglow::transport
