// Scenes with many lights: each point samples some lights at random (world/lightchooser.h). Samples of lights with the same
// kernel share blocks, one sample a lane.
#pragma once
#include "integrator/lightsampling.h"

namespace alpenglow::integrator {

/// Light sampling where lights are many: each point chooses some.
class LightSampling::ChosenLights final : VertexStage {
public:
    ChosenLights(LightSampling&, const StageSet&, const VertexStages&);
    /// Lights the points of a batch that VertexBlocks::lit marks. Leaves shadow rays in ShadowRays::queue.
    void light(const WorldImpl::LightList&, BatchContext&, Sched&);

private:
    static constexpr size_t kAtOnce = 32; ///< blocks processed at once: they fit into the cache of a core
    /// A light that a point samples, and the probability of choosing it.
    struct Asked {
        int light = 0, point = 0;
        float chance = 1;
    };
    /// Lights that share a kernel; rows: the kernel reads rows only.
    struct Together {
        const BoundKernel* kernel = nullptr;
        bool rows = false;
        std::vector<Asked> asked;
    };
    /// A block of light samples.
    struct Questions {
        VertexBlock points;
        LightBlock lights;
        Lanes there = 0; ///< lanes in use
        const Asked* asked[kBlock] = {};
        const FlatEmitter* lamp[kBlock] = {}; ///< for an emitter, its shape
        uint32_t visibility[kBlock] = {};     ///< of that shape
        int32_t says[kBlock] = {};            ///< index in VertexBlocks::values; -1: none
    };

    int togetherOf(const BoundLight&) const;
    void choose(const WorldImpl::LightList&);
    void ask(const BoundKernel* group, bool rows, std::span<const Asked>, BatchContext&, Sched&);
    void askInRows(const BoundKernel&, std::span<const Asked>, BatchContext&);
    void askByPoints(const BoundKernel* group, std::span<const Asked>, BatchContext&);
    void gatherPoints(std::span<const Asked>);
    void askOnce(const BoundKernel* group, BatchContext&);
    void placeQueries(const BatchContext&);
    void drawNumbers();
    void placeOnEmitters(size_t block);
    void placeLights();
    const shading::Batch& run(const BoundKernel&, std::span<const Asked>, BatchContext& call);
    void takeLight(size_t block, const shading::Batch&, const BatchContext&);
    void takeShadow(Questions&, int lane, const Vec3& L, const shading::Batch&, size_t at);
    void connect(Questions&, BatchContext&);
    Lanes gatherLobes(const Questions&, const Site&);

    LightSampling& lightSampling_;
    std::vector<int> together_; ///< by light: index in all_; -1: it has a kernel of its own
    std::vector<Vec3> origins_; ///< by light
    std::vector<Together> all_;
    std::vector<Asked> chosen_, sorted_;
    std::vector<size_t> begin_; ///< by index in the list: first in sorted_
    std::vector<Questions> blocks_;
    size_t count_ = 0; ///< used in blocks_
    std::vector<NumberBlock> pairs_, choices_;
    std::vector<float> lamp_; ///< shading::LightRows
    std::vector<shading::InstanceView> views_;
    std::vector<uint32_t> viewOf_;
    std::vector<ChosenLight> chosenHere_;    ///< for one block
    std::vector<std::pair<size_t, int>> of_; ///< by VertexBlocks::asked: block and lane
    std::vector<char> wide_;                 ///< by light: it filters over its surface (isWide())
    std::vector<Asked> again_;               ///< those that take further samples
    LobeBlock lobe_;
};

} // namespace alpenglow::integrator
