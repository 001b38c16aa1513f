// Ways through media that scatter (world/bound.h, Homogeneous), in closed form.
#pragma once
#include "base/numberlanes.h"
#include "integrator/beside.h"
#include "integrator/context.h"
#include "integrator/flight.h"

namespace alpenglow::transport {

/// Where a light with a place is seen from a way: points on it are chosen evenly by the angle under which that place sees them
/// (Kulla and Fajardo, Importance Sampling Techniques for Path Tracing in Participating Media, 2012), which is about how much of
/// its light comes to them.
class Equiangular {
public:
    /// Nothing where the light has no place that is known, or so far away that all of the way has about the same of its light.
    static std::optional<Equiangular> of(const FreeFlight&, const BoundLight&, MediumSampling);
    static bool sees(const FreeFlight& f, const BoundLight& l, MediumSampling how) { return Equiangular().look(f, l, how); }
    float at(float u) const;       ///< a point for a number of [0, 1), as a length of the way
    double density(float t) const; ///< a unit of length

private:
    /// All but the angles. False: there is none.
    bool look(const FreeFlight&, const BoundLight&, MediumSampling);
    double length_ = 0, nearest_ = 0, away_ = 0, from_ = 0, to_ = 0; ///< angles at the light
};

class Accumulator;
class Atmosphere;
struct BatchContext;
class BatchPool;
class BlockVertices;
class Flights;
struct KernelRun;
class LightKernels;
class LightPathStates;
class LitSurfaces;
class MediaStacks;
class RayStore;
class Requests;
class ShadowRays;
struct StageSet;
class VertexLight;

/// The event of media that absorb and scatter, under path. On each way a distance is drawn in proportion to what is left of the
/// light (of the three channels one, by what the path has left of it; all three make its density). What comes as far as its
/// surface goes on, the others meet lights there, by Gather, and are scattered. Of a ray from the camera both is followed.
/// Where lights with a place are near, more points are chosen by Equiangular; the power heuristic weighs both. What is scattered
/// there goes also toward such a light, as rays that pass it bring the more the nearer they come (Georgiev et al., Joint
/// Importance Sampling of Low-Order Anisotropic Volume Scattering, 2013).
class MediumFlights final : Stage, public FlightEvent {
public:
    explicit MediumFlights(const StageSet&);
    void happen(std::span<Flight>, Sched&) override;
    /// Nothing: MediaStacks::dim() has taken it.
    void dim(std::span<const ShadowRay>, std::span<Color>) override {}
    /// The part that a point chosen by distance has in the light of one with a place; the rest comes from other points.
    float shareOfDistance(const FreeFlight&, const BoundLight&) const;

    /// The direction of a light with a place that rays from a point in a medium may pass; 0 where none is near. Of several one,
    /// all with the same chance: a density for any of them is right. `away`: how far it is.
    Vec3 besideLight(const Medium&, const PathRay&, const Vec3& from, float* away = nullptr) const;
    /// The same for rays that leave a point of a surface, of lobes that give back most from there.
    Beside besideSurface(const KernelRun&, size_t point) const;
    /// Whether rays of surfaces pass lights in some medium, by what the render is.
    bool surfacesAim() const;

private:
    struct Crossing {
        size_t flight;
        FreeFlight way;
        Color weight;
        bool stops = false;
    }; ///< weight: of the ray where it begins
    bool leaks(const Flight&); ///< what ends nowhere is said
    std::optional<Crossing> cross(Flight&, size_t flight, Vec2 random, Sched&);
    void pass(Flight&, Sched&);
    void scatter(std::span<Flight>, std::span<const Crossing>, Sched&);
    void gather(BatchContext&, const Medium&, Sched&);
    void placePoints(BatchContext&, const Medium&) const;
    void nearLights(std::span<Flight>, std::span<const Crossing>, Sched&);
    void addOpacity(const PathRay&, const Color&); ///< to the sample of a camera ray
    void glow(const Flight&, const Homogeneous&, Sched&);
    class NearLight;
    std::vector<Crossing> crossings_;
    render::NumberRows numbers_;
    std::vector<Vec3> lights_;
    int leaks_ = 0; ///< rays that left the scene inside of such a medium
    Accumulator& accumulator_;
    Atmosphere& atmosphere_;
    BatchPool& batches_;
    BlockVertices& blocks_;
    Flights& flights_;
    LightKernels& lightKernels_;
    LitSurfaces& litSurfaces_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    RayStore& store_;
    Requests& requests_;
    ShadowRays& shadows_;
    VertexLight& vertexLight_;
};

} // namespace alpenglow::transport
