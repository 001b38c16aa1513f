// `path`: whole passes of samples over all pixels, into a film of exact sums.
#include "base/limits.h"
#include "base/numberlanes.h"
#include "render/imaging.h"
#include "render/noise.h"
#include "render/photonpass.h"
#include "render/rendering.h"
#include <algorithm>
#include <cmath>
#include <new>

namespace alpenglow::render {
namespace {

constexpr size_t kRaysPerCall =
    8192; // of one trace(): enough to fill the lanes of rare shaders too, and few ends of calls, when lanes run empty
constexpr int kPathTile = 32;         // pixels a side: eight samples of each are one call
constexpr uint32_t kPass = 8; // samples a pixel; a multiple of kReplicas, so that noise is judged on replicas of equal size
static_assert(kPass % kReplicas == 0);

} // namespace

transport::CameraRay pathRay(const Camera& camera, const FilterSampler& filter, uint64_t seed, int x, int y, uint32_t sample,
                             float* weight) {
    const PixelSample one{x, y, sample};
    NumberRows numbers;
    std::vector<transport::CameraRay> rays;
    std::vector<float> weights;
    pathRays(camera, filter, seed, {&one, 1}, numbers, rays, weights);
    *weight = weights[0];
    return rays[0];
}

void pathRays(const Camera& camera, const FilterSampler& filter, uint64_t seed, std::span<const PixelSample> samples,
              NumberRows& numbers, std::vector<transport::CameraRay>& rays, std::vector<float>& weights) {
    const bool moves = camera.shutterClose() > camera.shutterOpen();
    const SeedKey key(seed);
    numbers.clear();
    for (const PixelSample& p : samples) {
        const SampleNumbers own(Sampler(key, p.x, p.y), p.sample);
        numbers.askPair(own, 0, kUseFilter, 0);
        if (camera.hasLens()) numbers.askPair(own, 0, kUseLens, 0);
        if (moves) numbers.askOne(own, 0, kUseTime, 0);
    }
    numbers.draw();
    size_t next = 0;
    rays.clear();
    weights.clear();
    for (const PixelSample& p : samples) {
        const FilterSample f = filter.sample(numbers.pair(next++));
        const Vec2 lens = camera.hasLens() ? numbers.pair(next++) : Vec2{0.5f, 0.5f};
        const float time = moves ? numbers.one(next++) : 0;
        transport::CameraRay& r = rays.emplace_back(camera.ray(p.x + 0.5 + f.dx, p.y + 0.5 + f.dy, lens, time));
        r.px = p.x;
        r.py = p.y;
        r.sample = p.sample;
        weights.push_back(f.weight);
    }
}

namespace {

/// What the camera rays of a call need, kept from call to call.
struct Rays {
    std::vector<PixelSample> samples;
    NumberRows numbers;
    std::vector<transport::CameraRay> rays;
    std::vector<transport::SampleResult> results;
    std::vector<float> weights;
};

/// One run of renderPath().
class PathLoop {
public:
    PathLoop(Job&, Film&, SampleRange wanted, uint64_t seed);
    bool run(const std::function<void(Film&)>& afterPass);

private:
    uint32_t samplesOfPass() const;
    bool tracePass(uint32_t count);
    void traceTile(int worker, size_t tile, uint32_t count);
    bool take(int worker, std::vector<float>& out, Rays&);
    bool addPass(uint32_t count);
    void judge();
    void tell(double inPass, bool last);

    Job& job_;
    Film& film_;
    const RenderSettings& settings_;
    const SampleRange wanted_;
    const uint64_t seed_;
    const FilterSampler filter_;
    const std::vector<Channel>& channels_;
    const size_t stride_;         ///< floats of a sample that is held: colour, alpha, whether a surface was met, the rest
    std::vector<Window> tiles_;
    std::vector<std::vector<float>> held_; ///< by tile: the samples of the pass
    uint32_t next_;               ///< the first sample of the pass
    bool any_;                    ///< some pass is whole
    NoiseFigures noise_;
    uint32_t nextNoise_ = 16;     ///< samples a pixel at which noise is judged again
    bool judged_ = false;
    double secondsPerSample_ = 0; ///< of the last pass
    CausticPasses caustics_;
};

/// The first sample from `begin` on that the film has not.
uint32_t behind(const Film& film, SampleRange wanted) {
    uint32_t next = wanted.begin;
    while (next < wanted.end) { // behind what a checkpoint brought
        const auto in = std::find_if(film.ranges().begin(), film.ranges().end(),
                                     [&](SampleRange r) { return r.begin <= next && next < r.end; });
        if (in == film.ranges().end()) break;
        next = in->end;
    }
    return next;
}

PathLoop::PathLoop(Job& job, Film& film, SampleRange wanted, uint64_t seed)
    : job_(job), film_(film), settings_(job.settings), wanted_(wanted), seed_(seed), filter_(job.plan.basis.filter),
      channels_(film.description().channels), stride_(5 + channels_.size()), next_(behind(film, wanted)),
      any_(film.samplesPerPixel() > 0), caustics_(job) {
    if (filter_.degenerate())
        job.diagnostics.report(Severity::Error, Rie::Range, {},
                               "PixelFilter: its integral is not positive; a box of its widths is used");
    // Large tiles where every thread still gets many.
    const bool large = film.window().pixels() >= size_t(kPathTile) * kPathTile * 8 * size_t(job.team.threads());
    tiles_ = tilesOf(film.window(), large ? kPathTile : kTile);
    held_.resize(tiles_.size());
}

void PathLoop::tell(double inPass, bool last) {
    const uint64_t total = settings_.noise > 0 || settings_.seconds > 0 ? 0 : wanted_.end - wanted_.begin;
    ProgressState s;
    const double done = double(film_.samplesPerPixel()) + inPass;
    s.samplesDone = done;
    s.samplesTotal = total;
    s.noise = noise_.known ? noise_.noise : -1;
    const double t = job_.elapsed();
    s.raysPerMS = raysPerMS(job_.rayTotal, t);
    s.fraction = total ? done / double(total) : -1;
    if (settings_.seconds > 0) s.fraction = std::max(s.fraction, std::min(1.0, t / settings_.seconds));
    if (settings_.noise > 0 && noise_.noise > 0)
        s.fraction = std::max(s.fraction, std::min(1.0, settings_.noise / noise_.noise * (settings_.noise / noise_.noise)));
    if (last) job_.progress.finish(s, job_.what);
    else job_.progress.update(s, job_.what);
}

/// Passes are of 8 samples while they fit the memory that holds them back. The first eight come in passes of 1, 1, 2 and 4, so
/// that there is soon something to keep. 0: the time is over.
uint32_t PathLoop::samplesOfPass() const {
    const size_t perSample = film_.window().pixels() * stride_ * sizeof(float);
    const uint32_t most = uint32_t(std::clamp(kPassBytes / std::max(perSample, size_t(1)), size_t(1), size_t(kPass)));
    uint32_t count = std::min(most, wanted_.end - next_);
    if (next_ % kPass != 0) count = std::min(count, kPass - next_ % kPass); // so that noise is judged on whole nets
    if (film_.samplesPerPixel() < kPass) count = std::min(count, std::max(1u, film_.samplesPerPixel()));
    if (settings_.seconds > 0 && any_) {
        const double left = settings_.seconds - job_.elapsed();
        if (left <= 0) return 0;
        if (secondsPerSample_ > 0) {
            if (left < 0.5 * secondsPerSample_) return 0;
            count = std::clamp(uint32_t(left / secondsPerSample_), 1u, count);
        }
    }
    return count;
}

/// Traces the samples that are noted and appends them to `out`. False: halted.
bool PathLoop::take(int worker, std::vector<float>& out, Rays& r) {
    pathRays(job_.camera, filter_, seed_, r.samples, r.numbers, r.rays, r.weights);
    r.results.resize(r.rays.size());
    if (!job_.trace(worker, r.rays, r.results)) return false;
    for (size_t k = 0; k < r.rays.size(); ++k) {
        transport::SampleResult& s = r.results[k];
        const float w = r.weights[k];
        const Color c = clampSample(s.color, settings_.sampleClamp) * w;
        if (const float m = maxComponent(s.color); settings_.sampleClamp > 0 && m > settings_.sampleClamp)
            for (Color& part : s.parts) part *= settings_.sampleClamp / m;
        out.insert(out.end(), {c.x, c.y, c.z, (s.opacity.x + s.opacity.y + s.opacity.z) / 3 * w, s.z < 1e38f ? 1.f : 0.f});
        const size_t at = out.size();
        if (!channels_.empty()) filmValues(job_.plan, s, &out);
        for (size_t j = 0; j < channels_.size(); ++j)
            if (isSum(channels_[j].rule)) out[at + j] *= w;
    }
    r.samples.clear();
    return true;
}

void PathLoop::traceTile(int worker, size_t tile, uint32_t count) {
    const Window& t = tiles_[tile];
    std::vector<float>& out = held_[tile];
    out.clear();
    out.reserve(t.pixels() * count * stride_);
    Rays rays;
    for (int y = t.y0; y < t.y1; ++y)
        for (int x = t.x0; x < t.x1; ++x)
            for (uint32_t s = next_; s < next_ + count; ++s) {
                rays.samples.push_back({x, y, s});
                if (rays.samples.size() == kRaysPerCall && !take(worker, out, rays)) return;
            }
    if (!rays.samples.empty()) take(worker, out, rays);
}

/// False: not whole, because of the user, the time, or memory.
bool PathLoop::tracePass(uint32_t count) {
    bool whole = false;
    try {
        whole = caustics_.ready(next_, count) && job_.team.run(
            tiles_.size(), &job_.halt, [&](int worker, size_t i) { traceTile(worker, i, count); },
            [&](size_t done) {
                job_.pollStop();
                if (settings_.seconds > 0 && any_ && job_.elapsed() > settings_.seconds) job_.halt = 1;
                tell(double(count) * double(done) / double(tiles_.size()), false);
            });
    } catch (const std::bad_alloc&) { job_.outOfMemory = std::current_exception(); } // the film has whole passes only
    if (job_.world) job_.world->flushPrints(whole);
    return whole;
}

/// Puts a whole pass into the film. False: there is no room, which is reported.
bool PathLoop::addPass(uint32_t count) {
    StopFlag go{0};
    job_.team.run(
        tiles_.size(), &go,
        [&](int, size_t i) {
            const Window& t = tiles_[i];
            const float* p = held_[i].data();
            for (int y = t.y0; y < t.y1; ++y)
                for (int x = t.x0; x < t.x1; ++x)
                    for (uint32_t s = next_; s < next_ + count; ++s, p += stride_) {
                        FilmSample f;
                        f.radiance = {p[0], p[1], p[2]};
                        f.alpha = p[3];
                        f.surface = p[4] != 0;
                        f.aovs = {p + 5, channels_.size()};
                        film_.add(x, y, s, f);
                    }
        },
        [](size_t) {});
    if (film_.addRange({next_, next_ + count})) return true;
    job_.diagnostics.report(Severity::Error, Rie::Limit, {},
                            "more than " + std::to_string(limits::kSamplesPerPixel) + " samples a pixel");
    return false;
}

void PathLoop::judge() {
    if (film_.samplesPerPixel() < nextNoise_ || film_.samplesPerPixel() % kPass != 0) return;
    noise_ = noiseFigures(film_);
    judged_ = true;
    nextNoise_ = film_.samplesPerPixel() + std::max(kPass, film_.samplesPerPixel() / 8 / kPass * kPass);
}

bool PathLoop::run(const std::function<void(Film&)>& afterPass) {
    while (next_ < wanted_.end && !job_.pollStop()) {
        const uint32_t count = samplesOfPass();
        const double begun = clockSeconds();
        if (count == 0 || !tracePass(count) || !addPass(count)) break;
        secondsPerSample_ = (clockSeconds() - begun) / count;
        next_ += count;
        any_ = true;
        judge();
        if (afterPass) afterPass(film_);
        if (settings_.noise > 0 && judged_ && noise_.reached(settings_.noise)) break;
    }
    if (any_) tell(0, true);
    else job_.progress.clear();
    job_.halt = 0;
    return any_;
}

} // namespace

bool renderPath(Job& job, Film& film, SampleRange wanted, uint64_t seed, const std::function<void(Film&)>& afterPass) {
    return PathLoop(job, film, wanted, seed).run(afterPass);
}

} // namespace alpenglow::render
