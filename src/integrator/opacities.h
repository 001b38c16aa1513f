// Oi where shadow rays and gather() rays hit surfaces with opacity from a shader: runs the opacity-only kernel, one batch a
// surface.
#pragma once
#include "integrator/context.h"

namespace alpenglow::integrator {

class Accumulator;
class Displacement;
class KernelInputs;
struct StageSet;

/// Runs kernels that compute opacity alone.
class Opacities final : Stage {
public:
    explicit Opacities(const StageSet&);
    /// Opacity at hits of one binding, 0 to 1.
    void opacities(std::span<const OpacityQuery>, std::span<Color> out);
    /// At any hits. `take` receives the index and the opacity of each.
    void takeOpacities(std::span<const OpacityQuery> met, const std::function<void(size_t, const Color&)>& take);

private:
    Accumulator& accumulator_;
    Displacement& displacement_;
    KernelInputs& inputs_;
};

} // namespace alpenglow::integrator
