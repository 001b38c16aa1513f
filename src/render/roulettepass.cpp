#include "render/roulettepass.h"
#include "integrator/bouncetally.h"
#include "integrator/photons.h"
#include "render/filtersampler.h"
#include "scene/scene.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::render {

namespace {

constexpr int kLeastPixels = 64 * 64; ///< smaller pictures: too few pilot paths to learn from, or too many for the picture
constexpr int kLeastSide = 24, kMostSide = 32;
constexpr uint64_t kOtherSeed = 0x726f756cull; ///< makes the roulette independent of the picture's own samples

/// Mean luminance of the 5 x 5 pairs of samples about each, and a little of the picture's.
std::vector<double> brightnessAround(const integrator::BounceTally& t, int side) {
    std::vector<double> own(size_t(side) * size_t(side)), around(own.size());
    double all = 0;
    for (size_t i = 0; i < own.size(); ++i) {
        for (size_t k = 0; k < 2; ++k)
            for (const int64_t l : t.light[2 * i + k]) own[i] += double(l) / integrator::BounceTally::kUnit / 2;
        all += own[i] / double(own.size());
    }
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            double sum = 0;
            int count = 0;
            for (int v = std::max(y - 2, 0); v <= std::min(y + 2, side - 1); ++v)
                for (int u = std::max(x - 2, 0); u <= std::min(x + 2, side - 1); ++u, ++count) sum += own[size_t(v * side + u)];
            around[size_t(y * side + x)] = std::max(sum / count, 0.) + .02 * std::max(all, 0.) + 1e-9;
        }
    return around;
}

} // namespace

bool learnRoulette(Job& job) {
    const scene::Options& o = job.world->frame().options;
    const double width = std::max(o.xres, 1), height = std::max(o.yres, 1);
    if (!job.world->photons()) return true;
    integrator::setRoulette(*job.world, {});
    if (width * height < kLeastPixels || !integrator::mayTryPaths(*job.world) || !integrator::mayLearnRoulette(*job.world))
        return true;
    // For the complete picture, so that a crop equals that part of the picture.
    const int side = std::clamp(int(std::sqrt(width * height / 14)), kLeastSide, kMostSide);
    std::vector<PixelSample> samples;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (uint32_t k = 0; k < 2; ++k) samples.push_back({int((x + .5) * width / side), int((y + .5) * height / side), k});
    const FilterSampler filter(job.plan.basis.filter);
    NumberRows numbers;
    std::vector<integrator::CameraRay> rays;
    std::vector<float> weights;
    pathRays(job.camera, filter, job.settings.seed ^ kOtherSeed, samples, numbers, rays, weights);
    for (integrator::CameraRay& r : rays) r.sample += 0x50000000u; // larger than any sample number of a picture
    std::vector<integrator::SampleResult> results(rays.size());
    integrator::BounceTally tally;
    job.world->flushPrints(true); // of what ran before; the pilot's are dropped below
    Diagnostics silent;
    const auto tracer = job.engine.tracer(job.world, silent);
    tracer->tally(&tally);
    if (!tracer->trace(rays, results, &job.halt) || job.halt) return false;
    integrator::setRoulette(*job.world, integrator::rouletteBy(tally, brightnessAround(tally, side)));
    job.world->flushPrints(false);
    return !job.pollStop();
}

} // namespace alpenglow::render
