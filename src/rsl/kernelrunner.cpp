#include "rsl/kernelrunner.h"
#include <algorithm>
#include <new>

namespace alpenglow::rsl {

namespace {
constexpr std::align_val_t kAlign{64}; // of KernelCall::in and out
constexpr StopFlag kGo{};

int32_t noLights(KernelCall*, int32_t, int32_t, uint64_t, int32_t, const float*) { return 0; }
uint64_t noLight(KernelCall*, int32_t, int32_t, int32_t, uint64_t, int32_t, float*) { return 0; }
void endLights(KernelCall*, int32_t, int32_t, int32_t) {}
} // namespace

void KernelRunner::serve(KernelCall* call, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in,
                         float* out) {
    const Answer& answer = *static_cast<const KernelRunner*>(call->user)->answer_;
    if (site >= 0 && answer) answer(site, first, mask, lanes, in, out);
}

void KernelRunner::Free::operator()(float* p) const { ::operator delete[](p, kAlign); }

KernelRunner::KernelRunner(const CompiledKernel& k, size_t points) : kernel_(k) {
    call_.stride = int32_t((std::max<size_t>(points, 1) + 63) / 64 * 64);
    for (const auto& i : k.inputs())
        in_.push_back(newRows(size_t(std::max(1, i.array)) * size_t(ir::components(i.kind)) * size_t(inputParts(i))));
    for (const auto& o : k.outputs()) out_.push_back(newRows(size_t(ir::components(o.kind))));
    call_.in = in_.data();
    call_.out = out_.data();
    call_.strings = k.strings().data();
    call_.service = serve;
    call_.lightBegin = noLights;
    call_.lightFetch = noLight;
    call_.lightEnd = endLights;
}

float* KernelRunner::newRows(size_t count) {
    const size_t floats = std::max<size_t>(count, 1) * stride();
    rows_.emplace_back(static_cast<float*>(::operator new[](floats * sizeof(float), kAlign)));
    std::fill_n(rows_.back().get(), floats, 0.f);
    return rows_.back().get();
}

void KernelRunner::run(size_t points, const Answer& answer, const StopFlag* stop) {
    call_.n = int32_t(points);
    answer_ = &answer;
    call_.user = this;
    call_.stop = stop ? stop : &kGo;
    kernel_.run(&call_);
}

} // namespace alpenglow::rsl
