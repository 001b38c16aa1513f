// Evaluates lobes for light samples and weights them by MIS against sampling the lobe. One shadow ray carries the light of all
// lobes of a vertex that can share it. Reads VertexBlocks::lights (or another block of samples) and sites; writes
// ShadowRays::queue.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/vertexblocks.h"

namespace alpenglow::integrator {

class Accumulator;
class MediaStacks;
class ShadowRays;

/// Connects vertices with the light samples of their block.
class Connection final : VertexStage {
public:
    Connection(const StageSet&, const VertexStages&);
    /// For the samples of one light in VertexBlocks::lights.
    void connect(const BoundLight&, BatchContext&);
    /// Evaluates the lobes of a call site at `points` for their lights, into VertexBlocks::value; adds the result to shadow rays
    /// that were already sent. pointOf: by lane, index in the batch. Returns the lanes whose ray is still to be sent.
    Lanes contribute(const Site&, const VertexBlock& points, const LobeBlock&, LightBlock&, BatchContext&, const size_t* pointOf);
    /// Sends the shadow ray of a lane of VertexBlocks::shadow, from a point toward w. says: shadow parameters of the light, or
    /// null.
    void sendShadow(const Site&, size_t point, size_t lane, const Vec3& w, const BoundLight&, const LightValue* says,
                    BatchContext&);

    /// Shadow rays of one call site: calls with a bias, a limit of distance or a ray set share none with other calls at their
    /// point. While it lives, VertexBlocks::shadow is of this call site alone, if it needs that; then the common ones are back.
    class OwnShadows {
    public:
        /// For a call site of the blocks at hand.
        OwnShadows(Connection&, const Site&);
        OwnShadows(const OwnShadows&) = delete;
        OwnShadows& operator=(const OwnShadows&) = delete;
        ~OwnShadows();
        /// Sets the rays, and removes samples from l.asked that rays of the call site would not hit. By lane: points in the
        /// batch, lights, and indices in VertexBlocks::asked.
        void limit(const Site&, const size_t* points, const BoundLight* const* lights, const int32_t* queries, LightBlock& l);

    private:
        Connection& connection_;
        const bool own_;
        ShadowBlock shadow_;
        int32_t sent_[kBlock]; ///< VertexBlocks::sent
    };

private:
    /// Sets alone_ for light that rays of the lobe might also find.
    void weighAlone(const VertexBlock&, const LobeBlock&, const LightBlock&, const float* kept, bool ahead, Lanes met);
    /// For the light of a lane just added to the queue: ShadowRays::AloneLight.
    uint16_t pathOf(const Site&, size_t point, const Vec3& w, const BatchContext&) const;
    void noteAlone(const Site&, size_t lane, int32_t more);
    void connectBlock(size_t block, const BoundLight&, BatchContext&);
    void limitShadows(const Site&, const size_t* points, const BoundLight* const* lights, LightBlock&);
    void dropUnhit(const Site&, const size_t* points, const BoundLight* const* lights, const int32_t* queryOf, LightBlock&) const;
    void sumUnshadowed(const Site&, const VertexBlock&, const LobeBlock&, const LightBlock&, Lanes, const BatchContext&,
                       const size_t* points);
    alignas(64) Row draws_; ///< by lane: samples of the light that a lobe takes
    ShadowBlock alone_;     ///< light as in VertexBlocks::shadow, but without multiple importance sampling
    Lanes aloneLanes_ = 0;  ///< lanes of alone_ that differ
    Accumulator& accumulator_;
    LightSampling& lightSampling_;
    MediaStacks& media_;
    const LightPathStates& paths_;
    RayStore& store_;
    ShadowRays& shadows_;
};

} // namespace alpenglow::integrator
