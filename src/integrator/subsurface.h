// Random walks below surfaces: subsurface().
#pragma once
#include "integrator/subsurfacewalks.h"

namespace alpenglow::integrator {

class Accumulator;
class BatchPool;
class VertexLight;
class Displacement;
class Intersector;
class KernelInputs;
class LightKernels;
class LitSurfaces;
class PhotonStage;
class RayStore;
class Requests;
class ShadowRays;

/// The walks that a batch has requested, and their exits: points that gather light as diffuse() does.
class Walks final : Stage {
public:
    /// The batch and both lists outlive this.
    Walks(const StageSet&, BatchContext&, std::span<const WalkAsked>, std::span<const SubsurfaceMedium>);
    /// Follows all walks to their exits and lights these.
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
        Vec3 out; ///< unit surface normal, away from the inside
    };
    /// Where light enters, and the outward normal there.
    struct Entry {
        Vec3 out, at;
        std::optional<geometry::SurfacePoint> surface; ///< surface at `at`; none: a point inside
    };
    std::optional<Entry> entry(int asked) const;
    void start(int asked);
    void step();
    bool scatter(Walker&, double distance);
    bool intersect(Walker&, const accel::Hit&, double reached);
    void probe(int asked);
    void weigh(Walker&, double way, bool scatters) const;
    double distance(const Walker&) const;
    /// Turns the exits into points of a batch that gathers irradiance.
    void enterAt(BatchContext&, std::span<const Exit>);
    void gatherAt(std::span<const Exit>, Sched&);
    /// Handles exits on surfaces whose shaders return the entering light themselves.
    void askSurfaces(Sched&);
    /// Runs the shader of one surface at the exits; moves the exits to the front that it does not handle, and returns their
    /// number.
    size_t askAt(std::span<Exit>, Sched&);
    void askLights(BatchContext&, std::span<const Exit>, Sched&);
    void skies(const BatchContext&, Sched&);
    bool belongs(uint32_t shape, int group) const;
    accel::Ray rayOf(const Walker&, double length) const;

    BatchContext& c_;
    std::span<const WalkAsked> asked_;
    std::span<const SubsurfaceMedium> media_;
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

} // namespace alpenglow::integrator
