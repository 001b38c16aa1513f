// Runs a kernel over points that belong to no scene: memory for its inputs and outputs, and the call. Batches of the integrator,
// whose inputs come from points on surfaces, are shading::Batch.
#pragma once
#include "rsl/compiler.h"
#include <functional>
#include <memory>
#include <vector>

namespace alpenglow::rsl {

/// A kernel that does not wait for rays (KernelFacts::suspends), for up to a number of points at a time. Its light loops find no
/// lights.
class KernelRunner {
public:
    /// Answers a call site (a number of 0 or more) for some lanes; as rsl::ServiceFn.
    using Answer = std::function<void(int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out)>;

    /// Inputs are zero. The kernel must outlive the runner. Throws std::bad_alloc.
    KernelRunner(const CompiledKernel&, size_t points);
    KernelRunner(const KernelRunner&) = delete;
    KernelRunner& operator=(const KernelRunner&) = delete;
    /// Floats between rows.
    size_t stride() const { return size_t(call_.stride); }
    /// The rows of CompiledKernel::inputs()[k], in the layout of KernelCall::in.
    float* input(size_t k) { return rows_[k].get(); }
    /// A component of CompiledKernel::outputs()[k], by point.
    const float* output(size_t k, int component) const { return out_[k] + size_t(component) * stride(); }
    /// Runs the kernel over the first `points` points. Calls without an answer give zeros. stop: ends loops early if not 0.
    void run(size_t points, const Answer&, const StopFlag* stop = nullptr);

private:
    struct Free {
        void operator()(float*) const;
    };
    static void serve(KernelCall*, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out);
    float* newRows(size_t count);
    const CompiledKernel& kernel_;
    std::vector<std::unique_ptr<float[], Free>> rows_; ///< of the inputs, then of the outputs
    std::vector<const float*> in_;
    std::vector<float*> out_;
    const Answer* answer_ = nullptr; ///< of the current run
    KernelCall call_{};
};

} // namespace alpenglow::rsl
