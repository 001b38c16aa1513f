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

bool renderPath(Job& job, Film& film, SampleRange wanted, uint64_t seed, const std::function<void(Film&)>& afterPass) {
    const RenderSettings& settings = job.settings;
    FilterSampler filter(job.plan.basis.filter);
    if (filter.degenerate())
        job.diagnostics.report(Severity::Error, Rie::Range, {},
                               "PixelFilter: its integral is not positive; a box of its widths is used");
    const std::vector<Channel>& channels = film.description().channels;
    // Large tiles where every thread still gets many.
    const bool large = film.window().pixels() >= size_t(kPathTile) * kPathTile * 8 * size_t(job.team.threads());
    const std::vector<Window> tiles = tilesOf(film.window(), large ? kPathTile : kTile);
    const size_t stride = 5 + channels.size(); // colour, alpha, whether a surface was met, the rest
    // Passes: of 8 samples while they fit the memory that holds them back. The first eight come in passes of
    // 1, 1, 2 and 4, so that there is soon something to keep.
    size_t perSample = film.window().pixels() * stride * sizeof(float);
    uint32_t most = uint32_t(std::clamp(kPassBytes / std::max(perSample, size_t(1)), size_t(1), size_t(kPass)));
    std::vector<std::vector<float>> held(tiles.size());
    CausticPasses caustics(job);
    uint32_t next = wanted.begin;
    while (next < wanted.end) { // behind what a checkpoint brought
        auto in = std::find_if(film.ranges().begin(), film.ranges().end(),
                               [&](SampleRange r) { return r.begin <= next && next < r.end; });
        if (in == film.ranges().end()) break;
        next = in->end;
    }
    NoiseFigures noise;
    double secondsPerSample = 0;
    uint32_t nextNoise = 16;
    bool judged = false;
    uint64_t total = settings.noise > 0 || settings.seconds > 0 ? 0 : wanted.end - wanted.begin;
    auto tell = [&](double inPass, bool last) {
        ProgressState s;
        double done = double(film.samplesPerPixel()) + inPass;
        s.samplesDone = done;
        s.samplesTotal = total;
        s.noise = noise.known ? noise.noise : -1;
        double t = job.elapsed();
        s.raysPerMS = raysPerMS(job.rayTotal, t);
        s.fraction = total ? done / double(total) : -1;
        if (settings.seconds > 0) s.fraction = std::max(s.fraction, std::min(1.0, t / settings.seconds));
        if (settings.noise > 0 && noise.noise > 0)
            s.fraction = std::max(s.fraction, std::min(1.0, settings.noise / noise.noise * (settings.noise / noise.noise)));
        if (last) job.progress.finish(s, job.what);
        else job.progress.update(s, job.what);
    };
    bool any = film.samplesPerPixel() > 0;
    while (next < wanted.end && !job.pollStop()) {
        uint32_t count = std::min(most, wanted.end - next);
        if (next % kPass != 0) count = std::min(count, kPass - next % kPass); // so that noise is judged on whole nets
        if (film.samplesPerPixel() < kPass) count = std::min(count, std::max(1u, film.samplesPerPixel()));
        if (settings.seconds > 0 && any) {
            double left = settings.seconds - job.elapsed();
            if (left <= 0) break;
            if (secondsPerSample > 0) {
                if (left < 0.5 * secondsPerSample) break;
                count = std::clamp(uint32_t(left / secondsPerSample), 1u, count);
            }
        }
        double begun = clockSeconds();
        const auto traceTile = [&](int worker, size_t i) {
            const Window& t = tiles[i];
            std::vector<float>& out = held[i];
            out.clear();
            out.reserve(t.pixels() * count * stride);
            std::vector<PixelSample> samples;
            NumberRows numbers;
            std::vector<transport::CameraRay> rays;
            std::vector<transport::SampleResult> results;
            std::vector<float> weights;
            auto flush = [&] {
                pathRays(job.camera, filter, seed, samples, numbers, rays, weights);
                results.resize(rays.size());
                if (!job.trace(worker, rays, results)) return false;
                for (size_t k = 0; k < rays.size(); ++k) {
                    const transport::SampleResult& r = results[k];
                    float w = weights[k];
                    Color c = clampSample(r.color, settings.sampleClamp) * w;
                    out.insert(out.end(),
                               {c.x, c.y, c.z, (r.opacity.x + r.opacity.y + r.opacity.z) / 3 * w, r.z < 1e38f ? 1.f : 0.f});
                    size_t at = out.size();
                    if (!channels.empty()) filmValues(job.plan, r.opacity, r.z, r.zSecond, r.aovs, &out);
                    for (size_t j = 0; j < channels.size(); ++j)
                        if (channels[j].rule == ChannelRule::Average) out[at + j] *= w;
                }
                samples.clear();
                return true;
            };
            for (int y = t.y0; y < t.y1; ++y)
                for (int x = t.x0; x < t.x1; ++x)
                    for (uint32_t s = next; s < next + count; ++s) {
                        samples.push_back({x, y, s});
                        if (samples.size() == kRaysPerCall && !flush()) return;
                    }
            if (!samples.empty()) flush();
        };
        bool whole = false;
        try {
            whole = caustics.ready(next, count) && job.team.run(tiles.size(), &job.halt, traceTile, [&](size_t done) {
                job.pollStop();
                if (settings.seconds > 0 && any && job.elapsed() > settings.seconds) job.halt = 1;
                tell(double(count) * double(done) / double(tiles.size()), false);
            });
        } catch (const std::bad_alloc&) { job.outOfMemory = std::current_exception(); } // the film has whole passes only
        if (job.world) job.world->flushPrints(whole);
        if (!whole) break;
        StopFlag go{0};
        job.team.run(
            tiles.size(), &go,
            [&](int, size_t i) {
                const Window& t = tiles[i];
                const float* p = held[i].data();
                for (int y = t.y0; y < t.y1; ++y)
                    for (int x = t.x0; x < t.x1; ++x)
                        for (uint32_t s = next; s < next + count; ++s, p += stride) {
                            FilmSample f;
                            f.radiance = {p[0], p[1], p[2]};
                            f.alpha = p[3];
                            f.surface = p[4] != 0;
                            f.aovs = {p + 5, channels.size()};
                            film.add(x, y, s, f);
                        }
            },
            [](size_t) {});
        if (!film.addRange({next, next + count})) {
            job.diagnostics.report(Severity::Error, Rie::Limit, {},
                                   "more than " + std::to_string(limits::kSamplesPerPixel) + " samples a pixel");
            break;
        }
        secondsPerSample = (clockSeconds() - begun) / count;
        next += count;
        any = true;
        if (film.samplesPerPixel() >= nextNoise && film.samplesPerPixel() % kPass == 0) {
            noise = noiseFigures(film);
            judged = true;
            nextNoise = film.samplesPerPixel() + std::max(kPass, film.samplesPerPixel() / 8 / kPass * kPass);
        }
        if (afterPass) afterPass(film);
        if (settings.noise > 0 && judged && noise.reached(settings.noise)) break;
    }
    if (any) tell(0, true);
    else job.progress.clear();
    job.halt = 0;
    return any;
}

} // namespace alpenglow::render
