// The unit patch of `alpenglow shade`: P = (u, v, 0), u to the right and v downward over the picture, without a scene.
#pragma once
#include "base/diagnostics.h"
#include "base/stopflag.h"
#include "base/vec.h"
#include "display/image.h"
#include "rsl/kernelrunner.h"
#include "rsl/printlog.h"
#include "rsl/spilledarrays.h"
#include "services/withoutscene.h"
#include <string>
#include <vector>

namespace alpenglow::cli {

/// Runs a kernel over points of the patch, batch by batch.
class Patch {
public:
    /// values: of the shader's parameters. width, height: of the picture, of which du and dv are a pixel.
    Patch(const rsl::CompiledKernel&, std::vector<rsl::ParameterValue> values, const std::vector<std::string>& texturePaths,
          int width, int height, Diagnostics&);
    Patch(const Patch&) = delete;
    Patch& operator=(const Patch&) = delete;

    /// The outputs of the kernel, a channel for each number, as means of `side` by `side` points a pixel. Not whole if it was
    /// stopped.
    display::Image picture(int side);
    /// Runs a batch over the whole patch so many times and prints nanoseconds per point.
    void printTimes(int iterations);
    /// Whether the user stopped it.
    bool stopped() const { return *stop_ != 0; }

private:
    void answer(int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out);
    void run(size_t points);
    void fill(const std::vector<Vec2>& at);
    void fillInput(const rsl::ir::Input&, float* rows, const std::vector<Vec2>& at) const;
    std::vector<std::string> channels() const;
    void addBatch(display::Image&, size_t first, size_t points, size_t samples) const;

    const rsl::CompiledKernel& kernel_;
    std::vector<rsl::ParameterValue> values_;
    int width_, height_;
    Diagnostics& diagnostics_;
    services::WithoutScene services_;
    rsl::KernelRunner runner_;
    const StopFlag* stop_;
    bool print_ = true;
    size_t begun_ = 0; ///< index of the batch's first point
    rsl::PrintLog prints_;
    rsl::SpilledArrays spilled_;
};

} // namespace alpenglow::cli
