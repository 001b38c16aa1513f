// Where there are many lights: those that chance chooses at each point (world/lightchooser.h), for vertices in blocks
// (blockvertices.h). What is asked of lights of one kernel stands in blocks of its own, a question a lane, with the bits of
// gather.h.
#pragma once
#include "integrator/blockvertices.h"

namespace alpenglow::transport {

class BlockVertices::ChosenLights {
public:
    explicit ChosenLights(BlockVertices&);
    /// Lights the points of a batch of which BlockVertices::lit_ says that they ask for light. Shadow rays are left in
    /// ShadowRays::queue.
    void light(const WorldImpl::LightList&, BatchContext&);

private:
    static constexpr size_t kAtOnce = 32; ///< blocks: they stay in a core's cache
    /// A light that a point asks, and the chance with which it was chosen there.
    struct Asked {
        int light = 0, point = 0;
        float chance = 1;
    };
    /// Lights whose questions one kernel answers; rows: it reads nothing but rows.
    struct Together {
        const BoundKernel* kernel = nullptr;
        bool rows = false;
        std::vector<Asked> asked;
    };
    /// Of a block of questions.
    struct Questions {
        VertexBlock points;
        LightBlock lights;
        Lanes there = 0; ///< there are so many
        const Asked* asked[kBlock] = {};
        const FlatEmitter* lamp[kBlock] = {}; ///< of an emitter, the shape
        uint32_t visibility[kBlock] = {};     ///< of that shape
        int32_t says[kBlock] = {};            ///< BlockVertices::values_; -1: nothing more
    };

    int togetherOf(const BoundLight&) const;
    void choose(const WorldImpl::LightList&);
    void askInRows(const BoundKernel&, std::span<const Asked>, BatchContext&);
    void askByPoints(const BoundKernel* group, std::span<const Asked>, BatchContext&);
    void gatherPoints(std::span<const Asked>);
    void placeQueries(const BatchContext&);
    void drawNumbers();
    void placeOnEmitters(size_t block);
    void placeLights();
    const shading::Batch& run(const BoundKernel&, std::span<const Asked>, BatchContext& call);
    void takeLight(size_t block, const shading::Batch&, const BatchContext&);
    void takeShadow(Questions&, int lane, const Vec3& L, const shading::Batch&, size_t at);
    void connect(Questions&, BatchContext&);
    Lanes gatherLobes(const Questions&, const BlockVertices::Site&);

    BlockVertices& b_;
    const WorldImpl& world_;
    std::vector<int> together_; ///< by light, of all_; -1: it has a kernel of its own
    std::vector<Vec3> origins_; ///< by light
    std::vector<Together> all_;
    std::vector<Asked> chosen_, sorted_;
    std::vector<size_t> begin_; ///< by place in the list, in sorted_
    std::vector<Questions> blocks_;
    size_t count_ = 0; ///< of these
    std::vector<render::NumberBlock> pairs_, choices_;
    std::vector<float> lamp_; ///< shading::LightRows
    std::vector<shading::InstanceView> views_;
    std::vector<uint32_t> viewOf_;
    std::vector<ChosenLight> chosenHere_;    ///< of a block
    std::vector<Emitter::Sample> samples_;   ///< of BlockVertices::queries_,
    std::vector<std::pair<size_t, int>> of_; ///< whose blocks and lanes these are
    LobeBlock lobe_;
};

} // namespace alpenglow::transport
