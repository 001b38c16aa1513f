// The vertices of a batch in blocks of 16 points, in columns, and what the stages over them hand on to each other (vertexlight.h
// lists the stages).
#pragma once
#include "integrator/blocklobes.h"
#include "integrator/context.h"
#include "integrator/lastskies.h"
#include "integrator/raystore.h"
#include "integrator/raywords.h"
#include "lanes/stages.h"
#include <map>

namespace alpenglow::integrator {

class LightPathStates;
class SurfacePoints;

/// Columns of one batch, shared by the stages over vertices.
struct VertexBlocks final : Stage {
    using Site = BlockLobes; ///< a call site of the kernel
    explicit VertexBlocks(const StageSet&);
    /// The lobes of a block, one entry for each site.
    std::span<LobeBlock*> lobesOf(size_t block);
    /// The camera sample of a ray.
    const PathSample& sampleOf(const RayBlock& of, int lane) const {
        const uint64_t at = uint64_t(of.sample[1][lane]) << 32 | of.sample[0][lane];
        return at ? *reinterpret_cast<const PathSample*>(at) : store_.noSample;
    }
    /// Factor of the light of surfaces that the ray of a lobe carries, without the energy rule.
    float indirectOf(const Site& s, size_t point) const {
        const LobeVertex* const r = s.requestAt(point);
        const bool called = s.info && s.lighting; // not a lobe of a photon shading model
        if (s.direct || (called && s.diffuse && !apart.empty() && (apart[point / kBlock] >> point % kBlock & 1))) return 0;
        return r ? r->indirect : indirect.empty() ? 1 : indirect[point];
    }
    /// Sets the keys of the points of a block; the stream is still to be set.
    void beginNumbers(size_t block, NumberBlock&) const;
    /// Draws the random numbers of a stream (NumberBlock) at all points.
    void drawNumbers(uint32_t stream, std::vector<NumberBlock>&, bool ofLights = true) const;
    /// Origin of a ray of a lobe in direction w.
    Vec3 originOf(const Site&, size_t point, const Vec3& w) const;
    /// RayExtra::share of light that a lobe reflects at the hit of a ray.
    int32_t shareOf(const Site& s, size_t point, const PathRay& from) const {
        if (waits) return -1;
        const LobeVertex* const r = s.requestAt(point);
        return r && r->share >= 0 ? r->share : from.extra < 0 ? -1 : store_.extraOf(from).share;
    }
    /// PathRay::path of light that a lobe scatters toward w.
    uint16_t pathOf(const Site&, bool delta, size_t point, const Vec3& w, const BatchContext&) const;
    /// Index of a point in LitSurfaces::values; -1: none.
    int litSurfaceAt(size_t point) const { return litSurface.empty() ? -1 : litSurface[point]; }
    size_t bytes() const; ///< memory that the columns hold
    /// Index in WorldImpl::lights().
    uint32_t numberOf(const BoundLight& l) const { return uint32_t(&l - world_.lights().data()); }

    // By VertexLoading and the stages that read requests.
    const BatchContext* moved = nullptr;        ///< the batch, if its shader has moved points
    size_t blocks = 0, points = 0, count = 0;   ///< count: requesting sites in `sites`
    bool waits = false;                         ///< the kernel waits for its results
    bool single = false;                        ///< requests were made one by one (singlerequests.h)
    std::vector<uint32_t> before;               ///< if it waits, by point: earlier ray requests
    std::span<const float> indirect;            ///< at exits of walks, by point: factor of the light of rays
    std::vector<Lanes> apart;                   ///< by block: points of indirectdiffuse(); empty: none
    std::vector<VertexBlock> vertices;          ///< by block
    std::vector<RayBlock> rays;                 ///< incoming rays, then the next rays
    std::vector<Site> sites;                    ///< the first `count`, in the order of the calls
    std::map<int, std::vector<uint32_t>> loops; ///< by call site that is called several times at a point: calls so far
    bool repeats = false;                       ///< some call site is called several times at a point
    bool sendsSeveral = false;                  ///< the kernel waits for several rays of a call
    uint64_t ignored = 0;                       ///< rays that are not sent because their "weight" is 0
    // By LightSampling, for one light.
    std::vector<Lanes> lit;                  ///< by block: points that sample it
    int onlySite = -1;                       ///< the only site that samples it; -1: all
    uint32_t draw = 0;                       ///< which sample, if lobes take several
    bool several = false;                    ///< some lobe takes several samples of each light
    bool mirrored = false;                   ///< the light comes by mirrors: for light path outputs
    bool checksHits = false;                 ///< lobes differ in the samples that their rays could hit
    std::vector<int> litSurface;             ///< litSurfaceAt(); empty: no light queries surfaces
    std::vector<LightBlock> lights;          ///< by block: samples of the light
    std::vector<ShadePoint> queries;         ///< points as the light's kernel takes them
    std::vector<BlockQuery> asked;           ///< by query
    std::vector<LightValue> values;          ///< by query
    std::vector<int32_t> queryAt;            ///< by point: index in `values`; -1, or empty: `lights` holds all
    std::vector<size_t> litBlocks;           ///< blocks with points that sample it
    std::vector<NumberBlock> pairs, choices; ///< by block: random numbers of light samples
    // By Connection.
    ShadowBlock shadow{};
    int32_t sent[kBlock]; ///< shadow rays of a block, in ShadowRays::queue; -1: not yet sent
    // By ScatterRays, for one block.
    ScatterBlock next{};
    alignas(64) Row survived; ///< if the kernel waits: probability with which its ray was sent
    Lanes idle = 0;           ///< points whose ray carries no light and only reports what it hits
    uint32_t turn = 0;        ///< if all lobes are followed: which ray of each lobe
    // Scratch of all.
    alignas(64) Row whole; ///< all ones
    alignas(64) float value[kValueRows][kBlock] = {};
    alignas(64) float drawn[kDrawnRows][kBlock] = {};

private:
    std::vector<LobeBlock*> block_; ///< lobesOf()
    const LightPathStates& paths_;
    RayStore& store_;
    SurfacePoints& surfaces_;
};

class Connection;
class GuideScatter;
class LastVertices;
class LightSampling;
class LobeRequests;
class LobeSelection;
class PhotonFlight;
class PhotonGather;
class ScatterRays;
class SingleRequests;
class SpecularLights;
class VertexLoading;

/// The stages over vertices in blocks, by reference. Each takes those that it calls.
struct VertexStages {
    VertexBlocks& blocks;
    /// In the order of vertexlight.h.
    VertexLoading& loading;
    LobeRequests& requests;
    SingleRequests& single;
    LobeSelection& selection;
    LightSampling& lights;
    Connection& connection;
    LastVertices& last;
    GuideScatter& guide;
    PhotonGather& gather;
    PhotonFlight& flight;
    ScatterRays& scatter;
};

/// Base of these stages.
class VertexStage : protected Stage {
protected:
    using Site = BlockLobes;
    VertexStage(const StageSet&, const VertexStages&);
    ~VertexStage() = default;
    VertexBlocks& v_;
    const lanes::Stages& stages_;
};

} // namespace alpenglow::integrator
