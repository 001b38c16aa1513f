// A kernel run over points, as services see it.
#pragma once
#include "rsl/spilledarrays.h"
#include "services/gatherrows.h"
#include "services/lightloop.h"
#include <deque>

namespace alpenglow::services {

/// One batch of points, what shades it, and the state of its services.
struct KernelRun {
    std::shared_ptr<shading::Batch> batch;
    const BoundKernel* bound = nullptr;      ///< the kernel with its bound call sites
    const SurfaceBinding* binding = nullptr; ///< of the first point; the light list is the same for all
    std::vector<ShadePoint> points;
    std::vector<shading::PathRay> rays; ///< of the points; ShadePoint::ray points here
    std::vector<int> bindings;          ///< by point
    /// Number of points; a batch in rows has no point structures.
    size_t size() const { return points.empty() ? rays.size() : points.size(); }
    const BoundLight* light = nullptr;          ///< whose kernel runs
    const LitSurface* lit = nullptr;            ///< while a light's kernel runs: the lit surface
    const Medium* volume = nullptr;             ///< while a volume's kernel runs
    const LightOutput* lightOutput = nullptr;   ///< the run computes this output only
    bool forShadow = false;                     ///< the kernel returns opacity for shadow rays
    bool again = false;                         ///< a repeated run: prints and bakes nothing
    bool dark = false;                          ///< loops over lights are empty
    bool subsurface = false;                    ///< exits of subsurface walks: points that gather light, without a kernel
    bool between = false;                       ///< points on ray segments inside a medium
    std::shared_ptr<const KernelRun> displaced; ///< run of the displacement shader at these points, if its outputs are queried
    const KernelRun* surface = nullptr;         ///< while an atmosphere's kernel runs: the run of the surface behind it
    std::vector<int> surfacePoint;              ///< by point: index in that run
    // Data of services.
    std::deque<LightLoop> loops;    ///< Services::lightLoop()
    std::vector<Color> ambient;     ///< by point: sum of the ambient lights; empty until used
    std::vector<LightSheet> sheets; ///< by light sample; empty until a loop runs
    rsl::SpilledArrays spilled;     ///< of arrays that have outgrown the kernel's memory
    std::vector<uint32_t> draws;    ///< by call site and point: number of random() calls; empty until used
    std::vector<float>
        lightChannels;      ///< by point, all AOVs: values by outputchannel() of lights, and by atmospheres; empty without any
    int lightNow = -1;      ///< the light of the current iteration; -1: unknown
    uint32_t lightDraw = 0; ///< drawOf() of that loop
    std::vector<ShadowReach> lightReach; ///< by lane: for the light sample; distance 1e38 for distant lights
    /// Current rays of gather() loops, by index of the statement and first point of a strip.
    std::map<std::pair<int, int>, GatherRows> gathers;
    /// Resets the run and keeps its memory; the caller handles `points` and `batch`.
    void forget();
};

} // namespace alpenglow::services
