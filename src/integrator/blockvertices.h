// Vertices whose kernel asks for lobes and nothing else, under path: from the kernel's requests to the next rays, 16 points at a
// time (lanes/stages.h). What it does not take goes point by point (gather.h), with the same bits.
#pragma once
#include "base/numberlanes.h"
#include "integrator/batchcontext.h"
#include "integrator/blocklobes.h"
#include "integrator/context.h"
#include "integrator/raywords.h"
#include "integrator/stageset.h"
#include "lanes/stages.h"

namespace alpenglow::transport {

class BlockVertices final : Stage {
public:
    static constexpr size_t kMostSites = 32; ///< that ask, of a kernel
    explicit BlockVertices(const StageSet&);
    ~BlockVertices();
    /// Whether all that this kernel of a binding asks for is of this kind, with the lights of the binding.
    bool takes(const SurfaceBinding&, const BoundKernel&) const;
    /// Whether all that a batch whose kernel has run asks for is of this kind.
    bool takes(const BatchContext&) const;
    /// Whether the rays that came to a batch are: no photons, albedos or skies at their end must be looked for.
    bool takesRays(const BatchContext&) const;
    /// Lights its points and sends their rays; shadow rays are left in ShadowRays::queue. False: nothing was done, for some point
    /// needs a look by itself.
    bool run(BatchContext&, Sched&);
    /// The same for what strips of a batch wait for. False: nothing was done, and they must ask one by one.
    bool run(BatchContext&, std::span<class KernelStrip* const>, Sched&);
    /// The same inside of a medium, whose lobes are its. beside: by point, MediumFlights::besideLight(). needsPoints(): its
    /// points.
    bool run(BatchContext&, const Homogeneous&, std::span<const Vec3> beside, Sched&);
    bool needsPoints(const SurfaceBinding&) const;
    /// Samples of one light for such points, and the values of their lobes toward them, to `found`. False: nothing was done.
    bool light(const BatchContext&, const Homogeneous&, const BoundLight&, std::vector<BlockLit>& found);

private:
    class ChosenLights;      ///< chosenlights.h
    class Guided;            ///< blockguide.h
    using Site = BlockLobes; ///< a call site of the kernel
    // blockvertices.cpp
    bool follow(BatchContext&, Sched&, bool waits);
    bool followLobes(BatchContext&, Sched&);
    void begin(const BatchContext&, bool waits);
    bool loadVertices(const BatchContext&);
    void takeRays(const RayBlock&, bool between);
    bool loadPoints(size_t block, const BatchContext&);
    bool findSites(const BatchContext&);
    void beginSite(Site&, int number, const BatchContext&);
    bool request(const BatchContext&);
    bool requestOf(Site&, const EmitRecord&, const BatchContext&);
    void prepare();
    bool select(const BatchContext&);
    std::span<LobeBlock*> lobesOf(size_t block);
    // blocklights.cpp
    void light(BatchContext&);
    void findLit(const BoundLight*);
    void lightAlone(const BoundLight&, BatchContext&);
    static bool samples(const Site&, const BoundLight&);
    void sampleLight(const BoundLight&, BatchContext&);
    void drawNumbers(uint32_t stream, std::vector<render::NumberBlock>&, bool ofLights = true);
    bool placeQuery(const BoundLight&, const struct LightNumbers&, const ShadePoint& lit, ShadePoint& query,
                    Emitter::Sample&) const;
    static void takeValue(LightBlock&, int lane, const BoundLight&, const LightValue&, const ShadePoint& query,
                          const Emitter::Sample&);
    void takeValues(const BoundLight&, const BatchContext&);
    void beginLights(const BoundLight&);
    void connect(const BoundLight&, BatchContext&);
    void connectBlock(size_t block, const BoundLight&, BatchContext&);
    Lanes contribute(const Site&, const VertexBlock&, const LobeBlock&, const LightBlock&, BatchContext&, const size_t* points);
    void sendShadow(const Site&, size_t point, size_t lane, const Vec3& w, const BoundLight&, const LightValue* says,
                    BatchContext&);
    int32_t shareOf(const PathRay&) const;
    /// PathRay::path of light that a lobe of a site sends towards w.
    uint16_t pathOf(const Site&, bool delta, size_t point, const Vec3& w, const BatchContext&) const;
    // blocklightrows.cpp
    bool inRows(const BoundLight&, const BoundKernel&) const;
    void lightInRows(const BoundLight&, BatchContext&);
    void askInRows(const BoundLight&, const BatchContext&);
    void placeInRows(const BoundLight&);
    void placeOnEmitter(size_t k, const Emitter&);
    void takeRows(const BoundLight&, const shading::Batch&, const BatchContext&);
    void takeLightOf(size_t k, const BoundLight&, const shading::Batch&, const BatchContext&);
    void placeFar(const BoundLight&, const shading::Batch&, size_t at, LightBlock&) const;
    bool asksShadowDisk(const BoundLight&, const shading::Batch&, size_t at, LightValue&);
    // blockwaiting.cpp
    bool takes(const BatchContext&, std::span<KernelStrip* const>) const;
    void nameLights(VertexBlock&, uint32_t site) const;
    void endByChance(size_t block);
    void besideLights(const BatchContext&); // blockbeside.cpp
    // blockmedium.cpp
    void beginMedium(std::span<const Vec3> beside, float anisotropy);
    void loadFlown(size_t block, const BatchContext&);
    void takeParts(const BoundLight&, const BatchContext&);
    // blockscatter.cpp
    void scatter(BatchContext&, Sched&);
    void drawDirections(size_t block);
    void throwDice(size_t block);
    void sendRays(size_t block, BatchContext&, Sched&);
    void turnRays(size_t block, BatchContext&);
    void keepLobes(size_t block, BatchContext&);
    void spawn(const RayBlock&, Sched&);
    Accumulator& accumulator_;
    BatchPool& batches_;
    KernelInputs& inputs_;
    LightKernels& lightKernels_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    MediumFlights& mediumFlights_;
    PhotonStage& photons_;
    RayStore& store_;
    ShadowRays& shadows_;
    SurfacePoints& surfaces_;
    VertexLight& vertexLight_;
    const Stages& stages_;
    LobeLanesList lanes_;
    bool usable_ = false; ///< by what the world is
    Roulette roulette_ = Roulette::None;
    bool lastSkies_ = false;                     ///< where paths end by their length skies must be asked (Gather::lastSkies)
    size_t blocks_ = 0, points_ = 0, count_ = 0; ///< count_: of sites_ that are asked
    bool waits_ = false;                         ///< the kernel waits for what it asks for
    std::vector<uint32_t> before_;               ///< then, by point: rays that it has asked for before
    std::vector<VertexBlock> vertices_;
    std::vector<RayBlock> rays_;    ///< that came to them, then those that go on
    std::vector<Site> sites_;       ///< the first `count_`, in the order of the calls
    std::vector<LobeBlock*> block_; ///< lobesOf()
    std::vector<Lanes> lit_;        ///< by block: points that sample lights
    std::vector<LightBlock> lights_;
    std::vector<render::NumberBlock> pairs_, choices_;
    std::vector<ShadePoint> queries_;
    std::vector<BlockQuery> asked_;
    std::vector<LightValue> values_;
    std::vector<int32_t> queryAt_;    ///< by point: in values_; -1, or empty: that says nothing more than lights_
    std::vector<size_t> litBlocks_;   ///< blocks of which some points sample lights
    std::vector<float> lamp_;         ///< LightRows of their points
    std::vector<BlockPlaced> placed_; ///< of litBlocks_
    std::vector<std::unique_ptr<const shading::ParameterRows>> parameters_; ///< by light
    ScatterBlock next_{};
    ShadowBlock shadow_{};
    int32_t sent_[kBlock];     ///< shadow rays of a block, in ShadowRays::queue; -1: none yet
    std::vector<char> inRows_; ///< by light: its samples need no points
    std::vector<char> plain_;  ///< by light list: all lights are what blocks hold
    std::unique_ptr<ChosenLights> chosen_;
    std::unique_ptr<Guided> guided_;
    alignas(64) Row whole_; ///< 1
    alignas(64) float value_[kValueRows][kBlock] = {};
    alignas(64) float drawn_[kDrawnRows][kBlock] = {};
};

} // namespace alpenglow::transport
