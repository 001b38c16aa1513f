// Services for kernels without a scene: `alpenglow eval` and `alpenglow shade`.
#pragma once
#include "base/diagnostics.h"
#include "base/vec.h"
#include "rsl/kernel.h"
#include "services/names.h"
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::services {

/// Answers texture(), environment() and textureinfo() from maps on disk, rayinfo() and similar as for a camera ray, and
/// rendererinfo(), with the same code as in a scene. A missing map is reported once with its place. For one thread.
class WithoutScene {
public:
    /// `texturePaths`: search path of maps, in order.
    WithoutScene(std::vector<std::string> texturePaths, Diagnostics&);
    ~WithoutScene();
    WithoutScene(const WithoutScene&) = delete;
    WithoutScene& operator=(const WithoutScene&) = delete;
    /// Sets the points of the next batch in "current" space, and the eye position.
    void setPoints(const Vec3& eye, std::span<const Vec3> points);
    /// As rsl::ServiceFn. Returns false, without writing results, for other calls.
    bool answer(const rsl::CompiledKernel&, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in,
                float* out);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace alpenglow::services
