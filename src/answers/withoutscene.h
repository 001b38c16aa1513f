// What kernels ask where there is no scene: `alpenglow eval` and `alpenglow shade`.
#pragma once
#include "base/diagnostics.h"
#include "base/vec.h"
#include "rsl/kernel.h"
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::transport {

/// Answers texture(), environment() and textureinfo() from maps on disk, rayinfo() and its kin as for a camera ray, and
/// rendererinfo(), by the code that answers in a scene. A missing map is one error with its place. For one thread.
class WithoutScene {
public:
    /// `texturePaths`: folders in which maps are looked for, in order.
    WithoutScene(std::vector<std::string> texturePaths, Diagnostics&);
    ~WithoutScene();
    WithoutScene(const WithoutScene&) = delete;
    WithoutScene& operator=(const WithoutScene&) = delete;
    /// The points of the batch that runs next, in "current" space, and the eye that sees them.
    void setPoints(const Vec3& eye, std::span<const Vec3> points);
    /// As rsl::ServiceFn. False: it asks for something else, and nothing was written.
    bool answer(const rsl::CompiledKernel&, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in,
                float* out);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace alpenglow::transport
