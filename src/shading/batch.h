// A batch: points that one kernel shades together, laid out as the kernel reads them (rsl/kernel.h), and what came out.
#pragma once
#include "rsl/kernel.h"
#include "shading/point.h"
#include <functional>
#include <map>
#include <span>

namespace alpenglow::shading {

/// Values of a shader instance's numeric parameters, in current space: flattened elements. Strings are part of the kernel.
struct ParameterBlock {
    std::map<std::string, std::vector<float>> numbers;
    std::map<std::string, std::string> strings;
};

/// Resolves "space:FROM>TO" inputs: one of both is "current".
class SpaceResolver {
public:
    virtual ~SpaceResolver() = default;
    /// Matrix from `from` to `to`; null when there is no such space. "object" and "shader" are the point's own.
    virtual bool matrix(const std::string& from, const std::string& to, Matrix& out) const = 0;
};

/// What the points of a batch may differ in beyond their ShadePoint: one an instance.
struct InstanceView {
    const ParameterBlock* parameters = nullptr;
    const Matrix* shaderToCurrent = nullptr;
};

/// Aligned rows for the inputs and outputs of one kernel call. Lives as long as the call, across suspensions.
class Batch {
public:
    /// views[i] belongs to points[i]; with `mixed` false they are all the same.
    Batch(std::shared_ptr<const rsl::CompiledKernel>, std::span<const ShadePoint> points, std::span<const InstanceView> views, bool mixed,
          const SpaceResolver&);
    Batch(const Batch&) = delete;

    rsl::KernelCall& call() { return call_; }
    const rsl::CompiledKernel& kernel() const { return *kernel_; }
    int size() const { return call_.n; }
    /// Index of an output, -1 when the kernel has none of that name.
    int output(std::string_view name) const;
    float value(int output, int component, int point) const { return out_[output][size_t(component) * call_.stride + point]; }
    Color color(int output, int point) const { return {value(output, 0, point), value(output, 1, point), value(output, 2, point)}; }
    /// Rewrites one float or tuple input (for light loops that move from light to light).
    void setInput(int input, int component, int point, float v) { in_[input][size_t(component) * call_.stride + point] = v; }
    int input(std::string_view name) const;

private:
    void fill(int index, const rsl::ir::Input&, std::span<const ShadePoint>, std::span<const InstanceView>, bool mixed, const SpaceResolver&);
    std::shared_ptr<const rsl::CompiledKernel> kernel_;
    std::vector<std::vector<float>> storage_;
    std::vector<float*> in_, out_;
    rsl::KernelCall call_{};
};

} // namespace alpenglow::shading
