// The vertices of a batch in blocks of 16, and what the stages over them (blockvertices.h) hand on to each other.
#pragma once
#include "integrator/blocklobes.h"
#include "integrator/lastskies.h"
#include "integrator/raywords.h"
#include "integrator/vertex.h"
#include <map>

namespace alpenglow::integrator {

class VertexBlocks {
protected:
    using Site = BlockLobes; ///< a call site of the kernel
    VertexBlocks();
    std::span<LobeBlock*> lobesOf(size_t block);
    /// The camera sample of a ray.
    const PathSample& sampleOf(const RayBlock& rays, int lane) const {
        const uint64_t at = uint64_t(rays.sample[1][lane]) << 32 | rays.sample[0][lane];
        return at ? *reinterpret_cast<const PathSample*>(at) : *noSample_;
    }
    /// Factor of the light of surfaces that the ray of a lobe carries, without the energy rule.
    float indirectOf(const Site& s, size_t point) const {
        const LobeVertex* const r = s.requestAt(point);
        if (s.direct || (s.lighting && s.diffuse && !apart_.empty() && (apart_[point / kBlock] >> point % kBlock & 1))) return 0;
        return r ? r->indirect : indirect_.empty() ? 1 : indirect_[point];
    }
    /// Sets the keys of the points of a block; the stream is still to be set.
    void beginNumbers(size_t block, render::NumberBlock&) const;
    /// Draws the random numbers of a stream (NumberBlock) at all points.
    void drawNumbers(uint32_t stream, std::vector<render::NumberBlock>&, bool ofLights = true) const;

    const PathSample* noSample_ = nullptr;       ///< for rays without a camera sample
    const BatchContext* moved_ = nullptr;        ///< the batch, if its shader has moved points
    size_t blocks_ = 0, points_ = 0, count_ = 0; ///< count_: requesting sites in sites_
    bool waits_ = false;                         ///< the kernel waits for its results
    std::vector<uint32_t> before_;               ///< if it waits, by point: earlier ray requests
    std::span<const float> indirect_;            ///< at exits of walks, by point: factor of the light of rays
    std::vector<Lanes> apart_;                   ///< by block: points of indirectdiffuse(); empty: none
    std::vector<VertexBlock> vertices_;
    std::vector<RayBlock> rays_;                 ///< incoming rays, then the next rays
    std::vector<Site> sites_;                    ///< the first `count_`, in the order of the calls
    std::vector<LobeBlock*> block_;              ///< lobesOf()
    std::map<int, std::vector<uint32_t>> loops_; ///< by call site that is called several times at a point: calls so far
    bool repeats_ = false;                       ///< some call site is called several times at a point
    bool sendsSeveral_ = false;                  ///< the kernel waits for several rays of a call
    std::vector<Lanes> lit_;                     ///< by block: points that sample lights
    int onlySite_ = -1;                          ///< the only site that samples the light; -1: all
    uint32_t draw_ = 0;                          ///< which sample of the light, if lobes take several
    bool several_ = false;                       ///< some lobe takes several samples of each light
    bool checksHits_ = false;                    ///< lobes differ in the samples of the light that their rays could hit
    std::vector<int> told_;                      ///< by point: index in LitSurfaces::values; empty: no light queries surfaces
    std::vector<uint64_t> given_;                ///< by point: the light whose outputs were kept last, and which samples
    alignas(64) Row draws_;                      ///< by lane: samples of the light that a lobe takes
    std::vector<LightBlock> lights_;
    std::vector<LastRay> ends_;
    std::vector<render::NumberBlock> pairs_, choices_;
    std::vector<ShadePoint> queries_;
    std::vector<BlockQuery> asked_;
    std::vector<LightValue> values_;
    std::vector<int32_t> queryAt_;    ///< by point: index in values_; -1, or empty: lights_ holds all
    std::vector<size_t> litBlocks_;   ///< blocks with points that sample lights
    std::vector<float> lamp_;         ///< LightRows of these blocks
    std::vector<BlockPlaced> placed_; ///< by litBlocks_
    ScatterBlock next_{};
    std::vector<uint32_t> keys_; ///< by site, its number
    alignas(64) Row survived_;   ///< if the kernel waits: probability with which its ray was sent
    Lanes idle_ = 0;             ///< points of a block whose ray carries no light and only reports what it hits
    uint64_t ignored_ = 0;       ///< rays that are not sent because their "weight" is 0
    uint32_t turn_ = 0;          ///< if all lobes are followed: which ray of each lobe
    ShadowBlock shadow_{};
    int32_t sent_[kBlock];  ///< shadow rays of a block, in ShadowRays::queue; -1: not yet sent
    alignas(64) Row whole_; ///< all ones
    alignas(64) float value_[kValueRows][kBlock] = {};
    alignas(64) float drawn_[kDrawnRows][kBlock] = {};
};

} // namespace alpenglow::integrator
