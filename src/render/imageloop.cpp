// `hidden` and `raytrace`: PixelSamples image samples a pixel, reconstructed by each display's own filter, in bands of rows.
#include "base/limits.h"
#include "base/memory.h"
#include "base/sampler.h"
#include "render/growth.h"
#include "render/imaging.h"
#include "render/noise.h"
#include "render/rendering.h"
#include "render/watcher.h"
#include "scene/scene.h"
#include "world/depths.h"
#include "world/procedurals.h"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

namespace alpenglow::render {

namespace {

struct Wanted {
    int x, y, k;
};

/// Rays of a worker, reused from task to task.
struct Kept {
    std::vector<Wanted> wanted;
    ImageRays image;
    std::vector<integrator::CameraRay> behind;
    std::vector<integrator::SampleResult> results, found;
    std::vector<size_t> of; ///< by ray of `behind`
};

/// State shared by the bands of a picture.
class ImageLoop {
public:
    ImageLoop(Job&, int nx, int ny, Jitter, const Refinement&, uint64_t seed, DroppedSamples&, Reconstructions&,
              std::vector<float>& memory);
    void run();

private:
    using Done = std::function<void(size_t)>;
    void plan();
    void planBands();
    int rowOf(int band) const;
    Window beginBand(const Window& part);
    void band(int b);
    void showProgress(double fraction, bool last);
    Done progressOf(int b, double begin, size_t tasks);
    void trace(SampleBuffer&, size_t tasks, const std::function<void(size_t, std::vector<Wanted>&)>& list, const Done&);
    bool traceSlice(SampleBuffer&, int worker, std::span<const Wanted>);
    bool traceBehind(int worker, Kept&) const;
    bool showsDepthsAlone() const;
    void refine(SampleBuffer&, const Window& part, int b);
    std::vector<Wanted> differing(const SampleBuffer&, const Window& part) const;
    void reconstruct(const SampleBuffer&, const Window& part);
    bool seesNothing(const Window& tile) const;
    void show();
    void grow();
    size_t number(int x, int y) const { return size_t(y - window_.y0) * size_t(window_.width()) + size_t(x - window_.x0); }
    float* pixel(size_t image, int x, int y) {
        return result_.images[image].data.data() + number(x, y) * result_.images[image].channels.size();
    }
    PixelFilter filterOf(size_t image) const;

    Job& job_;
    int nx_, ny_;
    Jitter jitter_;
    Refinement refinement_;
    uint64_t seed_;
    DroppedSamples& dropped_;
    Reconstructions& result_;
    std::vector<float>& memory_; ///< from an earlier buffer
    const Window window_;
    std::vector<Channel> aovs_;
    std::vector<const OutputSpec*>
        filtered_;                       ///< displays with equal reconstruction are represented by one: a frame may have hundreds
    std::vector<FilterWeights> weights_; ///< by image
    std::vector<Kept> kept_;             ///< by worker
    bool depthsAlone_ = false;           ///< all displays show z only
    bool unshaded_ = false;              ///< and no shader is needed for that
    bool behindUnshaded_ = false;        ///< nor for the depths of second surfaces
    double xw_ = 1, yw_ = 1;
    int rows_ = 0, bands_ = 0, lower_ = 0;
    bool movesDown_ = false; ///< bands share the samples of rows between them
    std::optional<SampleBuffer> buffer_;
    double reached_ = 0;
    std::atomic<bool> begun_ = false; ///< a task is complete
    std::mutex mutex_;
    std::optional<Growth> growth_; ///< of the current band, if there is a watcher
    std::vector<uint8_t> there_;   ///< by pixel of the window: complete in the images. Only with a watcher
};

ImageLoop::ImageLoop(Job& job, int nx, int ny, Jitter jitter, const Refinement& refinement, uint64_t seed,
                     DroppedSamples& dropped, Reconstructions& result, std::vector<float>& memory)
    : job_(job), nx_(nx), ny_(ny), jitter_(jitter), refinement_(refinement), seed_(seed), dropped_(dropped), result_(result),
      memory_(memory), window_(job.camera.window()) {
    if (refinement.on()) {
        nx_ = ny_ = refinement.side;
        jitter_ = Jitter::Grid;
    }
    for (int i = 0; i < job.team.threads(); ++i)
        kept_.push_back({{}, ImageRays(job.camera, seed_, nx_, ny_, jitter_), {}, {}, {}, {}});
    plan();
    // With motion, surfaces are shaded at shutter open, but rays hit them at other depths.
    const bool still = job.camera.shutterClose() <= job.camera.shutterOpen();
    const bool ofDepth = depthsAlone_ || job.plan.needsDepth(DepthFilter::Midpoint);
    behindUnshaded_ = ofDepth && still && job.world && world::depthsNeedNoShaders(*job.world);
    unshaded_ = depthsAlone_ && behindUnshaded_;
}

/// Whether only z is shown: then neither filters nor samples of neighbours are needed.
bool ImageLoop::showsDepthsAlone() const {
    if (!aovs_.empty() || refinement_.on() || job_.settings.watcher || (job_.world && job_.world->frame().options.imager))
        return false;
    for (const OutputSpec& p : job_.plan.pictures)
        for (const OutputVariable& v : p.variables)
            if (v.source != OutputVariable::Source::Z) return false;
    return true;
}

void ImageLoop::plan() {
    const OutputPlan& plan = job_.plan;
    for (size_t i = 0; i < plan.engineOutputs.size(); ++i)
        for (int k = 0; k < plan.engineWidths[i]; ++k) aovs_.push_back({plan.engineOutputs[i] + "." + std::to_string(k)});
    for (const OutputSpec& p : plan.pictures) {
        xw_ = std::max(xw_, p.filter.xw);
        yw_ = std::max(yw_, p.filter.yw);
        const auto same = std::find_if(filtered_.begin(), filtered_.end(),
                                       [&](const OutputSpec* s) { return s->depth == p.depth && s->filter == p.filter; });
        result_.of.push_back(size_t(same - filtered_.begin()));
        if (same == filtered_.end()) filtered_.push_back(&p);
    }
    depthsAlone_ = showsDepthsAlone();
    if (jitter_ == Jitter::Middle || depthsAlone_) xw_ = yw_ = 1;
    if (refinement_.on()) xw_ = yw_ = 3; // one pixel on each side for comparison
    for (size_t p = 0; p < filtered_.size(); ++p) weights_.emplace_back(filterOf(p));
    result_.images.resize(filtered_.size());
    for (Image& i : result_.images) {
        i.window = window_;
        i.channels = {"r", "g", "b", "a", "Or", "Og", "Ob", "z"};
        for (const Channel& c : aovs_) i.channels.push_back(c.name);
        i.data.assign(window_.pixels() * i.channels.size(), 0.f);
    }
    planBands();
    if (job_.settings.watcher) there_.assign(window_.pixels(), 0);
}

/// Bands of rows bound the memory of samples: few bands if each starts anew, else bands that fit into the cache.
void ImageLoop::planBands() {
    const int rowsAbout = 2 * int(std::ceil(yw_ / 2));
    const size_t perRow =
        size_t(window_.width() + 2 * int(std::ceil(xw_ / 2))) * size_t(nx_ * ny_) * (10 + aovs_.size()) * sizeof(float);
    movesDown_ = !job_.settings.watcher && !refinement_.on();
    const size_t bytes = movesDown_ ? kBandBytes * size_t(job_.team.threads()) : kPassBytes;
    rows_ = int(std::clamp(bytes / std::max(perRow, size_t(1)), size_t(1), size_t(limits::kImageSide))) - rowsAbout;
    rows_ = (std::max({rows_, 2 * rowsAbout, kTile}) + kTile - 1) / kTile * kTile;
    // The first band is lower by its border rows, so that later bands, which share those, are complete tiles.
    lower_ = movesDown_ ? 2 * border(yw_) % rows_ : 0;
    bands_ = (window_.height() + lower_ + rows_ - 1) / rows_;
}

/// First row of a band; for the band after the last, the end of the picture.
int ImageLoop::rowOf(int b) const { return std::clamp(window_.y0 + b * rows_ - lower_, window_.y0, window_.y1); }

void ImageLoop::run() {
    for (int b = 0; b < bands_ && !job_.pollStop(); ++b) band(b);
    if (buffer_) memory_ = std::move(*buffer_).takeMemory();
    if (job_.world) job_.world->flushPrints(true);
    result_.begun = begun_ || !job_.interrupted;
    showProgress(job_.interrupted ? reached_ : 1, true);
    job_.halt = 0;
}

/// Prepares buffer_ for a band. Returns the pixels without samples.
Window ImageLoop::beginBand(const Window& part) {
    if (buffer_ && movesDown_) {
        const int fresh = buffer_->moveDown(part);
        const Window& all = buffer_->sampled();
        return {all.x0, fresh, all.x1, all.y1};
    }
    if (buffer_) memory_ = std::move(*buffer_).takeMemory();
    const int height =
        movesDown_ ? std::min(rows_, window_.height()) : part.height(); // later bands need it, or there would be two
    const size_t most = SampleBuffer::floats(part.width(), height, xw_, yw_, nx_ * ny_, aovs_.size());
    try {
        if (movesDown_ && memory_.capacity() < most) memory_ = {}, memory_.reserve(most);
        buffer_.emplace(part, xw_, yw_, nx_, ny_, aovs_, seed_, jitter_, std::move(memory_));
    } catch (const std::bad_alloc&) {
        job_.diagnostics.report(Severity::Error, Rie::NoMem, {},
                                "the " + std::to_string(nx_) + " x " + std::to_string(ny_) +
                                    " samples of each pixel (PixelSamples) take " + memorySizeText(most * sizeof(float)) +
                                    " for " + std::to_string(height) + (height == 1 ? " row" : " rows") + " of the picture",
                                "fewer samples, or --crop parts of the picture and merge them; path keeps no samples");
        throw;
    }
    return buffer_->sampled();
}

void ImageLoop::band(int b) {
    const Window part{window_.x0, rowOf(b), window_.x1, rowOf(b + 1)};
    if (job_.world && world::hasDeferred(*job_.world)) job_.world->flushPrints(true); // of samples that are not traced again
    const Window fresh = beginBand(part);
    SampleBuffer& buffer = *buffer_;
    const std::vector<Window> tiles = tilesOf(fresh);
    const int first = refinement_.on() ? nx_ * ny_ / 2 : 0, last = refinement_.on() ? first + 1 : nx_ * ny_;
    // Tasks that may be repeated after expansion are not complete while others run.
    const bool watched = job_.settings.watcher && !(job_.world && world::hasDeferred(*job_.world));
    if (watched) growth_.emplace(buffer, part, kTile);
    const uint64_t dropped = buffer.nonFinite();
    trace(
        buffer, tiles.size(),
        [&](size_t i, std::vector<Wanted>& wanted) {
            const Window& t = tiles[i];
            if (!watched && seesNothing(t)) return;
            for (int y = t.y0; y < t.y1; ++y)
                for (int x = t.x0; x < t.x1; ++x)
                    for (int k = first; k < last; ++k) wanted.push_back({x, y, k});
        },
        progressOf(b, 0, tiles.size()));
    if (refinement_.on() && !job_.pollStop()) refine(buffer, part, b);
    growth_.reset();
    dropped_.count += buffer.nonFinite() - dropped;
    reconstruct(buffer, part);
}

/// Shows finished tiles to the watcher.
void ImageLoop::show() {
    if (!growth_) return;
    Glance g;
    g.pixels = [this](const OutputSpec& s) {
        grow();
        return result_.images[result_.of[size_t(&s - job_.plan.pictures.data())]];
    };
    g.there = &there_;
    g.seconds = job_.elapsed();
    g.rays = job_.rayTotal;
    g.grown = growth_->grown();
    job_.settings.watcher->look(g);
}

/// Reconstructs pixels whose samples are complete.
void ImageLoop::grow() {
    growth_->take([this](const SampleBuffer& buffer, const Window& w) {
        for (size_t p = 0; p < filtered_.size(); ++p) {
            const size_t row = size_t(window_.width()) * result_.images[p].channels.size();
            buffer.reconstruct(weights_[p], filtered_[p]->depth, w, pixel(p, w.x0, w.y0), row);
        }
        for (int y = w.y0; y < w.y1; ++y) std::fill_n(there_.begin() + long(number(w.x0, y)), w.width(), uint8_t(1));
    });
}

void ImageLoop::showProgress(double fraction, bool last) {
    ProgressState s;
    s.fraction = fraction;
    s.samplesDone = fraction * nx_ * ny_;
    s.samplesTotal = uint64_t(nx_ * ny_);
    s.raysPerMS = raysPerMS(job_.rayTotal, job_.elapsed());
    if (job_.settings.watcher) job_.settings.watcher->progress(s, job_.what);
    if (last) job_.progress.finish(s, job_.what);
    else job_.progress.update(s, job_.what);
}

/// Progress callback for a band; `begin`: 0, or 1 for refinement tasks.
ImageLoop::Done ImageLoop::progressOf(int b, double begin, size_t tasks) {
    return [this, b, begin, tasks](size_t done) {
        job_.pollStop();
        show();
        const double steps = refinement_.on() ? 2 : 1;
        reached_ = (b + (begin + double(done) / double(std::max<size_t>(tasks, 1))) / steps) / bands_;
        showProgress(reached_, false);
    };
}

/// Traces samples of a buffer: those that `list` returns for task i.
void ImageLoop::trace(SampleBuffer& buffer, size_t tasks, const std::function<void(size_t, std::vector<Wanted>&)>& list,
                      const Done& done) {
    job_.run(
        tasks,
        [&](int worker, size_t i) {
            std::vector<Wanted>& wanted = kept_[size_t(worker)].wanted;
            wanted.clear();
            list(i, wanted);
            // A pixel with thousands of samples is traced in slices, so that each call stays small.
            constexpr size_t slice = 2048;
            for (size_t from = 0; from < wanted.size(); from += slice)
                if (!traceSlice(buffer, worker, std::span(wanted).subspan(from, std::min(slice, wanted.size() - from)))) return;
            if (growth_) growth_->over(i);
            if (!job_.unfinished(worker)) begun_ = true;
        },
        done);
}

/// Traces the depths of second surfaces with rays that start behind the first; samples have them only where the first surface is
/// transparent. Returns false if interrupted.
bool ImageLoop::traceBehind(int worker, Kept& k) const {
    constexpr float kBehind = 1 + 1e-5f; // relative to depth: beyond rounding, before any surface behind
    k.behind.clear();
    k.of.clear();
    const std::vector<integrator::CameraRay>& rays = k.image.rays();
    for (size_t i = 0; i < rays.size(); ++i) {
        if (!(k.results[i].z < 1e38f) || k.results[i].zSecond < 1e38f || !(rays[i].direction.z > 0)) continue;
        integrator::CameraRay r = rays[i];
        const float way = (k.results[i].z * kBehind - r.origin.z) / r.direction.z;
        r.origin += r.direction * way;
        r.start += way;
        r.width += r.spread * way;
        r.depthOnly = behindUnshaded_;
        k.behind.push_back(r);
        k.of.push_back(i);
    }
    if (k.behind.empty()) return true;
    k.found.resize(k.behind.size());
    if (!job_.trace(worker, k.behind, k.found)) return false;
    for (size_t i = 0; i < k.of.size(); ++i) k.results[k.of[i]].zSecond = k.found[i].z;
    return true;
}

/// Whether the samples of a tile, and all that share a filter with them, are known to see nothing. No samples are then stored:
/// all affected pixels are empty.
bool ImageLoop::seesNothing(const Window& t) const {
    if (refinement_.on()) return false;
    const int bx = 2 * int(std::ceil(xw_)), by = 2 * int(std::ceil(yw_));
    return job_.tracers[0]->seesNothing(job_.camera.sides({t.x0 - bx, t.y0 - by, t.x1 + bx, t.y1 + by}));
}

bool ImageLoop::traceSlice(SampleBuffer& buffer, int worker, std::span<const Wanted> wanted) {
    Kept& kept = kept_[size_t(worker)];
    kept.image.clear();
    for (const Wanted& w : wanted) kept.image.ask(w.x, w.y, w.k);
    kept.image.make();
    std::vector<integrator::CameraRay>& rays = kept.image.rays();
    for (integrator::CameraRay& r : rays) r.depthOnly = unshaded_;
    kept.results.resize(rays.size());
    if (!job_.trace(worker, rays, kept.results)) return false;
    if (job_.plan.needsDepth(DepthFilter::Midpoint) && !job_.unfinished(worker) && !traceBehind(worker, kept)) return false;
    if (job_.unfinished(worker)) return true; // these are traced again
    for (size_t k = 0; k < rays.size(); ++k) {
        integrator::SampleResult& r = kept.results[k];
        r.aovs.resize(aovs_.size());
        ImageSample s;
        s.color = clampSample(r.color, job_.settings.sampleClamp);
        s.opacity = r.opacity;
        if (r.z < 1e38f) s.z = r.z;
        if (r.zSecond < 1e38f) s.zSecond = r.zSecond;
        s.aovs = r.aovs;
        if (buffer.set(rays[k].px, rays[k].py, int(rays[k].sample), kept.image.places()[k], s)) continue;
        std::lock_guard lock(mutex_); // the result is the same for any thread order
        const std::array<int, 3> at{int(rays[k].sample), rays[k].py, rays[k].px};
        if (window_.contains(at[2], at[1]) && (!dropped_.first || at < *dropped_.first)) dropped_.first = at;
    }
    return true;
}

void ImageLoop::refine(SampleBuffer& buffer, const Window& part, int b) {
    const std::vector<Wanted> pixels = differing(buffer, part);
    constexpr size_t kPixels = 64;                                                    // in a task
    if (job_.world && world::hasDeferred(*job_.world)) job_.world->flushPrints(true); // existing samples are not traced again
    if (growth_) { // everything so far, while no worker is active
        reconstruct(buffer, part);
        std::vector<std::pair<int, int>> places;
        for (const Wanted& w : pixels) places.push_back({w.x, w.y});
        growth_.emplace(buffer, std::move(places), kPixels);
    }
    const size_t tasks = (pixels.size() + kPixels - 1) / kPixels;
    trace(
        buffer, tasks,
        [&](size_t i, std::vector<Wanted>& wanted) {
            for (size_t p = i * kPixels; p < std::min((i + 1) * kPixels, pixels.size()); ++p)
                for (int k = 0; k < nx_ * ny_; ++k)
                    if (k != pixels[p].k) wanted.push_back({pixels[p].x, pixels[p].y, k});
        },
        progressOf(b, 1, tasks));
    result_.refined.pixels += pixels.size();
    result_.refined.rays += pixels.size() * size_t(nx_ * ny_ - 1);
}

/// The pixels that differ from a neighbour, in reading order, with their existing samples. The buffer has one more pixel on all
/// sides, so that bands and crop windows have no effect.
std::vector<Wanted> ImageLoop::differing(const SampleBuffer& buffer, const Window& part) const {
    const int middle = nx_ * ny_ / 2;
    const auto colour = [&](int x, int y) {
        const Color c = buffer.color(x, y, middle);
        return Color(std::clamp(c.x, 0.f, 1.f), std::clamp(c.y, 0.f, 1.f), std::clamp(c.z, 0.f, 1.f));
    };
    std::vector<Wanted> found;
    for (int y = part.y0; y < part.y1; ++y)
        for (int x = part.x0; x < part.x1; ++x) {
            const Color c = colour(x, y);
            for (const auto& [dx, dy] : {std::pair{-1, 0}, {0, -1}, {1, 0}, {0, 1}}) {
                const Color d = colour(x + dx, y + dy) - c;
                if (!(std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z) > refinement_.threshold)) continue;
                found.push_back({x, y, middle});
                break;
            }
        }
    return found;
}

void ImageLoop::reconstruct(const SampleBuffer& buffer, const Window& part) {
    constexpr int kRows = 16; // in a task
    const size_t tasks = size_t((part.height() + kRows - 1) / kRows), channels = result_.images.front().channels.size();
    const size_t row = size_t(window_.width()) * channels;
    for (size_t p = 0; p < filtered_.size(); ++p) {
        // Images that differ only in their depth filter share everything else.
        size_t like = 0;
        while (!(weights_[like].filter() == weights_[p].filter())) ++like;
        StopFlag go{0};
        job_.team.run(
            tasks, &go,
            [&](int, size_t i) {
                const int y = part.y0 + int(i) * kRows;
                const Window rows{part.x0, y, part.x1, std::min(y + kRows, part.y1)};
                float* to = pixel(p, rows.x0, y);
                if (depthsAlone_) return buffer.reconstructDepth(filtered_[p]->depth, rows, to, row);
                if (like == p) return buffer.reconstruct(weights_[p], filtered_[p]->depth, rows, to, row);
                std::copy_n(pixel(like, rows.x0, y), size_t(rows.height()) * row, to);
                buffer.reconstructDepth(filtered_[p]->depth, rows, to, row);
            },
            [](size_t) {});
    }
    if (!there_.empty()) std::fill_n(there_.begin() + long(number(part.x0, part.y0)), part.pixels(), uint8_t(1));
}

PixelFilter ImageLoop::filterOf(size_t image) const {
    const bool own = refinement_.on() || jitter_ == Jitter::Middle;
    return own ? PixelFilter{FilterKind::Box, 1, 1} : filtered_[image]->filter;
}

} // namespace

Reconstructions renderImages(Job& job, int nx, int ny, Jitter jitter, const Refinement& refinement, uint64_t seed,
                             DroppedSamples* dropped, std::vector<float>& memory) {
    constexpr size_t kKeptBytes = size_t(64) << 20;
    *dropped = {};
    Reconstructions result;
    ImageLoop(job, nx, ny, jitter, refinement, seed, *dropped, result, memory).run();
    if (memory.capacity() * sizeof(float) > kKeptBytes) memory = {};
    return result;
}

} // namespace alpenglow::render
