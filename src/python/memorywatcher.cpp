#include "python/memorywatcher.h"
#include "scene/scene.h"
#include "world/world.h"
#include <utility>

namespace alpenglow::python {

void MemoryWatcher::begin(const render::WatchedFrame& f) {
    if (!keeps_) return;
    own_ = &f.plan;
    plan_ = f.plan;
    for (render::OutputSpec& s : plan_->pictures) s.srgb = s.srgb && plan_->basis.srgbAsked;
    facts_ = f.picture;
    imager_ = f.imager;
    frame_ = f.world ? f.world->frame().options.frameNumber : 0;
}

void MemoryWatcher::look(const render::Glance& g) {
    if (own_ && g.whole()) keep(g.pixels, *own_);
}

void MemoryWatcher::progress(const render::ProgressState& s, const std::string& what) {
    const std::lock_guard lock(mutex_);
    told_ = Told{s, what};
}

void MemoryWatcher::finished(std::unique_ptr<render::Film> film) {
    if (film && plan_) keep([&](const render::OutputSpec& s) { return render::filmImage(*film, *plan_, s.depth); }, *plan_);
    own_ = nullptr;
    plan_.reset();
    imager_ = {};
}

void MemoryWatcher::keep(const std::function<render::Image(const render::OutputSpec&)>& pixels, const render::OutputPlan& own) {
    for (size_t i = 0; i < plan_->pictures.size(); ++i) {
        const render::OutputSpec& s = plan_->pictures[i];
        if (s.deep) continue;
        auto image = render::finishedPicture(*plan_, s, facts_, pixels(own.pictures[i]), imager_);
        if (!image) return; // the user stopped the imager
        KeptPicture p{s.name, s.type, frame_, facts_.width, facts_.height, facts_.window, facts_.pixelAspect, {}, {}};
        int first = 0;
        for (const render::OutputVariable& v : s.variables) {
            p.variables.push_back({v.name, first, int(v.channels.size())});
            first += int(v.channels.size());
        }
        p.image = std::move(*image);
        kept_.push_back(std::move(p));
    }
}

std::vector<KeptPicture> MemoryWatcher::take() { return std::exchange(kept_, {}); }

std::optional<MemoryWatcher::Told> MemoryWatcher::told() {
    const std::lock_guard lock(mutex_);
    return std::exchange(told_, std::nullopt);
}

} // namespace alpenglow::python
