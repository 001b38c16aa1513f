// A batch of points that are shaded together.
#pragma once
#include "answers/kernelrun.h"
#include "integrator/rays.h"
#include <exception>
#include <utility>

namespace alpenglow::transport {

class KernelInputs;
class RayStore;

/// One affine pair group of a strip, as the kernel emitted it: rows of `lanes` floats, the first three the weight. light:
/// whose light a loop weighs; -1: of none, or not known.
struct EmitRecord {
    int site = 0, first = 0, lanes = 0;
    uint64_t mask = 0;
    size_t offset = 0;
    int light = -1;
};

/// What an atmosphere makes of the light that a ray met: Ci and Oi as seen, and the coefficient of the light met.
struct Haze {
    Color shown, opacity, slope{1};
    bool on = false;
}; ///< on: a volume shader has run

/// What a strip of a waiting kernel keeps (strips.h).
struct StripMemory {
    std::vector<float> in;     ///< rows of the request that it waits for
    std::vector<int> laneOf;   ///< lanes that ask
    std::vector<TargetId> ids; ///< by laneOf; of a gather, by the rays that are sent
    /// By site and lane, how often it has asked there: what other lanes ask for must not change this one's random numbers.
    std::vector<uint32_t> occurrences;
};

/// State of one batch while its kernel runs; KernelCall::user.
struct BatchContext : KernelRun {
    ~BatchContext();
    KernelInputs* host = nullptr;  ///< answers what the kernel calls
    RayStore* extrasOf = nullptr;  ///< not null: what its rays carry besides is freed with it
    std::vector<TargetId> targets; ///< by point; of an `aside` its own
    std::vector<accel::Hit> hits;  ///< by point, of rays that met surfaces
    /// By point, of a batch in rows (rowshading.h), whose `points` are empty until somebody asks for them; else void.
    std::vector<geometry::SurfacePoint> surfaces;
    std::vector<const geometry::Shape*> shapes;
    std::vector<float> ways; ///< incident vectors, then where the rays began: three rows each; then du, dv
    std::vector<EmitRecord> emits;
    std::vector<float> arena;
    std::vector<shading::FreeFlight> flown; ///< by point, where they lie inside of a medium (`between`)
    std::vector<float> depths;              ///< by point: camera z of the hit, if points are of another time; else empty
    std::vector<Haze> haze;                 ///< by point; only where a volume lies before some point
    std::vector<Color> clear;  ///< by point: what goes on behind it; only while gather() runs for a kernel that does not wait
    std::vector<float> passes; ///< by point: the chance with which its ray goes on, 0: another was taken; empty: it always does
    bool indirectKept = false; ///< RayStore::keepIndirect() has been here
    bool opaque = false;       ///< nothing goes on behind any point; false: perhaps
    std::vector<uint8_t> ownShadows; ///< of a light, by lit point: LightValue::ownShadow; empty: of none
    std::exception_ptr failure;      ///< of a callback while the kernel ran: exceptions cannot pass generated code
    /// After each run of the kernel: throws what a callback threw.
    void ran() {
        if (failure) std::rethrow_exception(std::exchange(failure, nullptr));
    }
    /// Before the kernel runs: points that are not shaded leave. A point moves to a place before it, then the first are kept.
    void move(size_t from, size_t to);
    void keepFirst(size_t count);
    size_t emitted = 0; ///< requests of all points so far
    size_t frame = 0;   ///< bytes of the frame of the strip that was started last
    // suspended request of the strip that runs now
    int requestSite = -1, requestFirst = 0, requestLanes = 0;
    uint64_t requestMask = 0;
    std::vector<float> requestIn;
    float* requestOut = nullptr;
};

} // namespace alpenglow::transport
