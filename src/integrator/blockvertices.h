// From the requests of kernels to the next rays, 16 points at a time (lanes/stages.h). Under path one lobe of a point is
// followed, under the other hiders all. Most requests are read in rows; the others one by one (blockrequests.h).
#pragma once
#include "base/numberlanes.h"
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/stageset.h"
#include "integrator/vertexblocks.h"
#include "lanes/stages.h"

namespace alpenglow::integrator {

class BlockVertices final : Stage, VertexBlocks {
public:
    explicit BlockVertices(const StageSet&);
    ~BlockVertices();
    /// Whether all requests of this kernel can be read in rows.
    bool takes(const BoundKernel&) const;
    /// Whether all requests of a batch whose kernel has run can.
    bool takes(const BatchContext&) const;
    /// Whether the rays that hit a batch allow it.
    bool takesRays(const BatchContext&) const;
    /// Reads the requests, lights the points and sends the next rays; leaves shadow rays in ShadowRays::queue. Returns false,
    /// without effect, if a point needs requests of its own.
    bool run(BatchContext&, Sched&);
    /// The same for the requests of suspended strips. Returns false, without effect, if the strips must request one by one.
    bool run(BatchContext&, std::span<class KernelStrip* const>, Sched&);
    /// The same for points inside a medium, with its phase function as lobe. beside: by point, MediumEvents::lightDirection().
    /// needsPoints(): whether the batch needs its points.
    void run(BatchContext&, const Homogeneous&, std::span<const Vec3> beside, Sched&);
    /// The same for exits of subsurface walks, where light is gathered as by diffuse(). indirect: by point, factor of its ray's
    /// light.
    void runExits(BatchContext&, std::span<const float> indirect, Sched&);
    /// The same for requests that were made one by one (Requests::lobes), all of points of this batch; removes them.
    void runRequests(BatchContext&, Sched&);
    bool needsPoints(const SurfaceBinding&) const;
    /// For photons, at surfaces that scatter by a photon shading model alone: those without one as matte ones.
    void runModels(BatchContext&, Sched&);
    /// Samples one light for such points and evaluates their lobes toward it, to `found`. False: not possible, no effect.
    bool light(const BatchContext&, const Homogeneous&, const BoundLight&, std::vector<BlockLit>& found);

private:
    class CallCount;    ///< blockvertices.cpp
    class ChosenLights; ///< chosenlights.h
    class Guided;       ///< blockguide.h
    class Requested;    ///< blockrequests.h
    class Photons;      ///< blockphotons.h
    class Flight;       ///< blockflight.h
    class OwnShadows;   ///< ownshadows.h
    // blockvertices.cpp
    bool follow(BatchContext&, Sched&, bool waits);
    void followLobes(BatchContext&, Sched&);
    void begin(const BatchContext&, bool waits);
    bool loadVertices(const BatchContext&);
    void takeRays(const RayBlock&, bool between);
    void endRays(size_t block, int lane, const SurfaceBinding&, bool between);
    bool loadPoints(size_t block, const BatchContext&);
    bool findSites(const BatchContext&);
    void beginSite(Site&, int number, const BatchContext&);
    bool request(BatchContext&);
    void noteHemispheres(const Site&, BatchContext&);
    bool requestOf(Site&, const EmitRecord&, const BatchContext&);
    void countCalls(Site&, const EmitRecord&, const BatchContext&, std::vector<uint32_t>& before);
    void prepare();
    void select(const BatchContext&);
    // blocklights.cpp
    void light(BatchContext&, Sched&);
    void findLit(const BoundLight*);
    void lightOnce(const BoundLight&, BatchContext&);
    void lightWide(const BoundLight&, BatchContext&);
    bool choosesLights(const WorldImpl::LightList&) const;
    bool samples(const Site&, const BoundLight&) const;
    Lanes litBy(size_t site, size_t block, const BoundLight&) const;
    void sampleLight(const BoundLight&, BatchContext&);
    void lastSkies(BatchContext&); // blocklastskies.cpp
    void endLobe(const Site&, size_t block, const BatchContext&);
    bool placeQuery(const BoundLight&, const LightGuide*, const struct LightNumbers&, const ShadePoint& lit, ShadePoint& query,
                    Emitter::Sample&) const;
    static void takeValue(LightBlock&, int lane, const BoundLight&, const LightValue&, const ShadePoint& query,
                          const Emitter::Sample&);
    void takeValues(const BoundLight&, const BatchContext&);
    void beginLights(const BoundLight&);
    void connect(const BoundLight&, BatchContext&);
    void connectBlock(size_t block, const BoundLight&, BatchContext&);
    Lanes contribute(const Site&, const VertexBlock&, const LobeBlock&, LightBlock&, BatchContext&, const size_t* points);
    void sendShadow(const Site&, size_t point, size_t lane, const Vec3& w, const BoundLight&, const LightValue*, BatchContext&);
    int32_t shareOf(const Site&, size_t point, const PathRay&) const;
    /// PathRay::path of light that a lobe of a call site scatters toward w.
    uint16_t pathOf(const Site&, bool delta, size_t point, const Vec3& w, const BatchContext&) const;
    // blocklightvalues.cpp
    void tellLights(const BatchContext&);
    int toldAt(size_t point) const; ///< index in LitSurfaces::values; -1: none
    void askQueries(const BoundLight&, const BoundKernel* group, std::span<const BoundLight* const> of, BatchContext&);
    void chooseSent(const BoundLight&, std::span<const float> values, const BatchContext&);
    void keepChannels(const BoundLight&, std::span<const float> values, BatchContext&);
    uint32_t numberOf(const BoundLight& l) const { return uint32_t(&l - world_.lights_.data()); }
    // blocklightdraws.cpp
    bool drawsSeveral() const;
    int drawsOf(const Site&, size_t point) const;
    int drawsOf(const BoundLight&, size_t point) const;
    bool lightsAt(const Site&, const BoundLight&, size_t point) const;
    void lightAlone(const BoundLight&, BatchContext&, Sched&);
    void drawOf(const BoundLight&, uint32_t stream, std::vector<render::NumberBlock>&) const;
    void nameDraw(const RayBlock&, int lane, uint32_t draws, render::NumberBlock&, int to) const;
    // blockraysets.cpp
    bool checksHits(const BoundLight&) const;
    void dropUnhit(const Site&, const size_t* points, const BoundLight* const* lights, const int32_t* queryOf, LightBlock&) const;
    void sumUnshadowed(const Site&, const VertexBlock&, const LobeBlock&, const LightBlock&, Lanes, const BatchContext&,
                       const size_t* points);
    // blocklightrows.cpp
    bool inRows(const BoundLight&, const BoundKernel&) const;
    void lightInRows(const BoundLight&, BatchContext&);
    void askInRows(const BoundLight&, const BatchContext&);
    void placeInRows(const BoundLight&, const LightGuide*);
    void placeOnEmitter(size_t k, const BoundLight&, const LightGuide*);
    void followGuide(size_t k, const BoundLight&, const LightGuide&, const struct GuidedLanes&);
    void takeRows(const BoundLight&, const shading::Batch&, const BatchContext&);
    void takeLightOf(size_t k, const BoundLight&, const shading::Batch&, const BatchContext&);
    void placeFar(const BoundLight&, const shading::Batch&, size_t at, LightBlock&) const;
    bool asksShadowDisk(const BoundLight&, const shading::Batch&, size_t at, LightValue&);
    // blockwaiting.cpp
    bool takes(const BatchContext&, std::span<KernelStrip* const>) const;
    void endByChance(size_t block);
    void lightDirections(const BatchContext&); // blocklightdirected.cpp
    // blockmedium.cpp
    void beginMedium(std::span<const Vec3> beside, float anisotropy);
    void loadFlown(size_t block, const BatchContext&);
    void takeParts(const BoundLight&, const BatchContext&);
    void beginExits(const BatchContext&);        // blockexits.cpp
    void walkBelow(size_t block, BatchContext&); // blockexits.cpp
    void showAlbedo(BatchContext&);              // blockalbedo.cpp
    // blockoptions.cpp
    bool readOptions(Site&, BatchContext&);
    void limitShadows(const Site&, const size_t* points, const BoundLight* const* lights, LightBlock&);
    void applyOptions(size_t block, const BatchContext&);
    Vec3 originOf(const Site&, size_t point, const Vec3& w) const;
    // blockscatter.cpp
    void scatter(BatchContext&, Sched&);
    void scatterAll(size_t block, BatchContext&, Sched&);
    void drawDirections(size_t block);
    void throwDice(size_t block);
    void endTrees(size_t block);
    void sendRays(size_t block, BatchContext&, Sched&);
    void turnRays(size_t block, BatchContext&);
    void keepLobes(size_t block, BatchContext&);
    void spawn(const RayBlock&, Sched&);
    Accumulator& accumulator_;
    BatchPool& batches_;
    KernelInputs& inputs_;
    LastSkies& lastSkies_;
    LightKernels& lightKernels_;
    LitSurfaces& litSurfaces_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    MediumEvents& mediumEvents_;
    OcclusionCalls& occlusion_;
    PhotonStage& photons_;
    RayStore& store_;
    ShadowRays& shadows_;
    SubsurfaceWalks& subsurface_;
    SurfacePoints& surfaces_;
    VertexLight& vertexLight_;
    const Stages& stages_;
    LobeLanesList lanes_;
    bool usable_ = false;    ///< the world and the settings allow blocks
    bool endsTrees_ = false; ///< lights send rays: roulette goes by throughput alone
    Roulette roulette_ = Roulette::None;
    std::vector<std::unique_ptr<const shading::ParameterRows>> parameters_; ///< by light
    std::vector<char> inRows_;                                              ///< by light: can be sampled without points
    std::unique_ptr<ChosenLights> chosen_;
    std::unique_ptr<Guided> guided_;
    std::unique_ptr<Requested> requested_;
    std::unique_ptr<Photons> gathered_;
    std::unique_ptr<Flight> flight_;
};

} // namespace alpenglow::integrator
