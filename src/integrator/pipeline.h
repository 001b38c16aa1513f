// The stages of one thread in their order: slices of rays from the scheduler meet surfaces, hits wait by group, points are
// shaded, requests become rays (docs/architecture.md has the way of a sample).
#pragma once
#include "integrator/photonjob.h"
#include "integrator/samples.h"
#include "integrator/stageset.h"
#include "shading/scheduler.h"

namespace alpenglow::transport {

class Pipeline final : public shading::Sched::RayService {
public:
    Pipeline(std::shared_ptr<const WorldImpl>, Diagnostics&);
    ~Pipeline() override;
    /// Follows camera rays to the end. Results do not depend on which rays share a call. False: `stop` was set, `out` is void.
    bool trace(std::span<const CameraRay>, std::span<SampleResult> out, const StopFlag* stop);
    /// Emits photons by number and follows them to the end: what comes to rest goes to `out`, in an order that depends on nothing
    /// else. This pipeline then follows photons only. False: `stop` was set, and `out` is void.
    bool emit(const PhotonJob&, uint32_t first, uint32_t count, std::vector<StoredPhoton>& out, const StopFlag* stop);
    // For the scheduler.
    void follow(std::span<const shading::Sched::Task> slice, shading::Sched&) override;
    bool settle(shading::Sched&) override;
    void followStrips(shading::Sched&) override;

    const StageSet& stages() const;
    const WorldImpl& world() const;
    Counters& counters();
    shading::Sched& scheduler(); ///< of this pipeline; made when it is asked for
    /// Whether a ray of the last trace() came to the bound of a procedural that is not made yet (Unmade): its results are void.
    bool& unfinished();

private:
    /// run() until it has room, with fewer rays at once each time; undo() takes back what it has counted.
    bool withinRoom(const std::function<bool()>& run, const std::function<void()>& undo);
    bool traceAll(std::span<const CameraRay>, std::span<SampleResult>);
    bool emitAll(const PhotonJob&, uint32_t first, uint32_t count);
    void beginRay(const CameraRay&, size_t i, shading::PathRay&); ///< the i-th of a call
    void beginTrace();                                            ///< nothing waits and nothing is spoiled
    void takeResults(std::span<SampleResult>, std::span<const shading::TargetId> roots);
    void endTrace(); ///< counts what the scheduler saw, and forgets
    void forget();   ///< what a trace() that has ended, or was given up, leaves behind
    void shadeHits(size_t group, shading::Sched&);
    struct Parts;
    std::unique_ptr<Parts> parts_;
    std::unique_ptr<shading::Sched> sched_;
};

} // namespace alpenglow::transport
