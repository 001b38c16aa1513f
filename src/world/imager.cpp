// Runs the imager of a frame over finished pixels.
#include "scene/scene.h"
#include "world/mutableworld.h"
#include <algorithm>

namespace alpenglow::world {

void MutableWorld::bindImager(Diagnostics& d) {
    const scene::ShaderRef& imager = frame_->options.imager;
    if (!imager) return;
    InstanceRef shader = instance(*imager, rsl::ShaderKind::Imager, d);
    if (const scene::AttributesRef& a = frame_->options.attributes) shader = withCoShaders(shader, a->coshaders, d);
    if (shader) imager_.kernel = kernelWithoutRays(*shader, {}, {}, false, false, d);
    imager_.shader = std::move(shader);
}

bool WorldImpl::runImager(int count, const float* x, const float* y, float* r, float* g, float* b, float* alpha, Diagnostics& d,
                          const StopFlag* stop) const {
    const InstanceRef& i = imager_.shader;
    const BoundKernel& k = imager_.kernel;
    if (!i || !k || k.kernel->facts().suspends) return false;
    const std::unique_ptr<Evaluator> evaluator = evaluators_(*this, d, stop, false);
    // The output alpha is what the shader writes; a shader that only makes pixels opaque sets alpha as well (methods of classes
    // have no alpha).
    const auto& writes = k.kernel->facts().writes;
    const auto written = [&](const char* name) { return std::find(writes.begin(), writes.end(), name) != writes.end(); };
    const bool opacityOnly = written("Oi") && !written("alpha");
    constexpr int kChunk = 4096;
    for (int begin = 0; begin < count; begin += kChunk) {
        int n = std::min(kChunk, count - begin);
        std::vector<ShadePoint> points(size_t(n), ShadePoint{});
        for (int p = 0; p < n; ++p) {
            ShadePoint& s = points[size_t(p)];
            int at = begin + p;
            const auto width = float(std::max(1, frame_->options.xres)), height = float(std::max(1, frame_->options.yres));
            s.P = {x[at], y[at], 0};
            s.surface.u = s.surface.s = x[at] / width; // not in RISpec; imagers of Aqsis use them
            s.surface.v = s.surface.t = y[at] / height;
            // The picture acts as the surface, a pixel as the footprint.
            s.surface.dPdu = {width, 0, 0};
            s.surface.dPdv = {0, height, 0};
            s.surface.dsdu = s.surface.dtdv = 1;
            s.surface.dtdu = s.surface.dsdv = 0;
            s.du = 1 / width;
            s.dv = 1 / height;
            s.Ci = {r[at], g[at], b[at]};
            s.Oi = Color(alpha[at]);
            s.alpha = alpha[at];
        }
        evaluator->run(k, nullptr, points, {&i->parameters, &i->toCurrent}, [&](const shading::Batch& batch) {
            const int ci = batch.output("Ci"), ai = batch.output("alpha"), oi = batch.output("Oi");
            for (int p = 0; p < n; ++p) {
                int at = begin + p;
                if (ci >= 0) {
                    Color v = batch.color(ci, p);
                    r[at] = v.x;
                    g[at] = v.y;
                    b[at] = v.z;
                }
                if (opacityOnly && oi >= 0) {
                    const Color v = batch.color(oi, p);
                    alpha[at] = (v.x + v.y + v.z) / 3;
                } else if (ai >= 0) {
                    alpha[at] = batch.value(ai, 0, p);
                }
            }
        });
    }
    return true;
}

} // namespace alpenglow::world
