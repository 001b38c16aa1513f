// Camera rays of image samples.
#include "render/rendering.h"

namespace alpenglow::render {

ImageRays::ImageRays(const Camera& camera, uint64_t seed, int nx, int ny, Jitter jitter)
    : camera_(&camera), seed_(seed), net_(nx, ny, camera.shutterClose() > camera.shutterOpen(), camera.hasLens()),
      places_(seed, nx, ny, jitter) {}

void ImageRays::clear() {
    places_.clear();
    asked_.clear();
}

void ImageRays::ask(int x, int y, int k) {
    places_.ask(x, y, k);
    asked_.push_back({x, y, k});
}

void ImageRays::make() {
    places_.draw();
    rays_.resize(asked_.size());
    const LensGrid& grid = camera_->lensGrid();
    std::optional<PixelNet::Pixel> pixel;
    if (camera_->plain() && !net_.asked()) return makePlain();
    for (size_t i = 0; i < asked_.size(); ++i) {
        const Asked& a = asked_[i];
        PixelNet::Numbers n;
        if (net_.asked()) {
            if (!pixel || a.x != asked_[i - 1].x || a.y != asked_[i - 1].y) pixel = net_.pixel(Sampler(seed_, a.x, a.y));
            n = net_.sample(*pixel, a.k);
            if (grid.on()) n.lens = {(float(a.k % grid.x) + 0.5f) / float(grid.x), (float(a.k / grid.x) + 0.5f) / float(grid.y)};
        }
        const Vec2 place = places_.places()[i];
        rays_[i] = camera_->ray(float(a.x) + place.x, float(a.y) + place.y, n.lens, n.time);
        rays_[i].px = a.x;
        rays_[i].py = a.y;
        rays_[i].sample = uint32_t(a.k);
    }
}

/// The same for rays that differ by raster position only.
void ImageRays::makePlain() {
    raster_.resize(asked_.size());
    for (size_t i = 0; i < asked_.size(); ++i) {
        const Vec2 place = places_.places()[i];
        raster_[i] = {float(asked_[i].x) + place.x, float(asked_[i].y) + place.y};
    }
    camera_->plainRays(raster_, rays_.data());
    for (size_t i = 0; i < asked_.size(); ++i) {
        rays_[i].px = asked_[i].x;
        rays_[i].py = asked_[i].y;
        rays_[i].sample = uint32_t(asked_[i].k);
    }
}

} // namespace alpenglow::render
