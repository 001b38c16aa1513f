// Observes the current render for the view: shots for viewers, and saved pictures.
#include "render/filmpicture.h"
#include "render/imaging.h"
#include "render/noise.h"
#include "scene/scene.h"
#include "view/session.h"
#include <algorithm>
#include <cmath>
#include <filesystem>

namespace alpenglow::view {
namespace {

constexpr double kShotShare = 0.02; ///< largest fraction of rendering time for shots
constexpr double kShotLeast = 0.08; ///< seconds between two
constexpr size_t kMostPoints = 4000;

using Seconds = std::chrono::duration<double>;

render::Imager imagerOf(const std::shared_ptr<const world::World>& world, Diagnostics& diags) {
    return [world, &diags](int n, const float* x, const float* y, float* r, float* g, float* b, float* a) {
        world->runImager(n, x, y, r, g, b, a, diags);
        return true;
    };
}

/// An imager, and a curve behind it.
render::Imager exposedBehind(render::Imager imager, float gain, float gamma) {
    if (gain == 1 && gamma == 1) return imager;
    return
        [imager = std::move(imager), gain, gamma](int n, const float* x, const float* y, float* r, float* g, float* b, float* a) {
            if (!imager(n, x, y, r, g, b, a)) return false;
            for (float* c : {r, g, b})
                for (int i = 0; i < n; ++i) c[i] = render::expose(c[i], gain, gamma);
            return true;
        };
}

} // namespace

void Session::begin(const render::WatchedFrame& f) {
    auto means = std::make_shared<Means>(Means{f.plan, f.picture, f.world});
    plan_ = &f.plan;
    Diagnostics quiet;
    render::OutputSpec png = render::singleOutput("view.png", f.plan.basis, quiet);
    for (render::OutputSpec& s : means->plan.pictures) { // linear light, without the display curve
        s.gain = s.gamma = 1;
        s.srgb = false;
        s.ownExposure = false;
    }
    if (f.picture.imager) { // the imager runs after exposure; the page's curve comes last
        render::OutputSpec& first = means->plan.pictures.front();
        first.gain = png.gain;
        first.gamma = png.gamma;
        png.gain = png.gamma = 1;
        for (render::OutputSpec& s : means->plan.pictures)
            if (s.name.starts_with("light:")) { // parts of the picture
                s.gain = first.gain;
                s.ownExposure = true;
            }
    }
    means_ = means;
    grew_ = false;
    if (pass_.phase == Phase::Whole) kept_.means = means;
    std::lock_guard lock(mutex_);
    curveAtFirst_ = {double(png.gain), double(png.gamma), png.srgb ? 1.0 : 0.0};
}

std::unique_ptr<render::Film> Session::filmFor(const render::FilmDescription& d) {
    if (pass_.phase != Phase::Whole || !kept_.film || kept_.film->description() != d) {
        if (pass_.phase == Phase::Whole) kept_.seconds = kept_.rays = 0;
        return nullptr;
    }
    return std::move(kept_.film);
}

void Session::look(const render::Glance& g) {
    if (pass_.phase != Phase::Coarse && overtaken()) stop_ = 1; // requested during the build, which is not interrupted
    passSeconds_ = g.seconds;
    passRays_ = double(g.rays);
    if (g.film && g.grown && pass_.phase == Phase::Whole && g.film->samplesPerPixel() > 0)
        sampleSeconds_ = (kept_.seconds + g.seconds) / (double(g.film->samplesPerPixel()) * double(g.film->window().pixels()));
    if (!g.film) kept_.image.reset();
    if (g.whole() && pass_.phase == Phase::Whole)
        kept_.image = std::make_shared<render::Image>(g.pixels(plan_->pictures.front()));
    if (!g.there && pass_.phase == Phase::Whole) savePending(*means_, g.film, [&] { return g.pixels(plan_->pictures.front()); });
    stale_ |= g.grown;
    grew_ |= g.grown;
    if (g.there && (!grew_ || pass_.factor != 1)) return; // nothing yet, or everything arrives at once
    if (g.whole() || shotIsDue()) shoot(g, *means_);
}

void Session::finished(std::unique_ptr<render::Film> film) {
    plan_ = nullptr;
    if (pass_.phase != Phase::Whole) {
        if (film && stale_ && !stop_ && pass_.phase == Phase::Crop) { // its last samples
            render::Glance g;
            g.pixels = [&](const render::OutputSpec& s) { return render::filmImage(*film, means_->plan, s.depth); };
            g.film = film.get();
            g.seconds = passSeconds_;
            g.rays = uint64_t(passRays_);
            shoot(g, *means_);
        }
        return;
    }
    kept_.seconds += passSeconds_;
    kept_.rays += passRays_;
    passSeconds_ = passRays_ = 0;
    if (film) kept_.film = std::move(film);
}

std::set<std::string> Session::wantedPlanes() const {
    std::lock_guard lock(mutex_);
    std::set<std::string> names;
    for (const auto& [name, when] : viewers_)
        if (Clock::now() - when < std::chrono::seconds(20)) names.insert(name);
    return names;
}

bool Session::shotIsDue() const {
    if (shownOf_ != pass_.phase) return true; // the first of its kind
    const std::set<std::string> wanted = wantedPlanes();
    if (wanted.empty()) return false;
    for (const std::string& w : wanted)
        if (!shotPlanes_.contains(w)) return true;
    return stale_ && Seconds(Clock::now() - lastShot_).count() >= std::max(kShotLeast, shotSeconds_ / kShotShare);
}

/// While nothing renders: shows what was not shown yet, and handles requests.
void Session::lookAtRest() {
    if (!kept_.means || (!kept_.film && !kept_.image)) return;
    const auto image = [&] {
        return kept_.film ? render::filmImage(*kept_.film, kept_.means->plan, kept_.means->plan.pictures.front().depth)
                          : *kept_.image;
    };
    savePending(*kept_.means, kept_.film.get(), image);
    bool missing = false;
    for (const std::string& w : wantedPlanes()) missing |= !shotPlanes_.contains(w);
    if (!stale_ && !missing && shownOf_ == Phase::Whole) return;
    pass_.phase = Phase::Whole;
    passSeconds_ = passRays_ = 0;
    plan_ = nullptr;
    render::Glance g;
    g.pixels = [&](const render::OutputSpec&) { return image(); };
    g.film = kept_.film.get();
    shoot(g, *kept_.means);
}

void Session::shoot(const render::Glance& g, const Means& means) {
    const auto begun = Clock::now();
    auto picture = std::make_shared<Picture>();
    picture->number = ++pictures_;
    picture->window = means.facts.window;
    const bool coarse = pass_.phase == Phase::Coarse;
    picture->width = coarse ? width_ : means.facts.width;
    picture->height = coarse ? height_ : means.facts.height;
    picture->stepX = double(picture->width) / means.facts.width;
    picture->stepY = double(picture->height) / means.facts.height;
    const std::set<std::string> wanted = wantedPlanes();
    const render::OutputPlan& own = plan_ ? *plan_ : means.plan;
    const render::Image image = g.pixels(own.pictures.front());
    const render::Imager imager = means.facts.imager ? imagerOf(means.world, *diags_) : render::Imager{};
    for (const render::OutputSpec& s : means.plan.pictures) {
        const bool first = &s == &means.plan.pictures.front();
        if (!first && !wanted.contains(s.name) && !s.name.starts_with("light:")) continue;
        auto finished = render::finishedPicture(means.plan, s, means.facts, image, first ? imager : render::Imager{});
        if (finished && (s.name.starts_with("light:") || s.name.starts_with("lpe:")) && finished->channels.size() == 3)
            finished->channels = {"r", "g", "b"};
        if (finished) picture->planes.push_back({s.name, std::make_shared<display::Image>(std::move(*finished))});
    }
    if (g.there && shownOf_) { // earlier shots of this round
        const std::shared_ptr<const Picture> before = [&] {
            std::lock_guard lock(mutex_);
            return picture_;
        }();
        if (before) fill(*picture, *g.there, *before);
    }
    if (wanted.contains("noise") && g.film)
        picture->planes.push_back({"noise", std::make_shared<display::Image>(noisePlane(*g.film))});
    Figures& f = picture->figures;
    const bool whole = pass_.phase == Phase::Whole;
    f.seconds = (whole ? kept_.seconds : 0) + g.seconds;
    f.raysPerMS = f.seconds > 0 ? ((whole ? kept_.rays : 0) + double(g.rays)) / f.seconds / 1000 : 0;
    const scene::Options& o = round_.frame->options;
    f.spp = g.film          ? g.film->samplesPerPixel()
            : pass_.spp > 0 ? pass_.spp
                            : std::round(std::max(1.f, o.pixelSamplesX)) * std::round(std::max(1.f, o.pixelSamplesY));
    if (g.film) {
        const render::NoiseFigures n = render::noiseFigures(*g.film);
        f.noiseRSE = n.noiseRSE;
        f.noiseRSE999 = n.noiseRSE999;
        f.noise = n.noise;
        f.noiseAtMost = n.noiseAtMost;
        f.efficiency = render::efficiency(n.noiseRSE, f.seconds);
    }
    if (pass_.phase == Phase::Crop) {
        if (!g.there) {
            crop_ = picture;
            cropOf_ = pass_.crop;
        }
    } else if (whole && crop_ && crop_->figures.spp > f.spp && g.film) overlay(*picture, *crop_);
    shotPlanes_ = wanted;
    stale_ = false;
    shownOf_ = pass_.phase;
    lastShot_ = Clock::now();
    shotSeconds_ = Seconds(lastShot_ - begun).count();
    {
        std::lock_guard lock(mutex_);
        // Around a crop the earlier picture remains; new pages shall see it, too.
        if (pass_.phase == Phase::Crop && picture_ && picture_->stepX == 1 && picture_->width == picture->width) {
            auto both = std::make_shared<Picture>(*picture_);
            overlay(*both, *picture);
            both->figures = picture->figures;
            both->number = ++pictures_;
            picture_ = both;
        } else picture_ = picture;
        if (whole && g.film && (curve_.empty() || curve_.back()[1] < f.spp)) {
            if (curve_.size() >= kMostPoints) { // drops every other point
                for (size_t i = 0; i < curve_.size() / 2; ++i) curve_[i] = curve_[2 * i + 1];
                curve_.resize(curve_.size() / 2);
                ++curveOf_;
            }
            curve_.push_back({f.seconds, f.spp, f.raysPerMS, f.noiseRSE, f.efficiency});
        }
    }
    notifyViewers();
}

std::string Session::freeName(const std::string& type, const render::Film* film) const {
    const std::string stem = film ? "Pathtraced_" + std::to_string(film->samplesPerPixel())
                                  : "Raytraced_" + std::to_string(std::max(0, round_.wishes.depth));
    for (int no = 0;; ++no) {
        std::string name = stem + "_" + std::to_string(no) + "." + type;
        std::error_code e;
        if (!std::filesystem::exists(name, e)) return name;
    }
}

void Session::savePending(const Means& means, const render::Film* film, const std::function<render::Image()>& image) {
    std::vector<Save> saves;
    {
        std::lock_guard lock(mutex_);
        if (saves_.empty()) return;
        saves.swap(saves_);
    }
    for (const Save& s : saves) save(s, means, film, image());
    notifyViewers();
}

/// Saves like render -o: PNG with the curve of the page, EXR with linear values. Lights as dimmed.
bool Session::save(const Save& s, const Means& means, const render::Film* film, const render::Image& image) {
    const std::string name = freeName(s.type, film);
    render::OutputPlan plan = means.plan;
    render::OutputSpec spec = render::singleOutput(name, plan.basis, *diags_);
    render::Imager imager = means.facts.imager ? imagerOf(means.world, *diags_) : render::Imager{};
    if (s.type == "png") {
        const float gamma = s.srgb ? 1 : s.gamma; // one or the other
        spec.srgb = s.srgb;
        if (imager) { // behind it, as on the page
            spec.gain = means.plan.pictures.front().gain;
            spec.gamma = means.plan.pictures.front().gamma;
            imager = exposedBehind(std::move(imager), s.gain, gamma);
        } else {
            spec.gain = s.gain;
            spec.gamma = gamma;
        }
    }
    plan.pictures.assign(1, spec);
    plan.resolve(plan.engineWidths, *diags_);
    std::map<std::string, double> dim;
    {
        std::lock_guard lock(mutex_);
        dim = wishes_.dim;
    }
    render::Image mixed = image;
    bool mixes = false;
    for (render::OutputSpec part : means.plan.pictures) {
        if (!part.name.starts_with("light:") || !dim.contains(part.name.substr(6)) || dim[part.name.substr(6)] == 1) continue;
        part.ownExposure = false; // they are put together before the imager
        const auto light = render::finishedPicture(means.plan, part, means.facts, image, {});
        if (!light) continue;
        mixes = true;
        const float by = float(dim[part.name.substr(6)] - 1);
        const size_t n = mixed.channels.size();
        for (size_t i = 0; i < mixed.window.pixels(); ++i)
            for (size_t k = 0; k < 3; ++k) mixed.data[i * n + k] += by * light->data[i * 3 + k];
    }
    const bool fine = film && !mixes
                          ? render::writeFilm(*film, plan, means.facts, imager, false, *diags_)
                          : render::writeOutputs(
                                plan, means.facts, [&](const render::OutputSpec&) -> const render::Image& { return mixed; },
                                imager, false, *diags_);
    std::lock_guard lock(mutex_);
    if (fine) saved_.push_back(name);
    if (saved_.size() > 100) saved_.erase(saved_.begin());
    return fine;
}

} // namespace alpenglow::view
