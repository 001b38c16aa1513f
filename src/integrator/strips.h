// Strips of kernels that wait for rays.
#pragma once
#include "integrator/gathercalls.h"
#include "integrator/waitingkernels.h"
#include <array>

namespace alpenglow::transport {

/// What a request came back with, where its call takes it. Results are rows of `lanes` floats; `sums` may be null.
void putResult(const SiteInfo&, const shading::TargetValue&, const TraceSums* sums, float* out, int lanes, int lane);

/// A strip of a suspending kernel while it waits. What it asks for is followed together with what other strips of its batch ask
/// for (WaitingKernels::follow).
class KernelStrip final : public Sched::Strip {
public:
    KernelStrip(WaitingKernels& stages, std::shared_ptr<BatchContext> c, void* handle, int first, int depth)
        : stages_(stages), c_(std::move(c)), handle_(handle), first_(first), depth_(depth), bytes_(c_->frame) {}
    ~KernelStrip() override {
        if (handle_) c_->bound->kernel->destroy(handle_);
    }
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
    std::vector<float> in_;
    std::vector<int> laneOf_;
    std::vector<TargetId> ids_;    ///< by laneOf_; of a gather, by `sent_`
    GatherRows* gather_ = nullptr; ///< the gather that it waits for; null: another request
    std::vector<GatherSent> sent_;
    size_t gatherBytes_ = 0;
    /// By site and lane, how often it has asked there: what other lanes ask for must not change this one's random numbers.
    std::vector<uint32_t> occurrences_;
    std::array<uint32_t, 64> asked_{}; ///< rays that a lane has asked for so far
};

} // namespace alpenglow::transport
