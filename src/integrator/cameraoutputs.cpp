#include "integrator/cameraoutputs.h"
#include "base/direction.h"
#include "integrator/accumulator.h"
#include "integrator/stageset.h"
#include "integrator/vertex.h"
#include "world/outputs.h"

namespace alpenglow::integrator {

CameraOutputs::CameraOutputs(const StageSet& s) : Stage(s.context), accumulator_(s.accumulator) {}

void CameraOutputs::see(const PathRay& ray, const Color& opacity, float z, bool matte) {
    SampleResult& r = *accumulator_.results[size_t(ray.sample->path)];
    if (!matte) r.opacity += ray.weight * opacity;
    if (r.z >= 1e38f) r.z = z;
    else if (r.zSecond >= 1e38f) r.zSecond = z;
}

/// The unit shading normal on the side that the ray sees; 0 if there is none.
static Vec3 normalSeen(const ShadePoint& p, const Vec3& dir) {
    const float l = length(p.N);
    if (l > 0 && std::isfinite(l)) return onSeenSide(p.N, p, dir) * (1 / l);
    const Vec3 n = directionOr(p.N, {});
    return dot(n, n) > 0 ? onSeenSide(n, p, dir) : n;
}

void CameraOutputs::seeNormal(const PathRay& ray, const ShadePoint& p, const Color& opacity) {
    if (!world_.settings().firstSeen) return;
    accumulator_.results[size_t(ray.sample->path)]->normal += normalSeen(p, ray.dir) * luminance(ray.weight * opacity);
}

void CameraOutputs::begin(const BatchContext& c) {
    wantedAt_.clear();
    perhaps_.clear();
    for (const rsl::OutputName& name : world_.wanted()) wantedAt_.push_back(outputsNamed(*c.batch, name));
}

/// Whether lights or the atmosphere write an output, rather than the surface.
bool CameraOutputs::givenByOthers(const BatchContext& c, size_t output, int point) {
    if (wantedAt_[output].empty() || c.lightChannels.empty()) return wantedAt_[output].empty();
    if (perhaps_.empty())
        for (const rsl::OutputName& name : world_.wanted())
            perhaps_.push_back(c.binding && givesPerhaps(*c.binding->surface, name));
    return perhaps_[output] && !givenAt(*c.batch, world_.wanted()[output], point);
}

void CameraOutputs::add(const BatchContext& c, int point) {
    const size_t i = size_t(point);
    const PathRay& ray = c.rays[i];
    const SurfaceBinding& binding = world_.bindings()[size_t(c.bindings[i])];
    const shading::Batch& b = *c.batch;
    SampleResult& r = *accumulator_.results[size_t(ray.sample->path)];
    size_t at = 0;
    for (size_t k = 0; k < wantedAt_.size(); at += size_t(world_.widthsOfOutputs()[k++])) {
        if (!binding.inLightOutputs.empty() && binding.inLightOutputs[k]) continue; // LightOutputs::lightOutputBatches() adds it
        const int width = world_.widthsOfOutputs()[k];
        if (!givenByOthers(c, k, point)) {
            int to = 0;
            for (const int o : wantedAt_[k]) {
                const int size = rsl::ir::components(b.kernel().outputs()[size_t(o)].kind);
                for (int w = 0; w < size && to < width; ++w, ++to)
                    r.aovs[at + size_t(to)] += (size == 3 ? ray.weight[w] : luminance(ray.weight)) * b.value(o, w, point);
            }
        } else if (!c.lightChannels.empty()) {
            const size_t all = c.lightChannels.size() / c.points.size();
            for (int w = 0; w < width; ++w)
                r.aovs[at + size_t(w)] +=
                    (width % 3 == 0 ? ray.weight[w % 3] : luminance(ray.weight)) * c.lightChannels[i * all + at + size_t(w)];
        }
    }
}

} // namespace alpenglow::integrator
