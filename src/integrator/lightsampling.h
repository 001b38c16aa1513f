// Light sampling: points on lights for the vertices of a batch, and the radiance from the lights' kernels there, one kernel call
// a light: in rows where points, kernel and values are columns (lightrows.cpp), else one structure a sample (lightvalues.cpp).
// Where lights are many, each point chooses some (chosenlights.h). Reads VertexBlocks::vertices and sites; writes
// VertexBlocks::lights, queries and values, which Connection reads.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/vertexblocks.h"
#include "world/lightguide.h"

namespace alpenglow::integrator {

class Accumulator;
class BatchPool;
class KernelInputs;
class LightKernels;
class LitSurfaces;
class MediaStacks;
class MediumEvents;
class ShadowRays;
struct LightNumbers;

/// Samples lights for the vertices of a batch.
class LightSampling final : VertexStage {
public:
    LightSampling(const StageSet&, const VertexStages&);
    ~LightSampling();
    /// For all blocks of the batch; shadow rays go to ShadowRays::queue.
    void run(BatchContext&, Sched&);
    /// Records what lights may query of the lit surfaces: VertexBlocks::litSurface.
    void recordLitSurfaces(BatchContext&);
    /// Whether points in media need structures, because lights there read more than rows hold.
    bool needsPoints(const SurfaceBinding&) const;
    /// Samples one light in rows for all points whose lobes take it. Returns false, without effect, if it needs structures.
    bool sampleInRows(const BoundLight&, const BatchContext&);

    /// Whether lobes of a call site sample a light. trace() without "samplelights" samples emitters and skies only; it samples
    /// none that illuminance loops handle.
    bool samples(const Site&, const BoundLight&) const;
    /// Points of a block whose lobe of a site samples a light.
    Lanes litBy(size_t site, size_t block, const BoundLight&) const;
    /// Samples of each light that the lobe of a call site takes at a point.
    int drawsOf(const Site&, size_t point) const;

private:
    class ChosenLights; ///< chosenlights.h
    void findLit(const BoundLight*);
    void lightAlone(const BoundLight&, BatchContext&, Sched&);
    void lightOnce(const BoundLight&, BatchContext&);
    void lightWide(const BoundLight&, BatchContext&);
    bool choosesLights(const WorldImpl::LightList&) const;
    void sampleLight(const BoundLight&, BatchContext&);
    bool placeQuery(const BoundLight&, const LightGuide*, const LightNumbers&, const ShadePoint& lit, ShadePoint& query,
                    Emitter::Sample&) const;
    static void takeValue(LightBlock&, int lane, const BoundLight&, const LightValue&, const ShadePoint& query,
                          const Emitter::Sample&);
    void takeValues(const BoundLight&, const BatchContext&);
    void beginLights(const BoundLight&);
    void takeParts(const BoundLight&, const BatchContext&);
    // lightvalues.cpp
    void askQueries(const BoundLight&, const BoundKernel* group, std::span<const BoundLight* const> of, BatchContext&);
    void chooseSent(const BoundLight&, std::span<const float> values, const BatchContext&);
    void keepChannels(const BoundLight&, std::span<const float> values, BatchContext&);
    // lightdraws.cpp
    bool drawsSeveral() const;
    int drawsOf(const BoundLight&, size_t point) const;
    bool lightsAt(const Site&, const BoundLight&, size_t point) const;
    void drawOf(const BoundLight&, uint32_t stream, std::vector<NumberBlock>&) const;
    void nameDraw(const RayBlock&, int lane, uint32_t draws, NumberBlock&, int to) const;
    bool checksHits(const BoundLight&) const;
    // lightrows.cpp
    bool inRows(const BoundLight&, const BoundKernel&) const;
    void askInRows(const BoundLight&, const BatchContext&);
    void placeInRows(const BoundLight&, const LightGuide*);
    void placeOnEmitter(size_t k, const BoundLight&, const LightGuide*);
    void followGuide(size_t k, const BoundLight&, const LightGuide&, const struct GuidedLanes&);
    void takeRows(const BoundLight&, const shading::Batch&, const BatchContext&);
    void takeLightOf(size_t k, const BoundLight&, const shading::Batch&, const BatchContext&);
    void placeFar(const BoundLight&, const shading::Batch&, size_t at, LightBlock&) const;
    bool asksShadowDisk(const BoundLight&, const shading::Batch&, size_t at, LightValue&);

    std::vector<uint32_t> given_;     ///< by point: the light whose outputs were kept last, counted from 1; 0: none
    std::vector<float> lamp_;         ///< LightRows of VertexBlocks::litBlocks
    std::vector<BlockPlaced> placed_; ///< by litBlocks
    std::vector<std::unique_ptr<const shading::ParameterRows>> parameters_; ///< by light
    std::vector<char> inRows_;                                              ///< by light: can be sampled without points
    std::unique_ptr<ChosenLights> chosen_;
    Accumulator& accumulator_;
    BatchPool& batches_;
    Connection& connection_;
    PhotonGather& gathered_;
    KernelInputs& inputs_;
    LightKernels& lightKernels_;
    LitSurfaces& litSurfaces_;
    MediaStacks& media_;
    MediumEvents& mediumEvents_;
    const LightPathStates& paths_;
    RayStore& store_;
    ShadowRays& shadows_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::integrator
