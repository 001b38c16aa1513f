// The kernels that a world needs while nobody follows rays, run by a pipeline.
#pragma once
#include "world/evaluator.h"
#include "world/world.h"

namespace alpenglow::transport {

/// A MakeEvaluator. The world must outlive it.
std::unique_ptr<Evaluator> makeKernelEvaluator(const WorldImpl&, Diagnostics&, const StopFlag* stop);

} // namespace alpenglow::transport
