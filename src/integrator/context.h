// What the stages of a thread share: the world, the rules of the hider, counters, the stop flag.
#pragma once
#include "integrator/rays.h"
#include "integrator/samples.h"
#include "world/lightguide.h"

namespace alpenglow::integrator {

/// How a hider transports light.
struct Rules {
    bool pickOne = false;          ///< path: one continuation per vertex, chosen at random; else all
    bool roulette = false;         ///< Russian roulette ends rays
    bool lightsAtRequests = false; ///< lobes sample lights at their requests
    bool emissionCounts = false;   ///< rays of lobes that sample no lights also see emission
    /// Of the hider and the frame's options.
    explicit Rules(const Settings& s)
        : pickOne(s.hider == Hider::Path), roulette(pickOne && s.roulette), lightsAtRequests(s.direct && !s.bsdfOnly),
          emissionCounts(pickOne) {}
};

/// A direction in which a path saw a light, or met an opaque surface.
struct SeenSample {
    static constexpr int32_t kBlocked = -1; ///< SeenSample::light of a surface
    SeenLight seen;                         ///< position and direction, camera space
    int32_t light;                          ///< index in WorldImpl::lights(); kBlocked: a surface
};

/// One for each thread.
struct Context {
    /// diagnostics: receives warnings; outlives the context. building: as MakeEvaluator.
    Context(std::shared_ptr<const WorldImpl>, Diagnostics&, bool building);
    const std::shared_ptr<const WorldImpl> frame; ///< keeps the world alive
    const WorldImpl& world;                       ///< *frame
    Diagnostics& diagnostics;                     ///< thread safe
    const bool building;                          ///< the world is not complete: what services answer may change
    const SeedKey seed;                           ///< of all random numbers
    const int32_t totalReflection;                ///< the label of rays that Counters::totalReflected counts
    Rules rules;                                  ///< of the hider
    Counters counters;                            ///< of this thread
    const StopFlag* stop = nullptr;               ///< null: cannot be stopped
    std::vector<SeenSample>* seen = nullptr;      ///< not null: receives the lights that paths see (learnlights.h)
    /// The current call can still be repeated with fewer points at a time, so exceeding the memory for requests is not yet an
    /// error.
    bool beginsAnew = false;
    /// Rays followed at once: enough to fill batches, few enough that their points stay in the cache of a core. Reduced after a
    /// shader requested more rays for the points of a batch than memory allows.
    static constexpr int kSlice = limits::kSliceRays / 8;
    int raysAtOnce = kSlice;
    uint64_t& raysOf(RayType); ///< the counter of rays of this type
};

/// Base of all stages: access to the context. A stage keeps references to the stages that it calls and to no others (stageset.h).
class Stage {
public:
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

protected:
    explicit Stage(Context& c)
        : context_(c), world_(c.world), rules_(c.rules), counters_(c.counters), diagnostics_(c.diagnostics) {}
    ~Stage() = default;
    Context& context_;
    const WorldImpl& world_;
    const Rules& rules_;
    Counters& counters_;
    Diagnostics& diagnostics_;
};

} // namespace alpenglow::integrator
