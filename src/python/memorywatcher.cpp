#include "python/memorywatcher.h"
#include "scene/scene.h"
#include "world/world.h"
#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace alpenglow::python {
namespace {

constexpr double kLeast = 0.25; // seconds between two looks at a growing picture
constexpr double kShare = 0.02; // of the time of rendering

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

} // namespace

void MemoryWatcher::begin(const render::WatchedFrame& f) {
    if (!keeps_) return;
    own_ = &f.plan;
    plan_ = f.plan;
    for (render::OutputSpec& s : plan_->pictures) s.srgb = s.srgb && plan_->basis.srgbAsked;
    facts_ = f.picture;
    imager_ = f.imager;
    world_ = f.world;
    whole_ = false;
    last_ = cost_ = 0;
    partial_.clear();
    frame_ = f.world ? f.world->frame().options.frameNumber : 0;
}

void MemoryWatcher::look(const render::Glance& g) {
    if (!own_) return;
    if (g.whole()) {
        auto made = pictures(g.pixels, *own_, imager_, false);
        kept_.insert(kept_.end(), std::make_move_iterator(made.begin()), std::make_move_iterator(made.end()));
        whole_ = true;
        return;
    }
    if (!g.grown || (g.film && !grows_)) return; // the samples of path come with finished()
    const double now = seconds();
    if (now - last_ < std::max(kLeast, cost_ / kShare)) return;
    render::Imager imager;
    if (facts_.imager) // not the renderer's, which minds the first time that it is asked
        imager = [this](int n, const float* x, const float* y, float* r, float* gr, float* b, float* a) {
            Diagnostics unheard;
            world_->runImager(n, x, y, r, gr, b, a, unheard);
            return true;
        };
    auto made = pictures(g.pixels, *own_, imager, g.film != nullptr);
    if (grows_ && !made.empty()) {
        const std::lock_guard lock(mutex_);
        grown_ = made.front();
    }
    if (!g.film) partial_ = std::move(made);
    last_ = seconds();
    cost_ = last_ - now;
}

void MemoryWatcher::progress(const render::ProgressState& s, const std::string& what) {
    const std::lock_guard lock(mutex_);
    latest_ = Progress{s, what};
}

void MemoryWatcher::finished(std::unique_ptr<render::Film> film) {
    if (film && plan_) {
        partial_ = pictures([&](const render::OutputSpec& s) { return render::filmImage(*film, *plan_, s.depth); }, *plan_,
                            imager_, false);
        whole_ = false;
    }
    if (!whole_) kept_.insert(kept_.end(), std::make_move_iterator(partial_.begin()), std::make_move_iterator(partial_.end()));
    partial_.clear();
    own_ = nullptr;
    plan_.reset();
    imager_ = {};
    world_.reset();
}

std::vector<KeptPicture> MemoryWatcher::pictures(const Pixels& pixels, const render::OutputPlan& own,
                                                 const render::Imager& imager, bool first) const {
    std::vector<KeptPicture> all;
    for (size_t i = 0; i < plan_->pictures.size(); ++i) {
        const render::OutputSpec& s = plan_->pictures[i];
        if (s.deep) continue;
        auto image = render::finishedPicture(*plan_, s, facts_, pixels(own.pictures[i]), imager);
        if (!image) return {}; // the user stopped the imager
        KeptPicture p{s.name, s.type, frame_, facts_.width, facts_.height, facts_.window, facts_.pixelAspect, {}, {}};
        int channel = 0;
        for (const render::OutputVariable& v : s.variables) {
            p.variables.push_back({v.name, channel, int(v.channels.size())});
            channel += int(v.channels.size());
        }
        p.image = std::move(*image);
        all.push_back(std::move(p));
        if (first) break;
    }
    return all;
}

std::optional<KeptPicture> MemoryWatcher::grown() {
    const std::lock_guard lock(mutex_);
    return std::exchange(grown_, std::nullopt);
}

std::vector<KeptPicture> MemoryWatcher::take() { return std::exchange(kept_, {}); }

std::optional<MemoryWatcher::Progress> MemoryWatcher::latest() {
    const std::lock_guard lock(mutex_);
    return std::exchange(latest_, std::nullopt);
}

} // namespace alpenglow::python
