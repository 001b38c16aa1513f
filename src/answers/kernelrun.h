// A kernel that runs over points, as far as what answers it is concerned.
#pragma once
#include "answers/gatherrows.h"
#include "answers/lightloop.h"
#include <deque>

namespace alpenglow::transport {

struct KernelRun {
    std::shared_ptr<shading::Batch> batch;
    const BoundKernel* bound = nullptr;
    const SurfaceBinding* binding = nullptr; ///< of the first point; the light list is the same for all
    std::vector<ShadePoint> points;
    std::vector<shading::PathRay> rays; ///< of the points: ShadePoint::ray points here
    std::vector<int> bindings;          ///< by point
    /// How many points: those of a batch in rows have no structures.
    size_t size() const { return points.empty() ? rays.size() : points.size(); }
    const BoundLight* light = nullptr;  ///< whose kernel runs
    const LitSurface* lit = nullptr;    ///< while a light's kernel runs: what it lights
    const Medium* volume = nullptr;     ///< while a volume's kernel runs
    const LightOutput* aside = nullptr; ///< the run gives this output and nothing else
    bool forShadow = false;             ///< the kernel tells its opacity to shadow rays
    bool again = false;                 ///< it is no shading of its own: nothing is printed and baked
    bool dark = false;                  ///< loops over lights find none
    bool below = false;                 ///< walks below a surface come out at the points: light is gathered; no kernel
    bool between = false;               ///< the points lie on the way of rays, inside of a medium, on no surface
    std::shared_ptr<const KernelRun>
        displaced;                      ///< the displacement shader's run at these points, where its outputs are asked for
    const KernelRun* surface = nullptr; ///< while an atmosphere's kernel runs: the surface's run that it dims
    std::vector<int> surfacePoint;      ///< by point: its number in that run
    // What answers keep with it.
    std::deque<LightLoop> loops;    ///< Answers::lightLoop()
    std::vector<Color> ambient;     ///< by point: the sum of the ambient lights; empty until it is asked for
    std::vector<LightSheet> sheets; ///< by turn of all lights; empty until a loop runs
    std::vector<uint32_t> draws;    ///< by site and point: how often random() was called there; empty until it is
    std::vector<float>
        lightChannels;      ///< by point, all AOVs: what lights gave by outputchannel(), and atmospheres; empty when none did
    int lightNow = -1;      ///< whose light it is that the loop over lights has; -1: not known
    uint32_t lightDraw = 0; ///< drawOf() that loop
    std::vector<ShadowReach> lightReach; ///< by lane: of the light sample; 1e38 far for distant lights
    /// By number of the statement and first point of a strip: what its gather loops hold now.
    std::map<std::pair<int, int>, GatherRows> gathers;
    /// As new, in the memory that is there; of `points` and `batch` the caller decides.
    void forget();
};

} // namespace alpenglow::transport
