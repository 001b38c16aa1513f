#include "view/preview.h"
#include "base/srgb.h"
#include <algorithm>
#include <chrono>
#include <cmath>

namespace alpenglow::view {
namespace {

constexpr double kLeast = 0.25; ///< seconds between two pictures
constexpr double kShare = 0.02; ///< of the time of rendering

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

} // namespace

void Preview::begin(const render::WatchedFrame& f) {
    own_ = &f.plan;
    plan_ = f.plan;
    for (render::OutputSpec& s : plan_->pictures) {
        if (!f.picture.imager) s.gain = s.gamma = 1; // an imager needs the result of exposure
        s.srgb = s.ownExposure = false;
    }
    facts_ = f.picture;
    world_ = f.world;
    last_ = -1;
    cost_ = 0;
    stale_ = false;
}

void Preview::look(const render::Glance& g) {
    stale_ |= g.grown;
    const double t = now();
    const bool due = last_ < 0 || g.whole() || t - last_ >= std::max(kLeast, cost_ / kShare);
    if (!stale_ || !own_ || !due) return;
    show(g, *own_);
    stale_ = false;
    last_ = now();
    cost_ = last_ - t;
}

void Preview::show(const render::Glance& g, const render::OutputPlan& own) {
    render::Imager imager;
    if (facts_.imager) // a separate one: the renderer's stores when it was first called
        imager = [this](int n, const float* x, const float* y, float* r, float* gr, float* b, float* a) {
            world_->runImager(n, x, y, r, gr, b, a, diagnostics_);
            return true;
        };
    for (size_t i = 0; i < plan_->pictures.size(); ++i) {
        const render::OutputSpec& s = plan_->pictures[i];
        if (s.map || s.deep || !wants(s)) continue;
        if (const auto image = render::finishedPicture(*plan_, s, facts_, g.pixels(own.pictures[i]), imager))
            show(s, facts_, *image);
    }
}

void Preview::finished(std::unique_ptr<render::Film> film) {
    if (film && stale_ && plan_) { // its last samples
        render::Glance g;
        g.pixels = [&](const render::OutputSpec& s) { return render::filmImage(*film, *plan_, s.depth); };
        g.film = film.get();
        show(g, *plan_);
    }
    own_ = nullptr;
    plan_.reset();
    world_.reset();
}

void Watchers::finished(std::unique_ptr<render::Film> film) {
    if (all.empty()) return;
    for (size_t i = 0; i + 1 < all.size(); ++i) all[i]->finished(film ? std::make_unique<render::Film>(*film) : nullptr);
    all.back()->finished(std::move(film));
}

Bytes shrunk(const display::Image& image, int width, int height) {
    Bytes out{std::clamp(width, 1, std::max(image.width, 1)), std::clamp(height, 1, std::max(image.height, 1)), {}};
    out.rgb.resize(size_t(out.width) * size_t(out.height) * 3);
    const size_t n = image.channels.size();
    uint8_t* to = out.rgb.data();
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const int x0 = int(int64_t(x) * image.width / out.width),
                      x1 = std::max(x0 + 1, int(int64_t(x + 1) * image.width / out.width));
            const int y0 = int(int64_t(y) * image.height / out.height),
                      y1 = std::max(y0 + 1, int(int64_t(y + 1) * image.height / out.height));
            double sum[3] = {0, 0, 0};
            for (int py = y0; py < y1; ++py)
                for (int px = x0; px < x1; ++px)
                    for (size_t k = 0; k < 3; ++k) {
                        const float v = image.pixel(px, py)[n >= 3 ? k : 0];
                        sum[k] += std::isfinite(v) ? std::clamp(double(v), 0.0, 1e6) : 0;
                    }
            for (double s : sum)
                *to++ = uint8_t(std::lround(std::clamp(double(srgbEncode(float(s / ((x1 - x0) * (y1 - y0))))), 0.0, 1.0) * 255));
        }
    return out;
}

} // namespace alpenglow::view
