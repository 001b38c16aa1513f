// A pass before the picture: shades primitives whose shaders bake completely, on grids of micropolygons.
#include "render/bakepass.h"
#include "scene/scene.h"
#include "world/bakes.h"
#include <algorithm>

namespace alpenglow::render {

namespace {
constexpr size_t kAtOnce = 1u << 16;      ///< maximum number of points whose samples are accumulated at once
constexpr size_t kSamplesWait = 1u << 22; ///< and of their samples
constexpr size_t kAsked = 16;             ///< number of corners, and of centres, that decide whether a shape bakes at all
constexpr size_t kRays = 256;             ///< in one trace(): their shaders may send thousands of rays

/// A ray from the eye to a grid point that ignores all geometry before it. number: index of the point within its shape. `pixel`:
/// a camera ray that supplies footprint and time. The point must outlive the trace, which reads its distance.
integrator::CameraRay rayTo(const world::World& w, shading::GridPoint& point, int number, const integrator::CameraRay& pixel) {
    integrator::CameraRay r = pixel;
    const Vec3 at = world::placeOf(w, point);
    r.width = std::max(0.f, pixel.width - pixel.spread * pixel.start);
    r.start = 0;
    const float l = length(at);
    if (w.frame().options.projection == "perspective") {
        r.origin = Vec3(0.f);
        r.direction = l > 0 ? at / l : Vec3(0, 0, 1);
        point.distance = l;
    } else {
        r.origin = Vec3(at.x, at.y, std::min(0.f, at.z - 1));
        r.direction = Vec3(0, 0, 1);
        point.distance = at.z - r.origin.z;
    }
    r.cosine = r.direction.z;
    r.py = int(point.shape);
    r.px = number;
    r.grid = &point;
    return r;
}

/// Traces all samples of some points. Returns false if stopped.
bool tracePoints(Job& job, std::vector<shading::GridPoint>& points, const std::vector<int>& numbers, uint32_t samples,
                 const integrator::CameraRay& pixel) {
    const auto work = [&](int worker, size_t task) {
        const size_t begin = task * kRays, end = std::min(points.size(), begin + kRays);
        std::vector<integrator::CameraRay> rays;
        for (size_t i = begin; i < end; ++i) rays.push_back(rayTo(*job.world, points[i], numbers[i], pixel));
        std::vector<integrator::SampleResult> results(rays.size());
        for (uint32_t s = 0; s < samples; ++s) {
            for (integrator::CameraRay& r : rays) r.sample = s;
            if (!job.trace(worker, rays, results)) return;
        }
    };
    return job.team.run((points.size() + kRays - 1) / kRays, &job.halt, work, [&](size_t) { job.pollStop(); });
}

/// Whether no point of a shape bakes, if a few points are representative.
bool noneBakes(Job& job, uint32_t shape, const std::vector<shading::GridPoint>& all, const integrator::CameraRay& pixel) {
    if (!world::bakesAllOrNone(*job.world, shape)) return false;
    std::vector<shading::GridPoint> few;
    std::vector<int> numbers;
    for (const bool corner : {true, false})
        for (size_t i = 0, n = 0; i < all.size() && n < kAsked; ++i) {
            if (all[i].corner != corner) continue;
            few.push_back(all[i]);
            numbers.push_back(int(i));
            ++n;
        }
    const std::vector<uint64_t> before = job.counters().lightRuns;
    const bool whole = tracePoints(job, few, numbers, 1, pixel), none = !world::bakedNow(*job.world);
    std::vector<uint64_t> runs = job.counters().lightRuns; // of these points: few decide only for lights that ran there
    for (size_t i = 0; i < before.size(); ++i) runs[i] -= before[i];
    const bool lit = world::bakingLightsRan(*job.world, shape, runs);
    world::commitBakes(*job.world, false);
    return whole && none && lit;
}

} // namespace

bool bakeGrids(Job& job, uint32_t samples) {
    if (!job.world || !world::bakes(*job.world)) return true;
    const integrator::CameraRay pixel = job.camera.ray(job.camera.width() / 2., job.camera.height() / 2., {0.5f, 0.5f}, 0);
    std::vector<shading::GridPoint> all, points;
    std::vector<int> numbers;
    bool whole = true;
    const size_t most = std::clamp(kSamplesWait / std::max<size_t>(samples, 1), 16 * kRays, kAtOnce);
    const auto flush = [&] {
        if (!points.empty()) {
            whole = whole && tracePoints(job, points, numbers, samples, pixel);
            world::commitBakes(*job.world, whole);
        }
        points.clear();
        numbers.clear();
    };
    for (const uint32_t shape : world::bakedShapes(*job.world)) {
        all.clear();
        world::bakedPoints(*job.world, shape, all);
        if (noneBakes(job, shape, all, pixel)) continue;
        for (size_t i = 0; i < all.size() && whole; ++i) {
            points.push_back(all[i]);
            numbers.push_back(int(i));
            if (points.size() == most) flush();
        }
    }
    flush();
    job.world->flushPrints(false);
    return whole;
}

} // namespace alpenglow::render
