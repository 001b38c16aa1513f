// A batch of points that are shaded together.
#pragma once
#include "integrator/rays.h"
#include "services/kernelrun.h"
#include <exception>
#include <utility>

namespace alpenglow::integrator {

class KernelInputs;
class RayStore;

/// A group of affine pairs of one strip, as the kernel emitted it: rows of `lanes` floats; the first three rows are the weight.
/// light: the light whose loop made the pair; -1: none, or unknown.
struct EmitRecord {
    int site = 0, first = 0, lanes = 0; ///< index of the call site; first point of the strip; width of a row
    uint64_t mask = 0;                  ///< points of the strip that made the pair, as bits
    size_t offset = 0;                  ///< of the rows, in BatchContext::arena
    int light = -1;
};

/// Effect of an atmosphere on light behind it: Ci and Oi as seen, and the transmittance (coefficient of Ci).
struct AtmosphereEffect {
    Color shown, opacity, slope{1}; ///< by channel
    bool on = false;
}; ///< on: a volume shader has run

/// Data of a suspended strip (strips.h).
struct StripMemory {
    std::vector<float> in;          ///< argument rows of the pending request
    std::vector<int> laneOf;        ///< lanes that made the request
    std::vector<AccumulatorId> ids; ///< by laneOf; for a gather, by ray sent
    /// By call site and lane: number of calls so far. Counted by lane, so that the random numbers of a lane do not depend on the
    /// others.
    std::vector<uint32_t> occurrences;
};

/// State of one batch while its kernel runs; KernelCall::user.
struct BatchContext : KernelRun {
    ~BatchContext();
    KernelInputs* host = nullptr;       ///< answers the calls of the kernel
    RayStore* extrasOf = nullptr;       ///< not null: frees the RayExtra of the batch's rays in its destructor
    std::vector<AccumulatorId> targets; ///< by point; a batch for light outputs has its own
    std::vector<accel::Hit> hits;       ///< by point, for rays that hit surfaces
    /// By point, for a batch in rows (rowshading.h), whose `points` stay empty until a stage needs them; undefined otherwise.
    std::vector<geometry::SurfacePoint> surfaces;
    std::vector<const geometry::Shape*> shapes;
    std::vector<float> ways;                         ///< incident vectors, then ray origins: three rows each; then du, dv
    std::vector<EmitRecord> emits;                   ///< in the order in which the kernel made them
    std::vector<float> arena;                        ///< rows of all pairs
    std::vector<shading::FreeFlight> flown;          ///< by point: the ray segment, for points inside a medium (`between`)
    std::vector<float> depths;                       ///< by point: camera z of the hit, if points have other times; else empty
    std::vector<AtmosphereEffect> atmosphereEffects; ///< by point; empty if no point has a volume before it
    /// by point: transparency, i.e. the weight of light from behind; set only during gather() for kernels that do not wait
    std::vector<Color> clear;
    /// by point: probability of continuing behind the surface; 0: a lobe was chosen; empty: 1 everywhere
    std::vector<float> passes;
    bool indirectKept = false;       ///< RayStore::keepIndirect() has run
    bool opaque = false;             ///< every point is known to be opaque
    std::vector<uint8_t> ownShadows; ///< of a light, by lit point: LightValue::ownShadow; empty: none
    std::exception_ptr failure;      ///< from a callback during the kernel; exceptions cannot pass through generated code
    /// Call after each run of the kernel: rethrows what a callback threw.
    void ran() {
        if (failure) std::rethrow_exception(std::exchange(failure, nullptr));
    }
    /// Removes points before the kernel runs: move() each kept point to a lower index, then keepFirst().
    void move(size_t from, size_t to);
    /// Removes all points from this index on.
    void keepFirst(size_t count);
    size_t emitted = 0; ///< requests emitted so far, over all points
    size_t frame = 0;   ///< bytes of the frame of the last strip started
    // The suspended request of the current strip.
    int requestSite = -1, requestFirst = 0, requestLanes = 0;
    uint64_t requestMask = 0;
    std::vector<float> requestIn;
    float* requestOut = nullptr;
};

} // namespace alpenglow::integrator
