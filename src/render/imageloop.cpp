// `hidden` and `raytrace`: PixelSamples image samples a pixel, reconstructed by each display's own filter, in bands of rows.
#include "base/limits.h"
#include "base/sampler.h"
#include "render/imaging.h"
#include "render/noise.h"
#include "render/rendering.h"
#include <algorithm>
#include <cmath>
#include <mutex>

namespace alpenglow::render {

void gridOf(const scene::Options& o, const RenderSettings& s, int* nx, int* ny) {
    auto whole = [](float v) { return v >= 1 ? int(std::min(v, 4096.f) + 0.5f) : 1; };
    *nx = whole(o.pixelSamplesX);
    *ny = whole(o.pixelSamplesY);
    if (s.spp > 0) {
        uint32_t spp = std::min(s.spp, 4096u * 4096u);
        *nx = int(std::ceil(std::sqrt(double(spp))));
        *ny = int((spp + uint32_t(*nx) - 1) / uint32_t(*nx));
    }
}

Jitter jitterOf(const scene::Options& o, Diagnostics& diags) {
    const scene::Param* p = scene::find(o.hiderParams, "jitter");
    if (!p)
        if (auto i = o.values.find("hider:jitter"); i != o.values.end()) p = &i->second;
    if (!p || p->numbers.empty()) return Jitter::Jittered;
    int j = int(p->numbers[0]);
    if (j >= 0 && j <= 2) return Jitter(j);
    diags.report(Severity::Error, Rie::Range, p->place, "hider parameter \"jitter\" is 0, 1 or 2; 1 is used");
    return Jitter::Jittered;
}

transport::CameraRay imageRay(const Camera& camera, Vec2 position, uint64_t seed, int x, int y, uint32_t sample) {
    Vec2 lens{0.5f, 0.5f};
    float time = 0;
    if (camera.hasLens() || camera.shutterClose() > camera.shutterOpen()) {
        Sampler numbers(seed, x, y);
        lens = numbers.get2(0, kUseLens, 0, sample);
        time = numbers.get1(0, kUseTime, 0, sample);
    }
    transport::CameraRay r = camera.ray(position.x, position.y, lens, time);
    r.px = x;
    r.py = y;
    r.sample = sample;
    return r;
}

Reconstructions renderImages(Job& job, int nx, int ny, Jitter jitter, uint64_t seed, DroppedSamples* dropped) {
    const OutputPlan& plan = job.plan;
    const Window window = job.camera.window();
    std::vector<Channel> aovs;
    for (size_t i = 0; i < plan.engineOutputs.size(); ++i)
        for (int k = 0; k < plan.engineWidths[i]; ++k) aovs.push_back({plan.engineOutputs[i] + "." + std::to_string(k)});
    double xw = 1, yw = 1;
    for (const OutputSpec& p : plan.pictures) {
        xw = std::max(xw, p.filter.xw);
        yw = std::max(yw, p.filter.yw);
    }
    // One for all pictures with the same filters: a frame may have hundreds.
    Reconstructions result;
    std::vector<const OutputSpec*> filtered;
    for (const OutputSpec& p : plan.pictures) {
        const auto same = std::find_if(filtered.begin(), filtered.end(), [&](const OutputSpec* s) {
            return s->depth == p.depth && s->filter.kind == p.filter.kind && s->filter.xw == p.filter.xw &&
                   s->filter.yw == p.filter.yw;
        });
        result.of.push_back(size_t(same - filtered.begin()));
        if (same == filtered.end()) filtered.push_back(&p);
    }
    std::vector<Image>& images = result.images;
    images.resize(filtered.size());
    for (Image& i : images) {
        i.window = window;
        i.channels = {"r", "g", "b", "a", "Or", "Og", "Ob", "z"};
        for (const Channel& c : aovs) i.channels.push_back(c.name);
        i.data.assign(window.pixels() * i.channels.size(), 0.f);
    }
    const int spp = nx * ny;
    // Bands of rows, so that the samples in memory stay bounded. The samples of a band's border are made again by the next band,
    // with the same bits, so bands cannot be seen.
    size_t perRow = size_t(window.width() + 2 * int(std::ceil(xw / 2))) * size_t(spp) * (10 + aovs.size()) * sizeof(float);
    int border = 2 * int(std::ceil(yw / 2));
    int band = int(std::clamp(kPassBytes / std::max(perRow, size_t(1)), size_t(1), size_t(limits::kImageSide))) - border;
    band = std::max({band, 2 * border, kTile});
    const int bands = (window.height() + band - 1) / band;
    *dropped = {};
    std::mutex droppedMutex;
    const auto drop = [&](const transport::CameraRay& r) { // the same whatever thread meets it first
        std::lock_guard lock(droppedMutex);
        const std::array<int, 3> at{int(r.sample), r.py, r.px};
        if (const bool seen = window.contains(r.px, r.py); seen && (!dropped->first || at < *dropped->first)) dropped->first = at;
    };
    auto tell = [&](double fraction, bool last) {
        ProgressState s;
        s.fraction = fraction;
        s.samplesDone = fraction * spp;
        s.samplesTotal = uint64_t(spp);
        s.raysPerMS = raysPerMS(job.rayTotal, job.elapsed());
        if (last) job.progress.finish(s, job.what);
        else job.progress.update(s, job.what);
    };
    double reached = 0;
    for (int b = 0; b < bands && !job.pollStop(); ++b) {
        Window part{window.x0, window.y0 + b * band, window.x1, std::min(window.y0 + (b + 1) * band, window.y1)};
        SampleBuffer buffer(part, xw, yw, nx, ny, aovs, seed, jitter);
        const std::vector<Window> tiles = tilesOf(buffer.sampled());
        // A pixel with thousands of samples is traced in slices, so that one call stays small.
        const int slice = 2048;
        job.team.run(
            tiles.size(), &job.halt,
            [&](int worker, size_t i) {
                const Window& t = tiles[i];
                std::vector<transport::CameraRay> rays;
                std::vector<transport::SampleResult> results;
                auto flush = [&] {
                    results.assign(rays.size(), {});
                    if (!job.trace(worker, rays, results)) return false;
                    for (size_t k = 0; k < rays.size(); ++k) {
                        transport::SampleResult& r = results[k];
                        r.aovs.resize(aovs.size());
                        ImageSample s;
                        s.color = clampSample(r.color, job.settings.sampleClamp);
                        s.opacity = r.opacity;
                        if (r.z < 1e38f) s.z = r.z;
                        if (r.zSecond < 1e38f) s.zSecond = r.zSecond;
                        s.aovs = r.aovs;
                        if (!buffer.set(rays[k].px, rays[k].py, int(rays[k].sample), s)) drop(rays[k]);
                    }
                    rays.clear();
                    return true;
                };
                for (int y = t.y0; y < t.y1; ++y)
                    for (int x = t.x0; x < t.x1; ++x)
                        for (int k = 0; k < spp; ++k) {
                            rays.push_back(imageRay(job.camera, buffer.position(x, y, k), seed, x, y, uint32_t(k)));
                            if (int(rays.size()) >= slice && !flush()) return;
                        }
                if (!rays.empty()) flush();
            },
            [&](size_t done) {
                job.pollStop();
                reached = (b + double(done) / double(tiles.size())) / bands;
                tell(reached, false);
            });
        dropped->count += buffer.nonFinite();
        for (size_t p = 0; p < images.size(); ++p) {
            const OutputSpec& s = *filtered[p];
            const size_t rowFloats = size_t(window.width()) * images[p].channels.size();
            float* to = images[p].data.data() + size_t(part.y0 - window.y0) * rowFloats;
            StopFlag go{0};
            job.team.run(
                size_t(part.height()), &go,
                [&](int, size_t row) {
                    int y = part.y0 + int(row);
                    Image r = buffer.reconstruct(s.filter, s.depth, {part.x0, y, part.x1, y + 1});
                    std::copy(r.data.begin(), r.data.end(), to + row * rowFloats);
                },
                [](size_t) {});
        }
    }
    if (job.world) job.world->flushPrints(true);
    tell(job.interrupted ? reached : 1, true);
    job.halt = 0;
    return result;
}

} // namespace alpenglow::render
