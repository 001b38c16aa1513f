// `path`: complete passes of samples over all pixels, into a film of exact sums.
#include "base/limits.h"
#include "base/numberlanes.h"
#include "render/adaptive.h"
#include "render/imaging.h"
#include "render/noise.h"
#include "render/photonpass.h"
#include "render/rendering.h"
#include "render/watcher.h"
#include "scene/scene.h"
#include <algorithm>
#include <cmath>
#include <new>

namespace alpenglow::render {
namespace {

constexpr size_t kRaysPerCall =
    8192; // of one trace(): enough to fill the lanes of rare shaders, with few partly filled batches at the end
constexpr int kPathTile = 32; // side in pixels: eight samples of each form one call
constexpr uint32_t kPass = 8; // samples per pixel; a multiple of kReplicas, so that noise is measured on replicas of equal size
static_assert(kPass % kReplicas == 0 && kPilotSamples % kPass == 0);
constexpr uint32_t kMostOfPass = 32; // samples per pixel, for passes that add few to some pixels

} // namespace

integrator::CameraRay pathRay(const Camera& camera, const FilterSampler& filter, uint64_t seed, int x, int y, uint32_t sample,
                              float* weight) {
    const PixelSample one{x, y, sample};
    NumberRows numbers;
    std::vector<integrator::CameraRay> rays;
    std::vector<float> weights;
    pathRays(camera, filter, seed, {&one, 1}, numbers, rays, weights);
    *weight = weights[0];
    return rays[0];
}

void pathRays(const Camera& camera, const FilterSampler& filter, uint64_t seed, std::span<const PixelSample> samples,
              NumberRows& numbers, std::vector<integrator::CameraRay>& rays, std::vector<float>& weights) {
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
        integrator::CameraRay& r = rays.emplace_back(camera.ray(p.x + 0.5 + f.dx, p.y + 0.5 + f.dy, lens, time));
        r.px = p.x;
        r.py = p.y;
        r.sample = p.sample;
        weights.push_back(f.weight);
    }
}

namespace {

/// Camera rays of a call, reused from call to call.
struct Rays {
    std::vector<PixelSample> samples;
    NumberRows numbers;
    std::vector<integrator::CameraRay> rays;
    std::vector<integrator::SampleResult> results;
    std::vector<float> weights;
};

/// Next samples of all pixels: `count` from `first` on, or for adaptive films `steps` (Spread).
struct Pass {
    uint32_t first = 0, count = 0, steps = 0;
    uint32_t samples() const { return count + kReplicas * steps; } ///< for a pixel with rate 1
};

/// One execution of renderPath().
class PathLoop {
public:
    PathLoop(Job&, Film&, SampleRange wanted, uint64_t seed);
    bool run(const std::function<void(Film&)>& afterPass);

private:
    bool mayAdapt() const;
    uint32_t mostOfPass() const;
    uint32_t samplesWithinTime(uint32_t count) const;
    uint32_t samplesOfPass() const;
    uint32_t stepsOfPass() const;
    Pass nextPass();
    SampleRange samplesOf(const Pass&, int x, int y) const;
    bool tracePass(const Pass&);
    void traceTile(int worker, size_t tile, const Pass&);
    bool take(int worker, std::vector<float>& out, Rays&);
    bool addPass(const Pass&);
    uint32_t reached() const;
    uint32_t firstJudged() const;
    void judge();
    void showProgress(double inPass, bool last);
    void show(bool grown);

    Job& job_;
    Film& film_;
    const RenderSettings& settings_;
    const SampleRange wanted_;
    const uint64_t seed_;
    const FilterSampler filter_;
    const std::vector<Channel>& channels_;
    const size_t stride_; ///< floats of a stored sample: colour, alpha, whether a surface was hit, weight, the rest
    std::vector<Window> tiles_;
    std::vector<std::vector<float>> held_; ///< by tile: samples of the pass
    uint32_t next_;                        ///< the first sample that no pixel has
    const bool adapts_;                    ///< sampling adapts to noise after kPilotSamples
    bool any_;                             ///< some pass is complete
    double samples_;                       ///< per pixel, on average
    NoiseFigures noise_;
    uint32_t nextNoise_; ///< samples per pixel at the next noise test
    bool judged_ = false;
    double secondsPerSample_ = 0; ///< of the last pass
    CausticPasses caustics_;
};

/// The first sample from `begin` on that is not in the film.
uint32_t behind(const Film& film, SampleRange wanted) {
    uint32_t next = wanted.begin;
    while (next < wanted.end) { // after those of a checkpoint
        const auto in = std::find_if(film.ranges().begin(), film.ranges().end(),
                                     [&](SampleRange r) { return r.begin <= next && next < r.end; });
        if (in == film.ranges().end()) break;
        next = in->end;
    }
    return next;
}

PathLoop::PathLoop(Job& job, Film& film, SampleRange wanted, uint64_t seed)
    : job_(job), film_(film), settings_(job.settings), wanted_(wanted), seed_(seed), filter_(job.plan.basis.filter),
      channels_(film.description().channels), stride_(6 + channels_.size()), next_(behind(film, wanted)), adapts_(mayAdapt()),
      any_(film.samplesPerPixel() > 0), samples_(film.samples().mean), caustics_(job) {
    if (filter_.degenerate())
        job.diagnostics.report(Severity::Error, Rie::Range, {},
                               "PixelFilter: its integral is not positive; a box of its widths is used");
    // Large tiles, if every thread still gets many.
    const bool large = film.window().pixels() >= size_t(kPathTile) * kPathTile * 8 * size_t(job.team.threads());
    tiles_ = tilesOf(film.window(), large ? kPathTile : kTile);
    held_.resize(tiles_.size());
    nextNoise_ = firstJudged();
}

void PathLoop::showProgress(double inPass, bool last) {
    const uint64_t total = settings_.noise > 0 || settings_.seconds > 0 ? 0 : wanted_.end - wanted_.begin;
    ProgressState s;
    const double done = samples_ + inPass;
    s.samplesDone = done;
    s.samplesTotal = total;
    s.noise = noise_.known ? noise_.noise : -1;
    const double t = job_.elapsed();
    s.raysPerMS = raysPerMS(job_.rayTotal, t);
    s.fraction = total ? done / double(total) : -1;
    if (settings_.seconds > 0) s.fraction = std::max(s.fraction, std::min(1.0, t / settings_.seconds));
    if (settings_.noise > 0 && noise_.noise > 0)
        s.fraction = std::max(s.fraction, std::min(1.0, settings_.noise / noise_.noise * (settings_.noise / noise_.noise)));
    if (settings_.watcher) settings_.watcher->progress(s, job_.what);
    if (last) job_.progress.finish(s, job_.what);
    else job_.progress.update(s, job_.what);
}

/// Shows complete passes to the watcher.
void PathLoop::show(bool grown) {
    if (!settings_.watcher || !any_) return;
    Glance g;
    g.pixels = [this](const OutputSpec& s) { return filmImage(film_, job_.plan, s.depth); };
    g.film = &film_;
    g.seconds = job_.elapsed();
    g.rays = job_.rayTotal;
    g.grown = grown;
    settings_.watcher->look(g);
}

/// Adaptive sampling requires a complete render: parts have fixed samples. Caustic photons belong to one sample of all pixels.
bool PathLoop::mayAdapt() const {
    const scene::Options& o = job_.world->frame().options;
    const scene::Param* asked = scene::find(o.hiderParams, "adaptive");
    const bool refused = asked && !asked->numbers.empty() && asked->numbers[0] == 0;
    return settings_.noise > 0 && !settings_.samples && !settings_.part && !refused && !CausticPasses::asked(o);
}

/// Samples per pixel that fit into the memory for a pass.
uint32_t PathLoop::mostOfPass() const {
    const size_t perSample = film_.window().pixels() * stride_ * sizeof(float);
    return uint32_t(std::clamp(kPassBytes / std::max(perSample, size_t(1)), size_t(1), size_t(kMostOfPass)));
}

/// Number of these samples that fit into the remaining time; 0: none.
uint32_t PathLoop::samplesWithinTime(uint32_t count) const {
    if (!(settings_.seconds > 0) || !any_) return count;
    const double left = settings_.seconds - job_.elapsed();
    if (left <= 0) return 0;
    if (!(secondsPerSample_ > 0)) return count;
    return left < 0.5 * secondsPerSample_ ? 0 : std::clamp(uint32_t(left / secondsPerSample_), 1u, count);
}

/// Passes have 8 samples if they fit into memory. The first eight come in passes of 1, 1, 2 and 4, so that a result exists early.
/// 0: out of time.
uint32_t PathLoop::samplesOfPass() const {
    uint32_t count = std::min({mostOfPass(), kPass, wanted_.end - next_});
    if (next_ % kPass != 0) count = std::min(count, kPass - next_ % kPass); // so that noise is measured on complete nets
    if (film_.samplesPerPixel() < kPass) count = std::min(count, std::max(1u, film_.samplesPerPixel()));
    return samplesWithinTime(count);
}

/// Steps to the next noise test, as many as fit. 0: out of time, or all samples are done.
uint32_t PathLoop::stepsOfPass() const {
    uint32_t samples = std::min(mostOfPass(), nextNoise_ > reached() ? nextNoise_ - reached() : kReplicas);
    samples = samplesWithinTime(std::max(samples, kReplicas));
    uint32_t steps = samples == 0 ? 0 : std::max(1u, samples / kReplicas);
    while (steps > 0 && film_.samplesAfter(steps).mean > wanted_.end) steps /= 2;
    return steps;
}

/// An empty pass ends rendering.
Pass PathLoop::nextPass() {
    if (adapts_ && !film_.spread() && film_.samplesPerPixel() >= kPilotSamples && film_.samplesPerPixel() % kPass == 0 &&
        film_.ranges().size() == 1 && film_.ranges().front().begin == 0 && film_.spread(ratesOf(film_)))
        nextNoise_ = firstJudged();
    Pass p;
    p.first = next_;
    if (film_.spread()) p.steps = stepsOfPass();
    else if (next_ < wanted_.end) p.count = samplesOfPass();
    return p;
}

SampleRange PathLoop::samplesOf(const Pass& p, int x, int y) const {
    return p.steps ? film_.samplesOfSteps(x, y, p.steps) : SampleRange{p.first, p.first + p.count};
}

/// Traces the listed samples and appends the results to `out`. Returns false if stopped.
bool PathLoop::take(int worker, std::vector<float>& out, Rays& r) {
    pathRays(job_.camera, filter_, seed_, r.samples, r.numbers, r.rays, r.weights);
    r.results.resize(r.rays.size());
    if (!job_.trace(worker, r.rays, r.results)) return false;
    for (size_t k = 0; k < r.rays.size(); ++k) {
        integrator::SampleResult& s = r.results[k];
        const Color c = clampSample(s.color, settings_.sampleClamp);
        if (const float m = maxComponent(s.color); settings_.sampleClamp > 0 && m > settings_.sampleClamp)
            for (Color& part : s.parts) part *= settings_.sampleClamp / m;
        const float alpha = (s.opacity.x + s.opacity.y + s.opacity.z) / 3;
        out.insert(out.end(), {c.x, c.y, c.z, alpha, s.z < 1e38f ? 1.f : 0.f, r.weights[k]});
        if (!channels_.empty()) filmValues(job_.plan, s, &out);
    }
    r.samples.clear();
    return true;
}

void PathLoop::traceTile(int worker, size_t tile, const Pass& pass) {
    const Window& t = tiles_[tile];
    std::vector<float>& out = held_[tile];
    out.clear();
    size_t samples = 0;
    for (int y = t.y0; y < t.y1; ++y)
        for (int x = t.x0; x < t.x1; ++x) samples += samplesOf(pass, x, y).end - samplesOf(pass, x, y).begin;
    out.reserve(samples * stride_);
    Rays rays;
    for (int y = t.y0; y < t.y1; ++y)
        for (int x = t.x0; x < t.x1; ++x) {
            const SampleRange of = samplesOf(pass, x, y);
            for (uint32_t s = of.begin; s < of.end; ++s) {
                rays.samples.push_back({x, y, s});
                if (rays.samples.size() == kRaysPerCall && !take(worker, out, rays)) return;
            }
        }
    if (!rays.samples.empty()) take(worker, out, rays);
}

/// Returns false if incomplete, because of the user, time or memory.
bool PathLoop::tracePass(const Pass& pass) {
    bool whole = false;
    try {
        whole = caustics_.prepare() && (pass.steps || caustics_.ready(pass.first, pass.count)) &&
                job_.run(
                    tiles_.size(), [&](int worker, size_t i) { traceTile(worker, i, pass); },
                    [&](size_t done) {
                        job_.pollStop();
                        if (settings_.seconds > 0 && any_ && job_.elapsed() > settings_.seconds) job_.halt = 1;
                        showProgress(double(pass.samples()) * double(done) / double(tiles_.size()), false);
                        show(false);
                    });
    } catch (const std::bad_alloc&) { job_.outOfMemory = std::current_exception(); } // the film has complete passes only
    if (job_.world) job_.world->flushPrints(whole);
    return whole;
}

/// Adds a complete pass to the film. Returns false if a limit is reached, which is reported.
bool PathLoop::addPass(const Pass& pass) {
    StopFlag go{0};
    job_.team.run(
        tiles_.size(), &go,
        [&](int, size_t i) {
            const Window& t = tiles_[i];
            const float* p = held_[i].data();
            for (int y = t.y0; y < t.y1; ++y)
                for (int x = t.x0; x < t.x1; ++x) {
                    const SampleRange of = samplesOf(pass, x, y);
                    for (uint32_t s = of.begin; s < of.end; ++s, p += stride_) {
                        FilmSample f;
                        f.radiance = {p[0], p[1], p[2]};
                        f.alpha = p[3];
                        f.surface = p[4] != 0;
                        f.weight = p[5];
                        f.aovs = {p + 6, channels_.size()};
                        film_.add(x, y, s, f);
                    }
                }
        },
        [](size_t) {});
    if (pass.steps ? film_.addSteps(pass.steps) : film_.addRange({pass.first, pass.first + pass.count})) return true;
    job_.diagnostics.report(Severity::Error, Rie::Limit, {},
                            "more than " + std::to_string(limits::kSamplesPerPixel) + " samples a pixel");
    return false;
}

/// Samples of a pixel with rate 1, as if sampling had always been adaptive.
uint32_t PathLoop::reached() const {
    return film_.spread() ? uint32_t(film_.spread()->ofOne(film_.spread()->steps)) : film_.samplesPerPixel();
}

/// Number of samples at the next noise test after n.
uint32_t judgedAfter(uint32_t n) { return n + std::max(kPass, n / 8 / kPass * kPass); }

/// The first such number that is still ahead; for adaptive films, after all pixels have their share.
uint32_t PathLoop::firstJudged() const {
    const uint32_t from = film_.spread() ? std::max(reached(), film_.spread()->base) : reached();
    uint32_t n = kPilotSamples;
    while (n < from) n = judgedAfter(n);
    return n;
}

void PathLoop::judge() {
    if (reached() < nextNoise_ || reached() % kPass != 0) return;
    noise_ = noiseFigures(film_);
    judged_ = true;
    nextNoise_ = judgedAfter(reached());
}

bool PathLoop::run(const std::function<void(Film&)>& afterPass) {
    judge(); // the samples of a checkpoint may suffice
    while (!job_.pollStop() && !(settings_.noise > 0 && judged_ && noise_.reached(settings_.noise))) {
        const Pass pass = nextPass();
        const double begun = clockSeconds();
        if (pass.samples() == 0 || !tracePass(pass) || !addPass(pass)) break;
        secondsPerSample_ = (clockSeconds() - begun) / pass.samples();
        next_ += pass.count;
        samples_ = film_.samples().mean;
        any_ = true;
        judge();
        if (afterPass) afterPass(film_);
        show(true);
    }
    if (any_) showProgress(0, true);
    else job_.progress.clear();
    job_.halt = 0;
    return any_;
}

} // namespace

bool renderPath(Job& job, Film& film, SampleRange wanted, uint64_t seed, const std::function<void(Film&)>& afterPass) {
    return PathLoop(job, film, wanted, seed).run(afterPass);
}

} // namespace alpenglow::render
