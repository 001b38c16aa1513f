// Light that walks below surfaces: subsurface().
#pragma once
#include "integrator/subsurfacewalks.h"

namespace alpenglow::transport {

class Accumulator;
class BatchPool;
class Displacement;
class Intersector;
class KernelInputs;
class LightKernels;
class LitSurfaces;
class PhotonStage;
class RayStore;
class Requests;
class ShadowRays;
class VertexLight;

/// The walks that a batch has asked for, and where they come out: points that gather light as diffuse() does.
class Walks final : Stage {
public:
    Walks(const StageSet&, BatchContext&, std::span<const WalkAsked>, std::span<const Below>);
    void run(Sched&);

private:
    struct Walker {
        int asked;
        Vec3 at, dir;
        Color weight, begin;
        uint32_t vertex;
        int inside = 1, steps = 0;
    };
    struct Exit {
        int asked;
        Color weight;
        uint32_t vertex;
        uint32_t shape;
        geometry::SurfacePoint point;
        Vec3 out; ///< unit normal of the surface, away from its inside
    };
    /// Where light enters, and the outward normal about which it does.
    struct Entry {
        Vec3 out, at;
        std::optional<geometry::SurfacePoint> surface; ///< that `at` is on; none: a point within
    };
    std::optional<Entry> entry(int asked) const;
    void start(int asked);
    void step();
    bool scatter(Walker&, double distance);
    bool meet(Walker&, const accel::Hit&, double reached);
    void probe(int asked);
    void weigh(Walker&, double way, bool scatters) const;
    double distance(const Walker&) const;
    /// Points of a batch where light is to be found that enters there.
    void settleAt(BatchContext&, std::span<const Exit>);
    void gatherAt(std::span<const Exit>, Sched&);
    /// Takes the exits where surfaces say themselves what enters.
    void askSurfaces(Sched&);
    /// What the shader of the surface, the same for all, says of that light; moves to the front the exits of which it says
    /// nothing.
    size_t askAt(std::span<Exit>, Sched&);
    void askLights(BatchContext&, std::span<const Exit>, Sched&);
    void skies(const BatchContext&, Sched&);
    bool belongs(uint32_t shape, int group) const;
    accel::Ray rayOf(const Walker&, double length) const;

    BatchContext& c_;
    std::span<const WalkAsked> asked_;
    std::span<const Below> below_;
    std::vector<Walker> walkers_, going_;
    std::vector<Exit> exits_;

    Accumulator& accumulator_;
    BatchPool& batches_;
    Displacement& displacement_;
    Intersector& intersector_;
    KernelInputs& inputs_;
    LightKernels& lightKernels_;
    LitSurfaces& litSurfaces_;
    PhotonStage& photons_;
    RayStore& store_;
    Requests& requests_;
    ShadowRays& shadows_;
    SubsurfaceWalks& subsurface_;
    VertexLight& vertexLight_;
};

} // namespace alpenglow::transport
