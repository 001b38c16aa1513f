// What a world knows of its shapes, procedurals and maps; the world of no scene. worldbuilder.cpp builds those of scenes.
#include "base/hash.h"
#include "geometry/placed.h"
#include "scene/deferred.h"
#include "scene/numbers.h"
#include "scene/scene.h"
#include "world/cloudstore.h"
#include "world/ptexstore.h"
#include "world/surfaces.h"

namespace alpenglow::world {

void MutableWorld::numberShapes() {
    for (uint32_t i = 0; i < shapes_.size(); ++i) {
        numberOfShape_.emplace(shapes_[i].get(), i);
        const geometry::Placed* p = shapes_[i]->placed();
        if (!p) continue;
        moves_ |= p->moves();
        numberOfShape_.emplace(p->geometry().get(), i); // dicing looks up a binding by geometry
        if (p->deforming())
            for (const auto& key : p->deforming()->keys()) numberOfShape_.emplace(key.get(), i);
    }
    const auto waits = [](const scene::PrimitiveRef& p) { return p && scene::isProcedural(*p); };
    if (std::none_of(frame_->primitives.begin(), frame_->primitives.end(), waits)) return;
    std::map<std::string, uint32_t> within; // shapes of each part so far
    for (const geometry::ShapeRef& s : shapes_) {
        const std::string part = scene::partOf(s->attributes());
        uint64_t key = 0;
        for (const char c : part) key = mix64(key ^ uint64_t(uint8_t(c)));
        keysOfShapes_.push_back(part.empty() ? within[part]++ : uint32_t(mix64(key + within[part]++)));
    }
}

void MutableWorld::findProcedurals() {
    std::vector<DeferredBounds::Bound> bounds;
    const Matrix toCamera = scene::at(frame_->options.worldToCamera, scene::Shutter(frame_->options).open);
    for (const scene::PrimitiveRef& p : frame_->primitives) {
        if (!p || !scene::isProcedural(*p)) continue;
        DeferredBounds::Bound b;
        for (const Matrix& m : scene::overShutter(p->toWorld, scene::Shutter(frame_->options)).keys)
            for (int k = 0; k < 8; ++k) {
                const Vec3d corner(p->numbers[k & 1 ? 1 : 0], p->numbers[k & 2 ? 3 : 2], p->numbers[k & 4 ? 5 : 4]);
                b.box.add(Vec3(transformPoint(m * toCamera, corner)));
            }
        b.number = scene::deferredNumber(*p);
        procedurals_.add(b.box);
        if (scene::isDeferred(*p)) bounds.push_back(b);
    }
    if (!bounds.empty()) deferred_ = std::make_unique<DeferredBounds>(std::move(bounds), settings_.deferredAtOnce);
}

std::vector<World::MapRead> WorldImpl::mapsRead() const {
    std::vector<MapRead> all;
    for (const auto& f : textures_->files()) all.push_back({f.path, f.bytes, f.memory, f.scratch});
    return all;
}

void MutableWorld::begin(std::shared_ptr<const scene::Frame> frame, const Settings& settings, ServiceTable services,
                         Diagnostics& d) {
    frame_ = std::move(frame);
    sceneLights_ = frame_->lights.size();
    settings_ = settings;
    services_ = services;
    diagnostics_ = &d;
    setCamera(frame_->options);
    const MapFiles files{settings.texturePaths, settings.read};
    photons_ = std::make_shared<PhotonStore>(files, worldToCamera_, d);
    clouds_ = std::make_shared<CloudStore>(files, d);
    ptex_ = std::make_shared<PtexStore>(files, d);
}

std::shared_ptr<const WorldImpl> emptyWorld(const Settings& settings, ServiceTable services, Diagnostics& d) {
    auto w = std::make_shared<MutableWorld>();
    w->begin(std::make_shared<scene::Frame>(), settings, services, d);
    w->textures_ = std::make_unique<texture::TextureSystem>(d);
    w->accel_ = std::make_unique<accel::Accel>(w->shapes_, std::vector<uint32_t>(), d, true);
    return w;
}

} // namespace alpenglow::world
