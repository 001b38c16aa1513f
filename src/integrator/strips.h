// Strips of kernels that suspend while their rays are traced.
#pragma once
#include "integrator/gathercalls.h"
#include "integrator/waitingkernels.h"
#include <array>

namespace alpenglow::integrator {

/// Writes the result of a request to the outputs of its call: rows of `lanes` floats; `sums` may be null.
void putResult(const SiteInfo&, const shading::TargetValue&, const TraceSums* sums, float* out, int lanes, int lane);

/// The pending request of a strip.
struct StripRequest {
    int site = 0, first = 0, lanes = 0;  ///< of the kernel; first point of the strip; lanes of the rows
    bool gather = false;                 ///< rays of a gather(), which have been intersected already
    const StripMemory* memory = nullptr; ///< arguments and results; null: there is no request
    const uint32_t* asked = nullptr;     ///< by lane: rays requested before
};

/// A suspended strip. Its request is processed together with those of other strips of its batch (WaitingKernels::follow).
class KernelStrip final : public Sched::Strip {
public:
    /// handle: of the suspended coroutine; first: point of the batch.
    KernelStrip(WaitingKernels&, std::shared_ptr<BatchContext>, void* handle, int first, int depth);
    ~KernelStrip() override;
    int depth() const override { return depth_; }
    /// Its frame, and approximately the memory of its points.
    size_t frameBytes() const override { return bytes_ + gatherBytes_ + 4096 + size_t(c_->bound->kernel->lanes()) * 256; }
    bool resume(Sched&, std::span<const shading::TargetValue> results) override;
    /// After start or resume: either ends (returns true), or registers its request with the stage and waits.
    bool advance(Sched&, std::unique_ptr<Sched::Strip> self);
    /// The batch.
    const std::shared_ptr<BatchContext>& context() const { return c_; }
    /// Makes its request: lobes and shadow rays. Keeps its targets held.
    void ask(Sched&);
    /// The request is in flight: the strip becomes ready when all of it is complete.
    void asked(Sched&);
    /// The pending request, for a caller that makes it in place of ask(); noteAsked() then records that. lobes: lanes that send
    /// rays, one each.
    StripRequest request() const { return {site_, first_, lanes_, gather_ != nullptr, &m_, asked_.data()}; }
    /// Counts rays that lobes of the strip request.
    void noteAsked(uint64_t lobes);

private:
    void askGather();
    int points() const { return std::min(first_ + c_->bound->kernel->lanes(), int(c_->points.size())); }
    WaitingKernels& stages_;
    std::shared_ptr<BatchContext> c_;
    void* handle_;
    int first_, depth_;
    size_t bytes_;
    // The pending request.
    int site_ = 0, lanes_ = 0;
    float* out_ = nullptr;
    StripMemory m_;
    GatherRows* gather_ = nullptr; ///< the pending gather(); null: another request
    std::vector<GatherSent> sent_;
    size_t gatherBytes_ = 0;
    std::array<uint32_t, 64> asked_{}; ///< by lane: rays requested so far
};

} // namespace alpenglow::integrator
