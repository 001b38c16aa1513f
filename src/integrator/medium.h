// Segments through homogeneous scattering media (world/bound.h, Homogeneous), in closed form.
#pragma once
#include "base/numberlanes.h"
#include "integrator/context.h"
#include "integrator/lightdirected.h"
#include "integrator/raysegment.h"

namespace alpenglow::services {
struct KernelRun;
} // namespace alpenglow::services

namespace alpenglow::integrator {

/// Equiangular sampling: chooses points on a segment uniformly in the angle at which a light sees them (Kulla and Fajardo,
/// Importance Sampling Techniques for Path Tracing in Participating Media, 2012). The density is about proportional to the light
/// that arrives.
class Equiangular {
public:
    /// Without a value if the light has no known position, or is so far away that it lights the segment almost uniformly.
    static std::optional<Equiangular> of(const FreeFlight&, const BoundLight&, MediumSampling);
    /// Whether look() finds the light.
    static bool sees(const FreeFlight& f, const BoundLight& l, MediumSampling how) { return Equiangular().look(f, l, how); }
    float at(float u) const;       ///< a point for a number in [0, 1), as a distance along the segment
    double density(float t) const; ///< per unit of length

private:
    /// Sets all but the angles. Returns false if equiangular sampling does not apply.
    bool look(const FreeFlight&, const BoundLight&, MediumSampling);
    double length_ = 0, nearest_ = 0, away_ = 0, from_ = 0, to_ = 0; ///< angles are at the light
};

class Accumulator;
class Atmosphere;
struct BatchContext;
class BatchPool;
class VertexLight;
class SegmentEvents;
class LightKernels;
class LightPathStates;
class LitSurfaces;
class MediaStacks;
class RayStore;
class Requests;
class ShadowRays;
struct StageSet;

/// Absorption and scattering in media, under path. Each segment samples a distance in proportion to transmittance: one of the
/// three channels is chosen by path throughput, and the density is the mixture of all three. Rays that reach their surface
/// continue; the others gather light at the sampled point and scatter. Camera rays follow both branches.
///
///  Near lights with a position, more points are chosen by Equiangular and weighted by the power heuristic. Rays scattered there
///  are also sampled toward such a light, because rays receive more single scattering the closer they pass it (Georgiev et al.,
///  Joint Importance Sampling of Low-Order Anisotropic Volume Scattering, 2013).
class MediumEvents final : Stage, public SegmentEvent {
public:
    /// With the media of the world.
    explicit MediumEvents(const StageSet&);
    void happen(std::span<RaySegment>, Sched&) override;
    /// Does nothing: MediaStacks::dim() applies the transmittance.
    void dim(std::span<const ShadowRay>, std::span<Color>) override {}
    /// MIS weight of distance sampling for light from one light with a position; equiangular sampling has the rest.
    float shareOfDistance(const FreeFlight&, const BoundLight&) const;

    /// Unit direction from a point in a medium to a near light with a position, for light-directed sampling; 0 if there is none.
    /// Among several lights one is chosen uniformly, which is unbiased. `away`: its distance.
    Vec3 lightDirection(const Medium&, const PathRay&, const Vec3& from, float* away = nullptr) const;
    /// The same for a surface point within a medium; the result has the share of samples.
    LightDirected atSurfaceInMedium(const KernelRun&, size_t point) const;
    /// Whether the settings and the world use light-directed sampling at surfaces.
    bool surfacesAim() const;

private:
    struct Crossing {
        size_t flight;
        FreeFlight way;
        Color weight;
        bool stops = false;
    }; ///< weight: of the ray at the start of the segment
    bool leaks(const RaySegment&); ///< whether the ray left the scene inside a medium; counts
    std::optional<Crossing> cross(RaySegment&, size_t flight, Vec2 random, Sched&);
    void pass(RaySegment&, Sched&);
    void scatter(std::span<RaySegment>, std::span<const Crossing>, Sched&);
    void gather(BatchContext&, const Medium&, Sched&);
    void placePoints(BatchContext&, const Medium&) const;
    void nearLights(std::span<RaySegment>, std::span<const Crossing>, Sched&);
    void addOpacity(const PathRay&, const Color&); ///< adds to the sample of a camera ray
    void glow(const RaySegment&, const Homogeneous&, Sched&);
    class NearLight;
    std::vector<Crossing> crossings_;
    NumberRows numbers_;
    std::vector<Vec3> lights_;
    Accumulator& accumulator_;
    Atmosphere& atmosphere_;
    BatchPool& batches_;
    SegmentEvents& segmentEvents_;
    LightKernels& lightKernels_;
    LitSurfaces& litSurfaces_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    RayStore& store_;
    Requests& requests_;
    ShadowRays& shadows_;
    VertexLight& vertexLight_;
};

} // namespace alpenglow::integrator
