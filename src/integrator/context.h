// What all stages of a thread share: the frame, how its light is followed, counts, and whether to stop.
#pragma once
#include "integrator/rays.h"
#include "integrator/samples.h"

namespace alpenglow::transport {

/// How the hider follows light.
struct Rules {
    bool pickOne = false;          ///< path: one ray goes on from a vertex, chosen by chance; else all do
    bool roulette = false;         ///< rays end by chance
    bool lightsAtRequests = false; ///< lobes sample lights
    bool emissionCounts = false;   ///< what shines is seen by rays whose lobes sample no lights, too
    explicit Rules(const Settings& s)
        : pickOne(s.hider == Hider::Path), roulette(pickOne && s.roulette), lightsAtRequests(s.direct && !s.bsdfOnly),
          emissionCounts(pickOne) {}
};

/// Of one thread.
struct Context {
    Context(std::shared_ptr<const WorldImpl>, Diagnostics&);
    const std::shared_ptr<const WorldImpl> frame; ///< keeps the world
    const WorldImpl& world;
    Diagnostics& diagnostics;
    const render::SeedKey seed;
    const int32_t totalReflection; ///< the label of rays that Counters::totalReflected counts
    Rules rules;
    Counters counters;
    const StopFlag* stop = nullptr; ///< null: nobody stops what runs
    /// What runs now is done again, with fewer points at a time, if a shader asks for more rays than there is room for.
    bool beginsAnew = false;
    /// Rays followed at once: enough to fill batches, few enough that their points stay in the cache of a core. Fewer once a
    /// shader has asked for more rays at the points of a batch than there is room for.
    static constexpr int kSlice = limits::kSliceRays / 8;
    int raysAtOnce = kSlice;
    uint64_t& raysOf(RayType); ///< the counter of such rays
};

/// What every stage has of the context. Stages keep references to the stages they call, and no others (stageset.h).
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

} // namespace alpenglow::transport
