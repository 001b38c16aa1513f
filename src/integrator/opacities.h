// Oi where shadow rays and gathers meet surfaces whose shaders must say it: the kernel that gives Oi alone, a batch a surface.
#pragma once
#include "integrator/context.h"

namespace alpenglow::transport {

class Accumulator;
class Displacement;
class KernelInputs;
struct StageSet;

class Opacities final : Stage {
public:
    explicit Opacities(const StageSet&);
    /// At hits of one binding, 0 to 1.
    void opacities(std::span<const OpacityQuery>, std::span<Color> out);
    /// At any hits. `take` is told the number and the opacity of what was met.
    void takeOpacities(std::span<const OpacityQuery> met, const std::function<void(size_t, const Color&)>& take);

private:
    Accumulator& accumulator_;
    Displacement& displacement_;
    KernelInputs& inputs_;
};

} // namespace alpenglow::transport
