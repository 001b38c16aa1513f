#include "render/deeppass.h"
#include "base/limits.h"
#include "display/deep.h"
#include "scene/scene.h"

namespace alpenglow::render {
namespace {

/// A row of pixels during sampling.
struct Row {
    std::vector<uint32_t> counts; ///< number of steps of each pixel
    std::vector<display::DeepStep> steps;
};

display::DeepChange change(const integrator::DepthStep& s, const Color& before) {
    return {s.z, {before.x, before.y, before.z}, {s.transmittance.x, s.transmittance.y, s.transmittance.z}};
}

class DepthLoop {
public:
    DepthLoop(Job& job, int nx, int ny, Jitter jitter, uint64_t seed, float error)
        : job_(job), nx_(nx), ny_(ny), jitter_(jitter), seed_(seed), error_(error) {}
    bool row(int worker, int y, Row& out);

private:
    Job& job_;
    const int nx_, ny_;
    const Jitter jitter_;
    const uint64_t seed_;
    const float error_;
};

bool DepthLoop::row(int worker, int y, Row& out) {
    constexpr int64_t kSlice = 2048; // rays in a call
    const Window& w = job_.camera.window();
    const int samples = nx_ * ny_;
    ImageRays image(job_.camera, seed_, nx_, ny_, jitter_);
    std::vector<integrator::CameraRay>& rays = image.rays();
    std::vector<integrator::SampleResult> results;
    std::vector<display::DeepChange> changes;
    int64_t begun = 0; // samples of the row started
    const auto finish = [&] {
        const size_t before = out.steps.size();
        display::meanStairs(changes, size_t(samples), error_, out.steps);
        out.counts.push_back(uint32_t(out.steps.size() - before));
        changes.clear();
    };
    const int64_t all = int64_t(samples) * w.width();
    while (begun < all) {
        image.clear();
        for (int64_t i = begun; i < std::min(all, begun + kSlice); ++i) image.ask(w.x0 + int(i / samples), y, int(i % samples));
        image.make();
        for (integrator::CameraRay& r : rays) r.depths = true;
        results.assign(rays.size(), {});
        if (!job_.trace(worker, rays, results)) return false;
        for (const integrator::SampleResult& r : results) {
            Color before(1);
            for (const integrator::DepthStep& s : r.transmittance) {
                changes.push_back(change(s, before));
                before = s.transmittance;
            }
            if (++begun % samples == 0) finish();
        }
    }
    return true;
}

} // namespace

float deepShadowError(const scene::Options& o, Diagnostics& d) {
    const auto i = o.values.find("limits:deepshadowerror");
    if (i == o.values.end() || i->second.numbers.empty()) return 0.01f;
    const float e = i->second.numbers[0];
    if (e >= 0 && e <= 1) return e;
    d.report(Severity::Error, Rie::Range, i->second.place, "\"deepshadowerror\" must be in 0 to 1; 0.01 is used");
    return 0.01f;
}

std::shared_ptr<const display::DeepSamples> seeDepths(Job& job, int nx, int ny, Jitter jitter, uint64_t seed, float error) {
    const Window& w = job.camera.window();
    const size_t rows = size_t(w.height());
    std::vector<Row> made(rows);
    DepthLoop loop(job, nx, ny, jitter, seed, error);
    std::atomic<size_t> steps{0};
    const bool whole = job.runShown(rows, "depths", [&](int worker, size_t i) {
        steps -= made[i].steps.size(); // of an earlier run
        made[i] = {};
        loop.row(worker, w.y0 + int(i), made[i]);
        if ((steps += made[i].steps.size()) > limits::kDeepSteps) job.halt = 1;
    });
    if (steps > limits::kDeepSteps) {
        job.diagnostics.report(Severity::Error, Rie::Limit, {},
                               "a deep shadow map has more than " + std::to_string(limits::kDeepSteps) +
                                   " steps; it is not "
                                   "written",
                               "a larger Option \"limits\" \"float deepshadowerror\" or fewer pixels need fewer");
        if (!job.interrupted) job.halt = 0;
        return {};
    }
    if (!whole) return {};
    auto deep = std::make_shared<display::DeepSamples>();
    deep->steps.reserve(steps);
    for (const Row& r : made) {
        size_t at = 0;
        for (const uint32_t n : r.counts) {
            deep->first.push_back(deep->steps.size());
            deep->steps.insert(deep->steps.end(), r.steps.begin() + long(at), r.steps.begin() + long(at + n));
            at += n;
        }
    }
    deep->first.push_back(deep->steps.size());
    return deep;
}

} // namespace alpenglow::render
