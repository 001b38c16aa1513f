// Irradiance caching passes before the picture: records are made on grids of pixels, coarse to fine.
#include "render/rendering.h"

namespace alpenglow::render {

namespace {
constexpr int kCoarse = 32, kFine = 2; ///< spacing in pixels of the first and the last grid
constexpr size_t kRays = 32;           ///< of one trace(): each may send thousands, whose results stay in memory
constexpr int kSide = 64;              ///< side of the tiles that threads take
} // namespace

bool findRecords(Job& job) {
    if (!job.world || !job.world->interpolates()) return true;
    // The complete frame, even for a crop: a pixel must not depend on that.
    const std::vector<Window> tiles = tilesOf({0, 0, job.camera.width(), job.camera.height()}, kSide);
    for (int step = kCoarse; step >= kFine; step /= 2) {
        const auto work = [&](int worker, size_t i) {
            const Window& t = tiles[i];
            std::vector<integrator::CameraRay> rays;
            std::vector<integrator::SampleResult> results;
            const auto flush = [&] {
                results.assign(rays.size(), {});
                const bool whole = job.trace(worker, rays, results);
                rays.clear();
                return whole;
            };
            for (int y = t.y0 + step / 2; y < t.y1; y += step)
                for (int x = t.x0 + step / 2; x < t.x1; x += step) {
                    integrator::CameraRay& r = rays.emplace_back(job.camera.ray(x + 0.5, y + 0.5, {0.5f, 0.5f}, 0));
                    r.px = x;
                    r.py = y;
                    r.sample = uint32_t(step);
                    r.records = true;
                    if (rays.size() == kRays && !flush()) return;
                }
            if (!rays.empty()) flush();
        };
        const bool whole = job.team.run(tiles.size(), &job.halt, work, [&](size_t) { job.pollStop(); });
        job.world->flushPrints(false);
        job.world->keepRecords();
        if (!whole) return false;
    }
    return true;
}

} // namespace alpenglow::render
