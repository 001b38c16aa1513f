// Strips of kernels that wait for rays.
#pragma once
#include "integrator/gathercalls.h"
#include "integrator/waitingkernels.h"
#include <array>

namespace alpenglow::transport {

/// What a request came back with, where its call takes it. Results are rows of `lanes` floats; `sums` may be null.
void putResult(const SiteInfo&, const shading::TargetValue&, const TraceSums* sums, float* out, int lanes, int lane);

/// What a strip waits for.
struct StripRequest {
    int site = 0, first = 0, lanes = 0; ///< of the kernel; the strip's first point; lanes of the rows
    bool gather = false;                ///< the rays of a gather, which are found already
    const StripMemory* memory = nullptr;
    const uint32_t* asked = nullptr; ///< by lane: rays that it has asked for before
};

/// A strip of a suspending kernel while it waits. What it asks for is followed together with what other strips of its batch ask
/// for (WaitingKernels::follow).
class KernelStrip final : public Sched::Strip {
public:
    KernelStrip(WaitingKernels&, std::shared_ptr<BatchContext>, void* handle, int first, int depth);
    ~KernelStrip() override;
    int depth() const override { return depth_; }
    /// Its frame, and about what its points take.
    size_t frameBytes() const override { return bytes_ + gatherBytes_ + 4096 + size_t(c_->bound->kernel->lanes()) * 256; }
    bool resume(Sched&, std::span<const shading::TargetValue> results) override;
    /// After start or resume: ends (true), or notes its request with the stage and waits.
    bool advance(Sched&, std::unique_ptr<Sched::Strip> self);
    const std::shared_ptr<BatchContext>& context() const { return c_; }
    /// Asks for what it waits for: lobes and shadow rays. Its targets stay held.
    void ask(Sched&);
    /// What it asked for is on its way: it is ready once all of that is complete.
    void asked(Sched&);
    /// What ask() would ask for, for somebody who does that instead; and then, that it was done. lobes: lanes that send rays, one
    /// each.
    StripRequest request() const { return {site_, first_, lanes_, gather_ != nullptr, &m_, asked_.data()}; }
    void noteAsked(uint64_t lobes);

private:
    void askGather();
    int points() const { return std::min(first_ + c_->bound->kernel->lanes(), int(c_->points.size())); }
    WaitingKernels& stages_;
    std::shared_ptr<BatchContext> c_;
    void* handle_;
    int first_, depth_;
    size_t bytes_;
    // The request that it waits for.
    int site_ = 0, lanes_ = 0;
    float* out_ = nullptr;
    StripMemory m_;
    GatherRows* gather_ = nullptr; ///< the gather that it waits for; null: another request
    std::vector<GatherSent> sent_;
    size_t gatherBytes_ = 0;
    std::array<uint32_t, 64> asked_{}; ///< rays that a lane has asked for so far
};

} // namespace alpenglow::transport
