#include "world/cloudstore.h"
#include "pointcloud/brickmap.h"
#include "pointcloud/cloudfile.h"
#include "pointcloud/limits.h"
#include "texture/volume.h"
#include <tuple>

namespace alpenglow::world {

std::optional<std::string> CloudStore::pathOf(const std::string& name, const SourcePlace& place) {
    static constexpr MapKind kKind{"point cloud", "lookups return 0", "make it by bake3d() in an earlier frame", true,
                                   "point cloud or brick map"};
    return findMap(name, files_, kKind, diagnostics_, place);
}

const pointcloud::CloudMap* CloudStore::find(const std::string& name, const SourcePlace& place) {
    if (name.empty()) return nullptr;
    std::lock_guard lock(mutex_);
    const auto [at, fresh] = maps_.try_emplace(name);
    if (!fresh) return at->second.get();
    // Image stacks and voxel grids are looked up like point clouds.
    const auto volume = [&]() -> std::shared_ptr<const pointcloud::CloudMap> {
        std::vector<std::string> folders = {""};
        folders.insert(folders.end(), files_.folders.begin(), files_.folders.end());
        auto v = texture::loadVolume(name, {folders, files_.read, place}, diagnostics_);
        return v ? texture::mapOf(std::move(*v)) : nullptr;
    };
    if (texture::namesVolume(name)) return (at->second = volume()).get();
    if (const auto path = pathOf(name, place))
        at->second = texture::holdsVolume(*path) ? volume() : pointcloud::openMap(*path, diagnostics_, place);
    return at->second.get();
}

void CloudStore::noteLookup(const pointcloud::CloudMap* map, bool found, const SourcePlace& place) {
    std::lock_guard lock(mutex_);
    const auto [at, fresh] = asked_.try_emplace(map, Asked{found, place});
    if (fresh) return;
    at->second.found |= found;
    const auto order = [](const SourcePlace& p) { return std::tie(p.file, p.line, p.column); };
    if (order(place) < order(at->second.place)) at->second.place = place;
}

std::vector<std::pair<std::string, SourcePlace>> CloudStore::foundNothing() {
    std::lock_guard lock(mutex_);
    std::vector<std::pair<std::string, SourcePlace>> all;
    for (const auto& [name, map] : maps_)
        if (const auto of = asked_.find(map.get()); map && of != asked_.end() && !of->second.found)
            all.emplace_back(name, of->second.place);
    return all;
}

std::shared_ptr<const pointcloud::PointOctree>
CloudStore::octree(const std::string& name, bool light, const std::optional<pointcloud::Shear>& shear, const SourcePlace& place) {
    if (name.empty()) return nullptr;
    std::lock_guard lock(mutex_);
    for (const bool lit : {light, true}) // one with light serves both
        if (const auto known = octrees_.find({name, lit, shear}); known != octrees_.end()) return known->second;
    auto made = makeOctree(name, light, shear, place);
    // Objects can use any number of sheared spaces. Which ones are kept affects time only.
    if (!shear || !made || ++sheared_ <= limits::kShearedOctrees) octrees_[{name, light, shear}] = made;
    return made;
}

std::shared_ptr<const pointcloud::PointOctree> CloudStore::makeOctree(const std::string& name, bool light,
                                                                      const std::optional<pointcloud::Shear>& shear,
                                                                      const SourcePlace& place) {
    const auto path = pathOf(name, place);
    if (!path) return nullptr;
    const auto report = [&](Severity s, const std::string& what, const std::string& hint) {
        diagnostics_.reportOnce("octree:" + name + what,
                                {s, Rie::BadFile, place, "point cloud \"" + name + "\" " + what, hint, {}});
    };
    if (pointcloud::isBrickMap(*path)) {
        report(Severity::Error, "is a brick map, which point-based shadeops cannot read; it is ignored",
               "use the point cloud that it was made of");
        return nullptr;
    }
    auto cloud = pointcloud::loadCloud(*path, diagnostics_, place);
    if (!cloud) return nullptr;
    if (cloud->size() > limits::kOctreePoints) {
        report(Severity::Error, "has more than " + std::to_string(limits::kOctreePoints) + " points; it is ignored",
               "alpenglow ptc filter --depth thins it");
        return nullptr;
    }
    if (shear) pointcloud::transform(*cloud, shear->matrix());
    std::string channel;
    if (light)
        for (const char* known : {"_irradiance", "_radiosity"})
            if (cloud->offsetOf(known) >= 0) channel = known;
    auto octree = std::make_shared<pointcloud::PointOctree>(*cloud, channel);
    if (cloud->size() == 0) report(Severity::Warning, "has no points", "bake3d() says which surfaces it bakes");
    else if (octree->leftOut() > 0)
        report(octree->points().empty() ? Severity::Error : Severity::Warning,
               "has " + std::to_string(octree->leftOut()) + " points without area, which are ignored",
               "bake3d() writes a radius and \"_area\"");
    if (light && !octree->lit() && cloud->size() > 0)
        report(Severity::Warning, "has no channel \"_radiosity\"; its points emit no light",
               "bake3d(..., \"_radiosity\", Ci) writes it");
    return octree;
}

} // namespace alpenglow::world
