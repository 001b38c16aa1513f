// The stages of one thread in order: the scheduler's slices of rays are intersected, hits are queued by group, points are shaded,
// requests become rays (docs/architecture.md, "Stages of the integrator").
#pragma once
#include "integrator/photonjob.h"
#include "integrator/samples.h"
#include "integrator/stageset.h"
#include "shading/scheduler.h"

namespace alpenglow::integrator {

/// All stages of one thread.
class Pipeline final : public shading::Sched::RayService {
public:
    /// diagnostics outlive this. building: as MakeEvaluator; else the world is of World::build().
    Pipeline(std::shared_ptr<const WorldImpl>, Diagnostics&, bool building = false);
    ~Pipeline() override;
    /// Traces camera rays to the end. Results do not depend on which rays share a call. Returns false if `stop` was set; `out` is
    /// then undefined.
    bool trace(std::span<const CameraRay>, std::span<SampleResult> out, const StopFlag* stop);
    /// Emits photons first to first + count - 1, traces them to the end and appends stored ones to `out`, in an order that
    /// depends on nothing else. Afterwards this pipeline traces photons only. Returns false if `stop` was set; `out` is then
    /// undefined.
    bool emit(const PhotonJob&, uint32_t first, uint32_t count, std::vector<StoredPhoton>& out, const StopFlag* stop);
    /// Sends these probes through mirrors and glass, and fills `ends`, which has as many. The job's plan is not used. Afterwards
    /// this pipeline traces photons only. Returns false if `stop` was set; `ends` are then undefined.
    bool probe(const PhotonJob& job, std::span<const PhotonProbe> probes, std::span<ProbeEnd> ends, const StopFlag* stop);
    // Scheduler callbacks.
    void follow(std::span<const shading::Sched::Task> slice, shading::Sched&) override;
    bool shadeQueued(shading::Sched&) override;
    void followStrips(shading::Sched&) override;

    /// Of this pipeline; valid as long as it.
    const StageSet& stages() const;
    const WorldImpl& world() const;
    Counters& counters();
    shading::Sched& scheduler(); ///< of this pipeline; created at the first call
    /// Whether a ray of the last trace() reached the bound of a deferred procedural (DeferredBounds); its results are then
    /// undefined.
    bool& unfinished();

private:
    /// Repeats run() with fewer rays at once until it fits into memory; undo() reverts its counts.
    bool withinRoom(const std::function<bool()>& run, const std::function<void()>& undo);
    bool traceAll(std::span<const CameraRay>, std::span<SampleResult>);
    PhotonTrace& beginPhotons(const PhotonJob&, const StopFlag*); ///< sets the rules of photons
    bool emitAll(const PhotonJob&, uint32_t first, uint32_t count);
    void beginRay(const CameraRay&, size_t i, shading::PathRay&); ///< the i-th of a call
    const shading::Media* mediaAtStart(const CameraRay&);         ///< Interior volumes around its origin; null: none
    void beginTrace();                                            ///< resets per-call state
    void takeResults(std::span<SampleResult>, std::span<const shading::AccumulatorId> roots);
    void endTrace(); ///< adds the scheduler's counts, then calls forget()
    void forget();   ///< drops the state of a trace() that has ended or was abandoned
    void blocked(const shading::PathRay&, const accel::Hit&);
    void shadeHits(size_t group, shading::Sched&);
    struct Parts;
    std::unique_ptr<Parts> parts_;
    std::unique_ptr<shading::Sched> sched_;
};

} // namespace alpenglow::integrator
