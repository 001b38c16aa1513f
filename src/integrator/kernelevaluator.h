// Runs the kernels that a world needs outside of rendering, in a pipeline.
#pragma once
#include "integrator/names.h"
#include "world/evaluator.h"
#include "world/world.h"

namespace alpenglow::integrator {

/// A MakeEvaluator. The world must outlive the result.
std::unique_ptr<Evaluator> makeKernelEvaluator(const WorldImpl&, Diagnostics&, const StopFlag* stop, bool building);

} // namespace alpenglow::integrator
